//! Reads XYZ and extended XYZ files.
//!
//! A frame of an XYZ file is a line with the number of atoms, a comment line, and a line `species x y z …` for each
//! atom. A trajectory is several frames, one after the other. In an extended XYZ file the comment line names the
//! columns: `Properties=name:type:columns:…`, as ASE and OVITO write it. A property of several numbers is several
//! columns: `forces:R:3` is `forces.x`, `forces.y` and `forces.z`. Names mean the same as in all tables: `species` (or
//! `Z`), `pos`, `radius`, `color` and others make spheres, and the rest become columns of [`Dataset`]. `Lattice` is the
//! cell, which starts at `Origin`. Lengths are taken as they are, in Å.

use std::io;

use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, LoadErrorKind};
use crate::load::format::{FrameIndex, FrameSpan, FrameText, Frames, Options, read_from_memory};
use crate::load::numbers::component_names;
use crate::load::numbers::number;
use crate::load::rows::{self, Field, Kind, Lines, Rows, Values};
use crate::load::source::LineReader;
use crate::load::table::Table;
use pinhole::internals::text::{one_line, shortened, without_byte_order_mark};

/// Reads one frame, counted from 0.
///
/// The lines of other frames are counted but not checked.
///
/// # Errors
/// Returns an error if the text is not a valid XYZ file, or has no such frame.
pub fn read(bytes: &[u8], frame: usize) -> Result<Dataset, LoadError> {
    read_from_memory(bytes, FRAMES, &Options::default().with_frame(frame), None)
}

/// Whether the first line that is not blank is a number, as in an XYZ file.
pub(super) fn starts(bytes: &[u8]) -> bool {
    let bytes = without_byte_order_mark(bytes);
    let first = bytes.trim_ascii_start().split(|byte| *byte == b'\n').next().unwrap_or_default();
    let first = first.trim_ascii_end();
    !first.is_empty() && first.iter().all(u8::is_ascii_digit)
}

pub(super) const FRAMES: Frames = Frames::Lines { find, read: read_frame };

/// Finds frames by their numbers of atoms. The lines of atoms are only counted.
fn find(lines: &mut LineReader<'_>, last: Option<usize>) -> io::Result<FrameIndex> {
    let mut found = FrameIndex::default();
    // The last frame, its line, and its number of atoms.
    let mut previous: Option<(usize, usize, usize)> = None;
    let problem = loop {
        let (start, lines_before, index) = (lines.offset, lines.line, found.frames.len());
        let Some(text) = lines.next()? else {
            found.is_whole = true;
            break (index == 0)
                .then(|| LoadError::new("the file is empty; an XYZ file starts with the number of its atoms"));
        };
        let text = without_byte_order_mark(text);
        let line = lines_before + 1;
        let Ok(text) = std::str::from_utf8(text).map(str::trim) else {
            let message = "this line is not UTF-8 text; an XYZ file is plain text";
            break Some(LoadError::line(line, message));
        };
        if text.is_empty() {
            continue;
        }
        let Ok(atoms) = text.parse() else {
            let before = previous.map_or_else(String::new, |(index, line, atoms)| {
                format!("; frame {index} before it declares {} on line {line}", counted(atoms))
            });
            let text = shortened(text);
            let what = "is not a valid number of atoms, which must begin a frame";
            break Some(LoadError::line(line, format!("`{text}` {what}{before}")));
        };
        if last.is_some_and(|last| index > last) {
            break None;
        }
        let _comment = lines.skip(1)?;
        let skipped = lines.skip(atoms)?;
        if skipped < atoms {
            let declared = counted(atoms);
            let message = format!("frame {index} declares {declared}, but the file ends after {skipped}");
            break Some(LoadError::line(line, message));
        }
        found.frames.push(FrameSpan { bytes: start..lines.offset, lines_before });
        previous = Some((index, line, atoms));
    };
    found.problem = problem;
    Ok(found)
}

