// A dispatch for every path of a list.

fn path_of(group: vec3u, lane: u32) -> u32 {
    let ordinal = (stage.first.x + group.x) * 64u + lane;
    if (ordinal >= atomicLoad(&queue.counts[stage.list])) {
        return NO_PATH;
    }
    return queue.entries[stage.list * stage.paths + ordinal];
}
