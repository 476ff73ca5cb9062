//! Collects the atoms of one model.

use super::altloc::{self, Candidate};
use super::element::{self, Residue};
use super::error::PdbError;
use super::hybrid36;
use super::labels::{Labels, Memo, retain};
use super::record::Record;
use crate::image::color::LinearRgb;
use crate::load::elements::{Appearance, appearance, unknown_note};
use crate::load::{Column, ColumnValues, Loaded};
use crate::scene::sphere_array::SphereArray;

/// Fields that an atom must have, each with its first and last column.
const NEEDED: [(&str, usize, usize); 6] = [
    ("atom name", 13, 16),
    ("residue name", 18, 20),
    ("residue number", 23, 26),
    ("x coordinate", 31, 38),
    ("y coordinate", 39, 46),
    ("z coordinate", 47, 54),
];

/// The atoms that were read so far, in the order of the file.
#[derive(Default)]
pub(super) struct Atoms {
    spheres: Vec<[f64; 4]>,
    colors: Vec<LinearRgb>,
    species: Species,
    name: Labels,
    residue: Labels,
    residues: Vec<Residue>,
    chain: Labels,
    record: Labels,
    residue_number: Vec<f64>,
    occupancy: Vec<f64>,
    b_factor: Vec<f64>,
    /// The letter of the alternate location and the insertion code of the residue, for each atom.
    letters: Vec<[u8; 2]>,
    has_alternates: bool,
}

impl Atoms {
    pub(super) fn is_empty(&self) -> bool {
        self.spheres.is_empty()
    }

    /// Appends the atom of an ATOM or HETATM record.
    pub(super) fn push(&mut self, record: &Record<'_>) -> Result<(), PdbError> {
        record.must_have(&NEEDED)?;
        let text = record.text(23, 26);
        let number = hybrid36::decode(text).ok_or_else(|| PdbError::ResidueNumber {
            line: record.line,
            found: text.escape_debug().to_string(),
        })?;
        let [x, y, z] = [
            record.number("x coordinate", 31, 38)?,
            record.number("y coordinate", 39, 46)?,
            record.number("z coordinate", 47, 54)?,
        ];
        self.occupancy.push(record.number_or(1.0, "occupancy", 55, 60)?);
        self.b_factor.push(record.number_or(0.0, "B-factor", 61, 66)?);
        self.residue_number.push(f64::from(number));

        let name = record.bytes(13);
        self.name.push(name);
        // The format has residue names of three characters and a blank column 21; other programs use all four.
        let residue = self.residue.push(record.bytes(18)) as usize;
        if let (true, Some(name)) =
            (residue == self.residues.len(), self.residue.names.get(residue))
        {
            self.residues.push(Residue::of(name));
        }
        let residue = self.residues.get(residue).copied().unwrap_or(Residue::Other);
        let [chain] = record.bytes(22);
        self.chain.push([chain, b' ', b' ', b' ']);
        self.record.push(if record.name == "ATOM" { *b"ATOM" } else { *b"HETA" });

        let appearance = self.species.push(name, record.bytes(77), residue);
        self.spheres.push([x, y, z, appearance.radius]);
        self.colors.push(appearance.color);
        let ([letter], [insertion]) = (record.bytes(17), record.bytes(27));
        self.letters.push([letter, insertion]);
        self.has_alternates |= letter != b' ';
        Ok(())
    }

    /// Keeps one location of each atom. Returns a note if others were left out.
    fn keep_one_location(&mut self) -> Option<String> {
        if !self.has_alternates {
            return None;
        }
        let keep = altloc::kept(self.candidates());
        let left_out = keep.iter().filter(|kept| !**kept).count();
        if left_out == 0 {
            return None;
        }
        retain(&mut self.spheres, &keep);
        retain(&mut self.colors, &keep);
        retain(&mut self.residue_number, &keep);
        retain(&mut self.occupancy, &keep);
        retain(&mut self.b_factor, &keep);
        self.species.retain(&keep);
        for labels in [&mut self.name, &mut self.residue, &mut self.chain, &mut self.record] {
            labels.retain(&keep);
        }
        let atoms = if left_out == 1 { "1 atom is" } else { &format!("{left_out} atoms are") };
        Some(format!(
            "{atoms} left out as alternate {}; the locations with the highest occupancy are kept",
            if left_out == 1 { "location of another atom" } else { "locations of other atoms" }
        ))
    }

