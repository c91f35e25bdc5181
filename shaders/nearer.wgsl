// The nearer of two hits; at equal distances the one that comes first in the scene file.
fn nearer(a: Hit, b: Hit) -> Hit {
    if a.sphere == UNFINISHED || b.sphere == UNFINISHED {
        return Hit(MISS, UNFINISHED);
    }
    let tie = a.distance == b.distance && b.distance < MISS;
    if b.distance < a.distance || (tie && spheres[b.sphere].index < spheres[a.sphere].index) {
        return b;
    }
    return a;
}
