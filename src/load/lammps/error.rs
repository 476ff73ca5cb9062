//! Errors of reading LAMMPS files.

use super::cell::Shape;

/// An error of reading a file of LAMMPS. Lines are counted from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LammpsError {
    /// The file has no frame.
    #[error("the file is empty; a dump of LAMMPS starts with ITEM: TIMESTEP")]
    Empty,
    /// Something else stands where an item of a dump must begin.
    #[error(
        "line {line}: `{found}` stands where ITEM: must begin an item{}",
        previous.map_or_else(String::new, |(line, atoms)| format!("; the frame before it declares {atoms} atoms on line {line}"))
    )]
    NoItem {
        /// Number of the line.
        line: usize,
        /// The text of the line.
        found: String,
        /// Of the frame before, the line with the number of atoms, and this number.
        previous: Option<(usize, usize)>,
    },
    /// The file is a dump of something else, such as of bonds or a grid.
    #[error("line {line}: `{found}` is not an item of a dump of atoms")]
    UnknownItem {
        /// Number of the line.
        line: usize,
        /// The text of the line.
        found: String,
    },
    /// A frame has no number of atoms before its atoms, or no box.
    #[error("line {line}: {item} is missing before ITEM: ATOMS")]
    MissingItem {
        /// Number of the line with ITEM: ATOMS.
        line: usize,
        /// The item.
        item: &'static str,
    },
    /// A number of atoms or of types is not valid.
    #[error("line {line}: `{found}` is not a valid number of {what}")]
    Count {
        /// Number of the line.
        line: usize,
        /// What is counted.
        what: &'static str,
        /// The text that was found.
        found: String,
    },
    /// The file ends before all atoms.
    #[error("line {line}: {declared} atoms are declared, but the file ends after {found}")]
    TooFewAtoms {
        /// Number of the line with the number of atoms.
        line: usize,
        /// The number of atoms that is declared.
        declared: usize,
        /// Number of lines of atoms.
        found: usize,
    },
    /// The file ends within an item.
    #[error("line {line}: the file ends within the frame that begins here, before its atoms")]
    CutOff {
        /// Number of the first line of the frame.
        line: usize,
    },
    /// A line of the box cannot be read.
    #[error("line {line}: `{found}` is not a line of the box; {}", shape.values())]
    Box {
        /// Number of the line.
        line: usize,
        /// The text of the line.
        found: String,
        /// How the box is written.
        shape: Shape,
    },
    /// The items of a dump have no names for their columns.
    #[error(
        "line {line}: the columns have no names; name them in the order of the file, such as with --columns id,type,xs,ys,zs"
    )]
    NoNames {
        /// Number of the line with ITEM: ATOMS.
        line: usize,
    },
    /// Names of columns are given for a file that has them.
    #[error("line {line}: the file names its columns; remove the names that are given")]
    TwoNames {
        /// Number of the line with the names.
        line: usize,
    },
    /// No columns are positions.
    #[error(
        "line {line}: there are no positions among the columns {columns}; they are x y z, xu yu zu, xs ys zs or \
         xsu ysu zsu"
    )]
    NoPositions {
        /// Number of the line with the names.
        line: usize,
        /// Names of the columns.
        columns: String,
    },
    /// A line of a data file is not valid.
    #[error("line {line}: `{found}` cannot be read")]
    Line {
        /// Number of the line.
        line: usize,
        /// The text of the line.
        found: String,
    },
    /// A data file declares no number of atoms before the atoms.
    #[error("line {line}: a line such as `100 atoms` must come before the atoms")]
    NoCount {
        /// Number of the line.
        line: usize,
    },
    /// A data file has no atoms.
    #[error("there is no section Atoms; a data file of LAMMPS has one")]
    NoAtoms,
    /// Something else stands where a section of a data file must begin.
    #[error(
        "line {line}: `{found}` stands where a section must begin; {declared} atoms are declared on line {line_of_count}"
    )]
    NoSection {
        /// Number of the line.
        line: usize,
        /// The text of the line.
        found: String,
        /// The number of atoms that is declared.
        declared: usize,
        /// Number of the line that declares it.
        line_of_count: usize,
    },
    /// A data file has two sections with the same name.
    #[error(
        "line {line}: a second section {section} begins here; the first begins on line {first_line}; \
         remove one of them"
    )]
    SecondSection {
        /// Number of the line where the second begins.
        line: usize,
        /// Name of the section.
        section: &'static str,
        /// Number of the line where the first begins.
        first_line: usize,
    },
    /// A mass is not a finite number.
    #[error("line {line}: the mass is `{found}`, which is not a finite number")]
    Mass {
        /// Number of the line.
        line: usize,
        /// The text that was found.
        found: String,
    },
    /// The file does not say what its columns are.
    #[error(
        "line {line}: atoms have {found} columns, and the file does not say which; name their style, as in \
         `Atoms # full`, or the columns, as with --columns {charge}"
    )]
    NoStyle {
        /// Number of the line of the first atom.
        line: usize,
        /// Number of columns.
        found: usize,
        /// Columns of a style, as an example.
        charge: String,
    },
    /// The style of atoms has no columns that this reader knows.
    #[error(
        "line {line}: the columns of the style {style} are not known; name them, such as with --columns id,type,x,y,z"
    )]
    UnknownStyle {
        /// Number of the line of the first atom.
        line: usize,
        /// Name of the style.
        style: String,
    },
    /// The first atom has another number of columns than have names.
    #[error(
        "line {line}: this line has {found} columns, but {declared} have names ({names}); three whole numbers may follow"
    )]
    Columns {
        /// Number of the line of the first atom.
        line: usize,
        /// Number of columns.
        found: usize,
        /// Number of names.
        declared: usize,
        /// The names.
        names: String,
    },
}
