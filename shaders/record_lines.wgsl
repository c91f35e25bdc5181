// A record, in a kernel whose loops a driver may have cut short: after that, it would go through
// a loop once, and write the first word alone.
fn write_record(start: u32, address: vec4<u32>, radiance: vec3<u32>) {
    ledger.records[start] = address.x;
    ledger.records[start + 1u] = address.y;
    ledger.records[start + 2u] = address.z;
    ledger.records[start + 3u] = address.w;
    ledger.records[start + 4u] = radiance.x;
    ledger.records[start + 5u] = radiance.y;
    ledger.records[start + 6u] = radiance.z;
    ledger.records[start + 7u] = 0u;
}
