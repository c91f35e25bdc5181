// Entry points for the tests: one function of the kernel over a table of inputs.

@group(0) @binding(4) var<storage, read> inputs: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read_write> outputs: array<vec4<u32>>;

fn input_floats(at: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(inputs[at]);
}

// Row: pcg4d key. Result: its bits.
@compute @workgroup_size(64)
fn probe_pcg4d(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    outputs[id.x] = pcg4d(inputs[id.x]);
}

// Row: four words. Result: their unit floats.
@compute @workgroup_size(64)
fn probe_unit_float(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let bits = inputs[id.x];
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(
        unit_float(bits.x), unit_float(bits.y), unit_float(bits.z), unit_float(bits.w)));
}

// Row: u, x, -, -. Result: sin 2πu, cos 2πu, -log(1 - u), 1 - exp(-x).
@compute @workgroup_size(64)
fn probe_math(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let row = input_floats(id.x);
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(
        sincos_2pi(row.x), minus_log_complement(row.x), one_minus_exp_minus(row.y)));
}

// Rows in fours: origin and form (0 factored, 1 anchored); direction and side (0
// entry, 1 exit, 2 exit leaving); position and size, with the offset in the fourth
// row. Result: distance, b, c, discriminant.
@compute @workgroup_size(64)
fn probe_hit(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let origin = input_floats(4u * id.x);
    let direction = input_floats(4u * id.x + 1u);
    let shape = input_floats(4u * id.x + 2u);
    let offset = input_floats(4u * id.x + 3u).x;
    let ray = Ray(origin.xyz, direction.xyz);
    var q = factored(ray, shape.xyz, shape.w);
    if origin.w == 1.0 {
        q = anchored(ray, shape.xyz, offset, shape.w);
    }
    var t = entry(q);
    if direction.w > 0.0 {
        t = exit(q, direction.w == 2.0);
    }
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(t, q.b, q.c, q.discriminant));
}

// Rows in pairs: origin, then direction with the packed sphere that the ray leaves.
// Results in threes: distance and sphere; the surface point; the normal.
@compute @workgroup_size(64)
fn probe_nearest(@builtin(global_invocation_id) id: vec3<u32>) {
    if 3u * id.x >= arrayLength(&outputs) { return; }
    let ray = Ray(input_floats(2u * id.x).xyz, input_floats(2u * id.x + 1u).xyz);
    let hit = nearest(ray, inputs[2u * id.x + 1u].w);
    outputs[3u * id.x] = vec4<u32>(bitcast<u32>(hit.distance), hit.sphere, 0u, 0u);
    if hit.sphere < UNFINISHED {
        let point = surface_point(ray, hit);
        outputs[3u * id.x + 1u] = bitcast<vec4<u32>>(vec4<f32>(point.position, 0.0));
        outputs[3u * id.x + 2u] = bitcast<vec4<u32>>(vec4<f32>(point.normal, 0.0));
    }
}

// Row: u, v, exponent, -. Result: direction of the lobe about +z, 1 - cosα.
@compute @workgroup_size(64)
fn probe_phong(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let row = input_floats(id.x);
    let direction = around(vec3<f32>(0.0, 0.0, 1.0), polar_phong(row.x, row.z), row.y);
    let t = one_minus_exp_minus(minus_log_complement(row.x) / (row.z + 1.0));
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(direction, t));
}

// Rows in threes: normal; incoming direction with the packed sphere, whose surface
// counts; u, v. Result: scattered direction and weight.
@compute @workgroup_size(64)
fn probe_scatter(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let normal = input_floats(3u * id.x);
    let incoming = input_floats(3u * id.x + 1u);
    let u = input_floats(3u * id.x + 2u).xy;
    let s = scatter(inputs[3u * id.x + 1u].w, normal.xyz, incoming.xyz, u);
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(s.direction, s.weight));
}

// Row: u, v, height of a cone (0: cosine-weighted hemisphere), -. Result: direction about
// +z, sine of its polar angle.
@compute @workgroup_size(64)
fn probe_polar(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let row = input_floats(id.x);
    let polar = select(polar_cone(row.x, row.z), polar_cosine(row.x), row.z == 0.0);
    let direction = around(vec3<f32>(0.0, 0.0, 1.0), polar, row.y);
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(direction, polar.x));
}

// Rows in threes: position and form (0 factored, 1 anchored); position and size of the
// shape; its offset. Result: axis and height of the cone.
@compute @workgroup_size(64)
fn probe_cone(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let position = input_floats(3u * id.x);
    let shape = input_floats(3u * id.x + 1u);
    let offset = input_floats(3u * id.x + 2u).x;
    var cone = cone_factored(position.xyz, shape.xyz, shape.w);
    if position.w == 1.0 {
        cone = cone_anchored(position.xyz, shape.xyz, offset, shape.w);
    }
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(cone.axis, cone.height));
}

// Row: u, x, -, -. Result: -log(1 - u), exp(-x), 0, 0.
@compute @workgroup_size(64)
fn probe_exp(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let row = input_floats(id.x);
    outputs[id.x] = bitcast<vec4<u32>>(
        vec4<f32>(minus_log_complement(row.x), exp_minus(row.y), 0.0, 0.0));
}

// Rows in threes: normal; incoming direction with the packed sphere, whose exponent
// counts; another direction. Result: weight and density of the lobe there.
@compute @workgroup_size(64)
fn probe_evaluate(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let normal = input_floats(3u * id.x);
    let incoming = input_floats(3u * id.x + 1u);
    let direction = input_floats(3u * id.x + 2u);
    let worth = evaluate(inputs[3u * id.x + 1u].w, normal.xyz, incoming.xyz, direction.xyz);
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(worth.weight, worth.density, 0.0, 0.0));
}

