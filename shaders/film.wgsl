// The exact film: sums of samples as integers, so that no order of adding changes a
// bit and a billion samples lose nothing. Per pixel 13 words: three for each
// channel's sum, four for the sum of the squared luminance.

const FILM_WORDS: u32 = 13u;

@group(0) @binding(2) var<storage, read_write> film: array<atomic<u32>>;

// trunc(x·2^shift) as (low, high), for 0 <= x with x·2^shift < 2^64: the mantissa is
// moved into place, nothing is rounded but what falls off the low end.
fn to_fixed(x: f32, shift: i32) -> vec2<u32> {
    let bits = bitcast<u32>(x);
    let exponent = i32(bits >> 23u);
    // The mantissa at the very top of the 64 bits, then down by `down` bits.
    let top = ((bits & 0x007fffffu) | 0x00800000u) << 8u;
    let down = u32(clamp(190 - exponent - shift, 0, 64));
    let d = down & 31u;
    let high = top >> d;
    let low = (top << (31u - d)) << 1u;
    let lost = exponent == 0 || down >= 64u;
    let fixed = select(vec2<u32>(low, high), vec2<u32>(high, 0u), down >= 32u);
    return select(fixed, vec2<u32>(0u), lost);
}

// Rec. 709 luminance weights in units of 2^-16; they add up to one.
const LUMINANCE: vec3<u32> = vec3<u32>(13933u, 46871u, 4732u);

// floor((13933 r + 46871 g + 4732 b)/2^16). Partial sums cannot overflow: the
// weights add up to 2^16 and each limb is at most 2^16 - 1.
fn luminance(r: vec2<u32>, g: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let limb0 = dot(vec3<u32>(r.x, g.x, b.x) & vec3<u32>(0xffffu), LUMINANCE);
    let limb1 = dot(vec3<u32>(r.x, g.x, b.x) >> vec3<u32>(16u), LUMINANCE);
    let limb2 = dot(vec3<u32>(r.y, g.y, b.y) & vec3<u32>(0xffffu), LUMINANCE);
    let limb3 = dot(vec3<u32>(r.y, g.y, b.y) >> vec3<u32>(16u), LUMINANCE);
    let base = limb1 + (limb0 >> 16u);
    let low = base + (limb2 << 16u);
    return vec2<u32>(low, limb3 + (limb2 >> 16u) + u32(low < base));
}

// floor(y²/2^32) as three words, low first.
fn square(y: vec2<u32>) -> vec3<u32> {
    let low = multiply(y.x, y.x).y;
    let cross = multiply(y.x, y.y);
    let high = multiply(y.y, y.y);
    // low + 2·cross + high·2^32
    let doubled = vec3<u32>(cross.x << 1u, (cross.y << 1u) | (cross.x >> 31u), cross.y >> 31u);
    let w0 = low + doubled.x;
    let carry0 = u32(w0 < low);
    let sum1 = high.x + doubled.y;
    let w1 = sum1 + carry0;
    let carry1 = u32(sum1 < high.x) + u32(w1 < sum1);
    return vec3<u32>(w0, w1, high.y + doubled.z + carry1);
}

// Adds one word of a sample's share to the film and returns the carry out. A word
// that is all ones takes a carry by becoming zero and passing it on; each carry is
// made by exactly one invocation, so the sums are right whatever the order. Zeros are
// added too: sparing them costs a group of invocations more than it saves.
fn add_word(word: u32, value: u32, carry: u32) -> u32 {
    let addend = value + carry;
    let before = atomicAdd(&film[word], addend);
    // The addend itself wraps where a value of all ones meets a carry.
    return u32(before + addend < before) | (carry & u32(addend == 0u));
}

// Adds a two-word integer and returns the carry out.
fn add_pair(word: u32, value: vec2<u32>) -> u32 {
    return add_word(word + 1u, value.y, add_word(word, value.x, 0u));
}

// Adds one sample to the pixel whose first word is `word`.
fn add_sample(word: u32, radiance: vec3<f32>) {
    let r = to_fixed(radiance.x, scene.film_shift);
    let g = to_fixed(radiance.y, scene.film_shift);
    let b = to_fixed(radiance.z, scene.film_shift);
    let squared = square(luminance(r, g, b));
    // Bit k stands for a carry into word k: the last word of each sum gets nothing else,
    // and carries are rare.
    var carries = add_pair(word, r) << 2u;
    carries |= add_pair(word + 3u, g) << 5u;
    carries |= add_pair(word + 6u, b) << 8u;
    carries |= add_word(word + 11u, squared.z, add_pair(word + 9u, squared.xy)) << 12u;
    add_carry(word + 2u, carries >> 2u);
    add_carry(word + 5u, carries >> 5u);
    add_carry(word + 8u, carries >> 8u);
    add_carry(word + 12u, carries >> 12u);
}

// In straight lines: after a driver has cut a loop of another sample of the group short, a loop
// here would be gone through once.
fn add_carry(word: u32, carry: u32) {
    if (carry & 1u) != 0u {
        atomicAdd(&film[word], 1u);
    }
}
