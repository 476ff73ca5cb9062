// New words of colour for the spheres of a range of ids, wherever they stand in a brick.
// dispatched: for an update of colours and each brick: one invocation for each of its spheres.
// provides: recolor

struct RecolorRange {
    // Which spheres.
    first: u32,
    count: u32,
    // How many spheres the brick has.
    shape_count: u32,
    zero: u32,
}

// The range of ids that is updated.
@group(0) @binding(0) var<uniform> range: RecolorRange;
// A word of colour for each sphere of the range.
@group(0) @binding(1) var<storage, read> new_words: array<u32>;
// The ids of the brick, as in accel/brick.wgsl.
@group(0) @binding(2) var<storage, read> ids: array<u32>;
// The words of the brick, as in scene/appearance.wgsl.
@group(0) @binding(3) var<storage, read_write> appearances: array<u32>;

@compute @workgroup_size(64)
fn recolor(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let shape_index = (group.y * groups.x + group.x) * 64u + lane;
    if (shape_index >= range.shape_count) {
        return;
    }
    // What lies before the first has become a large number.
    let at = ids[shape_index] - range.first;
    if (at < range.count) {
        appearances[shape_index] = new_words[at];
    }
}
