//! The values of a number in a kernel: an interval that grows by the freedom that WGSL allows.
//!
//! Between two fences, a compiler may fuse products and sums, and add the terms of a sum in any order. A number
//! is therefore stored as the result of exact arithmetic, with the sum of the magnitudes of its terms and the
//! number of roundings that a term may have passed through. Only when a kernel compares the number, divides by it
//! or fences it, the interval grows by the error of all roundings: γ(k) times the terms' magnitudes
//! (`rounding.rs`). Two things are assumed: that products of sums are not expanded, and that a number is flushed
//! to zero only where it appears in the kernel's text.

mod functions;
#[cfg(test)]
mod tests;
mod vector;

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::rounding::{DIVIDE, FLUSH, Interval, PAD, U, gamma};

pub(crate) use functions::{atan2_turns, sin_cos_eighth, sin_cos_turns};
pub(crate) use vector::Vector;

/// A limit above every f32. Products of two such numbers are still finite.
const LARGEST: f64 = 1e90;

/// A number that a kernel has computed and not yet fenced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Number {
    /// The interval of exact arithmetic.
    low: f64,
    high: f64,
    /// The sum of the magnitudes of the number's terms.
    size: f64,
    /// The error of subnormal numbers that were flushed to zero.
    flushed: f64,
    /// The number of terms of the number's sums.
    terms: u32,
    /// The number of roundings of a term, without the roundings of sums.
    products: u32,
    /// Whether no term is negative, so that nothing cancels.
    is_positive: bool,
}

impl Number {
    pub(crate) const ZERO: Self = Self::known(0.0);
    pub(crate) const ONE: Self = Self::known(1.0);
    pub(crate) const TWO: Self = Self::known(2.0);
    pub(crate) const HALF: Self = Self::known(0.5);

    /// A number that f32 represents exactly.
    pub(crate) const fn known(value: f64) -> Self {
        Self::between(value, value)
    }

    /// A number that the device recorded. It may count as zero if it is subnormal.
    pub(crate) fn recorded(value: f32) -> Self {
        let wide = f64::from(value);
        if wide.abs() < FLUSH {
            return Self::between(wide.min(0.0), wide.max(0.0));
        }
        Self::known(wide)
    }

    /// A constant from a kernel's text, which is rounded.
    pub(crate) fn constant(value: f64) -> Self {
        Self { products: 1, ..Self::known(value) }
    }

    /// All numbers of an interval.
    pub(crate) const fn between(low: f64, high: f64) -> Self {
        let size = if high > -low { high } else { -low };
        let is_positive = low >= 0.0;
        Self { low, high, size, flushed: 0.0, terms: 1, products: 0, is_positive }
    }

    /// All numbers within `error` of `value`.
    pub(crate) const fn around(value: f64, error: f64) -> Self {
        Self::between(value - error, value + error)
    }

    fn bounded(self) -> Self {
        // No end is larger than the magnitudes of the terms together.
        if self.size <= LARGEST && self.flushed <= LARGEST {
            return self;
        }
        let within = |number: f64| number.clamp(-LARGEST, LARGEST);
        Self {
            low: within(self.low),
            high: within(self.high),
            size: within(self.size),
            flushed: within(self.flushed),
            ..self
        }
    }

    /// The number with all rounding errors added, as after `fence`.
    pub(crate) fn fence(self) -> Self {
        let steps = self.products + self.terms - 1;
        if steps == 0 {
            return self;
        }
        let relative = PAD * gamma(steps);
        let cancels = self.terms > 1 && !self.is_positive;
        let error = |end: f64| {
            let size = if cancels { self.size } else { end.abs() };
            relative * size + PAD * self.flushed
        };
        let low = self.low - error(self.low);
        let low = if self.is_positive { low.max(0.0) } else { low };
        Self::between(low, self.high + error(self.high)).bounded()
    }

    /// The interval of values that a device may have.
    pub(crate) fn interval(self) -> Interval {
        let Self { low, high, .. } = self.fence();
        Interval { low, high }
    }

    /// Whether the number is zero on every device. A sum that may only cancel is not.
    pub(crate) fn is_zero(&self) -> bool {
        self.size == 0.0
    }

    /// Whether the number is less than another; `None` if undecided.
    pub(crate) fn is_less(self, other: Self) -> Option<bool> {
        let (a, b) = (self.interval(), other.interval());
        if a.high < b.low {
            Some(true)
        } else if a.low >= b.high {
            Some(false)
        } else {
            None
        }
    }

    /// Whether the number is more than another; `None` if undecided.
    pub(crate) fn is_more(self, other: Self) -> Option<bool> {
        other.is_less(self)
    }

