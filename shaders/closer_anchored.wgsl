// A sphere in anchored form among others.

fn closer_anchored(best: Hit, ray: Ray, s: Shape, i: u32, leaving: u32) -> Hit {
    return closer(best, anchored(ray, s.position, s.offset, s.size), i, leaving);
}
