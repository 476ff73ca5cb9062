// The lists of the spheres that may be seen in each tile of a picture, the nearest first. Twin: src/accel/tile_lists.rs.
// provides: farthest, find_in_tile
// needs: Entry, Nearest, Shape, brick, discriminant_of, ids, intersect, offer, shapes, spend

// For each tile the bits of the distance of the farthest hit, from which the host finds the tiles that are done.
@group(1) @binding(3) var<storage, read_write> farthest: array<atomic<u32>>;

// The nearest hit of a ray after a sphere is offered.
fn offered(entry: Entry, sphere: Shape, index: u32, before: Nearest) -> Nearest {
    var nearest = before;
    offer(&nearest, intersect(entry.ray, sphere).t, index);
    return nearest;
}

// Offers the spheres of a tile's list to the rays of four pixels, until all others are beyond the nearest hits. Returns
// the nearest hits.
fn find_in_tile(tile: u32, entries: array<Entry, 4>, before: array<Nearest, 4>) -> array<Nearest, 4> {
    var a = before[0];
    var b = before[1];
    var c = before[2];
    var d = before[3];
    // The starts of the lists follow the ids. Then come the index of the sphere of each place in the lists, and a lower
    // bound of the distance of each sphere's hits from the camera.
    let end = ids[brick.first_reference + tile + 1u];
    var at = ids[brick.first_reference + tile];
    loop {
        if (at == end || !spend(1u)) {
            break;
        }
        let index = ids[brick.cell_counts.y + at];
        let reach = max(
            max(entries[0].distance + a.t, entries[1].distance + b.t),
            max(entries[2].distance + c.t, entries[3].distance + d.t));
        if (bitcast<f32>(ids[brick.cell_counts.z + index]) > reach) {
            break;
        }
        let sphere = shapes[index];
        // Most spheres of a list are hit by none of the four rays.
        let most = max(
            max(discriminant_of(entries[0].ray, sphere), discriminant_of(entries[1].ray, sphere)),
            max(discriminant_of(entries[2].ray, sphere), discriminant_of(entries[3].ray, sphere)));
        if (most >= 0.0) {
            a = offered(entries[0], sphere, index, a);
            b = offered(entries[1], sphere, index, b);
            c = offered(entries[2], sphere, index, c);
            d = offered(entries[3], sphere, index, d);
        }
        at++;
    }
    return array(a, b, c, d);
}
