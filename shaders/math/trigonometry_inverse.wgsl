// The angle of a vector, in turns: WGSL's atan2 may be off by 4096 ULP.
// provides: atan2_turns
// needs: fence

// In [-1/2, 1/2], and off by less than 2^-23; 0 for no vector, and 1/2 for y = 0 and x < 0. Twin: `f64::atan2`.
fn atan2_turns(y: f32, x: f32) -> f32 {
    let size = abs(vec2f(x, y));
    // A small number is no angle, and nothing is divided by zero.
    let ratio = fence(min(size.x, size.y) / max(max(size.x, size.y), 0x1p-100));
    let square = fence(ratio * ratio);
    // A minimax polynomial (Remez) of atan(ratio)/(2 pi ratio) on [0, 1]; it is off by 2^-26 of itself.
    let series = 0.15915494 + square * (-0.053051233 + square * (0.031819243 + square * (-0.022605801
        + square * (0.01693557 + square * (-0.011943451 + square * (0.0067945621
        + square * (-0.0025573994 + square * 0.00045357359)))))));
    let octant = fence(ratio * series);
    let quadrant = fence(select(octant, 0.25 - octant, size.y > size.x));
    let half = fence(select(quadrant, 0.5 - quadrant, x < 0.0));
    return select(half, -half, y < 0.0);
}
