// One invocation traces one sample of one pixel and adds it to the film.

@group(0) @binding(1) var<uniform> work: Dispatch;

@compute @workgroup_size(TILE_WIDTH, TILE_HEIGHT, TILE_SAMPLES)
fn render(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<u32>(id.x, work.row_start + id.y);
    if pixel.x >= WIDTH || pixel.y >= work.row_end || id.z >= work.sample_count {
        return;
    }
    let low = work.first_sample_low + id.z;
    let high = work.first_sample_high + u32(low < id.z);
    let key = SampleKey(pixel.y * WIDTH + pixel.x, low, high);
    let sample = trace(pixel, key);
    if !sample.finished || exceeds_bound(sample.radiance) {
        record_invalid(key, sample);
        return;
    }
    if all(sample.radiance == vec3<f32>(0.0)) {
        return;
    }
    let row = pixel.y - work.band_start;
    add_sample((row * WIDTH + pixel.x) * FILM_WORDS, sample.radiance);
}
