//! The error of a column that cannot give colours, radii, opacities or strengths of light.

use super::scale::ScaleError;
use pinhole_data::column::ColumnError;

/// The reason why a column does not give colours, radii, opacities or strengths of light.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColorByError {
    /// There is no such column, or its values are text where numbers are needed.
    #[error(transparent)]
    Column(#[from] ColumnError),
    /// The range is wrong.
    #[error("the range of the colors: {0}")]
    Scale(#[from] ScaleError),
    /// The values, the range or the factor do not suit the request.
    #[error("{0}")]
    Values(String),
}
