//! Reads molecules of Tripos (`.mol2`), one after the other, each of which is a frame. The document "Tripos Mol2 File
//! Format" of Tripos describes them.
//!
//! A molecule has sections, which begin with `@<TRIPOS>` and a name. Of these MOLECULE, ATOM, BOND, SUBSTRUCTURE and CRYSIN
//! are read. Lengths are in Å. The columns are `species`, `charge`, `molecule` if it has a name, `name`, `type`, and
//! `residue`, `residue_number` and `chain` if the file has them.

use std::collections::HashMap;
use std::io;

use super::sdf::{Molecule, NumberedLines};
use crate::load::atoms::cell_edges;
use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, Place};
use crate::load::format::{FrameIndex, FrameSpan, FrameText, Frames, Options};
use crate::load::labels::LabelsBuilder;
use crate::load::numbers::number;
use crate::load::rows::{self, Values};
use crate::load::source::LineReader;
use crate::load::table::TableColumn;
use pinhole::internals::text::{shortened, without_byte_order_mark};

pub(super) const FRAMES: Frames = Frames::Lines { find, read };

/// The start of the line before a section.
const SECTION: &[u8] = b"@<TRIPOS>";

/// True if the first line that is neither blank nor a comment begins a section.
pub(super) fn starts(bytes: &[u8]) -> bool {
    let mut lines = rows::Lines::new(without_byte_order_mark(bytes)).map(<[u8]>::trim_ascii);
    lines.find(|line| !line.is_empty() && !line.starts_with(b"#")).is_some_and(|line| line.starts_with(SECTION))
}

/// Finds the molecules, each of which is a frame. Their contents are not checked.
fn find(lines: &mut LineReader<'_>, last: Option<usize>) -> io::Result<FrameIndex> {
    let mut found = FrameIndex::default();
    loop {
        let (offset, lines_before) = (lines.offset, lines.line);
        let text = lines.next()?;
        let text = if lines_before == 0 { text.map(without_byte_order_mark) } else { text };
        let is_start =
            text.and_then(|text| text.strip_prefix(SECTION)).is_some_and(|name| name.starts_with(b"MOLECULE"));
        found.is_whole = text.is_none();
        if !(is_start || found.is_whole) {
            continue;
        }
        if let Some(before) = found.frames.last_mut() {
            before.bytes.end = offset;
        }
        if found.is_whole || last.is_some_and(|last| found.frames.len() > last) {
            break;
        }
        found.frames.push(FrameSpan { bytes: offset..offset, lines_before });
    }
    if found.frames.is_empty() {
        found.problem = Some(LoadError::new("there is no line @<TRIPOS>MOLECULE, with which a molecule begins"));
    }
    Ok(found)
}

fn read(frame: &FrameText<'_>, options: &Options) -> Result<Dataset, LoadError> {
    let mut lines = NumberedLines { lines: rows::Lines::new(frame.text), line: frame.lines_before };
    let mut reader = Reader::default();
    while let Some(text) = lines.next() {
        reader.take(lines.line, text)?;
    }
    let first = frame.lines_before + 1;
    let Reader { mut molecule, name, counts, cell, is_part_of_crystal, names, types, residues, chains, .. } = reader;
    let (line, [atoms, bonds]) = counts.ok_or_else(|| {
        LoadError::line(first, format!("the molecule of frame {} ends before the line with counts", frame.index))
    })?;
    let check = |what: &str, declared: Option<usize>, found: usize| match declared {
        Some(declared) if declared != found => {
            Err(LoadError::line(line, format!("{declared} {what} are declared, but the molecule has {found}")))
        }
        _ => Ok(()),
    };
    check("atoms", atoms, molecule.lines.len())?;
    check("bonds", bonds, molecule.bonds.len() + reader.others)?;
    if molecule.lines.is_empty() {
        let message = format!("the molecule of frame {} has no atoms; choose another frame", frame.index);
        return Err(LoadError::line(first, message));
    }
    molecule.columns =
        vec![TableColumn::labels("name", names.into_labels()), TableColumn::labels("type", types.into_labels())];
    if residues.iter().any(|residue| !residue.name.is_empty()) {
        let [mut names, mut letters] = [LabelsBuilder::default(), LabelsBuilder::default()];
        for residue in &residues {
            names.push(residue.name);
            letters.push(chains.get(&residue.id).copied().unwrap_or_default());
        }
        let numbers = residues.iter().map(|residue| residue.number).collect();
        molecule.columns.push(TableColumn::labels("residue", names.into_labels()));
        molecule.columns.push(TableColumn::numbers("residue_number", numbers));
        if chains.values().any(|chain| !chain.is_empty()) {
            molecule.columns.push(TableColumn::labels("chain", letters.into_labels()));
        }
    }
    let mut loaded = molecule.into_loaded(&name, false, options)?;
    loaded.cell = cell;
    loaded.is_part_of_crystal = is_part_of_crystal;
    Ok(loaded)
}

