//! What can be wrong with a PDB file.

/// Why a file is not a PDB file, or has no such frame. Lines and columns count from 1.
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
        /// Where.
        line: usize,
        /// How many columns the line has.
        columns: usize,
        /// The name of the record.
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
        /// Where.
        line: usize,
        /// The first column of the value.
        first: usize,
        /// The last column of the value.
        last: usize,
        /// Which value.
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
        /// Where.
        line: usize,
        /// The text without the blanks around it.
        found: String,
    },
    /// A record that is read has a byte that is not ASCII, so that its columns cannot be told.
    #[error(
        "line {line}, column {column}: the byte 0x{byte:02x} is not ASCII; ATOM, HETATM and CRYST1 records \
         must be ASCII text"
    )]
    NotAscii {
        /// Where.
        line: usize,
        /// Where in the line.
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
        /// Where the atom is.
        line: usize,
        /// Where the first MODEL record is.
        model_line: usize,
    },
    /// The models are mixed: one begins inside another.
    #[error(
        "line {line}: mixed models: this MODEL record is inside the model that begins on line {outer_line}; \
         ENDMDL must end a model before another begins"
    )]
    ModelInsideModel {
        /// Where the inner model begins.
        line: usize,
        /// Where the outer model begins.
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
        /// How many there are.
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
        /// Where it begins.
        line: usize,
    },
    /// The file has no atoms.
    #[error("there are no ATOM or HETATM records; a PDB file has one for each atom")]
    NoAtoms,
    /// The file is of the format that followed PDB.
    #[error("this is an mmCIF file, not a PDB file; download the entry in PDB format")]
    MmCif,
    /// No periodic cell has these lengths and angles.
    #[error(
        "line {line}: there is no cell with the edges {lengths:?} and the angles {angles:?}; edges must be \
         longer than 0, and angles in degrees must be those between three edges that are not in one plane"
    )]
    Cell {
        /// Where.
        line: usize,
        /// The lengths of the edges a, b and c, in Å.
        lengths: [f64; 3],
        /// The angles α, β and γ, in degrees.
        angles: [f64; 3],
    },
}

fn not_valid(found: &str, kind: &str) -> String {
    match found {
        "" => "blank".to_owned(),
        _ => format!("`{found}`, which is not {kind}"),
    }
}
