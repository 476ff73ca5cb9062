// The parameters of a frame, the struct of a hit, and the source of fences.
// provides: Hit, NO_HIT, NO_ID, WORKGROUP_SIDE, frame, iteration_limit, runtime_zero, start_fences
// needs: FrameParameters

// Distance of a miss. It is not infinite, because WGSL lets implementations assume that infinities do not exist.
const NO_HIT: f32 = 1e30;
const NO_ID: u32 = 0xffffffffu;

// The side of a workgroup, in pixels.
const WORKGROUP_SIDE: u32 = 8u;

struct Hit {
    // Distance from the point where the ray enters the scene's box.
    t: f32,
    // Index in input order.
    id: u32,
    // Index into the spheres of all bricks.
    shape_index: u32,
    // Distance from the camera to that point.
    distance: f32,
}

// Parameters of the frame: camera, film, tile, slice, shading and background.
@group(0) @binding(0) var<uniform> frame: FrameParameters;

// A zero that no compiler knows, which `fence` uses: two equal numbers of the frame, neither of which is 0. A driver may
// compile a kernel anew when it knows that a uniform is 0, and would then see through fences made of it alone. Every
// kernel calls `start_fences` first. Reading the frame at each fence instead would take a software device 5 to 9 % of the
// time of a tree traversal.
var<private> zero_bits: u32;

// The iteration limit of the frame, which is also read once.
var<private> most_iterations: u32;

fn start_fences() {
    zero_bits = frame.iteration_limit ^ frame.iteration_limit_again;
    most_iterations = frame.iteration_limit;
}

fn runtime_zero() -> u32 {
    return zero_bits;
}

// Number of loop iterations after which an invocation gives up.
fn iteration_limit() -> u32 {
    return most_iterations;
}
