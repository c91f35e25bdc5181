// A sphere in factored form among others.

fn closer_factored(best: Hit, ray: Ray, s: Shape, i: u32, leaving: u32) -> Hit {
    return closer(best, factored(ray, s.position, s.size), i, leaving);
}
