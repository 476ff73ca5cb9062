//! Colours in linear light, and their conversion from and to sRGB.

use std::fmt;
use std::sync::LazyLock;

use serde::de::{Error, SeqAccess, Unexpected, Visitor};

use crate::exact;

/// A colour in linear light with the Rec. 709 primaries. The value 1 is display white.
///
/// Components are finite and not negative, and may exceed 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearRgb([f32; 3]);

impl serde::Serialize for LinearRgb {
    /// Writes `#rrggbb` if that is exact, and a linear triple otherwise.
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let [r, g, b] = self.to_srgb8();
        let bits = |color: Self| color.0.map(f32::to_bits);
        if bits(Self::from_srgb8([r, g, b])) == bits(*self) {
            return serializer.collect_str(&format_args!("#{r:02x}{g:02x}{b:02x}"));
        }
        self.0.serialize(serializer)
    }
}

impl<'de> serde::Deserialize<'de> for LinearRgb {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Triple;

        impl<'de> Visitor<'de> for Triple {
            type Value = LinearRgb;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a CSS color in quotes or a linear triple [r, g, b]")
            }

            /// Of CSS colours, only `#rrggbb` is read here.
            fn visit_str<E: Error>(self, text: &str) -> Result<LinearRgb, E> {
                let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6);
                let number = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
                let number = number.ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))?;
                let [_, rgb @ ..] = number.to_be_bytes();
                Ok(LinearRgb::from_srgb8(rgb))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<LinearRgb, A::Error> {
                LinearRgb::new(exact::elements(seq, &self)?).map_err(A::Error::custom)
            }
        }

        deserializer.deserialize_any(Triple)
    }
}

impl LinearRgb {
    /// Black.
    pub const BLACK: Self = Self([0.0; 3]);
    /// White.
    pub const WHITE: Self = Self([1.0; 3]);

    /// A colour from red, green and blue.
    ///
    /// # Errors
    /// Returns an error if a component is NaN, infinite or negative.
    pub fn new(rgb: [f32; 3]) -> Result<Self, ColorError> {
        if rgb.iter().all(|c| c.is_finite() && *c >= 0.0) {
            Ok(Self(rgb))
        } else {
            Err(ColorError(format!("the color {rgb:?} has a component that is negative or not finite")))
        }
    }

    /// A grey of the given value. NaN, infinities and negative values give black.
    #[must_use]
    pub const fn gray(value: f32) -> Self {
        // The comparison is false for NaN as well.
        if value >= 0.0 && value < f32::INFINITY { Self([value; 3]) } else { Self::BLACK }
    }

    /// Decodes 8-bit sRGB.
    #[must_use]
    pub fn from_srgb8(bytes: [u8; 3]) -> Self {
        Self(bytes.map(|byte| DECODED[usize::from(byte)]))
    }

    /// The components red, green and blue.
    #[must_use]
    pub const fn to_array(self) -> [f32; 3] {
        self.0
    }

    /// Encodes as 8-bit sRGB; see [`to_srgb8`].
    #[must_use]
    pub fn to_srgb8(self) -> [u8; 3] {
        to_srgb8(self.0)
    }
}

/// The reason why a value or a text is not a valid colour.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct ColorError(String);

/// The weights of red, green and blue in the luminance of linear light (ITU-R BT.709).
pub(crate) const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The relative luminance of linear light (ITU-R BT.709).
pub(crate) fn luminance([r, g, b]: [f64; 3]) -> f64 {
    LUMINANCE[0] * r + LUMINANCE[1] * g + LUMINANCE[2] * b
}

/// Encodes linear light as 8-bit sRGB, rounded to the nearest byte. Values outside [0, 1] are clamped. NaN becomes 0.
///
/// This is the exact inverse of [`LinearRgb::from_srgb8`] for every byte.
#[must_use]
pub fn to_srgb8(linear: [f32; 3]) -> [u8; 3] {
    linear.map(encode_srgb8)
}

/// Encodes linear light as 16-bit sRGB, rounded to the nearest of 65536 steps and clamped like [`to_srgb8`].
#[must_use]
pub fn to_srgb16(linear: [f32; 3]) -> [u16; 3] {
    linear.map(|linear| {
        // The conversion to u16 turns NaN into 0.
        (encode_srgb(f64::from(linear).clamp(0.0, 1.0)) * 65535.0).round() as u16
    })
}

/// The transfer function of IEC 61966-2-1 from linear light to sRGB, the inverse of [`decode_srgb`].
fn encode_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The transfer function of IEC 61966-2-1 from sRGB to linear light.
fn decode_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The linear values of all bytes of 8-bit sRGB.
static DECODED: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|byte| decode_srgb(byte as f64 / 255.0) as f32));

/// The linear values half-way, in sRGB, between neighbouring bytes. A search in this table also rounds to the nearest
/// byte, and is faster than the transfer function.
static BETWEEN_BYTES: LazyLock<[f32; 255]> =
    LazyLock::new(|| std::array::from_fn(|byte| decode_srgb((byte as f64 + 0.5) / 255.0) as f32));

fn encode_srgb8(linear: f32) -> u8 {
    // No entry is at most NaN, so NaN becomes 0.
    BETWEEN_BYTES.partition_point(|between| *between <= linear) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_the_round_trip() {
        for byte in 0..=255 {
            assert_eq!(LinearRgb::from_srgb8([byte; 3]).to_srgb8(), [byte; 3]);
        }
    }

    /// Compares the table with the formula of IEC 61966-2-1.
    #[test]
    fn encoding_rounds_to_the_nearest_byte() {
        for i in 0..=100_000 {
            let linear = i as f32 / 100_000.0;
            let encoded = encode_srgb(f64::from(linear));
            let [byte, ..] = to_srgb8([linear; 3]);
            assert!((encoded * 255.0 - f64::from(byte)).abs() <= 0.500_01, "{linear}: {byte}");
        }
    }

    /// A flat 8-bit colour stays the same in 16 bits, which are its byte twice.
    #[test]
    fn sixteen_bits_of_a_byte_are_that_byte_twice() {
        for byte in 0..=255 {
            let linear = LinearRgb::from_srgb8([byte; 3]).to_array();
            assert_eq!(to_srgb16(linear), [u16::from(byte) * 257; 3]);
        }
        assert_eq!(to_srgb16([-1.0, 2.0, f32::NAN]), [0, 65535, 0]);
    }

    #[test]
    fn known_values_of_the_transfer_function() {
        assert_eq!(LinearRgb::from_srgb8([0, 255, 0]), LinearRgb([0.0, 1.0, 0.0]));
        // 188 is the byte nearest to half of the light.
        assert_eq!(to_srgb8([0.5; 3]), [188; 3]);
    }

    #[test]
    fn out_of_range_values_are_clamped() {
        assert_eq!(to_srgb8([-1.0, 2.0, f32::NAN]), [0, 255, 0]);
    }

    #[test]
    fn a_color_is_finite_and_not_negative() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.1] {
            let error = LinearRgb::new([0.5, bad, 0.5]).unwrap_err().to_string();
            assert!(error.ends_with("has a component that is negative or not finite"), "{error}");
        }
        assert_eq!(LinearRgb::new([0.0, 0.5, 7.0]), Ok(LinearRgb([0.0, 0.5, 7.0])));
    }
}
