// The concentric map from the unit square to the unit disk by Shirley and Chiu. It maps (1/2, 1/2) exactly to the
// centre. Twin: src/geometry/math.rs.
// provides: concentric_disk
// needs: PI, fence, sin_cos_eighth

fn concentric_disk(square: vec2f) -> vec2f {
    let spot = vec2f(fence(2.0 * square.x - 1.0), fence(2.0 * square.y - 1.0));
    let is_wide = abs(spot.x) > abs(spot.y);
    let radius = select(spot.y, spot.x, is_wide);
    let along = select(spot.x, spot.y, is_wide);
    // At the centre both are zero.
    let part = along / select(radius, 1.0, radius == 0.0);
    let sine_cosine = sin_cos_eighth(fence(0.25 * PI * part));
    return radius * select(sine_cosine, sine_cosine.yx, is_wide);
}
