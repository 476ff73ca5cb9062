//! How far a conforming WGSL implementation may be from the exact result of an operation.
//!
//! From the accuracy table of the WGSL specification ("Floating point accuracy"): sums, differences and
//! products are rounded to either neighbour, a quotient is within 2.5 ULP, an inverse square root within 2, and
//! a square root within what follows from one over it; numbers below the normal ones may become zero. Products
//! and sums may be fused, and the terms of a sum be taken in any order: so whatever stands between two fences
//! (`shaders/math/fence.wgsl`) is bounded by γ(k) times the sum of its terms' magnitudes, where no term passes more
//! than k roundings (Higham, *Accuracy and Stability of Numerical Algorithms*, second edition, section 3.1).

/// One rounding to either neighbour, relative: 2⁻²³. An ULP is at most this.
pub(super) const U: f64 = 1.0 / (1 << 23) as f64;

/// What is lost where a number below the normal ones becomes zero: 2⁻¹²⁶.
pub(super) const FLUSH: f64 = f32::MIN_POSITIVE as f64;

/// A quotient, in ULP.
pub(crate) const DIVIDE_ULP: f64 = 2.5;

/// A square root, in ULP: two of an inverse square root and 2.5 of one over it, and what is left of their
/// product.
pub(crate) const SQRT_ULP: f64 = 5.0;

/// A quotient, relative.
pub(super) const DIVIDE: f64 = DIVIDE_ULP * U;

/// A square root, relative.
pub(super) const SQRT: f64 = SQRT_ULP * U;

/// Bounds are themselves computed in f64, whose roundings are 2⁻²⁹ of those that they bound.
pub(super) const PAD: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// `k` roundings one after the other, relative.
pub(crate) const fn gamma(k: u32) -> f64 {
    let sum = k as f64 * U;
    sum / (1.0 - sum)
}

/// What the length of a fenced vector, the root of three squares' sum, may be off by.
pub(super) fn error_of_length(length: f64) -> f64 {
    // Squares may become zero, each operation's at most: 8 times, halved by the root.
    PAD * ((gamma(3) + SQRT) * length + 4.0 * FLUSH / length)
}

/// How far a vector that was divided by its length may be from unit length.
pub(super) fn unit_error(length: f64) -> f64 {
    error_of_length(length) / length + PAD * (DIVIDE + 2.0 * U)
}

/// Numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lowest.
    pub low: f64,
    /// The highest.
    pub high: f64,
}

impl Interval {
    /// All that is within `error` of `value`.
    pub(super) fn around(value: f64, error: f64) -> Self {
        Self { low: value - error, high: value + error }
    }

    /// Whether a number lies in it.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// What lies in both; `low` is above `high` if nothing does.
    pub(super) fn intersection(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    /// The smallest that holds both.
    pub(super) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// How far a number is from the middle, of the half width: at most 1 for what lies in it.
    #[must_use]
    pub fn fraction(&self, value: f64) -> f64 {
        let (middle, half) = (0.5 * (self.low + self.high), 0.5 * (self.high - self.low));
        if half > 0.0 && half.is_finite() { (value - middle).abs() / half } else { 0.0 }
    }
}
