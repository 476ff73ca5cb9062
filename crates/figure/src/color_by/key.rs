//! The meaning of colours, for legends.

use super::scale::{Scale, entry};

/// The meaning of a column's colours.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ColorKey {
    /// The name of the column.
    pub title: String,
    /// The scale or the categories.
    pub kind: KeyKind,
    /// The colour of spheres without a value in 8-bit sRGB; `None` if every sphere has a value.
    pub missing: Option<[u8; 3]>,
}

/// A scale or categories.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum KeyKind {
    /// Numbers on a colour map.
    Scale(ColorScale),
    /// Categories, each with its colour.
    Categories(Vec<Category>),
}

/// A category and its colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Category {
    /// The text or the whole number that all spheres of the category have.
    pub name: String,
    /// The colour in 8-bit sRGB.
    pub color: [u8; 3],
    /// The number of spheres of the category.
    pub count: usize,
}

/// A scale with a table of colours.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorScale {
    scale: Scale,
    colors: Vec<[u8; 3]>,
}

impl ColorScale {
    /// A scale with colours in 8-bit sRGB, the first at its low end. An empty table is all black.
    #[must_use]
    pub fn new(scale: Scale, colors: Vec<[u8; 3]>) -> Self {
        Self { scale, colors: if colors.is_empty() { vec![[0; 3]] } else { colors } }
    }

    /// The scale.
    #[must_use]
    pub fn scale(&self) -> &Scale {
        &self.scale
    }

    /// The table of colours.
    #[must_use]
    pub fn colors(&self) -> &[[u8; 3]] {
        &self.colors
    }

    /// The index of the colour of a number; `None` if the number has no place on the scale.
    #[must_use]
    pub fn index(&self, value: f64) -> Option<usize> {
        self.scale.position(value).map(|position| entry(position, self.colors.len()))
    }

    /// The colour of a number in 8-bit sRGB; `None` if the number has no place on the scale.
    #[must_use]
    pub fn color(&self, value: f64) -> Option<[u8; 3]> {
        self.colors.get(self.index(value)?).copied()
    }

    /// The colour at a position from 0 to 1, in 8-bit sRGB.
    pub(crate) fn color_at(&self, position: f64) -> [u8; 3] {
        self.colors.get(entry(position, self.colors.len())).copied().unwrap_or_default()
    }
}
