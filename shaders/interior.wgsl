// The side from which spheres are seen: those that hold the camera from inside, the
// others from outside. A ray that leaves an inner wall meets it again at the far
// end of the chord.

fn distance_to(q: Quadratic, sphere: u32, leaving: u32) -> f32 {
    let leaves = sphere == leaving;
    let outer = select(entry(q), MISS, leaves);
    return select(outer, exit(q, leaves), spheres[sphere].inside == 1u);
}
