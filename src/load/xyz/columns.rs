//! What an extended XYZ frame declares beside what makes spheres: other columns, and the periodic cell.

use std::collections::HashMap;

use super::{Atom, XyzError, parse_number, value_of};
use crate::load::loaded::{Column, ColumnValues, Labels};
use crate::text::shortened;

/// A column of a file that becomes a column of the loaded spheres.
pub(super) struct OtherColumn {
    name: String,
    is_text: bool,
    /// Index of the column in an atom's line.
    column: usize,
}

impl OtherColumn {
    /// The columns of one field of `Properties`, which begin at `first`.
    pub(super) fn of_field(
        name: &str,
        kind: &str,
        first: usize,
        count: usize,
    ) -> Result<impl Iterator<Item = Self>, String> {
        /// More than any program writes, and few enough to be listed.
        const MAX_COLUMNS: usize = 1024;
        let is_text = match kind {
            "S" | "L" => true,
            "R" | "I" => false,
            _ => {
                return Err(format!(
                    "Properties: {name} has the type `{}`, which is none of R, I, S and L",
                    shortened(kind)
                ));
            }
        };
        if count > MAX_COLUMNS {
            return Err(format!(
                "Properties: {name} has {count} columns; {MAX_COLUMNS} are the most"
            ));
        }
        let name = shortened(name);
        Ok((0..count).map(move |i| {
            let name = match (count, i) {
                (1, _) => name.clone(),
                (2 | 3, i) => format!("{name}.{}", ["x", "y", "z"][i]),
                (_, i) => format!("{name}.{i}"),
            };
            Self { name, is_text, column: first + i }
        }))
    }
}

/// The values of a column so far.
pub(super) struct OtherValues<'a> {
    column: &'a OtherColumn,
    numbers: Vec<f64>,
    labels: Labels,
    known: HashMap<String, u32>,
}

impl<'a> OtherValues<'a> {
    pub(super) fn new(column: &'a OtherColumn) -> Self {
        Self { column, numbers: Vec::new(), labels: Labels::default(), known: HashMap::new() }
    }

    pub(super) fn push(&mut self, atom: &Atom<'_>) -> Result<(), XyzError> {
        let OtherColumn { name, is_text, column } = self.column;
        if !is_text {
            self.numbers.push(atom.number(*column, name)?);
            return Ok(());
        }
        let text = atom.text(*column, name)?;
        let index = match self.known.get(text) {
            Some(index) => *index,
            None => {
                // There are no more names than spheres, which are fewer than 2³².
                let index = self.labels.names.len() as u32;
                self.labels.names.push(shortened(text));
                self.known.insert(text.to_owned(), index);
                index
            }
        };
        self.labels.indices.push(index);
        Ok(())
    }

    pub(super) fn into_column(self) -> Column {
        let values = if self.column.is_text {
            ColumnValues::Labels(self.labels)
        } else {
            ColumnValues::Numbers(self.numbers)
        };
        Column { name: self.column.name.clone(), values }
    }
}

/// The periodic cell of a comment line: `Lattice` has the three components of each edge vector, one edge after the other.
pub(super) fn cell_of(comment: &str) -> Result<Option<[[f64; 3]; 3]>, String> {
    let Some(text) = value_of("Lattice", comment) else {
        return Ok(None);
    };
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(parse_number).collect();
    match numbers.as_deref() {
        Some(&[ax, ay, az, bx, by, bz, cx, cy, cz]) => {
            Ok(Some([[ax, ay, az], [bx, by, bz], [cx, cy, cz]]))
        }
        _ => Err(format!("Lattice={} is not a list of nine finite numbers", shortened(text))),
    }
}
