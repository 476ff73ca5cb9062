//! The principal axes of points: the directions in which they spread most and least.

use glam::{DMat3, DQuat, DVec2, DVec3};

/// Directions in which points spread differ if the mean squares of their distances have less than this ratio.
const DIFFERENT: f64 = 0.8;

/// Turns of a pair of axes after which the others are tried. Few suffice, as each halves what is left at least.
const SWEEPS: usize = 16;

/// From where points look widest, and what is up then: the direction towards the eye, along which they spread least, and
/// the direction of middle spread, so that they are longest from side to side. `None` if they spread in all directions
/// alike. Of two opposite directions it is the one nearer to `near`, for the eye and for up.
pub(super) fn widest_view(points: impl Iterator<Item = DVec3> + Clone, near: [DVec3; 2]) -> Option<[DVec3; 2]> {
    let finite = points.filter(|point| point.is_finite());
    let count = finite.clone().count();
    if count < 2 {
        return None;
    }
    let mean = finite.clone().sum::<DVec3>() / count as f64;
    let square = |a: DVec3| DMat3::from_cols(a * a.x, a * a.y, a * a.z);
    let spread = finite.map(|point| square(point - mean)).fold(DMat3::ZERO, |sum, part| sum + part);
    let [(least, shortest), (middle, second), (most, longest)] = eigenvectors(spread)?;
    let towards = |axis: DVec3, near: DVec3| if axis.dot(near) < 0.0 { -axis } else { axis };
    if least < DIFFERENT * middle {
        let eye = towards(shortest, near[0]);
        // Where two directions are alike, what is up without this stays so as far as possible.
        let up = if middle < DIFFERENT * most { second } else { near[1] - eye * near[1].dot(eye) };
        return Some([eye, towards(up.try_normalize().unwrap_or(second), near[1])]);
    }
    // A rod is seen from its side.
    let side = (near[0] - longest * near[0].dot(longest)).try_normalize()?;
    (middle < DIFFERENT * most).then(|| [side, towards(longest.cross(side), near[1])])
}

/// The view near another one, by up to 40 degrees along each side, in which points hide each other least: those that are
/// nearer to each other than `reach` in the picture. Smaller turns are better.
pub(super) fn clearest_view(points: &[DVec3], [eye, up]: [DVec3; 2], reach: f64) -> [DVec3; 2] {
    let right = up.cross(eye);
    let hidden = |[eye, up]: [DVec3; 2]| -> f64 {
        let right = up.cross(eye);
        let places: Vec<DVec2> =
            points.iter().map(|point| DVec2::new(point.dot(right), point.dot(up)) / reach).collect();
        let pairs =
            places.iter().enumerate().flat_map(|(at, a)| places[..at].iter().map(move |b| a.distance_squared(*b)));
        pairs.map(|squared| (1.0 - squared).max(0.0)).sum()
    };
    let steps = || (-4..=4).map(|step| 10.0 * f64::from(step));
    let turned = |across: f64, upward: f64| {
        let turn = DQuat::from_axis_angle(right, upward.to_radians()) * DQuat::from_axis_angle(up, across.to_radians());
        [turn * eye, turn * up]
    };
    let views = steps().flat_map(|across| steps().map(move |upward| (across, upward)));
    let rated = views.map(|(across, upward)| {
        let view = turned(across, upward);
        (hidden(view) + 1e-4 * (across * across + upward * upward), view)
    });
    rated.min_by(|a, b| a.0.total_cmp(&b.0)).map_or([eye, up], |(_, view)| view)
}

/// The eigenvalues of a symmetric matrix, the smallest first, with vectors of length 1, by the rotations of Jacobi (Golub
/// and Van Loan, Matrix Computations, section 8.5).
fn eigenvectors(mut matrix: DMat3) -> Option<[(f64, DVec3); 3]> {
    let mut turned = DMat3::IDENTITY;
    for _ in 0..SWEEPS {
        for [p, q] in [[0, 1], [0, 2], [1, 2]] {
            let apq = matrix.col(q)[p];
            if apq == 0.0 {
                continue;
            }
            let tau = (matrix.col(q)[q] - matrix.col(p)[p]) / (2.0 * apq);
            let tangent = 1.0_f64.copysign(tau) / (tau.abs() + tau.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            let sine = tangent * cosine;
            let mut turn = DMat3::IDENTITY;
            (turn.col_mut(p)[p], turn.col_mut(q)[q]) = (cosine, cosine);
            (turn.col_mut(q)[p], turn.col_mut(p)[q]) = (sine, -sine);
            matrix = turn.transpose() * matrix * turn;
            turned *= turn;
        }
    }
    let mut pairs = [0, 1, 2].map(|axis| (matrix.col(axis)[axis], turned.col(axis)));
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    pairs.iter().all(|(value, vector)| value.is_finite() && vector.is_finite()).then_some(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEAR: [DVec3; 2] = [DVec3::new(0.4, 0.3, 0.8), DVec3::Y];

    fn view(points: &[[f64; 3]]) -> Option<[DVec3; 2]> {
        widest_view(points.iter().map(|point| DVec3::from(*point)), NEAR)
    }

    #[test]
    fn flat_points_are_seen_from_their_flat_side() {
        // A rectangle of 8 x 2 in a plane that leans.
        let (along, across) = (DVec3::new(0.0, 0.6, 0.8), DVec3::X);
        let eye = along.cross(across);
        let eye = if eye.dot(NEAR[0]) < 0.0 { -eye } else { eye };
        let points: Vec<[f64; 3]> = [[4.0, 1.0], [4.0, -1.0], [-4.0, 1.0], [-4.0, -1.0]]
            .map(|[a, b]| (along * a + across * b + DVec3::splat(7.0)).to_array())
            .to_vec();
        let [found, up] = view(&points).unwrap();
        assert!((found - eye).length() < 1e-9 && up.dot(across).abs() > 1.0 - 1e-9, "{found} {up}");
    }

    #[test]
    fn rods_are_seen_from_their_side() {
        let [eye, up] = view(&[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]]).unwrap();
        let along = DVec3::ONE;
        assert!(eye.dot(along).abs() < 1e-9 && up.dot(along).abs() < 1e-9 && eye.dot(up).abs() < 1e-9, "{eye} {up}");
    }

    #[test]
    fn few_points_do_not_hide_each_other() {
        // From the front, the first two are in one place.
        let points = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [2.0, 0.0, 0.0], [-2.0, 0.0, 0.0]].map(DVec3::from);
        let front = [DVec3::Z, DVec3::Y];
        let [eye, up] = clearest_view(&points, front, 0.9);
        let place = |point: DVec3| point - eye * point.dot(eye);
        assert!((place(points[0]) - place(points[1])).length() > 0.6, "{eye}");
        assert!((eye.length() - 1.0).abs() < 1e-9 && eye.dot(up).abs() < 1e-9 && eye.dot(DVec3::Z) > 0.5, "{eye} {up}");
        assert_eq!(clearest_view(&points[2..], front, 0.9), front);
    }

    #[test]
    fn round_clouds_have_no_axes() {
        let corners: Vec<[f64; 3]> = (0..8).map(|i| [0, 1, 2].map(|axis| f64::from(i >> axis & 1))).collect();
        assert_eq!(view(&corners), None);
        assert_eq!(view(&[[1.0; 3]]), None);
        assert_eq!(view(&[[f64::NAN; 3], [f64::INFINITY; 3], [1.0; 3]]), None);
        assert_eq!(view(&[[1.0; 3], [1.0; 3]]), None);
        assert_eq!(view(&[[1e300; 3], [-1e300, 0.0, 1e300]]), None);
    }
}
