// The nearest of the spheres under the hierarchy.

// Brings the nearer of two children to the front.
fn ordered(c: Children, a: u32, b: u32) -> Children {
    var o = c;
    let swapped = c.entry[b] < c.entry[a];
    o.entry[a] = select(c.entry[a], c.entry[b], swapped);
    o.entry[b] = select(c.entry[b], c.entry[a], swapped);
    o.item[a] = select(c.item[a], c.item[b], swapped);
    o.item[b] = select(c.item[b], c.item[a], swapped);
    return o;
}

// Nearest first.
fn sorted(c: Children) -> Children {
    let halves = ordered(ordered(c, 0u, 1u), 2u, 3u);
    return ordered(ordered(ordered(halves, 0u, 2u), 1u, 3u), 1u, 2u);
}

// Some spheres and the nearest hit so far. The order of the scene file is another one, so at
// equal distances it is asked for.
fn nearest_of(item: u32, best: Hit, ray: Ray, leaving: u32) -> Hit {
    var nearest = best;
    let end = (item >> 4u) + (item & 15u);
    var i = item >> 4u;
    for (; i < end; i++) {
        let q = factored(ray, spheres[i].position, spheres[i].size);
        let t = select(entry(q), MISS, i == leaving);
        if t < nearest.distance || (t == nearest.distance && t < MISS
            && spheres[i].index < spheres[nearest.sphere].index) {
            nearest = Hit(t, i);
        }
    }
    if i != end {
        return Hit(MISS, UNFINISHED);
    }
    return nearest;
}

fn nearest_hierarchy(ray: Ray, leaving: u32) -> Hit {
    let climber = climber(ray);
    var best = Hit(MISS, NO_SPHERE);
    var item = ROOT;
    var height = 0u;
    while item != NOTHING && best.sphere != UNFINISHED {
        if (item & 15u) == A_NODE {
            let c = sorted(children(item >> 4u, climber, best.distance));
            height = push(push(push(height, c.entry.w, c.item.w), c.entry.z, c.item.z), c.entry.y, c.item.y);
            item = select(NOTHING, c.item.x, c.entry.x < MISS);
        } else {
            best = nearest_of(item, best, ray, leaving);
            item = NOTHING;
        }
        if item == NOTHING && height > 0u {
            height--;
            item = waiting[height];
        }
    }
    if item != NOTHING {
        return Hit(MISS, UNFINISHED);
    }
    return best;
}
