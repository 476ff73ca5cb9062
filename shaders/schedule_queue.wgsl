// A dispatch for every path of a list.

fn path_of(group: vec3u, lane: u32) -> u32 {
    let ordinal = (dispatch.first.x + group.x) * 64u + lane;
    if (ordinal >= atomicLoad(&queue.counts[dispatch.list])) {
        return NO_PATH;
    }
    return queue.entries[dispatch.list * dispatch.paths + ordinal];
}
