//! The unit cell of a frame, which programs write in three ways.

/// Returns the edge vectors of a cell; `None` if its lengths are 0, as where there is no cell.
///
/// The six numbers are a, the angle between a and b, b, the angle between a and c, the angle between b and c, and c.
/// Angles are degrees, or cosines (CHARMM, NAMD). Newer versions of CHARMM write the six different elements of a
/// symmetric matrix whose rows are the edges; that is assumed if the numbers cannot be lengths and angles.
pub(super) fn edges(cell: [f64; 6]) -> Result<Option<[[f64; 3]; 3]>, String> {
    let [a, gamma, b, beta, alpha, c] = cell;
    if cell.iter().any(|value| !value.is_finite()) {
        return Err(format!("the unit cell {cell:?} has a number that is not finite"));
    }
    if a == 0.0 && b == 0.0 && c == 0.0 {
        return Ok(None);
    }
    if let Some(edges) = from_angles([a, b, c], [alpha, beta, gamma]) {
        return Ok(Some(edges));
    }
    let [xx, xy, yy, xz, yz, zz] = cell;
    if xx > 0.0 && yy > 0.0 && zz > 0.0 {
        return Ok(Some([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]));
    }
    Err(format!("the unit cell {cell:?} is neither lengths and angles nor a matrix"))
}

/// The edges, of which the first is along x and the second in the plane of x and y, if these are possible.
fn from_angles(lengths: [f64; 3], angles: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    if lengths.iter().any(|length| *length <= 0.0)
        || angles.iter().any(|angle| *angle < -1.0 || *angle >= 180.0)
    {
        return None;
    }
    let are_cosines = angles.iter().all(|angle| angle.abs() <= 1.0);
    let [alpha, beta, gamma] = angles.map(|angle| match angle {
        cosine if are_cosines => cosine,
        90.0 => 0.0,
        degrees => degrees.to_radians().cos(),
    });
    let [a, b, c] = lengths;
    let sin_gamma = (1.0 - gamma * gamma).sqrt();
    let y = (alpha - beta * gamma) / sin_gamma;
    let z_squared = 1.0 - beta * beta - y * y;
    (z_squared > 0.0).then(|| {
        [[a, 0.0, 0.0], [b * gamma, b * sin_gamma, 0.0], [c * beta, c * y, c * z_squared.sqrt()]]
    })
}
