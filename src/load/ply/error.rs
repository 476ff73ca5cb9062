//! Errors of reading PLY files.

/// An error of reading a PLY file. Lines are counted from 1, and bytes from 0.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PlyError {
    /// The first line is not `ply`.
    #[error("this is not a PLY file: its first line is not `ply`")]
    NoPly,
    /// A line of the header cannot be read.
    #[error("line {line}: {message}")]
    Header {
        /// Number of the line.
        line: usize,
        /// What is wrong with it.
        message: String,
    },
    /// The header does not end.
    #[error("the header has no line `end_header`; the file is cut off or is not a PLY file")]
    NoEnd,
    /// The header declares no vertices.
    #[error(
        "the header declares no `element vertex`, which has the positions; its elements are {found}"
    )]
    NoVertices {
        /// Names of the elements.
        found: String,
    },
    /// A text file has fewer lines than its header says.
    #[error(
        "the header declares `element {element} {wanted}`, but the file ends after {found} of them; it is cut off"
    )]
    TooFewLines {
        /// Name of the element.
        element: String,
        /// Number by the header.
        wanted: u64,
        /// Number in the file.
        found: u64,
    },
    /// A binary file has fewer bytes than its header says.
    #[error(
        "byte {byte}: the header declares `element {element} {wanted}`, which begin here, but the file ends within number \
         {index}, counted from 0; it is cut off"
    )]
    TooFewBytes {
        /// Where the elements start.
        byte: usize,
        /// Name of the element.
        element: String,
        /// Number by the header.
        wanted: u64,
        /// The first that is not there as a whole.
        index: u64,
    },
    /// There are more data than the header says.
    #[error(
        "{place}: there are more data after those of `element {element} {wanted}`, the last that the header declares"
    )]
    TooMany {
        /// Line or byte where they start.
        place: String,
        /// Name of the last element.
        element: String,
        /// Number by the header.
        wanted: u64,
    },
    /// A value of a text file is missing, or is not a number.
    #[error("line {line}: the property {property} {}", found.as_ref().map_or_else(
        || "is missing; a vertex has one value for each property".to_owned(),
        |found| format!("is `{found}`, which is not a number")
    ))]
    Value {
        /// Number of the line.
        line: usize,
        /// Name of the property.
        property: String,
        /// The text that was found.
        found: Option<String>,
    },
    /// A line of a text file has more values than there are properties.
    #[error(
        "line {line}: there are more values than the {properties} that the header declares; the first is `{found}`"
    )]
    TooManyValues {
        /// Number of the line.
        line: usize,
        /// Number of properties.
        properties: usize,
        /// The first value that is too many.
        found: String,
    },
    /// There is not enough memory for the vertices.
    #[error("there is not enough memory for {count} vertices")]
    Memory {
        /// Number of vertices.
        count: u64,
    },
}
