// The angle of a vector in turns. The error of WGSL's atan2 may be 4096 ULP.
// provides: atan2_turns
// needs: fence

// The angle in [-1/2, 1/2], with an error of less than 2^-23. It is 0 for the zero vector, and 1/2 for y = 0 and x < 0.
// Twin: `f64::atan2`.
fn atan2_turns(y: f32, x: f32) -> f32 {
    let size = abs(vec2f(x, y));
    // The maximum avoids a division by zero.
    let ratio = fence(min(size.x, size.y) / max(max(size.x, size.y), 0x1p-100));
    let square = fence(ratio * ratio);
    // A minimax polynomial (Remez) for atan(ratio)/(2 pi ratio) on [0, 1], with a relative error of 2^-26.
    let series = 0.15915494 + square * (-0.053051233 + square * (0.031819243 + square * (-0.022605801
        + square * (0.01693557 + square * (-0.011943451 + square * (0.0067945621
        + square * (-0.0025573994 + square * 0.00045357359)))))));
    let octant = fence(ratio * series);
    let quadrant = fence(select(octant, 0.25 - octant, size.y > size.x));
    let half = fence(select(quadrant, 0.5 - quadrant, x < 0.0));
    return select(half, -half, y < 0.0);
}
