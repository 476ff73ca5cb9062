// Which path an invocation works on.

//// pixels
// A dispatch for every pixel of the tile, or of where the scene may be seen, and for every sample in flight.
// provides: path_of
// needs: NO_PATH, dispatch, frame, pixel_in_tile

fn path_of(group: vec3u, lane: u32) -> u32 {
    let pixel = pixel_in_tile(dispatch.first + group.xy, lane);
    let index = (group.z * frame.tile_size.y + pixel.y) * frame.tile_size.x + pixel.x;
    return select(index, NO_PATH, any(pixel >= frame.tile_size));
}

//// queue
// A dispatch for every path of a list.
// provides: path_of
// needs: NO_PATH, dispatch, queue

fn path_of(group: vec3u, lane: u32) -> u32 {
    let ordinal = (dispatch.first.x + group.x) * 64u + lane;
    if (ordinal >= atomicLoad(&queue.counts[dispatch.list])) {
        return NO_PATH;
    }
    return queue.entries[dispatch.list * dispatch.paths + ordinal];
}
