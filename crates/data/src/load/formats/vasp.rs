//! Reads files of VASP: POSCAR and CONTCAR, which have one frame, and XDATCAR, which has several. The pages of these
//! names in the VASP wiki describe them.
//!
//! A header has a comment, the scale, the lattice vectors, the symbols of the elements and the numbers of their atoms.
//! In POSCAR the line `Selective dynamics` may follow, and then `Direct` or `Cartesian` and a line for each atom. In
//! XDATCAR each frame starts with a line such as `Direct configuration= 1`, before which the header may be repeated
//! with another lattice. Lengths are in Å. The columns are `species`, and `movable.x` to `movable.z`, which are 1 or 0,
//! along the lattice vectors, of files with selective dynamics. Velocities are not used.

mod header;

use std::io;

use glam::{DMat3, DVec3};

use crate::load::dataset::{ColumnValues, Dataset, Labels};
use crate::load::error::LoadError;
use crate::load::format::{FrameIndex, FrameSpan, FrameText, Frames, Options};
use crate::load::formats::xyz::counted;
use crate::load::labels::LabelsBuilder;
use crate::load::numbers::{component_names, number};
use crate::load::rows::{self, Field, Kind, Lines, Rows, Values};
use crate::load::source::LineReader;
use crate::load::table::{Table, TableColumn};
use header::Header;
use pinhole::internals::text::{shortened, without_byte_order_mark};

pub(super) const FRAMES: Frames = Frames::Lines { find, read };

/// True if the first lines are a comment, a scale, three vectors, and numbers of atoms, perhaps after symbols.
pub(super) fn starts(bytes: &[u8]) -> bool {
    let mut lines = Lines::new(bytes).skip(1);
    let mut is_numbers = |counts: &[usize]| {
        let line = lines.next().unwrap_or_default();
        counts.contains(&Values { rest: line }.map_while(number).count())
    };
    if !is_numbers(&[1, 3]) || !(0..3).all(|_| is_numbers(&[3])) {
        return false;
    }
    let is_count = |text: &[u8]| text.iter().all(u8::is_ascii_digit);
    let is_counts = |line: &[u8]| !line.trim_ascii().is_empty() && Values { rest: line }.all(is_count);
    lines.take(2).any(is_counts)
}

/// Finds frames by their numbers of atoms. The lines of atoms are only counted.
fn find(lines: &mut LineReader<'_>, last: Option<usize>) -> io::Result<FrameIndex> {
    let mut found = FrameIndex::default();
    found.problem = find_all(lines, last, &mut found).err();
    Ok(found)
}

fn find_all(lines: &mut LineReader<'_>, last: Option<usize>, found: &mut FrameIndex) -> Result<(), LoadError> {
    let mut header = Header::read(&mut || Ok(lines.next()?.map(<[u8]>::to_vec)), 0)?;
    found.head = 0..lines.offset;
    let mut has_own_header = false;
    loop {
        let (start, lines_before, index) = (lines.offset, lines.line, found.frames.len());
        let Some(mut text) = lines.next()?.map(<[u8]>::to_vec) else {
            found.is_whole = true;
            let message = "the file ends before the positions, which begin with Direct or Cartesian";
            return if index == 0 { Err(LoadError::line(header.line, message)) } else { Ok(()) };
        };
        if index > 0 && text.trim_ascii().is_empty() {
            continue;
        }
        if index > 0 && !is_configuration(&text) {
            let mut first = Some(text);
            let mut next = || match first.take() {
                Some(first) => Ok(Some(first)),
                None => Ok(lines.next()?.map(<[u8]>::to_vec)),
            };
            header = Header::read(&mut next, lines_before).map_err(|error| {
                let before = format!("frame {} before this ends after {}", index - 1, counted(header.atoms));
                let message = format!("{}; {before}, and another lattice may follow", error.message);
                LoadError { message, ..error }
            })?;
            has_own_header = true;
            text = lines.next()?.unwrap_or_default().to_vec();
        } else if has_own_header {
            let message = format!("frame {index} has no lattice, although a frame before it has its own");
            return Err(LoadError::line(lines.line, message));
        }
        let is_single = index == 0 && !is_configuration(&text);
        if is_single && is_selective(&text) {
            text = lines.next()?.unwrap_or_default().to_vec();
        }
        Mode::of(&text, lines.line)?;
        if last.is_some_and(|last| index > last) {
            return Ok(());
        }
        let skipped = lines.skip(header.atoms)?;
        if skipped < header.atoms {
            let declared = counted(header.atoms);
            let message = format!("the numbers here are those of {declared}, but frame {index} ends after {skipped}");
            return Err(LoadError::line(header.line, message));
        }
        found.frames.push(FrameSpan { bytes: start..lines.offset, lines_before });
        if is_single {
            found.is_whole = true;
            found.notes.extend(rest_of(lines, &header)?);
            return Ok(());
        }
    }
}

