//! A molecule of MDL while it is read, and the data that it becomes.

use crate::load::bonds::{Numbered, ordered};
use crate::load::dataset::Dataset;
use crate::load::error::LoadError;
use crate::load::format::Options;
use crate::load::labels::LabelsBuilder;
use crate::load::rows;
use crate::load::table::{Table, TableColumn};

/// The lines of a record, with the number of lines read.
pub(in crate::load::formats) struct NumberedLines<'a> {
    pub(in crate::load::formats) lines: rows::Lines<'a>,
    pub(in crate::load::formats) line: usize,
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
pub(in crate::load::formats) struct Molecule {
    pub(in crate::load::formats) places: [Vec<f64>; 3],
    pub(in crate::load::formats) species: LabelsBuilder,
    pub(in crate::load::formats) charges: Vec<f64>,
    /// Line of each atom.
    pub(in crate::load::formats) lines: Vec<usize>,
    /// The numbers of the atoms in the file, if they are not 1, 2, 3 and so on.
    pub(in crate::load::formats) numbers: Vec<i64>,
    /// The numbers of two bonded atoms, each with the line.
    pub(in crate::load::formats) bonds: Vec<(usize, [i64; 2])>,
    /// Further columns.
    pub(in crate::load::formats) columns: Vec<TableColumn>,
    /// Number of items of data, such as measured values, after the molecule.
    pub(in crate::load::formats) data: usize,
    pub(in crate::load::formats) notes: Vec<String>,
}

impl Molecule {
    pub(in crate::load::formats) fn push(&mut self, line: usize, place: [f64; 3], symbol: &[u8], charge: f64) {
        for (values, value) in self.places.iter_mut().zip(place) {
            values.push(value);
        }
        self.species.push(symbol);
        self.charges.push(charge);
        self.lines.push(line);
    }

    pub(in crate::load::formats) fn into_loaded(
        self,
        name: &str,
        is_drawing: bool,
        options: &Options,
    ) -> Result<Dataset, LoadError> {
        let Self { places, species, charges, lines, numbers, bonds, columns, data, notes } = self;
        let count = lines.len();
        let number = |row: usize| numbers.get(row).copied().unwrap_or(row as i64 + 1);
        let rows = Numbered::new((0..count).map(|row| Some(number(row))));
        let bonds: Vec<_> = bonds.into_iter().map(|(line, pair)| rows.pair(line, pair)).collect::<Result<_, _>>()?;
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
        table.columns.extend(columns);
        let mut loaded = rows::into_loaded(table, options, |row| lines.get(row).copied().unwrap_or_default())?;
        loaded.notes.extend(notes);
        if is_drawing {
            loaded.notes.push("the positions are those of a drawing (2D), not of a molecule in space".to_owned());
        }
        loaded.bonds = ordered(bonds);
        loaded.has_all_bonds = true;
        if data > 0 {
            loaded.notes.push(format!("the items of data after the molecule ({data}) are not used"));
        }
        Ok(loaded)
    }
}
