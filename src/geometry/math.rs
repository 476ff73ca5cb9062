//! Small vector helpers, and the range of lengths that the kernels can square without overflow.

use glam::DVec3;

/// The largest magnitude, in scene units, of any coordinate, radius or camera parameter: 2⁵⁶.
///
/// Kernels compute in f32 and must never produce an infinity. With every length at most 2⁵⁶, the vector between a ray's
/// origin and a centre is at most 2⁵⁹ long in each component, so a squared distance stays below 2¹²⁰; f32 reaches 2¹²⁸.
pub const MAX_LENGTH: f64 = (1_u64 << 56) as f64;

/// The smallest radius or view-plane length, in scene units: 2⁻⁵⁶.
///
/// Its square, 2⁻¹¹², is still a normal f32; a device may flush subnormal numbers to zero.
pub const MIN_LENGTH: f64 = 1.0 / MAX_LENGTH;

/// The vector of length one along `v`, or `None` if `v` is zero or not finite.
///
/// Scales by the largest component first, so that no finite vector overflows or underflows.
pub(crate) fn unit(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    if !v.is_finite() || largest == 0.0 {
        return None;
    }
    // A division, because 1/largest is infinite for a subnormal `largest`.
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
}
