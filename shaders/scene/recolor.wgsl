// Writes new colour words for the spheres of a range of ids.
// dispatched: for an update of colours and each brick, with one invocation for each sphere of the brick.
// provides: recolor

struct RecolorRange {
    // First id and number of ids of the range.
    first: u32,
    count: u32,
    // Number of spheres of the brick.
    shape_count: u32,
    zero: u32,
}

// The range of ids that is updated.
@group(0) @binding(0) var<uniform> range: RecolorRange;
// Colour words, one for each sphere of the range.
@group(0) @binding(1) var<storage, read> new_words: array<u32>;
// Ids of the spheres of the brick, see accel/brick.wgsl.
@group(0) @binding(2) var<storage, read> ids: array<u32>;
// Appearance words of the brick, see scene/appearance.wgsl.
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
    // The subtraction wraps around, so ids before the range become large numbers.
    let at = ids[shape_index] - range.first;
    if (at < range.count) {
        appearances[shape_index] = new_words[at];
    }
}
