//! The bonds of a PDB file, in its CONECT records.

use super::record::hybrid36;
use crate::load::atoms::Atoms;
use crate::load::rows::Values;

/// The columns of the atom and of those that it is bonded to, counted from 0.
const COLUMNS: [std::ops::Range<usize>; 5] = [6..11, 11..16, 16..21, 21..26, 26..31];

/// The bonds that were read so far.
#[derive(Default)]
pub(super) struct Links {
    /// Pairs of serial numbers, each with its line.
    pairs: Vec<(usize, [i32; 2])>,
    /// Number of records that cannot be read, and the line of the first.
    unreadable: usize,
    first_unreadable: usize,
}

impl Links {
    /// Reads a record: the number of an atom, and up to four of those that it is bonded to. A bond may be listed twice.
    pub(super) fn take(&mut self, line: usize, text: &[u8]) {
        let field = |columns: std::ops::Range<usize>| {
            text.get(columns.start..columns.end.min(text.len())).unwrap_or_default().trim_ascii()
        };
        let in_columns = COLUMNS.into_iter().map(field).filter(|field| !field.is_empty()).map(hybrid36);
        // Some programs write numbers in other columns.
        let rest = text.get(6..).unwrap_or_default();
        let numbers: Option<Vec<i32>> =
            in_columns.collect::<Option<_>>().or_else(|| Values { rest }.map(hybrid36).collect());
        match numbers.as_deref() {
            Some([first, others @ ..]) => self.pairs.extend(others.iter().map(|other| (line, [*first, *other]))),
            _ => {
                self.first_unreadable = if self.unreadable == 0 { line } else { self.first_unreadable };
                self.unreadable += 1;
            }
        }
    }

    /// Adds the bonds to the atoms with these serial numbers. Returns notes on those that are left out.
    pub(super) fn add_to(self, atoms: &mut Atoms) -> Vec<String> {
        let mut notes = Vec::new();
        if self.unreadable > 0 {
            notes.push(format!(
                "CONECT records that cannot be read are left out: {}, the first on line {}; their numbers belong in columns \
                 7-11, 12-16, 17-21, 22-26 and 27-31",
                self.unreadable, self.first_unreadable
            ));
        }
        let missing = atoms.bond_by_serial(self.pairs.iter().map(|(_, pair)| *pair));
        if let Some((line, [a, b])) = missing.first().and_then(|first| self.pairs.get(*first)) {
            notes.push(format!(
                "bonds of CONECT records are left out: {}, the first on line {line}, of the atoms {a} and {b}; no atom has \
                 one of the numbers, or several have it",
                missing.len()
            ));
        }
        notes
    }
}
