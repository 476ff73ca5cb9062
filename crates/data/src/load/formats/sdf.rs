//! Reads molecules in the formats of MDL, V2000 and V3000: one in a `.mol` file, and one after the other in an `.sdf`
//! file, where each is a frame. The document "CT File Formats" of BIOVIA describes them.
//!
//! A record has three lines, the first of which is the name of the molecule, a line with counts, atoms, bonds,
//! properties, and perhaps items of data; `$$$$` ends it. Lengths are in Å. The columns are `species`, `charge`, and
//! `molecule` if the molecule has a name. Items of data are counted, but not used.

mod molecule;
mod v3000;

use std::io;

pub(super) use self::molecule::{Molecule, NumberedLines};
use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, Place};
use crate::load::format::{FrameIndex, FrameSpan, FrameText, Frames, Options};
use crate::load::numbers::number;
use crate::load::rows::{self, Values};
use crate::load::source::LineReader;
use pinhole::internals::text::{shortened, without_byte_order_mark};

pub(super) const FRAMES: Frames = Frames::Lines { find, read };

/// Number of lines before the atoms of V2000.
const HEAD: usize = 4;

/// True if the fourth line ends with a version of the format.
pub(super) fn starts(bytes: &[u8]) -> bool {
    let line = rows::Lines::new(bytes).nth(HEAD - 1).unwrap_or_default().trim_ascii_end();
    line.ends_with(b"V2000") || line.ends_with(b"V3000")
}

/// Finds the records, each of which is a frame. Their contents are not checked.
fn find(lines: &mut LineReader<'_>, last: Option<usize>) -> io::Result<FrameIndex> {
    let mut found = FrameIndex::default();
    let (mut start, mut lines_before, mut is_empty) = (0, 0, true);
    loop {
        let offset = lines.offset;
        let text = lines.next()?.map(<[u8]>::trim_ascii_end);
        found.is_whole = text.is_none();
        let is_end = text.is_none_or(|text| text == b"$$$$");
        if !is_end {
            is_empty &= text.is_none_or(<[u8]>::is_empty);
            if last.is_some_and(|last| found.frames.len() > last) && !is_empty {
                return Ok(found);
            }
            continue;
        }
        // Blank lines may follow the last record.
        if !(found.is_whole && is_empty) {
            found.frames.push(FrameSpan { bytes: start..offset, lines_before });
        }
        if found.is_whole {
            break;
        }
        (start, lines_before, is_empty) = (lines.offset, lines.line, true);
    }
    if found.frames.is_empty() {
        found.problem = Some(LoadError::new("the file is empty; a molecule starts with a line for its name"));
    }
    Ok(found)
}

fn read(frame: &FrameText<'_>, options: &Options) -> Result<Dataset, LoadError> {
    let mut lines = NumberedLines { lines: rows::Lines::new(frame.text), line: frame.lines_before };
    let first = frame.lines_before + 1;
    let mut head = [&b""[..]; HEAD];
    for line in &mut head {
        *line = lines.next().ok_or_else(|| {
            LoadError::line(first, format!("the molecule of frame {} ends before the line with counts", frame.index))
        })?;
    }
    let [name, program, _, counts] = head;
    let mut molecule = Molecule::default();
    if counts.trim_ascii_end().ends_with(b"V3000") {
        v3000::read(&mut molecule, &mut lines)?;
    } else {
        molecule.read_v2000(counts, &mut lines)?;
    }
    molecule.data = lines.lines.filter(|line| line.starts_with(b">")).count();
    if molecule.species.indices.is_empty() {
        let message = format!("the molecule of frame {} has no atoms; choose another frame", frame.index);
        return Err(LoadError::line(lines.line.max(first), message));
    }
    let is_drawing = program.get(20..22) == Some(b"2D") && molecule.places[2].iter().all(|z| *z == 0.0);
    let name = String::from_utf8_lossy(without_byte_order_mark(name)).trim().to_owned();
    molecule.into_loaded(&name, is_drawing, options)
}

