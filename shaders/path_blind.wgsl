// One path that counts light only where it hits it by itself, as in the source.

fn trace(pixel: vec2<u32>, key: SampleKey) -> Sample {
    load_shapes();
    var ray = camera_ray(pixel, unit_floats(random_bits(key, 0u)));
    var throughput = vec3<f32>(1.0);
    var leaving = NO_SPHERE;
    for (var bounce = 0u; bounce <= BOUNCES; bounce++) {
        let hit = nearest(ray, leaving);
        if hit.sphere >= UNFINISHED {
            return Sample(vec3<f32>(0.0), hit.sphere == NO_SPHERE);
        }
        let color = scene.spheres[hit.sphere].color;
        if scene.spheres[hit.sphere].kind == KIND_EMITTER {
            return Sample(throughput * color, true);
        }
        if bounce == BOUNCES {
            return Sample(vec3<f32>(0.0), true);
        }
        let point = surface_point(ray, hit);
        let u = unit_floats(random_bits(key, bounce + 1u));
        let scattering = scatter(hit.sphere, point.normal, ray.direction, u);
        if scattering.weight == 0.0 {
            return Sample(vec3<f32>(0.0), true);
        }
        throughput *= scattering.weight * color;
        ray = Ray(point.position, scattering.direction);
        leaving = hit.sphere;
    }
    return Sample(vec3<f32>(0.0), false);
}
