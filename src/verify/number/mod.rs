//! What a number of a kernel may be: an interval that grows by whatever WGSL leaves free.
//!
//! Between two fences a compiler may fuse products and sums and take the terms of a sum in any order. So a number
//! is kept as what exact arithmetic would make of it, with how large its terms are together and through how many
//! roundings a term may have come; only when a kernel compares it, divides by it or fences it, does it grow by all
//! of them: by γ(k) times the terms' magnitudes (`rounding.rs`). That products of sums are not multiplied out, and
//! that a number is only flushed to zero where the kernel's text says that it stands, are assumptions.

mod functions;
#[cfg(test)]
mod tests;
mod vector;

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::rounding::{DIVIDE, FLUSH, Interval, PAD, U, gamma};

pub(super) use functions::{atan2_turns, sin_cos_eighth, sin_cos_turns};
pub(super) use vector::Vector;

/// No f32 is larger, and products of two are still finite.
const LARGEST: f64 = 1e90;

/// A number that a kernel has computed, and not yet fenced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number {
    /// Of exact arithmetic.
    low: f64,
    high: f64,
    /// The magnitudes of its terms, added up.
    size: f64,
    /// What was lost where a number below the normal ones became zero.
    flushed: f64,
    /// How many terms its sums have.
    terms: u32,
    /// How many roundings a term has beside those of sums.
    products: u32,
    /// Whether no term is negative: then nothing cancels.
    is_positive: bool,
}

impl Number {
    pub(super) const ZERO: Self = Self::known(0.0);
    pub(super) const ONE: Self = Self::known(1.0);
    pub(super) const TWO: Self = Self::known(2.0);
    pub(super) const HALF: Self = Self::known(0.5);

    /// A number that f32 holds exactly.
    pub(super) const fn known(value: f64) -> Self {
        Self::between(value, value)
    }

    /// A number that the device had; it may be zero if it is below the normal ones.
    pub(super) fn had(value: f32) -> Self {
        let wide = f64::from(value);
        if wide.abs() < FLUSH {
            return Self::between(wide.min(0.0), wide.max(0.0));
        }
        Self::known(wide)
    }

    /// A constant in a kernel's text.
    pub(super) fn constant(value: f64) -> Self {
        Self { products: 1, ..Self::known(value) }
    }

    /// All f32 of an interval.
    pub(super) const fn between(low: f64, high: f64) -> Self {
        let size = if high > -low { high } else { -low };
        let is_positive = low >= 0.0;
        Self { low, high, size, flushed: 0.0, terms: 1, products: 0, is_positive }
    }

    /// All that is within `error` of `value`.
    pub(super) const fn around(value: f64, error: f64) -> Self {
        Self::between(value - error, value + error)
    }

    fn bounded(self) -> Self {
        let within = |number: f64| number.clamp(-LARGEST, LARGEST);
        Self {
            low: within(self.low),
            high: within(self.high),
            size: within(self.size),
            flushed: within(self.flushed),
            ..self
        }
    }

    /// Rounded where it stands, as by `fence`.
    pub(super) fn fence(self) -> Self {
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

    /// What it may be, as a device has it.
    pub(super) fn interval(self) -> Interval {
        let Self { low, high, .. } = self.fence();
        Interval { low, high }
    }

    /// Whether it is zero whatever a device does; what only cancels is not.
    pub(super) fn is_zero(&self) -> bool {
        self.size == 0.0
    }

    /// Whether it is less than another; `None` if that is open.
    pub(super) fn is_less(self, other: Self) -> Option<bool> {
        let (a, b) = (self.interval(), other.interval());
        if a.high < b.low {
            Some(true)
        } else if a.low >= b.high {
            Some(false)
        } else {
            None
        }
    }

    /// Whether it is more than another; `None` if that is open.
    pub(super) fn is_more(self, other: Self) -> Option<bool> {
        other.is_less(self)
    }

    /// Whether it is positive; `None` if that is open.
    pub(super) fn is_above_zero(self) -> Option<bool> {
        self.is_more(Self::ZERO)
    }

    pub(super) fn min(self, other: Self) -> Self {
        let (a, b) = (self.interval(), other.interval());
        Self::between(a.low.min(b.low), a.high.min(b.high))
    }

    pub(super) fn max(self, other: Self) -> Self {
        let (a, b) = (self.interval(), other.interval());
        Self::between(a.low.max(b.low), a.high.max(b.high))
    }

    pub(super) fn clamp(self, low: f64, high: f64) -> Self {
        self.max(Self::known(low)).min(Self::known(high))
    }

    pub(super) fn abs(self) -> Self {
        let Interval { low, high } = self.interval();
        if low >= 0.0 {
            Self::between(low, high)
        } else {
            Self::between((-high).max(0.0), high.max(-low))
        }
    }

    /// The product with itself.
    pub(super) fn squared(self) -> Self {
        let fenced = self.abs();
        fenced * fenced
    }

    /// What either may be.
    pub(super) fn union(self, other: Self) -> Self {
        let Interval { low, high } = self.interval().union(other.interval());
        Self::between(low, high)
    }

    /// What both may be; itself, if nothing is.
    pub(super) fn narrowed(self, other: Self) -> Self {
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
        // Exact.
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
        let ends = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        let flushed = self.flushed * other.size
            + other.flushed * self.size
            + self.flushed * other.flushed
            + FLUSH;
        let product = Self {
            low: ends.into_iter().fold(f64::INFINITY, f64::min),
            high: ends.into_iter().fold(f64::NEG_INFINITY, f64::max),
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

    /// Whatever there is, if the divisor may be zero.
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
        let quotient = Self::between(
            least - relative * least.abs() - FLUSH,
            most + relative * most.abs() + FLUSH,
        );
        // The quotient of positive numbers is positive.
        let quotient = if least >= 0.0 {
            Self::between(quotient.low.max(0.0), quotient.high)
        } else {
            quotient
        };
        quotient.bounded()
    }
}
