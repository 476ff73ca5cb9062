//! Errors of reading XYZ files.

/// An error of reading an XYZ file. Lines are counted from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum XyzError {
    /// A frame does not start with a valid number of atoms.
    #[error(
        "line {line}: `{found}` is not a valid number of atoms, which must begin a frame{}",
        after_frame(previous)
    )]
    Count {
        /// Number of the line.
        line: usize,
        /// The text of the line.
        found: String,
        /// The frame before this line, if there is one.
        previous: Option<DeclaredFrame>,
    },
    /// The file has no frame.
    #[error("the file is empty; an XYZ file starts with the number of its atoms")]
    Empty,
    /// The file ends before the frame does.
    #[error(
        "line {}: frame {} declares {}, but the file ends after {found}",
        frame.line, frame.index, atoms(frame.atoms)
    )]
    TooFewAtoms {
        /// The frame that is affected.
        frame: DeclaredFrame,
        /// Number of atoms that the file has in this frame.
        found: usize,
    },
    /// The list of properties of an extended XYZ frame cannot be used.
    #[error("line {line}: {message}")]
    Properties {
        /// Number of the line.
        line: usize,
        /// What is wrong with the list.
        message: String,
    },
    /// The line that must have the number of atoms is not UTF-8 text.
    #[error("line {line}: this line is not UTF-8 text; an XYZ file is plain text")]
    NotText {
        /// Number of the line.
        line: usize,
    },
}

/// A frame as its first line declares it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeclaredFrame {
    /// Index of the frame, from 0.
    pub index: usize,
    /// Number of the line with the number of atoms, from 1.
    pub line: usize,
    /// The number of atoms that the line declares.
    pub atoms: usize,
}

/// The end of a sentence about the line after a frame, which is wrong if the frame's number of atoms is.
fn after_frame(previous: &Option<DeclaredFrame>) -> String {
    previous.map_or_else(String::new, |frame| {
        let DeclaredFrame { index, line, atoms: count } = frame;
        format!("; frame {index} before it declares {} on line {line}", atoms(count))
    })
}

fn atoms(count: usize) -> String {
    if count == 1 { "1 atom".to_owned() } else { format!("{count} atoms") }
}
