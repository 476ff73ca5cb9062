//! What is wrong with a line of values.

use crate::scene::sphere::SphereError;

/// An error in a line of values. Lines and columns are counted from 1; a column is a value of its line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LineError {
    /// A line has too few values.
    #[error(
        "line {line}: {what}, which is column {column}, is missing; the line has {columns} {}",
        if *columns == 1 { "column" } else { "columns" }
    )]
    Missing {
        /// Number of the line.
        line: usize,
        /// Index of the first column that is missing.
        column: usize,
        /// Name of this column.
        what: String,
        /// Number of columns of the line.
        columns: usize,
    },
    /// A line has too many values.
    #[error("line {line}: this line has {columns} columns, but only {declared} have names")]
    TooMany {
        /// Number of the line.
        line: usize,
        /// Number of columns of the line.
        columns: usize,
        /// Number of columns that the file declares.
        declared: usize,
    },
    /// A value is not a number.
    #[error("line {line}, column {column}: {what} is `{found}`, which is not a number")]
    Number {
        /// Number of the line.
        line: usize,
        /// Index of the column.
        column: usize,
        /// Name of the column.
        what: String,
        /// The text that was found.
        found: String,
    },
    /// A position is not finite.
    #[error("line {line}: {what} is {found}; a position must be finite")]
    Position {
        /// Number of the line.
        line: usize,
        /// Name of the column.
        what: String,
        /// The value.
        found: f64,
    },
    /// A radius is not finite or not greater than 0.
    #[error("line {line}: {what} is {found}; a radius must be finite and greater than 0")]
    Radius {
        /// Number of the line.
        line: usize,
        /// Name of the column.
        what: String,
        /// The value.
        found: f64,
    },
    /// A sphere is out of range.
    #[error("line {line}: {error}")]
    Sphere {
        /// Number of the line.
        line: usize,
        /// What is wrong with the sphere.
        error: SphereError,
    },
    /// A line is not UTF-8 text.
    #[error("line {line}: this line is not UTF-8 text, as it must be")]
    NotText {
        /// Number of the line.
        line: usize,
    },
}
