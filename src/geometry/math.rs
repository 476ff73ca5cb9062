//! Small vector helpers, a map from square to disk, and the range of lengths that kernels can square without overflow.

use std::f64::consts::FRAC_PI_4;

use glam::{DVec2, DVec3};

/// The largest magnitude, in scene units, of any coordinate, radius or camera parameter: 2⁵⁶.
///
/// Kernels compute in f32 and must never produce an infinity. With every length at most 2⁵⁶, the vector between a ray's
/// origin and a centre is at most 2⁵⁹ long in each component, so a squared distance stays below 2¹²⁰; f32 reaches 2¹²⁸.
pub const MAX_LENGTH: f64 = (1_u64 << 56) as f64;

/// The smallest radius or view-plane length, in scene units: 2⁻⁵⁶.
///
/// The square of this length, 2⁻¹¹², is still a normal f32. A device may flush subnormal numbers to zero.
pub const MIN_LENGTH: f64 = 1.0 / MAX_LENGTH;

/// The vector of length one along `v`, or `None` if `v` is zero or not finite.
///
/// Scales by the largest component first, so that no finite vector overflows or underflows.
#[must_use]
pub fn unit(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    if !v.is_finite() || largest == 0.0 {
        return None;
    }
    // Divides, because 1/largest is infinite for a subnormal `largest`.
    (v / largest).try_normalize()
}

/// The bits of a number, with −0 turned into +0, so that equal numbers have equal bits.
pub(crate) fn equal_bits(x: f32) -> u32 {
    (x + 0.0).to_bits()
}

/// Converts a vector to f64.
pub(crate) fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

/// Maps a point of the unit square [0, 1)² to the unit disk by the concentric map, which preserves relative areas and
/// keeps neighbours together. The centre (½, ½) stays the centre. The WGSL twin is `shaders/math/disk.wgsl`.
///
/// P. Shirley and K. Chiu, *A low distortion map between disk and square*, Journal of Graphics Tools 2 (1997), with D.
/// Cline's signed radius, which needs two cases instead of four.
pub(crate) fn concentric_disk(square: DVec2) -> DVec2 {
    let spot = 2.0 * square - 1.0;
    if spot == DVec2::ZERO {
        return DVec2::ZERO;
    }
    if spot.x.abs() > spot.y.abs() {
        let (sin, cos) = (FRAC_PI_4 * (spot.y / spot.x)).sin_cos();
        spot.x * DVec2::new(cos, sin)
    } else {
        let (sin, cos) = (FRAC_PI_4 * (spot.x / spot.y)).sin_cos();
        spot.y * DVec2::new(sin, cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_survives_every_magnitude() {
        for magnitude in [f64::MIN_POSITIVE / 4.0, 1e-200, 1.0, 1e200, f64::MAX] {
            let n = unit(DVec3::new(magnitude, -magnitude, magnitude)).unwrap();
            assert!((n.length() - 1.0).abs() < 1e-15, "{magnitude:e}: {n}");
        }
    }

    #[test]
    fn unit_refuses_what_has_no_direction() {
        assert_eq!(unit(DVec3::ZERO), None);
        assert_eq!(unit(DVec3::new(f64::NAN, 0.0, 1.0)), None);
        assert_eq!(unit(DVec3::new(0.0, f64::INFINITY, 1.0)), None);
    }

    fn near(square: [f64; 2], disk: [f64; 2]) {
        let found = concentric_disk(DVec2::from(square));
        assert!((found - DVec2::from(disk)).length() < 1e-15, "{square:?}: {found}");
    }

    #[test]
    fn on_paper() {
        let half = 0.5_f64.sqrt();
        assert_eq!(concentric_disk(DVec2::splat(0.5)), DVec2::ZERO);
        near([0.0, 0.5], [-1.0, 0.0]);
        near([0.5, 1.0], [0.0, 1.0]);
        near([1.0, 1.0], [half, half]);
        near([0.0, 1.0], [-half, half]);
        near([0.75, 0.25], [0.5 * half, -0.5 * half]);
    }

    /// Equal areas of the square are mapped to equal areas of the disk, so a grid of points has the moments of a
    /// uniform disk.
    #[test]
    fn areas_keep_their_proportions() {
        let side = 1000;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(side);
        let points: Vec<DVec2> =
            (0..side * side).map(|k| concentric_disk(DVec2::new(at(k % side), at(k / side)))).collect();
        let mean = |f: fn(&DVec2) -> f64| points.iter().map(f).sum::<f64>() / points.len() as f64;
        assert!(points.iter().all(|p| p.length() < 1.0));
        assert!((mean(|p| p.length_squared()) - 0.5).abs() < 1e-5);
        assert!((mean(|p| p.x * p.x) - 0.25).abs() < 1e-5);
        assert!((mean(|p| p.x.powi(4)) - 0.125).abs() < 1e-5);
        assert!(mean(|p| p.x).abs() < 1e-12 && mean(|p| p.x * p.y).abs() < 1e-12);
    }
}
