// The lists of the spheres that may be seen in each tile of a picture, the nearest first. Twin: src/accel/tile_lists.rs.
// provides: find_in_tile
// needs: NO_HIT, Nearest, Search, brick, distance_within, ids, offer, spend

// Offers the spheres of a tile's list, until all others are beyond the nearest hit. `distance` is that of the ray's origin
// from the camera.
fn find_in_tile(search: Search, distance: f32, tile: vec2u, nearest: ptr<function, Nearest>) {
    // The starts of the lists follow the ids, and then comes a lower bound of the distance of each place's hits.
    let start = brick.first_reference + tile.y * brick.cell_counts.x + tile.x;
    let end = ids[start + 1u];
    var at = ids[start];
    loop {
        if (at == end || !spend(1u)) {
            break;
        }
        if (bitcast<f32>(ids[brick.cell_counts.y + at]) > distance + (*nearest).t) {
            break;
        }
        offer(nearest, distance_within(search, at, NO_HIT), at);
        at++;
    }
}
