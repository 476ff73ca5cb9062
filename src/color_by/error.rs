//! Why a column does not give colours, radii, opacities or strengths.

use super::column::ColumnError;
use super::number::short;
use super::scale::ScaleError;
use crate::added::AddError;
use crate::scene::SceneError;

/// Why a column does not give colours, radii, opacities or strengths of light.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColorByError {
    /// There is no such column, or its values are text where numbers are needed.
    #[error(transparent)]
    Column(#[from] ColumnError),
    /// The range is wrong.
    #[error("the range of the colors: {0}")]
    Scale(#[from] ScaleError),
    /// The column has no value that can be shown.
    #[error("the column `{column}` has no {what}, so it gives no colors")]
    NoValue {
        /// The name of the column.
        column: String,
        /// What it would need.
        what: &'static str,
    },
    /// A range or a logarithmic scale was asked for, but the values are text or categories.
    #[error("{what} applies only to numbers on a color map, but {why}; remove it")]
    NotForCategories {
        /// What was asked for.
        what: &'static str,
        /// Why it does not apply.
        why: String,
    },
    /// A palette was asked for, but the numbers are too many or not whole.
    #[error(
        "`{palette}` is a palette for few different whole numbers or text, but {why}; choose a color map, such as viridis"
    )]
    NotForPalette {
        /// The name of the palette.
        palette: &'static str,
        /// Why it does not apply.
        why: String,
    },
    /// A radius is not a positive number.
    #[error(
        "sphere {index} would have the radius {}; a radius from `{column}` must be finite and greater than 0",
        short(*.value)
    )]
    Radius {
        /// The index of the sphere.
        index: usize,
        /// The name of the column.
        column: String,
        /// The value times the factor.
        value: f64,
    },
    /// A sphere is out of range.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Bonds or the edges of the cell cannot be added.
    #[error(transparent)]
    Add(#[from] AddError),
    /// A factor is not a positive number.
    #[error("the factor of `{column}` is {}; it must be finite and greater than 0", short(*.value))]
    Factor {
        /// The name of the column.
        column: String,
        /// The factor as given.
        value: f64,
    },
}
