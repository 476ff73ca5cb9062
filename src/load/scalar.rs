//! The types of numbers of formats that say which they have.

use super::binary::{Number, Order};

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    #[cfg_attr(not(feature = "vtk"), expect(dead_code, reason = "PLY has no integers of 64 bits"))]
    I64,
    #[cfg_attr(not(feature = "vtk"), expect(dead_code, reason = "PLY has no integers of 64 bits"))]
    U64,
    F32,
    F64,
}

impl Scalar {
    /// Bytes of a number.
    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The number that means all of a colour, for the types that colours have.
    pub(super) const fn full(self) -> Option<f64> {
        match self {
            Self::U8 => Some(255.0),
            Self::U16 => Some(65535.0),
            _ => None,
        }
    }

    /// Decodes the number at the start of `bytes`, or 0 if there are too few: readers check that before.
    pub(super) fn decode(self, bytes: &[u8], order: Order) -> f64 {
        match self {
            Self::I8 => i8::decode(bytes, order).into(),
            Self::U8 => u8::decode(bytes, order).into(),
            Self::I16 => i16::decode(bytes, order).into(),
            Self::U16 => u16::decode(bytes, order).into(),
            Self::I32 => i32::decode(bytes, order).into(),
            Self::U32 => u32::decode(bytes, order).into(),
            Self::I64 => i64::decode(bytes, order) as f64,
            Self::U64 => u64::decode(bytes, order) as f64,
            Self::F32 => f32::decode(bytes, order).into(),
            Self::F64 => f64::decode(bytes, order),
        }
    }

    /// Reads a number from text: the one that a binary file has.
    pub(super) fn parse(self, text: &str) -> Option<f64> {
        match self {
            Self::F32 => text.parse::<f32>().ok().map(f64::from),
            _ => text.parse().ok(),
        }
    }
}