    /// Whether the number is positive; `None` if undecided.
    pub(crate) fn is_above_zero(self) -> Option<bool> {
        self.is_more(Self::ZERO)
    }

    pub(crate) fn min(self, other: Self) -> Self {
        let (a, b) = (self.interval(), other.interval());
        Self::between(a.low.min(b.low), a.high.min(b.high))
    }

    pub(crate) fn max(self, other: Self) -> Self {
        let (a, b) = (self.interval(), other.interval());
        Self::between(a.low.max(b.low), a.high.max(b.high))
    }

    pub(crate) fn clamp(self, low: f64, high: f64) -> Self {
        self.max(Self::known(low)).min(Self::known(high))
    }

    pub(crate) fn abs(self) -> Self {
        let Interval { low, high } = self.interval();
        if low >= 0.0 { Self::between(low, high) } else { Self::between((-high).max(0.0), high.max(-low)) }
    }

    /// The product with itself.
    pub(crate) fn squared(self) -> Self {
        let fenced = self.abs();
        fenced * fenced
    }

    /// The smallest interval that contains the values of both numbers.
    pub(crate) fn union(self, other: Self) -> Self {
        let Interval { low, high } = self.interval().union(other.interval());
        Self::between(low, high)
    }

    /// The values in both intervals; this number if there are none.
    pub(crate) fn narrowed(self, other: Self) -> Self {
        let Interval { low, high } = self.interval().intersection(other.interval());
        if low <= high { Self::between(low, high) } else { self }
    }
}

impl Neg for Number {
    type Output = Self;

    fn neg(self) -> Self {
        let is_positive = self.terms == 1 && self.high <= 0.0;
        Self { low: -self.high, high: -self.low, is_positive, ..self }
    }
}

impl Add for Number {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        // Adding zero is exact.
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        let sum = Self {
            low: self.low + other.low,
            high: self.high + other.high,
            size: self.size + other.size,
            flushed: self.flushed + other.flushed + FLUSH,
            terms: self.terms + other.terms,
            products: self.products.max(other.products),
            is_positive: self.is_positive && other.is_positive,
        };
        sum.bounded()
    }
}

impl Sub for Number {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Number {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let one = Interval { low: 1.0, high: 1.0 };
        let is_one = |Self { low, high, terms, products, .. }: Self| {
            Interval { low, high } == one && terms == 1 && products == 0
        };
        if self.is_zero() || other.is_zero() {
            return Self::ZERO;
        }
        if is_one(self) {
            return other;
        }
        if is_one(other) {
            return self;
        }
        let (a, b, c, d) = (self.low, self.high, other.low, other.high);
        // The case without infinite numbers, whose products with zero are NaN.
        let is_simple = a >= 0.0 && c >= 0.0 && b <= LARGEST && d <= LARGEST;
        let (low, high) = if is_simple {
            (a * c, b * d)
        } else {
            let ends = [a * c, a * d, b * c, b * d];
            (ends.into_iter().fold(f64::INFINITY, f64::min), ends.into_iter().fold(f64::NEG_INFINITY, f64::max))
        };
        let flushed = self.flushed * other.size + other.flushed * self.size + self.flushed * other.flushed + FLUSH;
        let product = Self {
            low,
            high,
            size: self.size * other.size,
            flushed,
            terms: self.terms + other.terms - 1,
            products: self.products + other.products + 1,
            is_positive: self.is_positive && other.is_positive,
        };
        product.bounded()
    }
}

impl Div for Number {
    type Output = Self;

    /// The quotient. If the divisor may be zero, any number.
    fn div(self, other: Self) -> Self {
        let Interval { low, high } = other.interval();
        if self.is_zero() {
            return Self::ZERO;
        }
        if low <= 0.0 && high >= 0.0 {
            let is_positive = self.is_positive && low >= 0.0;
            return Self::between(if is_positive { 0.0 } else { -LARGEST }, LARGEST);
        }
        let a = self.interval();
        let ends = [a.low / low, a.low / high, a.high / low, a.high / high];
        let least = ends.into_iter().fold(f64::INFINITY, f64::min);
        let most = ends.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let relative = PAD * (DIVIDE + U * DIVIDE);
        let quotient = Self::between(least - relative * least.abs() - FLUSH, most + relative * most.abs() + FLUSH);
        // The quotient of positive numbers is not negative.
        let quotient = if least >= 0.0 { Self::between(quotient.low.max(0.0), quotient.high) } else { quotient };
        quotient.bounded()
    }
}
