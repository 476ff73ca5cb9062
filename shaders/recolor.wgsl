// New words of colour for the spheres of a range of ids, wherever they stand in a brick.

struct RecolorRange {
    // Which spheres.
    first: u32,
    count: u32,
    // How many spheres the brick has.
    place_count: u32,
    zero: u32,
}

@group(0) @binding(0) var<uniform> range: RecolorRange;
// Of the spheres of the range.
@group(0) @binding(1) var<storage, read> new_words: array<u32>;
// Of the brick, by place; see brick.wgsl and appearance.wgsl.
@group(0) @binding(2) var<storage, read> ids: array<u32>;
@group(0) @binding(3) var<storage, read_write> looks: array<u32>;

@compute @workgroup_size(64)
fn recolor(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let place = (group.y * groups.x + group.x) * 64u + lane;
    if (place >= range.place_count) {
        return;
    }
    // What lies before the first has become a large number.
    let at = ids[place] - range.first;
    if (at < range.count) {
        looks[place] = new_words[at];
    }
}