// Rows as for probe_scatter. Result: density that the direction was drawn with, density
// that it has when it was not, versine of its angle from the lobe's axis, 0.
@compute @workgroup_size(64)
fn probe_density(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let normal = input_floats(3u * id.x);
    let incoming = input_floats(3u * id.x + 1u);
    let u = input_floats(3u * id.x + 2u).xy;
    let sphere = inputs[3u * id.x + 1u].w;
    let s = scatter(sphere, normal.xyz, incoming.xyz, u);
    let worth = evaluate(sphere, normal.xyz, incoming.xyz, s.direction);
    let t = 1.0 - polar_phong(u.x, spheres[sphere].exponent).y;
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(s.density, worth.density, t, 0.0));
}

// Rows in pairs: position with the light whose chance is asked; normal. The sample's
// pixel is the row's number. Result: that chance; the light that is picked, its chance.
@compute @workgroup_size(64)
fn probe_pick(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let point = SurfacePoint(input_floats(2u * id.x).xyz, input_floats(2u * id.x + 1u).xyz);
    let chance = chance_of(inputs[2u * id.x].w, point);
    let pick = pick_light(point, SampleKey(id.x, 0u, 0u), 0u);
    outputs[id.x] = vec4<u32>(bitcast<u32>(chance), pick.light, bitcast<u32>(pick.chance), 0u);
}

// Row: pixel (x, y), then where on it. Result: direction of the camera ray.
@compute @workgroup_size(64)
fn probe_camera(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let ray = camera_ray(inputs[id.x].xy, input_floats(id.x).zw);
    outputs[id.x] = bitcast<vec4<u32>>(vec4<f32>(ray.direction, 0.0));
}

// Row: r, g, b as floats, and the shift as a signed integer. Results in fours: the
// fixed-point channels (r and g, then b and luminance), then the square.
@compute @workgroup_size(64)
fn probe_fixed(@builtin(global_invocation_id) id: vec3<u32>) {
    if 3u * id.x >= arrayLength(&outputs) { return; }
    let row = input_floats(id.x);
    let shift = bitcast<i32>(inputs[id.x].w);
    let r = to_fixed(row.x, shift);
    let g = to_fixed(row.y, shift);
    let b = to_fixed(row.z, shift);
    let y = luminance(r, g, b);
    outputs[3u * id.x] = vec4<u32>(r, g);
    outputs[3u * id.x + 1u] = vec4<u32>(b, y);
    outputs[3u * id.x + 2u] = vec4<u32>(square(y), 0u);
}

// Row: r, g, b as floats, and the pixel's number. All rows are added to the film at
// once, so rows of one pixel compete for its words.
@compute @workgroup_size(64)
fn probe_film(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&inputs) { return; }
    add_sample(inputs[id.x].w * FILM_WORDS, input_floats(id.x).xyz);
}

// Row: origin with the distance of the light; direction with the packed sphere that the ray
// leaves; the packed light. Result: 1 if something hides the light, 1 if the search was cut
// short, 0, 0.
@compute @workgroup_size(64)
fn probe_occluded(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let origin = input_floats(3u * id.x);
    let direction = input_floats(3u * id.x + 1u);
    let leaving = inputs[3u * id.x + 1u].w;
    let light = inputs[3u * id.x + 2u].x;
    let hidden = occluded(Ray(origin.xyz, direction.xyz), leaving, light, origin.w);
    outputs[id.x] = vec4<u32>(u32(hidden), u32(unfinished), 0u, 0u);
}

// No input. Result: every field of the scene's header as the kernel reads it, in the order of
// the struct, padding left out as zeros.
@compute @workgroup_size(64)
fn probe_echo_scene(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x > 0u { return; }
    outputs[0] = vec4<u32>(bitcast<vec3<u32>>(scene.origin), scene.seed);
    outputs[1] = vec4<u32>(bitcast<vec3<u32>>(scene.forward), scene.factored_count);
    outputs[2] = vec4<u32>(bitcast<vec3<u32>>(scene.right), bitcast<u32>(scene.film_shift));
    outputs[3] = vec4<u32>(bitcast<vec3<u32>>(scene.up), scene.bound_bits);
    outputs[4] = vec4<u32>(
        scene.sphere_count, scene.light_count, bitcast<u32>(scene.approach),
        scene.hierarchy_count);
}

// The same of the spheres, three results each.
@compute @workgroup_size(64)
fn probe_echo_spheres(@builtin(global_invocation_id) id: vec3<u32>) {
    if 3u * id.x >= arrayLength(&outputs) { return; }
    let s = spheres[id.x];
    outputs[3u * id.x] = vec4<u32>(bitcast<vec3<u32>>(s.position), bitcast<u32>(s.size));
    outputs[3u * id.x + 1u] = vec4<u32>(bitcast<vec3<u32>>(s.color), bitcast<u32>(s.exponent));
    outputs[3u * id.x + 2u] = vec4<u32>(bitcast<u32>(s.offset), s.index, s.kind, s.inside);
}

// The same of the lights' places, one each.
@compute @workgroup_size(64)
fn probe_echo_lights(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    outputs[id.x] = vec4<u32>(light_at(id.x), 0u, 0u, 0u);
}

// The same of the light tree's nodes, two each.
@compute @workgroup_size(64)
fn probe_echo_light_tree(@builtin(global_invocation_id) id: vec3<u32>) {
    if 2u * id.x >= arrayLength(&outputs) { return; }
    let n = light_tree[id.x];
    outputs[2u * id.x] = vec4<u32>(bitcast<vec3<u32>>(n.center), bitcast<u32>(n.radius));
    outputs[2u * id.x + 1u] = vec4<u32>(
        bitcast<u32>(n.brightness), bitcast<u32>(n.everywhere), n.light, 0u);
}
