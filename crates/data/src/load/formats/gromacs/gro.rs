//! Reads coordinates of GROMACS as text (`.gro`), as its reference manual describes the format.
//!
//! A frame is a title, the number of atoms, a line for each atom, and a line with the box. Residue number, residue
//! name, atom name and atom number have five columns each. Positions follow, and perhaps velocities; the distance of
//! the decimal points is the width of each of these fields. The columns are `species`, `name`, `residue`,
//! `residue_number`, and `velocity.x` to `velocity.z` in Å/ps. Elements follow from the names of atoms and residues.
//! Atom numbers and titles are not used.

use std::io;

use super::{ANGSTROMS, trr};
use crate::load::atoms::{Atom, Atoms, element::unaligned};
use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, Place};
use crate::load::format::{FrameIndex, FrameSpan, FrameText, Frames, Options};
use crate::load::formats::xyz::counted;
use crate::load::numbers::number;
use crate::load::rows::{Lines, Values};
use crate::load::source::LineReader;
use pinhole::internals::text::{shortened, without_byte_order_mark};

pub(crate) const FRAMES: Frames = Frames::Lines { find, read };

/// Number of columns before the positions.
const BEFORE: usize = 20;

/// Names of the positions and velocities, in the order of their columns.
const FIELDS: [&str; 6] = ["x coordinate", "y coordinate", "z coordinate", "x velocity", "y velocity", "z velocity"];

/// True if the second line is a number of atoms, and the third has positions in fixed columns.
pub(crate) fn starts(bytes: &[u8]) -> bool {
    let mut lines = Lines::new(bytes).skip(1);
    let count = lines.next().and_then(count_of);
    let atom = lines.next().unwrap_or_default();
    count.is_some() && residue_number(atom).is_some() && width_of(atom).is_some()
}

/// Finds frames by their numbers of atoms. The lines of atoms are only counted.
fn find(lines: &mut LineReader<'_>, last: Option<usize>) -> io::Result<FrameIndex> {
    let mut found = FrameIndex::default();
    let problem = loop {
        let (mut start, mut lines_before, index) = (lines.offset, lines.line, found.frames.len());
        let Some(title) = lines.next()? else {
            found.is_whole = true;
            break (index == 0).then(|| LoadError::new("the file is empty; a .gro file starts with a title"));
        };
        let mut is_blank = is_blank(title);
        // A title may be blank, and blank lines may follow the last frame.
        let (count, is_number) = loop {
            let offset = lines.offset;
            let Some(text) = lines.next()? else { break (None, false) };
            if !(is_blank && self::is_blank(text)) {
                break (count_of(text), true);
            }
            (start, lines_before) = (offset, lines.line - 1);
            is_blank = true;
        };
        let line = lines_before + 2;
        let Some(atoms) = count else {
            let message = match (is_number, is_blank) {
                (true, _) => "a number of atoms must stand here, after the title",
                (false, true) if index > 0 => {
                    found.is_whole = true;
                    break None;
                }
                _ => "the file ends before the number of atoms, which follows the title",
            };
            break Some(LoadError::line(line, message));
        };
        if last.is_some_and(|last| index > last) {
            break None;
        }
        let skipped = lines.skip(atoms)?;
        if skipped < atoms || lines.next()?.is_none() {
            let end = if skipped < atoms { format!("after {skipped}") } else { "before the box".to_owned() };
            let message = format!("frame {index} declares {}, but the file ends {end}", counted(atoms));
            break Some(LoadError::line(line, message));
        }
        found.frames.push(FrameSpan { bytes: start..lines.offset, lines_before });
    };
    found.problem = problem;
    Ok(found)
}

fn is_blank(text: &[u8]) -> bool {
    without_byte_order_mark(text).trim_ascii().is_empty()
}

fn count_of(text: &[u8]) -> Option<usize> {
    std::str::from_utf8(text).ok()?.trim().parse().ok()
}

fn read(frame: &FrameText<'_>, _: &Options) -> Result<Dataset, LoadError> {
    let mut lines = Lines::new(frame.text).skip(1);
    let line_of_count = frame.lines_before + 2;
    let declared = lines.next().and_then(count_of).unwrap_or_default();
    // Finding the frame has counted its lines, so that there are as many as it declares.
    let mut reader = Reader { atoms: Atoms::with_capacity(declared), ..Reader::default() };
    let mut line = line_of_count;
    for text in lines.by_ref().take(declared) {
        line += 1;
        reader.take(line, text)?;
    }
    let cell = cell_of(line + 1, lines.next().unwrap_or_default(), (line_of_count, declared))?;
    let Reader { atoms, velocities, longer, .. } = reader;
    let mut loaded = atoms.into_loaded();
    loaded.columns.retain(|column| ["species", "name", "residue", "residue_number"].contains(&column.name.as_str()));
    if !velocities.is_empty() {
        loaded.columns.extend(trr::columns("velocity", &velocities, ANGSTROMS));
    }
    loaded.cell = cell;
    if let Some((line, first)) = longer {
        loaded.notes.push(format!(
            "text from column {first} on is not used, such as on line {line}; three positions and perhaps three \
             velocities belong there"
        ));
    }
    Ok(loaded)
}