/// A number of atoms in words.
pub(super) fn counted(atoms: usize) -> String {
    if atoms == 1 { "1 atom".to_owned() } else { format!("{atoms} atoms") }
}

fn read_frame(frame: &FrameText<'_>, options: &Options) -> Result<Dataset, LoadError> {
    let mut lines = Lines::new(without_byte_order_mark(frame.text));
    let mut lines_before = frame.lines_before;
    // Blank lines may come before the number of atoms.
    for head in lines.by_ref() {
        lines_before += 1;
        if !head.trim_ascii().is_empty() {
            break;
        }
    }
    // The comment may have any encoding; the used part is ASCII.
    let comment = String::from_utf8_lossy(lines.next().unwrap_or_default());
    lines_before += 1;
    let refused = |message: String| LoadError::line(lines_before, one_line(&message));
    let declared = Columns::of_comment(&comment).map_err(refused)?;
    let cell = cell_of(&comment).map_err(refused)?;
    let periodic = periodic_of(&comment).map_err(refused)?;
    let origin = origin_of(&comment).map_err(refused)?;
    let rows = Rows { text: lines.rest, lines_before, may_be_longer: declared.is_plain };
    let table = Table { columns: rows.read(&declared.fields)? };
    let columns = table.names();
    let mut loaded =
        rows::into_loaded(table, options, |row| lines_before + row + 1).map_err(|error| match error.kind {
            LoadErrorKind::NoPositions => {
                refused(format!("Properties has no pos:R:3, which must name the positions; its columns are {columns}"))
                    .of_kind(error.kind)
            }
            _ => error,
        })?;
    loaded.cell = cell;
    loaded.cell_origin = origin.filter(|_| cell.is_some()).unwrap_or_default();
    loaded.is_periodic = periodic;
    let values = Lines::new(lines.rest).next().map_or(0, |line| Values { rest: line }.count());
    if declared.is_plain && values > declared.fields.len() {
        loaded.notes.push(format!(
            "columns 5 to {values} are not used, because the file does not name them; line {lines_before} can do so with \
             Properties=species:S:1:pos:R:3:NAME:R:1"
        ));
    }
    Ok(loaded)
}

/// The columns of the lines of atoms.
struct Columns {
    fields: Vec<Field>,
    /// Whether the comment names no columns, so that lines begin with `species x y z`.
    is_plain: bool,
}

impl Columns {
    fn of_comment(comment: &str) -> Result<Self, String> {
        let Some(properties) = value_of("Properties", comment) else {
            let numbers = ["x", "y", "z"].map(|name| Field::new(name, Kind::Number));
            let species = Field::new("species", Kind::Text);
            return Ok(Self { fields: [species].into_iter().chain(numbers).collect(), is_plain: true });
        };
        let mut fields = Vec::new();
        let mut atomic_numbers = None;
        for property in properties.split(':').collect::<Vec<_>>().chunks(3) {
            let &[name, kind, count] = property else {
                return Err(format!("Properties={} is not a list of name:type:columns triples", shortened(properties)));
            };
            let count: usize = count.parse().map_err(|_| {
                let (count, name) = (shortened(count), shortened(name));
                format!("Properties: `{count}` is not a valid number of columns for {name}")
            })?;
            if let ("z" | "numbers", "I", 1) = (name.to_ascii_lowercase().as_str(), kind, count) {
                atomic_numbers.get_or_insert(fields.len());
            }
            add_fields(name, kind, count, &mut fields)?;
        }
        let has_symbols = fields.iter().any(|field| field.name.to_ascii_lowercase().trim() == "species");
        if let (false, Some(field)) = (has_symbols, atomic_numbers.and_then(|i| fields.get_mut(i))) {
            *field = Field::new("species", Kind::Text);
        }
        Ok(Self { fields, is_plain: false })
    }
}

