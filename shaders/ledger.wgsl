// Invalid samples: counted, and the first few recorded with their address. They add
// nothing to the film and still count as samples.

const LEDGER_RECORDS: u32 = 16u;

const REASON_UNFINISHED: u32 = 1u;
const REASON_OUT_OF_BOUNDS: u32 = 2u;

// A record: pixel, low and high word of the sample index, reason.
const RECORD_WORDS: u32 = 4u;

struct Ledger {
    count: atomic<u32>,
    records: array<u32, LEDGER_RECORDS * RECORD_WORDS>,
}

@group(0) @binding(3) var<storage, read_write> ledger: Ledger;

// Whether a channel is NaN, infinite, negative or above the proven bound. One
// comparison of bit patterns finds all four: their patterns are the larger ones,
// and no compiler may assume them away.
fn exceeds_bound(radiance: vec3<f32>) -> bool {
    return any(bitcast<vec3<u32>>(radiance) > vec3<u32>(scene.bound_bits));
}

// The loop is for the samples that are valid: a group of invocations without invalid
// ones leaves it at once, where straight-line stores would all be gone through.
fn record_invalid(key: SampleKey, reason: u32) {
    let slot = atomicAdd(&ledger.count, 1u);
    let record = vec4<u32>(key.pixel, key.index_low, key.index_high, reason);
    for (var i = 0u; i < RECORD_WORDS && slot < LEDGER_RECORDS; i++) {
        ledger.records[slot * RECORD_WORDS + i] = record[i];
    }
}