    fn candidates(&self) -> impl Iterator<Item = Candidate> + Clone {
        let indices = self.chain.indices.iter().zip(&self.residue.indices).zip(&self.name.indices);
        let numbers = self.residue_number.iter().zip(&self.occupancy);
        indices.zip(numbers).zip(&self.letters).map(
            |((((chain, residue), name), (number, occupancy)), [letter, insertion])| Candidate {
                key: (*chain, number.to_bits(), *insertion),
                residue: *residue,
                name: *name,
                letter: *letter,
                occupancy: *occupancy,
            },
        )
    }

    /// Returns the atoms as loaded data, without a cell and a number of frames.
    pub(super) fn into_loaded(mut self) -> Loaded {
        let left_out = self.keep_one_location();
        let unknown = self.species.unknown();
        let record = match self.record.into_values() {
            ColumnValues::Labels(mut labels) => {
                // Labels hold fields of four characters, so the name of the record was shortened.
                let names = labels.names.iter_mut();
                names.filter(|name| *name == "HETA").for_each(|name| name.push_str("TM"));
                ColumnValues::Labels(labels)
            }
            numbers @ ColumnValues::Numbers(_) => numbers,
        };
        let mut loaded = Loaded::new(SphereArray::F64(self.spheres));
        loaded.colors = Some(self.colors);
        loaded.columns = [
            ("species", self.species.labels.into_values()),
            ("name", self.name.into_values()),
            ("residue", self.residue.into_values()),
            ("chain", self.chain.into_values()),
            ("residue_number", ColumnValues::Numbers(self.residue_number)),
            ("b_factor", ColumnValues::Numbers(self.b_factor)),
            ("occupancy", ColumnValues::Numbers(self.occupancy)),
            ("record", record),
        ]
        .map(|(name, values)| Column { name: name.to_owned(), values })
        .into();
        loaded.notes = unknown.into_iter().chain(left_out).collect();
        loaded
    }
}

/// The elements of the atoms.
#[derive(Default)]
struct Species {
    labels: Labels,
    /// The appearance of each name in `labels`.
    appearances: Vec<Appearance>,
    /// The index in `labels` for a name, a symbol and a kind of residue.
    known: Memo,
}

impl Species {
    fn push(&mut self, name: [u8; 4], symbol: [u8; 2], residue: Residue) -> Appearance {
        let [a, b, c, d] = name;
        let [e, f] = symbol;
        let key = u64::from_le_bytes([a, b, c, d, e, f, residue as u8, 0]);
        let index = self.known.get(key).unwrap_or_else(|| {
            let (text, is_element) = element::symbol(name, symbol, residue);
            let mut field = [b' '; 4];
            field.iter_mut().zip(text.bytes()).for_each(|(to, from)| *to = from);
            let index = self.labels.index(field);
            if index as usize == self.appearances.len() {
                // An empty text gives the appearance of a species that is not an element.
                self.appearances.push(appearance(if is_element { &text } else { "" }));
            }
            self.known.insert(key, index);
            index
        });
        self.labels.indices.push(index);
        self.appearances.get(index as usize).copied().unwrap_or_else(|| appearance(""))
    }

    fn retain(&mut self, keep: &[bool]) {
        let former = self.labels.retain(keep);
        let appearance = |index: &u32| self.appearances.get(*index as usize).copied();
        self.appearances = former.iter().filter_map(appearance).collect();
    }

    /// Returns a note about species that are not elements.
    fn unknown(&self) -> Option<String> {
        let appearances = self.labels.names.iter().zip(&self.appearances);
        let unknown = appearances.filter(|(_, appearance)| !appearance.is_element);
        unknown_note(&unknown.map(|(name, _)| name.clone()).collect::<Vec<_>>(), "")
    }
}
