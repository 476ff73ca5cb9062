//! Errors of reading mmCIF and CIF files.

/// An error of reading an mmCIF or CIF file. Lines and columns are counted from 1; a column is a byte of its line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MmCifError {
    /// The file has no atoms.
    #[error(
        "there are no atoms: no loop_ has _atom_site.Cartn_x, _atom_site.Cartn_y and _atom_site.Cartn_z, or \
         _atom_site_fract_x, _y and _z, with rows below"
    )]
    NoAtoms,
    /// A quoted text has no end.
    #[error(
        "line {line}, column {column}: the quoted text that begins here does not end on its line"
    )]
    Quote {
        /// Number of the line.
        line: usize,
        /// Where the text begins.
        column: usize,
    },
    /// A text of several lines has no end.
    #[error(
        "line {line}: the text that begins here with ; does not end; a line that begins with ; must end it"
    )]
    Lines {
        /// Number of the line.
        line: usize,
    },
    /// The last row of the loop has too few values.
    #[error(
        "line {line}: the row of _atom_site that begins here has {values} values, but the loop names {columns} columns; \
         a value is missing in this row or in one before it, or the file is cut off"
    )]
    CutRow {
        /// Number of the line.
        line: usize,
        /// Number of values of the row.
        values: usize,
        /// Number of columns of the loop.
        columns: usize,
    },
    /// A value is not a finite number.
    #[error("line {line}, column {column}: {what} is `{found}`, which is not a finite number")]
    Number {
        /// Number of the line.
        line: usize,
        /// Where the value begins.
        column: usize,
        /// Name of the value.
        what: &'static str,
        /// The text that was found.
        found: String,
    },
    /// The atoms of a model are in several places.
    #[error(
        "line {line}: the model {model} begins again; all atoms of a model must follow each other"
    )]
    ModelAgain {
        /// Number of the line.
        line: usize,
        /// Name of the model.
        model: String,
    },
    /// Positions are fractions of a cell that the file does not have.
    #[error(
        "line {line}: the positions are fractions of the cell, but there are no _cell_length_a, _b, _c and \
         _cell_angle_alpha, _beta, _gamma"
    )]
    NoCell {
        /// Number of the line with the first atom.
        line: usize,
    },
    /// There is no cell with these edges and angles.
    #[error(
        "no periodic cell has edges of the lengths {lengths:?} and the angles {angles:?}; lengths must be greater than 0, \
         and the angles in degrees must belong to three edges that are not in one plane"
    )]
    Cell {
        /// Lengths of the edges.
        lengths: [f64; 3],
        /// Angles in degrees.
        angles: [f64; 3],
    },
}
