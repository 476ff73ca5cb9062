//! Vectors of three numbers.

use std::ops::{Add, Mul, Neg, Sub};

use glam::DVec3;

use super::Number;
use crate::verify::rounding::Interval;

/// A vector or a colour that a kernel has computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector(pub(crate) [Number; 3]);

impl Vector {
    pub(crate) const ZERO: Self = Self([Number::ZERO; 3]);
    pub(crate) const ONE: Self = Self([Number::ONE; 3]);

    /// A vector that the device recorded.
    pub(crate) fn recorded(vector: [f32; 3]) -> Self {
        Self(vector.map(Number::recorded))
    }

    /// All vectors within `error` of `exact` along each axis.
    pub(crate) fn around(exact: DVec3, error: f64) -> Self {
        Self(exact.to_array().map(|x| Number::around(x, error)))
    }

    pub(crate) fn map(self, f: impl Fn(Number) -> Number) -> Self {
        Self(self.0.map(f))
    }

    pub(crate) fn zip(self, other: Self, f: impl Fn(Number, Number) -> Number) -> Self {
        let ([a, b, c], [p, q, r]) = (self.0, other.0);
        Self([f(a, p), f(b, q), f(c, r)])
    }

    /// The product of each pair of components.
    pub(crate) fn times(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }

    pub(crate) fn fence(self) -> Self {
        self.map(Number::fence)
    }

    pub(crate) fn dot(self, other: Self) -> Number {
        let Self([x, y, z]) = self.times(other);
        x + y + z
    }

    pub(crate) fn squared(self) -> Number {
        let Self([x, y, z]) = self.map(Number::squared);
        x + y + z
    }

    /// The vector divided by its length. If the length may be zero, any vector of about unit length.
    pub(crate) fn normalized(self) -> Self {
        let v = self.fence();
        let length = v.squared().sqrt();
        v.map(|x| {
            let unit = x / length;
            // The quotient of a component and the length, which is at least as large.
            unit.clamp(-UNIT, UNIT)
        })
    }

    /// The middle of the vector's intervals, and half their widths.
    pub(crate) fn ball(self) -> (DVec3, DVec3) {
        let axes = self.intervals();
        let middle = DVec3::from(axes.map(|axis| 0.5 * (axis.low + axis.high)));
        (middle, DVec3::from(axes.map(|axis| 0.5 * (axis.high - axis.low))))
    }

    pub(crate) fn largest(self) -> Number {
        let Self([x, y, z]) = self;
        x.max(y).max(z)
    }

    pub(crate) fn intervals(self) -> [Interval; 3] {
        self.0.map(Number::interval)
    }
}

/// An upper limit for a component of a vector that was divided by its length.
const UNIT: f64 = 1.0 + 1e-5;

impl Add for Vector {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Vector {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Neg for Vector {
    type Output = Self;

    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl Mul<Number> for Vector {
    type Output = Self;

    fn mul(self, factor: Number) -> Self {
        self.map(|x| x * factor)
    }
}
