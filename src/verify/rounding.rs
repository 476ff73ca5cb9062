//! Bounds of the difference between a conforming WGSL implementation and the exact result of an operation.
//!
//! The accuracy table of the WGSL specification ("Floating point accuracy") says: sums, differences and products are
//! rounded to either neighbour; a quotient is within 2.5 ULP, an inverse square root within 2 ULP, and a square root
//! within the error of 1 divided by an inverse square root. Compilers may also make a quotient x/y the product of x and
//! 1/y, which the table omits; it then has both errors. Subnormal numbers may be flushed to zero. Products and sums may
//! be fused, and the terms of a sum may be added in any order. Therefore the error of an expression between two fences
//! (`shaders/math/fence.wgsl`) is bounded by γ(k) times the sum of its terms' magnitudes, if no term passes through
//! more than k roundings (Higham, *Accuracy and Stability of Numerical Algorithms*, second edition, section 3.1).

/// The relative error of one rounding to either neighbour: 2⁻²³. An ULP is at most this.
pub(super) const U: f64 = 1.0 / (1 << 23) as f64;

/// The largest error if a subnormal number is flushed to zero: 2⁻¹²⁶.
pub(super) const FLUSH: f64 = f32::MIN_POSITIVE as f64;

/// The error of a quotient, in units of 2⁻²³ of it: 2.5 ULP of 1/y and one rounding of the product x · (1/y). In ULP
/// the number would be larger, because an ULP of 1/y may be twice as large, relative to 1/y, as an ULP of the quotient.
pub(crate) const DIVIDE_UNITS: f64 = 3.5;

/// The error of a square root, in ULP: 2 for an inverse square root, 2.5 for 1 divided by it,
/// and the remainder of their product.
pub(crate) const SQRT_ULP: f64 = 5.0;

/// The relative error of a quotient, with the product of both errors.
pub(super) const DIVIDE: f64 = DIVIDE_UNITS * U * (1.0 + U);

/// The relative error of a square root.
pub(super) const SQRT: f64 = SQRT_ULP * U;

/// A factor for the error of the bounds themselves, which are computed in f64. Roundings of f64 are 2⁻²⁹ of the
/// roundings that they bound.
pub(super) const PAD: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// The relative error of `k` roundings in sequence.
pub(crate) const fn gamma(k: u32) -> f64 {
    let sum = k as f64 * U;
    sum / (1.0 - sum)
}

/// The error of the length of a fenced vector, which is the root of a sum of three squares.
pub(super) fn error_of_length(length: f64) -> f64 {
    // Each of 8 operations may flush a square to zero. The root halves the effect.
    PAD * ((gamma(3) + SQRT) * length + 4.0 * FLUSH / length)
}

/// The deviation from unit length of a vector that was divided by its length.
pub(super) fn unit_error(length: f64) -> f64 {
    error_of_length(length) / length + PAD * (DIVIDE + 2.0 * U)
}

/// The numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lowest number.
    pub low: f64,
    /// The highest number.
    pub high: f64,
}

impl Interval {
    pub(super) const ZERO: Self = Self { low: 0.0, high: 0.0 };

    /// The numbers within `error` of `value`.
    pub(super) fn around(value: f64, error: f64) -> Self {
        Self { low: value - error, high: value + error }
    }

    /// The numbers between `a` and `b`, either of which may be the larger, and within `error` of them.
    pub(super) fn between(a: f64, b: f64, error: f64) -> Self {
        Self { low: a.min(b) - error, high: a.max(b) + error }
    }

    /// The largest magnitude.
    pub(super) fn size(self) -> f64 {
        self.high.abs().max(self.low.abs())
    }

    /// Returns true if a number lies in the interval.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// The numbers in both intervals. `low` is above `high` if there are none.
    pub(super) fn intersection(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    /// The smallest interval that contains both.
    pub(super) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The distance of a number from the middle, relative to half the width: at most 1 for numbers in the interval.
    #[must_use]
    pub fn fraction(&self, value: f64) -> f64 {
        let (middle, half) = (0.5 * (self.low + self.high), 0.5 * (self.high - self.low));
        if half > 0.0 && half.is_finite() { (value - middle).abs() / half } else { 0.0 }
    }
}

impl std::fmt::Display for Interval {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { low, high } = self;
        if low.to_bits() == high.to_bits() {
            // The number is written like the f32 that it is.
            write!(f, "{:?}", *low as f32)
        } else {
            write!(f, "[{low:.10e}, {high:.10e}]")
        }
    }
}

/// The greatest f32 that is not above a number.
pub(super) fn down(value: f64) -> f32 {
    let near = value as f32;
    if f64::from(near) > value { near.next_down() } else { near }
}

/// The least f32 that is not below a number.
pub(super) fn up(value: f64) -> f32 {
    let near = value as f32;
    if f64::from(near) < value { near.next_up() } else { near }
}

/// Whether a number on the device is within two roundings of the requested number.
pub(crate) fn is_near(found: f32, asked: f64) -> bool {
    (f64::from(found) - asked).abs() <= 2.0 * U * asked.abs() + FLUSH
}

pub(crate) fn are_near<const N: usize>(found: [f32; N], asked: [f64; N]) -> bool {
    found.into_iter().zip(asked).all(|(found, asked)| is_near(found, asked))
}
