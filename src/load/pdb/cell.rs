//! Reads the periodic cell from a CRYST1 record.

use super::error::PdbError;
use super::record::Record;

/// Returns the edge vectors of the cell, the first along x and the second in the plane of x and y; or `None` if the
/// record is only a placeholder, as in files of structures that are not crystals.
pub(super) fn edges(record: &Record<'_>) -> Result<Option<[[f64; 3]; 3]>, PdbError> {
    const FIELDS: [(&str, usize, usize); 6] = [
        ("length of the cell's edge a", 7, 15),
        ("length of the cell's edge b", 16, 24),
        ("length of the cell's edge c", 25, 33),
        ("cell's angle alpha", 34, 40),
        ("cell's angle beta", 41, 47),
        ("cell's angle gamma", 48, 54),
    ];
    record.must_have(&FIELDS)?;
    let mut values = [0.0; 6];
    for (value, (what, first, last)) in values.iter_mut().zip(FIELDS) {
        *value = record.number(what, first, last)?;
    }
    let [a, b, c, alpha, beta, gamma] = values;
    let all = |values: [f64; 3], wanted| values.iter().all(|value| same(*value, wanted));
    // Programs write zeros for a structure without a cell.
    if all([a, b, c], 0.0) || (all([a, b, c], 1.0) && all([alpha, beta, gamma], 90.0)) {
        return Ok(None);
    }
    let [cos_alpha, cos_beta, cos_gamma] = [alpha, beta, gamma].map(cos_degrees);
    let sin_gamma = (1.0 - cos_gamma * cos_gamma).sqrt();
    let y = (cos_alpha - cos_beta * cos_gamma) / sin_gamma;
    let z_squared = 1.0 - cos_beta * cos_beta - y * y;
    let possible = [a, b, c].iter().all(|length| *length > 0.0)
        && [alpha, beta, gamma].iter().all(|angle| 0.0 < *angle && *angle < 180.0)
        && z_squared > 0.0;
    if !possible {
        let (lengths, angles) = ([a, b, c], [alpha, beta, gamma]);
        return Err(PdbError::Cell { line: record.line, lengths, angles });
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

/// Whether two values are equal in the format, which has at most three decimals.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}
