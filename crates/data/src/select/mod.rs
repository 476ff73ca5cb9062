//! Selects spheres by an expression over the columns of their data.
//!
//! A [`Selection`] is a text such as `species == O and z > 3 and |v| < 2` or `byres within 5 of resname HEM`. It has the
//! words that VMD, `MDAnalysis` and `PyMOL` share: lists of values (`resid 5 to 10`, `name CA CB`), comparisons of arithmetic
//! over columns, those of [`column()`](crate::column::column()), classes (`protein`, `water`), distances, and bonds. A
//! missing value, which is NaN or an empty text, never matches, whatever stands before it: neither `z > 3` nor
//! `not z > 3` selects a sphere whose `z` is NaN. Nothing here accesses the file system.
//!
//! A selection is parsed once, into a tree whose depth is limited. Words get their meaning when it is evaluated, because a
//! column of the data comes before a word of the language.
//!
//! ```
//! use pinhole::SphereArray;
//! use pinhole_data::load::Dataset;
//! use pinhole_data::select::Selection;
//!
//! let spheres = SphereArray::F32(vec![[0.0, 0.0, 0.0, 1.0], [5.0, 0.0, 0.0, 1.0], [9.0, 0.0, 0.0, 1.0]]);
//! let mut loaded = Dataset::new(spheres);
//! let kept = "x >= 5 and not index == 2".parse::<Selection>()?.apply(&mut loaded)?;
//! assert_eq!((kept.kept, kept.of), (1, 3));
//! assert_eq!(loaded.spheres, SphereArray::F32(vec![[5.0, 0.0, 0.0, 1.0]]));
//! # Ok::<(), pinhole_data::select::SelectError>(())
//! ```

mod arithmetic;
mod before;
mod classes;
mod compare;
mod data;
mod error;
mod evaluate;
mod foreign;
mod graph;
mod named;
mod near;
mod parse;
mod residues;
mod scan;
#[cfg(test)]
mod tests;
mod texts;
mod tree;
mod words;

pub use error::SelectError;
pub use named::{NameError, NamedSelections};

use std::fmt;
use std::str::FromStr;

use crate::load::Dataset;
use pinhole::internals::text::one_line;

/// An expression that chooses the spheres to keep.
///
/// Two selections are equal if their texts are, and those of the names that they may use.
#[derive(Clone, Debug)]
pub struct Selection {
    text: String,
    parsed: parse::Parsed,
    /// The selections that it may use by their names.
    names: NamedSelections,
}

/// The result of applying a selection.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct KeptSpheres {
    /// The number of spheres that are kept.
    pub kept: usize,
    /// The number of spheres before the selection.
    pub of: usize,
    /// Notes for the user, one line each: texts that no sphere has, and how the expression was read.
    pub notes: Vec<String>,
}

impl PartialEq for Selection {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.names == other.names
    }
}

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl FromStr for Selection {
    type Err = SelectError;

    fn from_str(text: &str) -> Result<Self, SelectError> {
        NamedSelections::default().selection(text)
    }
}

impl NamedSelections {
    /// Reads a selection that may use the names.
    ///
    /// # Errors
    /// Returns an error if the text is no selection.
    pub fn selection(&self, text: &str) -> Result<Selection, SelectError> {
        let parsed = parse::parse(text, &|name| self.has(name))?;
        Ok(Selection { text: text.to_owned(), parsed, names: self.clone() })
    }
}

impl Selection {
    /// Returns for each sphere whether it matches, and notes for the user.
    ///
    /// # Errors
    /// Returns an error if the expression needs what the data lacks, such as a column, or compares text with numbers.
    pub fn matches(&self, data: &Dataset) -> Result<(Vec<bool>, Vec<String>), SelectError> {
        let (matches, found) = evaluate::evaluate(&self.parsed.node, &self.text, &self.names, data)?;
        Ok((matches, self.parsed.notes.iter().cloned().chain(found).collect()))
    }

    /// Does the same as [`Selection::matches`], for a selection that must not be empty.
    ///
    /// # Errors
    /// Returns the errors of [`Selection::matches`], and an error if there are spheres but none matches.
    pub fn chosen(&self, data: &Dataset) -> Result<(Vec<bool>, Vec<String>), SelectError> {
        let (is_chosen, notes) = self.matches(data)?;
        if !is_chosen.is_empty() && !is_chosen.contains(&true) {
            let hint = self.parsed.remedy.as_ref().or(notes.first()).map_or(String::new(), |note| format!("; {note}"));
            return Err(SelectError::Nothing { expression: one_line(&self.text), of: is_chosen.len(), hint });
        }
        Ok((is_chosen, notes))
    }

    /// Leaves out the spheres that do not match, as [`Dataset::keep`] does.
    ///
    /// # Errors
    /// Returns the errors of [`Selection::chosen`]. The data are unchanged then.
    pub fn apply(&self, loaded: &mut Dataset) -> Result<KeptSpheres, SelectError> {
        let (is_kept, notes) = self.chosen(loaded)?;
        let (kept, of) = (is_kept.iter().filter(|kept| **kept).count(), is_kept.len());
        loaded.keep(&is_kept);
        Ok(KeptSpheres { kept, of, notes })
    }
}
