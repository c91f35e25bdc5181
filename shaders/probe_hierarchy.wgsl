// Entry points for the tests, where there is a hierarchy.

// No input. Result: every field of its nodes as the kernel reads it, three results each.
@compute @workgroup_size(64)
fn probe_echo_nodes(@builtin(global_invocation_id) id: vec3<u32>) {
    if 3u * id.x >= arrayLength(&outputs) { return; }
    let n = nodes[id.x];
    outputs[3u * id.x] = vec4<u32>(bitcast<vec3<u32>>(n.origin), n.kinds);
    outputs[3u * id.x + 1u] = vec4<u32>(n.low, n.first_node);
    outputs[3u * id.x + 2u] = vec4<u32>(n.high, n.first_sphere);
}