/// Returns a note if anything follows the positions of a POSCAR file, such as velocities.
fn rest_of(lines: &mut LineReader<'_>, header: &Header) -> Result<Option<String>, LoadError> {
    let mut is_next = true;
    while let Some(text) = lines.next()? {
        let first = Values { rest: text }.next();
        // A blank line or a line of text must come before velocities.
        if is_next && first.and_then(number).is_some() {
            let (line, atoms) = (header.line, header.atoms);
            let message = format!("this line follows {}, as many as line {line} declares", counted(atoms));
            return Err(LoadError::line(lines.line, message));
        }
        is_next = false;
        if first.is_some() {
            let line = lines.line;
            return Ok(Some(format!("the lines from {line} on, such as velocities, are not used")));
        }
    }
    Ok(None)
}

/// True for a line that starts a frame of XDATCAR.
fn is_configuration(text: &[u8]) -> bool {
    text.to_ascii_lowercase().windows(13).any(|word| word == b"configuration")
}

fn is_selective(text: &[u8]) -> bool {
    matches!(text.trim_ascii_start().first(), Some(b'S' | b's'))
}

/// The meaning of positions: VASP looks only at the first letter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    /// Fractions of the lattice vectors.
    Direct,
    /// Lengths, which are scaled as the lattice is.
    Cartesian,
}

impl Mode {
    fn of(text: &[u8], line: usize) -> Result<Self, LoadError> {
        match text.trim_ascii_start().first() {
            Some(b'D' | b'd') => Ok(Self::Direct),
            Some(b'C' | b'c' | b'K' | b'k') => Ok(Self::Cartesian),
            _ => {
                let found = shortened(&String::from_utf8_lossy(text.trim_ascii()));
                let message = format!("`{found}` stands where Direct or Cartesian must come before the positions");
                Err(LoadError::line(line, message))
            }
        }
    }
}

fn read(frame: &FrameText<'_>, options: &Options) -> Result<Dataset, LoadError> {
    let header = |lines: &mut Lines<'_>, before| Header::read(&mut || Ok(lines.next().map(<[u8]>::to_vec)), before);
    let mut lines = Lines::new(frame.text);
    let mut lines_before = frame.lines_before;
    let has_own_header = frame.index > 0 && !lines.clone().next().is_some_and(is_configuration);
    let header = if has_own_header {
        let header = header(&mut lines, lines_before)?;
        lines_before = header.line;
        header
    } else {
        header(&mut Lines::new(without_byte_order_mark(frame.head)), 0)?
    };
    let mut text = lines.next().unwrap_or_default();
    lines_before += 1;
    let is_selective = is_selective(text);
    if is_selective {
        text = lines.next().unwrap_or_default();
        lines_before += 1;
    }
    let mode = Mode::of(text, lines_before)?;
    let flags = if is_selective { component_names("movable", 3) } else { Vec::new() };
    let numbers = ["x", "y", "z"].map(|name| Field::new(name, Kind::Number));
    let fields: Vec<Field> =
        numbers.into_iter().chain(flags.into_iter().map(|name| Field::new(name, Kind::Text))).collect();
    let rows = Rows { text: lines.rest, lines_before, may_be_longer: true };
    let mut table = Table { columns: rows.read(&fields)? };
    let line_of = |row| lines_before + row + 1;
    place(&mut table, &header, mode, line_of)?;
    for column in table.columns.iter_mut().skip(3) {
        make_flags(column, line_of)?;
    }
    table.columns.push(TableColumn::labels("species", species(&header.kinds)));
    let mut loaded = rows::into_loaded(table, options, line_of)?;
    loaded.cell = Some(header.edges);
    loaded.notes.extend(header.note.iter().cloned());
    loaded.notes.extend(longer(lines.rest, fields.len(), &header));
    Ok(loaded)
}

