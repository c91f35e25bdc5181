// A record, in a kernel without other loops: the loop is for the samples that are valid. A group
// of invocations without invalid ones leaves it at once, where straight-line stores would all
// be gone through.
fn write_record(start: u32, address: vec4<u32>, radiance: vec3<u32>) {
    for (var i = 0u; i < RECORD_WORDS; i++) {
        ledger.records[start + i] = select(address, vec4<u32>(radiance, 0u), i >= 4u)[i & 3u];
    }
}
