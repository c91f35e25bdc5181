// Invalid samples: counted, and the first few recorded with their address. They add
// nothing to the film and still count as samples.

const LEDGER_RECORDS: u32 = 16u;

// A record: pixel, low and high word of the sample index, whether it was finished, bit
// patterns of its radiance, and a word that is 0. The host reads the reason from the bits.
const RECORD_WORDS: u32 = 8u;

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

// In straight lines, as the carries of the film.
fn record_invalid(key: SampleKey, sample: Sample) {
    let slot = atomicAdd(&ledger.count, 1u);
    if slot < LEDGER_RECORDS {
        let start = slot * RECORD_WORDS;
        let radiance = bitcast<vec3<u32>>(sample.radiance);
        ledger.records[start] = key.pixel;
        ledger.records[start + 1u] = key.index_low;
        ledger.records[start + 2u] = key.index_high;
        ledger.records[start + 3u] = u32(sample.finished);
        ledger.records[start + 4u] = radiance.x;
        ledger.records[start + 5u] = radiance.y;
        ledger.records[start + 6u] = radiance.z;
        ledger.records[start + 7u] = 0u;
    }
}
