// What belongs to one frame: its settings, and what a hit is.
// provides: Hit, NO_HIT, NO_ID, WORKGROUP_SIDE, frame, runtime_zero, start_fences
// needs: FrameParameters

// A miss. Never inf: WGSL lets an implementation assume that infinities do not exist.
const NO_HIT: f32 = 1e30;
const NO_ID: u32 = 0xffffffffu;

// The side of a workgroup, in pixels.
const WORKGROUP_SIDE: u32 = 8u;

struct Hit {
    // From where the ray enters the scene's box.
    t: f32,
    // Index in input order.
    id: u32,
    // Index into the spheres of all bricks.
    shape_index: u32,
    // How far from the camera the ray starts.
    distance: f32,
}

// Camera, film, tile, slice, shading and background.
@group(0) @binding(0) var<uniform> frame: FrameParameters;

// A zero that no compiler knows, for `fence`: every kernel starts with `start_fences`. Reading the frame at each fence
// takes a software device 5 to 9 % of walking a tree.
var<private> zero_bits: u32;

fn start_fences() {
    zero_bits = frame.zero;
}

fn runtime_zero() -> u32 {
    return zero_bits;
}
