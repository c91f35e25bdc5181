// Few spheres: they fit into a uniform buffer.

const SPHERE_CAPACITY: u32 = 512u;
const LIGHT_VECTORS: u32 = SPHERE_CAPACITY / 4u;

@group(0) @binding(6) var<uniform> spheres: array<Sphere, SPHERE_CAPACITY>;