/// A residue, which the format calls a substructure.
struct Residue<'a> {
    id: i64,
    name: &'a [u8],
    number: f64,
}

impl<'a> Residue<'a> {
    /// The number that ends a name is that of the residue if it is also its id, or follows three letters: `ALA12`.
    fn new(id: Option<&'a [u8]>, name: Option<&'a [u8]>) -> Self {
        let id = id.and_then(whole).unwrap_or_default();
        let name = name.unwrap_or_default();
        let digits = name.iter().rev().take_while(|byte| byte.is_ascii_digit()).count();
        let (start, end) = name.split_at(name.len() - digits);
        let number = whole(end).filter(|number| (*number == id && !start.is_empty()) || start.len() >= 3);
        match number {
            Some(number) => Self { id, name: start, number: number as f64 },
            None => Self { id, name, number: id as f64 },
        }
    }
}

/// The parts of a molecule that were read so far.
#[derive(Default)]
struct Reader<'a> {
    /// The name of the section, and the number of lines in it.
    section: &'a [u8],
    row: usize,
    molecule: Molecule,
    name: String,
    /// The line of the counts, and the numbers of atoms and bonds, which may be missing.
    counts: Option<(usize, [Option<usize>; 2])>,
    names: LabelsBuilder,
    types: LabelsBuilder,
    residues: Vec<Residue<'a>>,
    /// The chains of substructures.
    chains: HashMap<i64, &'a [u8]>,
    /// Number of bonds that say that two atoms are not bonded.
    others: usize,
    cell: Option<[[f64; 3]; 3]>,
    is_part_of_crystal: bool,
}

