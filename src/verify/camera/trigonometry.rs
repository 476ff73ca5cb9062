//! Sines and cosines: how far a device's may be from the exact ones. Twin of `shaders/math/trigonometry.wgsl`.

use std::f64::consts::{FRAC_PI_4, PI};

use crate::verify::rounding::{FLUSH, PAD, U, gamma};

/// What `sin_cos_eighth` may be off by, of exactly the angle that it is given, up to an eighth of a turn and what
/// rounding adds to that.
///
/// Both series are one term, and the rest as a fenced sum. The last term of the cosine's rest passes 5 roundings of
/// the square, one of its coefficient, 5 products and 4 sums; all terms together are no more than cosh(pi/4) - 1 <
/// 0.326 in size. Then there is one sum, of at most 1, and what is left out, the next term: (pi/4)^12/12!. The
/// sine's rest, sinh(pi/4) - pi/4 < 0.084, and what is left out of it, (pi/4)^11/11! < 1.8e-9, come to less.
pub(super) const EIGHTH_ERROR: f64 = gamma(15) * 0.326 + U + 1.2e-10;

/// A sine and a cosine, exactly. A device's are those of an angle that may differ, and each may be off by an error
/// besides: what is turned keeps its length.
#[derive(Clone, Copy, Debug)]
pub(super) struct SinCos {
    pub(super) sin: f64,
    pub(super) cos: f64,
    pub(super) error: f64,
    /// By how much the angle may differ.
    pub(super) turned: f64,
}

impl SinCos {
    /// Of so many half turns, which a device may be off by `error`.
    pub(super) fn of_half_turns(half_turns: f64, error: f64) -> Self {
        let (sin, cos) = (PI * half_turns).sin_cos();
        // What is over a quarter turn is exact; it is multiplied by a constant that is rounded as well.
        let turned = PAD * (PI * error + gamma(2) * FRAC_PI_4);
        Self { sin, cos, error: PAD * EIGHTH_ERROR + 4.0 * FLUSH, turned }
    }
}
