// Random numbers as a pure function of (pixel, sample index, block, seed).

// PCG-4D: Jarzynski & Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
// Integers only, hence the same bits on every device.
fn pcg4d(key: vec4<u32>) -> vec4<u32> {
    var v = key * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> vec4<u32>(16u));
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// The address of one sample: its pixel and its index, below 2^56.
struct SampleKey {
    pixel: u32,
    index_low: u32,
    index_high: u32,
}

// Four numbers of block `block` (below 256): block 0 serves the camera, block k
// the k-th scattering.
fn random_bits(key: SampleKey, block: u32) -> vec4<u32> {
    return pcg4d(vec4<u32>(key.pixel, key.index_low, (key.index_high << 8u) | block, scene.seed));
}

// The top 24 bits as a multiple of 2^-24 in [0, 1 - 2^-24]: every value is exact,
// and 1 is never reached (scaling all 32 bits rounds 128 of them up to 1).
fn unit_float(bits: u32) -> f32 {
    return f32(bits >> 8u) * 5.9604644775390625e-8;
}

fn unit_floats(bits: vec4<u32>) -> vec2<f32> {
    return vec2<f32>(unit_float(bits.x), unit_float(bits.y));
}
