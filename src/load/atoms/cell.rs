//! The edges of a periodic cell, from their lengths and angles.

/// Returns the edge vectors of the cell, the first along x and the second in the plane of x and y; `None` if the
/// values are only placeholders, as in files of structures that are not crystals.
///
/// # Errors
/// Says that there is no such cell.
pub(in crate::load) fn edges(
    lengths: [f64; 3],
    angles: [f64; 3],
) -> Result<Option<[[f64; 3]; 3]>, String> {
    let [a, b, c] = lengths;
    let all = |values: [f64; 3], wanted| values.iter().all(|value| same(*value, wanted));
    // Programs write zeros for a structure without a cell.
    if all(lengths, 0.0) || (all(lengths, 1.0) && all(angles, 90.0)) {
        return Ok(None);
    }
    let [cos_alpha, cos_beta, cos_gamma] = angles.map(cos_degrees);
    let sin_gamma = (1.0 - cos_gamma * cos_gamma).sqrt();
    let y = (cos_alpha - cos_beta * cos_gamma) / sin_gamma;
    let z_squared = 1.0 - cos_beta * cos_beta - y * y;
    let possible = lengths.iter().all(|length| *length > 0.0)
        && angles.iter().all(|angle| 0.0 < *angle && *angle < 180.0)
        && z_squared > 0.0;
    if !possible {
        return Err(format!(
            "no periodic cell has edges of the lengths {lengths:?} and the angles {angles:?}; lengths must be greater than \
             0, and the angles in degrees must belong to three edges that are not in one plane"
        ));
    }
    Ok(Some([
        [a, 0.0, 0.0],
        [b * cos_gamma, b * sin_gamma, 0.0],
        [c * cos_beta, c * y, c * z_squared.sqrt()],
    ]))
}

/// The cosine of an angle in degrees: exactly 0 at a right angle, which most cells have.
fn cos_degrees(angle: f64) -> f64 {
    if same(angle, 90.0) { 0.0 } else { angle.to_radians().cos() }
}

/// Whether two values are equal in the formats, which have few decimals.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}
