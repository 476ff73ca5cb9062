//! Whether numbers on the device are those that were asked for, apart from rounding.

use crate::verify::rounding::{FLUSH, U};

/// Whether a number is within two roundings of another.
pub(in crate::verify) fn is_near(found: f32, asked: f64) -> bool {
    (f64::from(found) - asked).abs() <= 2.0 * U * asked.abs() + FLUSH
}

pub(in crate::verify) fn are_near<const N: usize>(found: [f32; N], asked: [f64; N]) -> bool {
    found.into_iter().zip(asked).all(|(found, asked)| is_near(found, asked))
}
