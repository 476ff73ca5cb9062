//! A molecule of MDL while it is read, and the data that it becomes.

use crate::load::dataset::Dataset;
use crate::load::error::LoadError;
use crate::load::format::Options;
use crate::load::labels::LabelsBuilder;
use crate::load::rows;
use crate::load::table::{Table, TableColumn};

/// The lines of a record, with the number of lines read.
pub(super) struct NumberedLines<'a> {
    pub(super) lines: rows::Lines<'a>,
    pub(super) line: usize,
}

impl<'a> Iterator for NumberedLines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let text = self.lines.next()?;
        self.line += 1;
        Some(text)
    }
}

/// The atoms that were read so far.
#[derive(Default)]
pub(super) struct Molecule {
    pub(super) places: [Vec<f64>; 3],
    pub(super) species: LabelsBuilder,
    pub(super) charges: Vec<f64>,
    /// Line of each atom.
    pub(super) lines: Vec<usize>,
    /// Number of bonds.
    pub(super) bonds: usize,
    /// Number of items of data, such as measured values, after the molecule.
    pub(super) data: usize,
    pub(super) notes: Vec<String>,
}

impl Molecule {
    pub(super) fn push(&mut self, line: usize, place: [f64; 3], symbol: &[u8], charge: f64) {
        for (values, value) in self.places.iter_mut().zip(place) {
            values.push(value);
        }
        self.species.push(symbol);
        self.charges.push(charge);
        self.lines.push(line);
    }

    pub(super) fn into_loaded(self, name: &str, is_drawing: bool, options: &Options) -> Result<Dataset, LoadError> {
        let Self { places, species, charges, lines, bonds, data, notes } = self;
        let count = lines.len();
        let places = ["x", "y", "z"].into_iter().zip(places).map(|(name, values)| TableColumn::numbers(name, values));
        let mut table = Table { columns: places.collect() };
        table.columns.push(TableColumn::labels("species", species.into_labels()));
        table.columns.push(TableColumn::numbers("charge", charges));
        if !name.is_empty() {
            let mut molecule = LabelsBuilder::default();
            molecule.index(name.as_bytes());
            molecule.indices = vec![0; count];
            table.columns.push(TableColumn::labels("molecule", molecule.into_labels()));
        }
        let mut loaded = rows::into_loaded(table, options, |row| lines.get(row).copied().unwrap_or_default())?;
        loaded.notes.extend(notes);
        if is_drawing {
            loaded.notes.push("the positions are those of a drawing (2D), not of a molecule in space".to_owned());
        }
        if bonds > 0 {
            loaded
                .notes
                .push(format!("the bonds of the file ({bonds}) are not used; --bonds finds bonds by distances"));
        }
        if data > 0 {
            loaded.notes.push(format!("the items of data after the molecule ({data}) are not used"));
        }
        Ok(loaded)
    }
}
