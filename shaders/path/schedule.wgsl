// The path that an invocation processes.

//// pixels
// The path of an invocation in dispatches over the pixels of a tile, or its visible region, and all samples in flight.
// provides: path_of
// needs: NO_PATH, dispatch, frame, pixel_in_tile

fn path_of(group: vec3u, lane: u32) -> u32 {
    let pixel = pixel_in_tile(dispatch.first + group.xy, lane);
    let index = (group.z * frame.tile_size.y + pixel.y) * frame.tile_size.x + pixel.x;
    return select(index, NO_PATH, any(pixel >= frame.tile_size));
}

//// queue
// The path of an invocation in dispatches over a list of paths.
// provides: path_of
// needs: NO_PATH, dispatch, queue

fn path_of(group: vec3u, lane: u32) -> u32 {
    let ordinal = (dispatch.first.x + group.x) * 64u + lane;
    if (ordinal >= atomicLoad(&queue.counts[dispatch.list])) {
        return NO_PATH;
    }
    return queue.entries[dispatch.list * dispatch.paths + ordinal];
}
