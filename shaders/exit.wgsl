// Spheres seen from inside.

// Distance to the far side from inside. A ray that `leaves` this very sphere has
// c = 0, which makes it the chord.
fn exit(q: Quadratic, leaves: bool) -> f32 {
    let root = sqrt(max(q.discriminant, 0.0));
    let chord = 2.0 * abs(q.b) / q.leading;
    let ahead = (root - q.b) / q.leading;
    let behind = max(-q.c / (root + q.b), 0.0);
    return select(select(behind, ahead, q.b <= 0.0), chord, leaves);
}
