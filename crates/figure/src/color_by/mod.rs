//! Colours, radii, opacities and strengths of light from the columns of data.
//!
//! [`ColorBy`] turns a column, [`column::column`], into a colour for each sphere, and into a [`ColorKey`], from which
//! a legend is made. Nothing here accesses the file system.
//!
//! ```
//! use pinhole_figure::color_by::ColorBy;
//! use pinhole::SphereArray;
//!
//! let spheres = SphereArray::F32(vec![[0.0, 0.0, 0.0, 1.0], [5.0, 0.0, 0.0, 1.0]]);
//! let colored = ColorBy::column("x").apply(&spheres, &[])?;
//! // Viridis begins with a dark violet, and ends with yellow.
//! assert_eq!(colored.color(0).unwrap().to_srgb8(), [0x44, 0x01, 0x54]);
//! assert_eq!(colored.color(1).unwrap().to_srgb8(), [0xfd, 0xe7, 0x25]);
//! # Ok::<(), pinhole_figure::color_by::ColorByError>(())
//! ```

mod coloring;
mod joined;
mod key;
mod mapping;
mod maps;
pub mod number;
mod scale;

pub use joined::JoinedKeys;
pub use key::{Category, ColorKey, ColorScale, KeyKind};
pub use mapping::{EmissionBy, Mapping, RadiusBy};
pub use maps::{MapError, MapName};
pub use pinhole_data::column::ColumnError;
pub use scale::{Limit, Limits, Scale, ScaleError};

use serde::{Deserialize, Serialize};

use pinhole::image::color::LinearRgb;
use pinhole::scene::sphere_array::SphereArray;
use pinhole_data::column;
use pinhole_data::load::{Column, ColumnValues};

/// The reason why a column does not give colours, radii, opacities or strengths of light.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColorByError {
    /// There is no such column, or its values are text where numbers are needed.
    #[error(transparent)]
    Column(#[from] ColumnError),
    /// The range is wrong.
    #[error("the range of the colors: {0}")]
    Scale(ScaleError),
    /// The values, the range or the factor do not suit the request.
    #[error("{0}")]
    Values(String),
}

impl From<ScaleError> for ColorByError {
    /// Its message is a part of this one, so it is no source.
    fn from(error: ScaleError) -> Self {
        Self::Scale(error)
    }
}

/// The choices that turn a column into colours.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ColorBy {
    /// The column: its name, or `index`, `radius`, `x`, `y`, `z` or `|v|`; see `pinhole_data::column`.
    pub column: String,
    /// The colour map or palette. The default is viridis for numbers, and the palette of Okabe and Ito for text and
    /// few different whole numbers.
    pub map: Option<MapName>,
    /// Whether to reverse the map.
    #[serde(default, rename = "reverse")]
    pub is_reversed: bool,
    /// The numbers for the first and the last colour of the map.
    #[serde(default, rename = "range")]
    pub limits: Limits,
    /// Whether colours follow the logarithm of the numbers.
    #[serde(default, rename = "log")]
    pub is_log: bool,
    /// The colour of spheres without a value, in 8-bit sRGB.
    #[serde(default = "missing", with = "srgb8")]
    pub missing: [u8; 3],
    /// The categories in the order of their colours, whether or not they occur; other values count as missing. `None`
    /// stands for the categories that occur.
    #[serde(skip)]
    pub categories: Option<Vec<String>>,
}

const fn missing() -> [u8; 3] {
    MISSING
}

/// A colour of 8-bit sRGB, as a file gives it.
mod srgb8 {
    use pinhole::image::color::LinearRgb;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<[u8; 3], D::Error> {
        LinearRgb::deserialize(from).map(LinearRgb::to_srgb8)
    }

    pub(super) fn serialize<S: Serializer>(color: &[u8; 3], to: S) -> Result<S::Ok, S::Error> {
        LinearRgb::from_srgb8(*color).serialize(to)
    }
}

/// The default colour of spheres without a value: a middle grey, in 8-bit sRGB.
pub const MISSING: [u8; 3] = [0x80; 3];

impl ColorBy {
    /// Chooses this column, with the map and the range that suit its values.
    #[must_use]
    pub fn column(column: impl Into<String>) -> Self {
        Self {
            column: column.into(),
            map: None,
            is_reversed: false,
            limits: Limits::default(),
            is_log: false,
            missing: MISSING,
            categories: None,
        }
    }

    /// Computes the colours of the spheres.
    ///
    /// # Errors
    /// Returns an error if there is no such column, if it has no value that can be shown, if the range is wrong, or if
    /// an option does not apply to text.
    pub fn apply(&self, spheres: &SphereArray, columns: &[Column]) -> Result<Coloring, ColorByError> {
        let found = column::column(&self.column, spheres, columns)?;
        match found.values.as_ref() {
            ColumnValues::Labels(labels) => self.color_labels(&found.name, labels),
            ColumnValues::Numbers(values) if self.are_categories(&found, values) => {
                self.color_whole_numbers(&found.name, values)
            }
            ColumnValues::Numbers(values) => self.color_numbers(&found.name, values),
        }
    }
}

/// The colours of spheres, and their meaning.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Coloring {
    /// All colours that may occur. They are colours of 8-bit sRGB.
    pub palette: Vec<LinearRgb>,
    /// For each sphere, the index of its colour.
    pub indices: Vec<u32>,
    /// The meaning of the colours.
    pub key: ColorKey,
    /// Notes for the user, one line each: the range, missing values, repeated colours.
    pub notes: Vec<String>,
}

impl Coloring {
    /// The colour of a sphere, by its index in input order; `None` if there is no such sphere.
    #[must_use]
    pub fn color(&self, index: usize) -> Option<LinearRgb> {
        self.palette.get(*self.indices.get(index)? as usize).copied()
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