impl Molecule {
    fn read_v2000(&mut self, counts: &[u8], lines: &mut NumberedLines<'_>) -> Result<(), LoadError> {
        let line_of_counts = lines.line;
        let count = |first: usize, what: &str| {
            whole(counts, first, 3).and_then(|count| usize::try_from(count).ok()).ok_or_else(|| {
                let place = Place::Columns { line: line_of_counts, first: first + 1, last: first + 3 };
                LoadError::at(place, format!("the number of {what} must be a whole number in these columns"))
            })
        };
        let (atoms, bonds) = (count(0, "atoms")?, count(3, "bonds")?);
        let ends = |found: usize, what: &str, declared: usize| {
            let message = format!("{declared} {what} are declared, but the molecule ends after {found}");
            LoadError::line(line_of_counts, message)
        };
        for found in 0..atoms {
            let text = lines.next().filter(|text| !is_property(text)).ok_or_else(|| ends(found, "atoms", atoms))?;
            self.take_v2000(lines.line, text)?;
        }
        for found in 0..bonds {
            let text = lines.next().filter(|text| !is_property(text)).ok_or_else(|| ends(found, "bonds", bonds))?;
            let (line, pair) = (lines.line, whole(text, 0, 3).zip(whole(text, 3, 3)));
            let (a, b) = pair.ok_or_else(|| {
                let place = Place::Columns { line, first: 1, last: 6 };
                LoadError::at(place, "a bond begins with the numbers of two atoms, in three columns each")
            })?;
            self.bonds.push((line, [a.into(), b.into()]));
        }
        // Lists of atoms and texts for drawings, which old programs wrote.
        let (lists, texts) = (count(6, "").unwrap_or(0), count(15, "").unwrap_or(0));
        for _ in 0..lists.saturating_add(texts.saturating_mul(2)) {
            lines.next();
        }
        self.take_properties(lines, line_of_counts)
    }

    /// Reads the line of an atom in the fixed columns of V2000.
    fn take_v2000(&mut self, line: usize, text: &[u8]) -> Result<(), LoadError> {
        let mut place = [0.0; 3];
        for (index, (value, axis)) in place.iter_mut().zip(["x", "y", "z"]).enumerate() {
            let field = text.get(10 * index..10 * index + 10).unwrap_or_default().trim_ascii();
            *value = number(field).filter(|number| number.is_finite()).ok_or_else(|| {
                let found = shortened(&String::from_utf8_lossy(field));
                let place = Place::Columns { line, first: 10 * index + 1, last: 10 * index + 10 };
                LoadError::at(place, format!("{axis} is `{found}`; a finite number belongs there"))
            })?;
        }
        let symbol = text.get(31..text.len().min(34)).unwrap_or_default().trim_ascii();
        if symbol.is_empty() {
            let place = Place::Columns { line, first: 32, last: 34 };
            return Err(LoadError::at(place, "the symbol of the element is missing"));
        }
        // 4 is an atom with an unpaired electron.
        let charge = match whole(text, 36, 3) {
            Some(code @ (1..=3 | 5..=7)) => 4 - code,
            _ => 0,
        };
        self.push(line, place, symbol, f64::from(charge));
        Ok(())
    }

    /// Reads lines up to the end of the molecule. Charges in them replace those in the lines of atoms.
    fn take_properties(&mut self, lines: &mut NumberedLines<'_>, line_of_counts: usize) -> Result<(), LoadError> {
        let (mut is_first, mut has_charges) = (true, false);
        while let Some(text) = lines.next() {
            if text.starts_with(b"M  END") {
                break;
            }
            let is_letter = text.first().is_some_and(u8::is_ascii_alphabetic);
            if std::mem::take(&mut is_first) && !(is_letter || text.trim_ascii().is_empty()) {
                let message = format!(
                    "this line follows the atoms and bonds, of which there are as many as line {line_of_counts} declares"
                );
                return Err(LoadError::line(lines.line, message));
            }
            if text.starts_with(b"M  RAD") || text.starts_with(b"M  CHG") {
                if !std::mem::replace(&mut has_charges, true) {
                    self.charges.fill(0.0);
                }
                if let Some(pairs) = text.strip_prefix(b"M  CHG") {
                    self.take_charges(pairs).ok_or_else(|| {
                        let message = "a line of charges has the number of its atoms, and for each the index, from 1, \
                                       and the charge, such as `M CHG 1 4 1`";
                        LoadError::line(lines.line, message)
                    })?;
                }
            }
        }
        Ok(())
    }

    /// Sets the charges of a line, or returns `None` if it cannot be read.
    fn take_charges(&mut self, text: &[u8]) -> Option<()> {
        let mut values = Values { rest: text }.map(|value| std::str::from_utf8(value).ok()?.parse::<i32>().ok());
        for _ in 0..values.next()?? {
            let index = usize::try_from(values.next()??).ok()?.checked_sub(1)?;
            *self.charges.get_mut(index)? = f64::from(values.next()??);
        }
        values.next().is_none().then_some(())
    }
}

/// True for lines that can only follow the atoms and bonds.
fn is_property(text: &[u8]) -> bool {
    text.starts_with(b"M  ") || text.starts_with(b">")
}

/// The whole number in some columns, counted from 0.
fn whole(text: &[u8], first: usize, width: usize) -> Option<i32> {
    let field = text.get(first..text.len().min(first + width))?;
    std::str::from_utf8(field).ok()?.trim().parse().ok()
}
