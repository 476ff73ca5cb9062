//! Types of values that occur in several tables: colours and vectors.

use std::fmt;

use serde::Deserialize;
use serde::de::{self, SeqAccess, Visitor};

use crate::exact;
use crate::image::color::LinearRgb;
use crate::render::{BRIGHTEST, SettingsError};

/// A colour, written as a CSS colour or as a linear triple.
#[derive(Clone, Copy)]
pub(super) struct ColorValue(pub(super) LinearRgb);

/// Colour of spheres without a colour, in 8-bit sRGB: a light grey.
pub const DEFAULT_COLOR: [u8; 3] = [0xcc; 3];

impl Default for ColorValue {
    fn default() -> Self {
        Self(LinearRgb::from_srgb8(DEFAULT_COLOR))
    }
}

impl<'de> Deserialize<'de> for ColorValue {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ColorVisitor;

        impl<'de> Visitor<'de> for ColorVisitor {
            type Value = ColorValue;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a CSS color in quotes or a linear triple [r, g, b]")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<ColorValue, E> {
                LinearRgb::from_css(text).map(ColorValue).map_err(E::custom)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<ColorValue, A::Error> {
                let rgb = exact::elements(seq, &self)?;
                LinearRgb::new(rgb).map(ColorValue).map_err(de::Error::custom)
            }
        }

        deserializer.deserialize_any(ColorVisitor)
    }
}

/// A vector of three numbers.
#[derive(Clone, Copy)]
pub(super) struct Vector(pub(super) [f64; 3]);

impl<'de> Deserialize<'de> for Vector {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        exact::array(deserializer).map(Self)
    }
}

/// Multiplies a colour by a number that was checked. The result is light that `what` emits, and may be too bright.
pub(super) fn scaled(color: LinearRgb, by: f64, what: &str) -> Result<LinearRgb, SettingsError> {
    let rgb = color.to_array().map(|c| (f64::from(c) * by) as f32);
    let too_bright = || SettingsError::TooBright { what: what.to_owned(), rgb };
    let is_bearable = rgb.iter().all(|c| *c <= BRIGHTEST);
    LinearRgb::new(rgb).ok().filter(|_| is_bearable).ok_or_else(too_bright)
}
