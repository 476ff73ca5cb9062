//! Bonds between atoms, which files name by serial numbers or by residues and names.

use std::collections::HashMap;

use super::Atoms;
use crate::load::bonds::Numbered;
use crate::load::labels::LabelsBuilder;

/// An atom by the names of its chain, its residue and itself.
#[derive(Clone, Copy, Debug)]
pub(in crate::load) struct AtomKey<'a> {
    pub(in crate::load) chain: &'a [u8],
    pub(in crate::load) residue: &'a [u8],
    pub(in crate::load) residue_number: f64,
    pub(in crate::load) name: &'a [u8],
    pub(in crate::load) insertion: u8,
    /// The letter of the alternate location, or a blank for all of them.
    pub(in crate::load) letter: u8,
}

/// The most locations of an atom. More atoms of one name are different ones, and none of them is meant.
const MOST: usize = 16;

/// The indices of the names, the bits of the number, and the insertion code.
type Key = (u32, u32, u32, u64, u8);

impl Atoms {
    /// Adds bonds between atoms with these serial numbers. Returns the places of those whose atoms are not there.
    pub(in crate::load) fn bond_by_serial(&mut self, pairs: impl ExactSizeIterator<Item = [i32; 2]>) -> Vec<usize> {
        if pairs.len() == 0 {
            return Vec::new();
        }
        let rows = Numbered::new(self.serial.iter().map(|serial| serial.is_finite().then_some(*serial as i64)));
        let row = |serial: i32| rows.row(serial.into());
        let mut missing = Vec::new();
        for (place, [a, b]) in pairs.enumerate() {
            match row(a).zip(row(b)) {
                Some((a, b)) => self.bonds.push([a, b]),
                None => missing.push(place),
            }
        }
        missing
    }

    /// Adds bonds between atoms with these names. Returns the number of those whose atoms are not there.
    pub(in crate::load) fn bond_by_name(&mut self, pairs: &[[AtomKey<'_>; 2]]) -> usize {
        let [chains, residues, names] = [&self.chain, &self.residue, &self.name].map(indices_by_name);
        let key = |atom: &AtomKey<'_>| -> Option<Key> {
            let [chain, residue, name] = [(&chains, atom.chain), (&residues, atom.residue), (&names, atom.name)]
                .map(|(all, name)| all.get(name));
            Some((*chain?, *residue?, *name?, atom.residue_number.to_bits(), atom.insertion))
        };
        let mut rows: HashMap<Key, Vec<u32>> =
            pairs.iter().flatten().filter_map(key).map(|key| (key, Vec::new())).collect();
        for (row, letters) in self.letters.iter().enumerate() {
            let labels = (self.chain.indices[row], self.residue.indices[row], self.name.indices[row]);
            let key = (labels.0, labels.1, labels.2, self.residue_number[row].to_bits(), letters[1]);
            if let Some(rows) = rows.get_mut(&key).filter(|rows| rows.len() <= MOST) {
                rows.push(row as u32);
            }
        }
        let mut missing = 0;
        for pair in pairs {
            let [ends, others] = pair.each_ref().map(|atom| {
                let rows = key(atom).and_then(|key| rows.get(&key)).map_or(&[][..], Vec::as_slice);
                let is_there = |row: &&u32| [b' ', self.letters[**row as usize][0]].contains(&atom.letter);
                let is_one = rows.len() <= MOST;
                rows.iter().filter(|row| is_one && is_there(row)).copied().collect::<Vec<u32>>()
            });
            missing += usize::from(ends.is_empty() || others.is_empty());
            self.bonds.extend(ends.iter().flat_map(|a| others.iter().map(move |b| [*a, *b])));
        }
        missing
    }
}

fn indices_by_name(labels: &LabelsBuilder) -> HashMap<&[u8], u32> {
    labels.names.iter().map(String::as_bytes).zip(0..).collect()
}