fn add_fields(name: &str, kind: &str, count: usize, fields: &mut Vec<Field>) -> Result<(), String> {
    /// Maximum number of columns: more than any program writes, and few enough to be listed.
    const MAX_COLUMNS: usize = 1024;
    let kind = match kind {
        "S" | "L" => Kind::Text,
        "R" | "I" => Kind::Number,
        _ => {
            return Err(format!(
                "Properties: {} has the type `{}`, which is none of R, I, S and L",
                shortened(name),
                shortened(kind)
            ));
        }
    };
    let name = shortened(name);
    if count > MAX_COLUMNS - fields.len().min(MAX_COLUMNS) {
        return Err(format!(
            "Properties: with the {count} of {name} there are more columns than {MAX_COLUMNS}, which are the most"
        ));
    }
    fields.extend(component_names(&name, count).into_iter().map(|name| Field::new(name, kind)));
    Ok(())
}

/// Finds the value of `key=value` or `key="value"` in an extended XYZ comment.
fn value_of<'a>(key: &str, comment: &'a str) -> Option<&'a str> {
    let mut rest = comment;
    loop {
        rest = rest.trim_start();
        if rest.is_empty() {
            return None;
        }
        let name_end = rest.find(|c: char| c == '=' || c.is_whitespace()).unwrap_or(rest.len());
        let name = &rest[..name_end];
        rest = &rest[name_end..];
        let Some(after) = rest.strip_prefix('=') else {
            continue;
        };
        let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''));
        let value = match quote {
            Some(quote) => after[1..].split(quote).next().unwrap_or_default(),
            None => after.split(char::is_whitespace).next().unwrap_or_default(),
        };
        if name.eq_ignore_ascii_case(key) {
            return Some(value);
        }
        let quotes = if quote.is_some() { 2 } else { 0 };
        rest = after.get(value.len() + quotes..).unwrap_or_default();
    }
}

/// The periodic cell of a comment line. `Lattice` has the three edge vectors, one after the other.
fn cell_of(comment: &str) -> Result<Option<[[f64; 3]; 3]>, String> {
    let Some(text) = value_of("Lattice", comment) else {
        return Ok(None);
    };
    match numbers_of(text).as_deref() {
        Some(&[ax, ay, az, bx, by, bz, cx, cy, cz]) => Ok(Some([[ax, ay, az], [bx, by, bz], [cx, cy, cz]])),
        _ => Err(format!("Lattice={} is not a list of nine finite numbers", shortened(text))),
    }
}

/// The corner of the cell, which OVITO writes as `Origin`.
fn origin_of(comment: &str) -> Result<Option<[f64; 3]>, String> {
    let Some(text) = value_of("Origin", comment) else {
        return Ok(None);
    };
    match numbers_of(text).as_deref() {
        Some(&[x, y, z]) => Ok(Some([x, y, z])),
        _ => Err(format!("Origin={} is not a list of three finite numbers", shortened(text))),
    }
}

/// The directions in which the cell repeats: all, unless `pbc` has three values such as `T T F`.
fn periodic_of(comment: &str) -> Result<[bool; 3], String> {
    let Some(text) = value_of("pbc", comment) else {
        return Ok([true; 3]);
    };
    let value = |text: &str| match text {
        "T" | "True" | "true" | "TRUE" | "1" => Some(true),
        "F" | "False" | "false" | "FALSE" | "0" => Some(false),
        _ => None,
    };
    let values =
        text.split(|c: char| c.is_whitespace() || c == ',' || c == '[' || c == ']').filter(|text| !text.is_empty());
    match values.map(value).collect::<Option<Vec<bool>>>().as_deref() {
        Some(&[all]) => Ok([all; 3]),
        Some(&[x, y, z]) => Ok([x, y, z]),
        _ => Err(format!("pbc={} is not a list of three values T or F", shortened(text))),
    }
}

fn numbers_of(text: &str) -> Option<Vec<f64>> {
    let number = |text: &str| number(text.as_bytes()).filter(|number| number.is_finite());
    text.split_whitespace().map(number).collect()
}
