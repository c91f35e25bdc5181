// Places of the emitters in `spheres`, four to a vector: an array in a uniform buffer has
// a stride of 16 bytes.

@group(0) @binding(7) var<uniform> lights: array<vec4<u32>, LIGHT_VECTORS>;

fn light_at(i: u32) -> u32 {
    return lights[i / 4u][i % 4u];
}