/// Makes Cartesian positions in Å.
fn place(table: &mut Table, header: &Header, mode: Mode, line_of: impl Fn(usize) -> usize) -> Result<(), LoadError> {
    let [x, y, z, ..] = table.columns.as_mut_slice() else { return Ok(()) };
    let (ColumnValues::Numbers(x), ColumnValues::Numbers(y), ColumnValues::Numbers(z)) =
        (&mut x.values, &mut y.values, &mut z.values)
    else {
        return Ok(());
    };
    // A header of very long lines is cut off where frames are found.
    if x.len() != header.atoms {
        let message = format!("{} are declared, but the frame has {}", counted(header.atoms), counted(x.len()));
        return Err(LoadError::line(header.line, message));
    }
    for (name, values) in [("x", &*x), ("y", &*y), ("z", &*z)] {
        if let Some(row) = values.iter().position(|value| !value.is_finite()) {
            let message = format!("{name} is {}; a position must be finite", values[row]);
            return Err(LoadError::line(line_of(row), message));
        }
    }
    let matrix = match mode {
        Mode::Direct => DMat3::from_cols_array_2d(&header.edges),
        Mode::Cartesian => DMat3::from_diagonal(DVec3::from_array(header.scale)),
    };
    for ((x, y), z) in x.iter_mut().zip(y).zip(z) {
        [*x, *y, *z] = (matrix * DVec3::new(*x, *y, *z)).to_array();
    }
    Ok(())
}

/// Makes numbers of logical flags: 1 for `T`, and 0 for `F`. Fortran also reads `.TRUE.`.
fn make_flags(column: &mut TableColumn, line_of: impl Fn(usize) -> usize) -> Result<(), LoadError> {
    let ColumnValues::Labels(labels) = &column.values else { return Ok(()) };
    let flag = |name: &String| match name.trim_start_matches('.').bytes().next() {
        Some(b'T' | b't') => Some(1.0),
        Some(b'F' | b'f') => Some(0.0),
        _ => None,
    };
    let flags: Vec<Option<f64>> = labels.names.iter().map(flag).collect();
    let flags_of_rows: Result<Vec<f64>, usize> =
        labels.indices.iter().enumerate().map(|(row, index)| flags[*index as usize].ok_or(row)).collect();
    let numbers = flags_of_rows.map_err(|row| {
        let found = shortened(&labels.names[labels.indices[row] as usize]);
        let message = format!("{} is `{found}`; with selective dynamics T or F must follow the position", column.name);
        LoadError::line(line_of(row), message)
    })?;
    column.values = ColumnValues::Numbers(numbers);
    Ok(())
}

/// The symbol of each atom. There are as many atoms as lines of positions.
fn species(kinds: &[(String, usize)]) -> Labels {
    let mut labels = LabelsBuilder::with_capacity(kinds.iter().map(|(_, count)| count).sum());
    for (symbol, count) in kinds.iter().filter(|(_, count)| *count > 0) {
        let index = labels.index(symbol.as_bytes());
        labels.indices.extend(std::iter::repeat_n(index, *count));
    }
    labels.into_labels()
}

/// A note if there is more in the first line of positions than its fields, but for the symbol of the element.
fn longer(text: &[u8], fields: usize, header: &Header) -> Option<String> {
    let first = Lines::new(text).next().unwrap_or_default();
    let more: Vec<&[u8]> = Values { rest: first }.skip(fields).collect();
    let symbol = header.kinds.iter().find(|(_, count)| *count > 0).map(|(symbol, _)| symbol.as_bytes());
    let is_symbol = more.first().copied() == symbol && more.len() == 1;
    let is_comment = more.first().is_some_and(|word| word.starts_with(b"!") || word.starts_with(b"#"));
    let (first, last) = (fields + 1, fields + more.len());
    (!(more.is_empty() || is_symbol || is_comment)).then(|| {
        format!("the columns {first} to {last} of positions are not used, because a POSCAR file gives them no meaning")
    })
}
