// The path that an invocation processes.
// provides: path_of
// needs: NO_PATH, dispatch, frame, pixel_in_tile, queue

// Whether a dispatch processes the paths of a list, and not one for each pixel and each sample in flight.
override TAKES_LIST: bool;

fn path_of(group: vec3u, lane: u32) -> u32 {
    if (TAKES_LIST) {
        return path_in_list(group.x, lane);
    }
    return path_of_pixel(group, lane);
}

// The path of an invocation in dispatches over the pixels of a tile, or its visible region, and all samples in flight.
fn path_of_pixel(group: vec3u, lane: u32) -> u32 {
    let pixel = pixel_in_tile(dispatch.first + group.xy, lane);
    let index = (group.z * frame.tile_size.y + pixel.y) * frame.tile_size.x + pixel.x;
    return select(index, NO_PATH, any(pixel >= frame.tile_size));
}

// The path of an invocation in dispatches over a list of paths.
fn path_in_list(group: u32, lane: u32) -> u32 {
    let ordinal = (dispatch.first.x + group) * 64u + lane;
    if (ordinal >= atomicLoad(&queue.counts[dispatch.list])) {
        return NO_PATH;
    }
    return queue.entries[dispatch.list * dispatch.paths + ordinal];
}
