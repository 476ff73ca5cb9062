//! The check of sines and cosines: bounds of a device's error. The WGSL twin is `shaders/math/trigonometry.wgsl`.

use std::f64::consts::{FRAC_PI_4, PI};

use crate::verify::rounding::{FLUSH, PAD, U, gamma};

/// The error of `sin_cos_eighth` for exactly the angle that it is given, which is at most an eighth of a turn plus
/// rounding.
///
/// Both series consist of one term and a remainder, which is a fenced sum. The last term of the cosine's remainder
/// passes through 5 roundings of the square, one of its coefficient, 5 products and 4 sums; the magnitudes of all terms
/// add up to at most cosh(pi/4) - 1 < 0.326. Then there is one sum, of at most 1, and the truncation error, which is
/// the next term: (pi/4)^12/12!. The sine's remainder, sinh(pi/4) - pi/4 < 0.084, and its truncation error,
/// (pi/4)^11/11! < 1.8e-9, are smaller.
pub(super) const EIGHTH_ERROR: f64 = gamma(15) * 0.326 + U + 1.2e-10;

/// The exact sine and cosine of an angle. A device's values are those of an angle that may differ by `turned`, and each
/// has an additional error. The two are separate because a rotation preserves length.
#[derive(Clone, Copy, Debug)]
pub(super) struct SinCos {
    pub(super) sin: f64,
    pub(super) cos: f64,
    pub(super) error: f64,
    /// The largest difference of the angle.
    pub(super) turned: f64,
}

impl SinCos {
    /// Sine and cosine of a number of half turns; a device's number may differ by `error`.
    pub(super) fn of_half_turns(half_turns: f64, error: f64) -> Self {
        let (sin, cos) = (PI * half_turns).sin_cos();
        // The part beyond a quarter turn is exact; it is multiplied by a rounded constant.
        let turned = PAD * (PI * error + gamma(2) * FRAC_PI_4);
        Self { sin, cos, error: PAD * EIGHTH_ERROR + 4.0 * FLUSH, turned }
    }
}