/// The state of reading after some atoms.
#[derive(Default)]
struct Reader {
    atoms: Atoms,
    /// Three velocities of each atom, in nm/ps, if the first atom has them.
    velocities: Vec<f64>,
    /// Columns of each position and velocity, and the number of these fields, as the first atom has them.
    layout: Option<(usize, usize)>,
    /// Line with text after its last field, and the column where the text may begin.
    longer: Option<(usize, usize)>,
}

impl Reader {
    fn take(&mut self, line: usize, text: &[u8]) -> Result<(), LoadError> {
        let (width, fields) = match self.layout {
            Some(layout) => layout,
            None => *self.layout.insert(layout_of(line, text)?),
        };
        let residue_number = residue_number(text).ok_or_else(|| {
            let message = "the residue number must be a whole number".to_owned();
            LoadError::at(Place::Columns { line, first: 1, last: 5 }, message)
        })?;
        if let Some(byte) = text.iter().take(BEFORE).find(|byte| !byte.is_ascii()) {
            let message = format!("the byte 0x{byte:02x} is not ASCII; names of residues and atoms must be ASCII text");
            return Err(LoadError::line(line, message));
        }
        let mut values = [0.0; 6];
        for (index, value) in values.iter_mut().enumerate().take(fields) {
            let (first, last) = (BEFORE + index * width, BEFORE + (index + 1) * width);
            let field = between(text, first, last).trim_ascii();
            let parsed = number(field).filter(|number| (number * ANGSTROMS).is_finite());
            *value = parsed.ok_or_else(|| {
                let found = match field {
                    b"" => "blank".to_owned(),
                    _ => format!("`{}`", shortened(&String::from_utf8_lossy(field))),
                };
                let place = Place::Columns { line, first: first + 1, last };
                LoadError::at(place, format!("the {} is {found}; a finite number belongs there", FIELDS[index]))
            })?;
        }
        let end = BEFORE + fields * width;
        if self.longer.is_none() && !between(text, end, text.len()).trim_ascii().is_empty() {
            self.longer = Some((line, end + 1));
        }
        let [x, y, z, velocity @ ..] = values;
        if fields == values.len() {
            self.velocities.extend(velocity);
        }
        let residue = between(text, 5, 10).trim_ascii();
        let name = between(text, 10, 15).trim_ascii();
        let (name_field, symbol) = unaligned(name, residue);
        self.atoms.push(&Atom {
            place: [x, y, z].map(|length| length * ANGSTROMS),
            occupancy: 1.0,
            b_factor: 0.0,
            residue_number,
            name,
            name_field,
            symbol,
            residue,
            chain: b"",
            record: b"",
            entity: None,
            docking: None,
            letter: b' ',
            insertion: b' ',
            serial: f64::NAN,
        });
        Ok(())
    }
}

/// The bytes between two columns, counted from 0; fewer if the line ends before.
fn between(text: &[u8], first: usize, last: usize) -> &[u8] {
    text.get(first..last.min(text.len())).unwrap_or_default()
}

fn residue_number(text: &[u8]) -> Option<f64> {
    let field = std::str::from_utf8(between(text, 0, 5)).ok()?;
    field.trim().parse::<i32>().ok().map(f64::from)
}

/// Columns of each position: the distance between the decimal points of x, y and z, which must be the same twice.
fn width_of(text: &[u8]) -> Option<usize> {
    let mut dots = memchr::memchr_iter(b'.', text.get(BEFORE..)?);
    let (x, y, z) = (dots.next()?, dots.next()?, dots.next()?);
    (y - x == z - y && x < y - x).then_some(y - x)
}

/// Columns of each position and velocity, and the number of these fields, from the line of the first atom.
fn layout_of(line: usize, text: &[u8]) -> Result<(usize, usize), LoadError> {
    let Some(width) = width_of(text) else {
        let message = "the decimal points of x, y and z must have the same distance from each other, from column 21 on, \
                       as in a line that GROMACS writes";
        return Err(LoadError::line(line, message));
    };
    let is_number = |index: usize| {
        let first = BEFORE + index * width;
        number(between(text, first, first + width).trim_ascii()).is_some()
    };
    // GROMACS does not say that there are velocities; the numbers do.
    Ok((width, if (3..6).all(is_number) { 6 } else { 3 }))
}

/// The edges of the box in Å; `None` if they are 0, which means no box. The lengths along x, y and z may be followed by
/// the other components.
fn cell_of(
    line: usize,
    text: &[u8],
    (line_of_count, declared): (usize, usize),
) -> Result<Option<[[f64; 3]; 3]>, LoadError> {
    let length = |text| number(text).map(|length| length * ANGSTROMS).filter(|length| length.is_finite());
    let lengths: Option<Vec<f64>> = Values { rest: text }.take(10).map(length).collect();
    let cell = match lengths.as_deref() {
        Some(&[x, y, z]) => [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]],
        Some(&[ax, by, cz, ay, az, bx, bz, cx, cy]) => [[ax, ay, az], [bx, by, bz], [cx, cy, cz]],
        _ => {
            let found = shortened(&String::from_utf8_lossy(text.trim_ascii()));
            let message = format!(
                "`{found}` is not a box; three or nine numbers must follow the number of atoms that line \
                 {line_of_count} declares, which is {declared}"
            );
            return Err(LoadError::line(line, message));
        }
    };
    Ok(cell.as_flattened().iter().any(|length| *length != 0.0).then_some(cell))
}
