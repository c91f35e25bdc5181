// Invalid samples: counted, and the first few recorded with their address. They add
// nothing to the film and still count as samples.

const LEDGER_RECORDS: u32 = 16u;

const REASON_UNFINISHED: u32 = 1u;
const REASON_OUT_OF_BOUNDS: u32 = 2u;

struct Record {
    pixel: u32,
    index_low: u32,
    index_high: u32,
    reason: u32,
}

struct Ledger {
    count: atomic<u32>,
    records: array<Record, LEDGER_RECORDS>,
}

@group(0) @binding(3) var<storage, read_write> ledger: Ledger;

// Whether a channel is NaN, infinite, negative or above the proven bound. One
// comparison of bit patterns finds all four: their patterns are the larger ones,
// and no compiler may assume them away.
fn exceeds_bound(radiance: vec3<f32>) -> bool {
    return any(bitcast<vec3<u32>>(radiance) > vec3<u32>(scene.bound_bits));
}

fn record_invalid(key: SampleKey, reason: u32) {
    let slot = atomicAdd(&ledger.count, 1u);
    if slot < LEDGER_RECORDS {
        ledger.records[slot] = Record(key.pixel, key.index_low, key.index_high, reason);
    }
}
