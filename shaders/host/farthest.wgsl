// How far a ray need be followed if the host has drawn first.
// provides: farthest_shown
// needs: HostView, depth_aside, perspective_slope

// A distance along a pixel's ray that is not less than any whose `clip_depth` is not behind `depth`; 1e30 if there is
// none. All roundings here and there are less than 2^-21 of the numbers that are added, and 2^-16 of the result.
fn farthest_shown(view: HostView, center: vec2f, depth: f32) -> f32 {
    let aside = depth_aside(view, center);
    let change = sign(view.slope) * (depth - view.film_depth.z - aside);
    let rounding = 0x1p-21 * (abs(depth) + abs(view.film_depth.z) + abs(aside));
    // Along parallel rays depth changes with the distance, and along others with 1/distance.
    let along_parallel = (change + rounding) / abs(view.slope);
    let scaled = abs(perspective_slope(view, center));
    let least = change - rounding;
    let has_end = least > max(scaled * 1e-29, 1e-37);
    let in_perspective = select(1e30, scaled / select(1.0, least, has_end), has_end);
    let farthest = select(in_perspective, along_parallel, view.is_parallel != 0.0);
    return min(farthest * (1.0 + 0x1p-16), 1e30);
}
