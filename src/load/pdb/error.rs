//! Errors of reading PDB files.

/// An error of reading a PDB file. Lines and columns are counted from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PdbError {
    /// A line ends before all that its record must have.
    #[error(
        "line {line}: the {what} (columns {first}-{last}) is missing, because the line ends after {columns} \
         columns; {article} {record} record has at least 54 columns",
        article = if *record == "ATOM" { "an" } else { "a" }
    )]
    Short {
        /// Number of the line.
        line: usize,
        /// Number of columns of the line.
        columns: usize,
        /// Name of the record.
        record: &'static str,
        /// The first value that is missing, at least in part.
        what: &'static str,
        /// The first column of this value.
        first: usize,
        /// The last column of this value.
        last: usize,
    },
    /// A value is not a finite number.
    #[error(
        "line {line}, columns {first}-{last}: the {what} is {}; a number such as 11.104 belongs there",
        not_valid(found, "a finite number")
    )]
    Number {
        /// Number of the line.
        line: usize,
        /// The first column of the value.
        first: usize,
        /// The last column of the value.
        last: usize,
        /// Name of the value.
        what: &'static str,
        /// The text without the blanks around it.
        found: String,
    },
    /// A residue number is neither decimal nor hybrid-36.
    #[error(
        "line {line}, columns 23-26: the residue number is {}; a number such as 142, or a hybrid-36 \
         number such as A000, belongs there",
        not_valid(found, "a valid residue number")
    )]
    ResidueNumber {
        /// Number of the line.
        line: usize,
        /// The text without the blanks around it.
        found: String,
    },
    /// A record has a byte that is not ASCII, so that its columns cannot be counted.
    #[error(
        "line {line}, column {column}: the byte 0x{byte:02x} is not ASCII; ATOM, HETATM and CRYST1 records \
         must be ASCII text"
    )]
    NotAscii {
        /// Number of the line.
        line: usize,
        /// Column of the byte.
        column: usize,
        /// The byte.
        byte: u8,
    },
    /// The models are mixed: some atoms belong to one and some do not.
    #[error(
        "line {line}: mixed models: this atom does not belong to a model, although the file has MODEL \
         records (the first on line {model_line}); every atom must then stand between MODEL and ENDMDL"
    )]
    AtomOutsideModel {
        /// Line of the atom.
        line: usize,
        /// Line of the first MODEL record.
        model_line: usize,
    },
    /// The models are mixed: one begins inside another.
    #[error(
        "line {line}: mixed models: this MODEL record is inside the model that begins on line {outer_line}; \
         ENDMDL must end a model before another begins"
    )]
    ModelInsideModel {
        /// Line where the inner model begins.
        line: usize,
        /// Line where the outer model begins.
        outer_line: usize,
    },
    /// The file has fewer models.
    #[error(
        "there is no frame {wanted}; the file has {frames} {}, counted from 0",
        if *frames == 1 { "model" } else { "models" }
    )]
    NoSuchFrame {
        /// The frame that was asked for.
        wanted: usize,
        /// Number of models in the file, at least 1.
        frames: usize,
    },
    /// The model has no atoms, although others have.
    #[error(
        "line {line}: frame {frame} is the model that begins here, which has no ATOM or HETATM records; \
         choose another frame"
    )]
    EmptyFrame {
        /// The frame that was asked for.
        frame: usize,
        /// Line where the model begins.
        line: usize,
    },
    /// The file has no atoms.
    #[error("there are no ATOM or HETATM records; a PDB file has one for each atom")]
    NoAtoms,
    /// The file is an mmCIF file, the successor of PDB.
    #[error("this is an mmCIF file, not a PDB file; call it .cif, or read it as the format mmcif")]
    MmCif,
    /// No periodic cell has these lengths and angles.
    #[error(
        "line {line}: no periodic cell has edges of the lengths {lengths:?} and the angles {angles:?}; lengths \
         must be greater than 0, and the angles in degrees must belong to three edges that are not in one plane"
    )]
    Cell {
        /// Number of the line.
        line: usize,
        /// The lengths of the edges a, b and c, in Å.
        lengths: [f64; 3],
        /// The angles α, β and γ, in degrees.
        angles: [f64; 3],
    },
}

/// The end of a sentence about the text of a field.
fn not_valid(found: &str, kind: &str) -> String {
    match found {
        "" => "blank".to_owned(),
        _ => format!("`{found}`, which is not {kind}"),
    }
}
