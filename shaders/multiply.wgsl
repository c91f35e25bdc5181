// a·b as (low, high), from 16-bit limbs.
fn multiply(a: u32, b: u32) -> vec2<u32> {
    let a0 = a & 0xffffu;
    let a1 = a >> 16u;
    let b0 = b & 0xffffu;
    let b1 = b >> 16u;
    let middle = a1 * b0 + ((a0 * b0) >> 16u);
    let cross = (middle & 0xffffu) + a0 * b1;
    return vec2<u32>(a * b, a1 * b1 + (middle >> 16u) + (cross >> 16u));
}