impl<'a> Reader<'a> {
    fn take(&mut self, line: usize, text: &'a [u8]) -> Result<(), LoadError> {
        let text = text.trim_ascii();
        if let Some(section) = without_byte_order_mark(text).strip_prefix(SECTION) {
            (self.section, self.row) = (section.trim_ascii(), 0);
            return Ok(());
        }
        self.row += 1;
        match (self.section, self.row) {
            (b"MOLECULE", 1) if text.iter().any(|byte| *byte != b'*') => {
                self.name = String::from_utf8_lossy(text).into_owned();
            }
            (b"MOLECULE", 2) => {
                let mut counts = Values { rest: text }.map(whole);
                let mut count = || match counts.next() {
                    None => Ok(None),
                    Some(count) => count.and_then(|count| usize::try_from(count).ok()).map(Some).ok_or_else(|| {
                        LoadError::line(line, "this line must have the numbers of atoms and bonds, such as `12 11`")
                    }),
                };
                self.counts = Some((line, [count()?, count()?]));
            }
            (b"MOLECULE", _) => {}
            _ if text.is_empty() || text.starts_with(b"#") => {}
            (b"ATOM", _) => self.atom(line, text)?,
            (b"BOND", _) => self.bond(line, text)?,
            (b"CRYSIN", _) => self.crystal(line, text)?,
            (b"SUBSTRUCTURE", _) => {
                let mut values = Values { rest: text };
                if let (Some(id), Some(chain)) = (values.next().and_then(whole), values.nth(4)) {
                    self.chains.insert(id, if chain.starts_with(b"*") { b"" } else { chain });
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn atom(&mut self, line: usize, text: &'a [u8]) -> Result<(), LoadError> {
        let mut values = Values { rest: text };
        let [id, name, x, y, z, kind] = std::array::from_fn(|_| values.next().unwrap_or_default());
        let finite = |column: usize, what: &str, text: &[u8]| {
            number(text).filter(|number| number.is_finite()).ok_or_else(|| {
                let found = shortened(&String::from_utf8_lossy(text));
                let message = format!("{what} is `{found}`; a finite number belongs there");
                LoadError::at(Place::Column { line, column }, message)
            })
        };
        if kind.is_empty() {
            let message = "an atom has a number, a name, three coordinates and a type, such as `1 CA 0 0 0 C.3`";
            return Err(LoadError::line(line, message));
        }
        let id = whole(id).ok_or_else(|| LoadError::line(line, "the number of the atom must be a whole number"))?;
        let place = [finite(3, "x", x)?, finite(4, "y", y)?, finite(5, "z", z)?];
        self.residues.push(Residue::new(values.next(), values.next()));
        let charge = values.next().map_or(Ok(0.0), |charge| finite(9, "the charge", charge))?;
        self.names.push(name);
        self.types.push(kind);
        self.molecule.numbers.push(id);
        self.molecule.push(line, place, &symbol_of(kind), charge);
        Ok(())
    }

    fn bond(&mut self, line: usize, text: &[u8]) -> Result<(), LoadError> {
        let mut values = Values { rest: text }.skip(1);
        let ends = [values.next(), values.next()].map(|end| end.and_then(whole));
        let [Some(a), Some(b)] = ends else {
            return Err(LoadError::line(
                line,
                "a bond has a number, the numbers of two atoms, and a type, such as `1 1 2 ar`",
            ));
        };
        match values.next() {
            Some(b"nc") => self.others += 1,
            _ => self.molecule.bonds.push((line, [a, b])),
        }
        Ok(())
    }

    fn crystal(&mut self, line: usize, text: &[u8]) -> Result<(), LoadError> {
        let values: Option<Vec<f64>> = Values { rest: text }.take(6).map(number).collect();
        let Some(&[a, b, c, alpha, beta, gamma]) = values.as_deref() else {
            return Err(LoadError::line(
                line,
                "a cell has three lengths, three angles and the number of its space group",
            ));
        };
        self.cell = cell_edges([a, b, c], [alpha, beta, gamma]).map_err(|message| LoadError::line(line, message))?;
        self.is_part_of_crystal = Values { rest: text }.nth(6).is_some_and(|group| group != b"1");
        Ok(())
    }
}

/// The symbol of the element of a type. Types of Tripos begin with it (`C.ar`, `Ca`); those of Amber are one or two letters
/// in the same case (`CA`, `ca`, `hc`), of which the first is the element but for a few.
fn symbol_of(kind: &[u8]) -> Vec<u8> {
    const PAIRS: [&[u8]; 10] = [b"CL", b"BR", b"FE", b"LI", b"LP", b"MG", b"MN", b"SE", b"SI", b"ZN"];
    let word = kind.split(|byte| *byte == b'.').next().unwrap_or_default();
    match word {
        [a, b, ..] if a.is_ascii_uppercase() && b.is_ascii_lowercase() => word.to_vec(),
        [_, _, ..] => {
            let pair = word[..2].to_ascii_uppercase();
            if PAIRS.contains(&&*pair) { vec![pair[0], pair[1].to_ascii_lowercase()] } else { pair[..1].to_vec() }
        }
        _ => word.to_ascii_uppercase(),
    }
}

fn whole(text: &[u8]) -> Option<i64> {
    std::str::from_utf8(text).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_of_types() {
        let types = ["C.3", "Ca", "ca", "CA", "cl", "Cl", "BR", "hc", "O.co2", "Du", "N", "LP", "c3", "n"];
        let symbols: Vec<_> = types.map(|kind| String::from_utf8(symbol_of(kind.as_bytes())).unwrap()).into();
        assert_eq!(symbols, ["C", "Ca", "C", "C", "Cl", "Cl", "Br", "H", "O", "Du", "N", "Lp", "C", "N"]);
    }

    #[test]
    fn residues_of_substructures() {
        for (id, name, residue, number) in [
            ("7", "ALA225", "ALA", 225.0_f64),
            ("1", "P34", "P34", 1.0),
            ("5", "DA5", "DA", 5.0),
            ("3", "17", "17", 3.0),
        ] {
            let found = Residue::new(Some(id.as_bytes()), Some(name.as_bytes()));
            assert_eq!((found.name, found.number.to_bits()), (residue.as_bytes(), number.to_bits()));
        }
    }
}
