// The lists of the spheres that may be seen in each tile of a picture, the nearest first. Twin: src/accel/tile_lists.rs.
// provides: farthest, find_in_tile
// needs: Entry, Nearest, brick, discriminant_of, ids, intersect, offer, spend

// The index of the sphere of each place in the lists. A software device reads textures in less than half of the time
// that buffers take. Element i is at (i % 4096, i / 4096).
@group(1) @binding(3) var places: texture_storage_2d<r32uint, read>;
// The spheres of the brick.
@group(1) @binding(4) var listed: texture_storage_2d<rgba32float, read>;
// A lower bound of the distance of each sphere's hits from the camera, in ascending order.
@group(1) @binding(5) var nears: texture_storage_2d<r32float, read>;
// For each tile the bits of the distance of the farthest hit, from which the host finds the tiles that are done.
@group(1) @binding(6) var<storage, read_write> farthest: array<atomic<u32>>;

fn texel(index: u32) -> vec2u {
    return vec2u(index & 4095u, index >> 12u);
}

// The nearest hit of a ray after a sphere is offered.
fn offered(entry: Entry, sphere: vec4f, index: u32, before: Nearest) -> Nearest {
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
    // The starts of the lists follow the ids.
    let end = ids[brick.first_reference + tile + 1u];
    var at = ids[brick.first_reference + tile];
    loop {
        if (at == end || !spend(1u)) {
            break;
        }
        let index = textureLoad(places, texel(at)).x;
        let reach = max(
            max(entries[0].distance + a.t, entries[1].distance + b.t),
            max(entries[2].distance + c.t, entries[3].distance + d.t));
        if (textureLoad(nears, texel(index)).x > reach) {
            break;
        }
        let sphere = textureLoad(listed, texel(index));
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
