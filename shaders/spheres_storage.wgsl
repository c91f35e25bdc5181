// Any number of spheres.

@group(0) @binding(6) var<storage, read> spheres: array<Sphere>;
