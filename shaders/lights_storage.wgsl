// Places of the emitters in `spheres`.

@group(0) @binding(7) var<storage, read> lights: array<u32>;

fn light_at(i: u32) -> u32 {
    return lights[i];
}
