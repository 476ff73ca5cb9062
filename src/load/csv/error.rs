//! Errors of reading tables of text.

/// An error of reading a table of text. Lines are counted from 1.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CsvError {
    /// The file has no rows.
    #[error("there are no rows; a table has one on each line")]
    Empty,
    /// The columns have no names.
    #[error(
        "line {line}: the table has no header; name its {columns} columns in their order, such as with --columns {example}"
    )]
    NoNames {
        /// Number of the first row's line.
        line: usize,
        /// Number of columns.
        columns: usize,
        /// Names that may fit.
        example: String,
    },
    /// Names are given for a table that has a header.
    #[error("line {line}: the table has a header here; remove the names of columns that are given")]
    TwoNames {
        /// Number of the line with the header.
        line: usize,
    },
    /// There are more or fewer names than columns.
    #[error("line {line}: there are {names} names of columns, but this row has {columns} values")]
    Names {
        /// Number of the first row's line.
        line: usize,
        /// Number of names.
        names: usize,
        /// Number of values.
        columns: usize,
    },
}
