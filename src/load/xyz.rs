//! Reads XYZ and extended XYZ files.
//!
//! A frame of an XYZ file is a line with the number of atoms, a comment line, and a line `species x y z …` for each
//! atom. A trajectory is several frames, one after the other. In an extended XYZ file the comment line names the
//! columns: `Properties=name:type:columns:…`, as ASE and OVITO write it. Of these columns `species` (or `Z`), `pos`,
//! `radius` and `color` make the spheres; all others become columns of [`Loaded`], those of several numbers one for each:
//! `forces:R:3` is `forces.x`, `forces.y` and `forces.z`. `Lattice` is the cell. Lengths are taken as they are, in Å.

use std::collections::HashMap;
use std::io;

mod columns;
mod error;

use columns::{OtherColumn, OtherValues, cell_of};
pub use error::{DeclaredFrame, XyzError};

use super::elements::{Appearance, appearance, unknown_note};
use super::error::LoadError;
use super::format::Options;
use super::loaded::{Column, ColumnValues, Labels, Loaded};
use super::trajectory::{FrameIndex, FrameSpan, FrameText, Frames, LineReader};
use crate::image::color::LinearRgb;
use crate::scene::sphere::Sphere;
use crate::scene::sphere_array::SphereArray;
use crate::text::{shortened, without_byte_order_mark};

/// The atoms of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Atoms {
    /// The centre and radius of each atom, in the order of the file.
    pub spheres: Vec<[f64; 4]>,
    /// The colour of each atom.
    pub colors: Vec<LinearRgb>,
    /// The species of each atom.
    pub species: Labels,
    /// Species that are not chemical elements, each once, in order of first appearance.
    pub unknown_species: Vec<String>,
    /// The other columns that the frame declares.
    pub columns: Vec<Column>,
    /// The three edge vectors of the periodic cell, if the frame has one.
    pub cell: Option<[[f64; 3]; 3]>,
}

/// Reads one frame, counted from 0.
///
/// The lines before the frame are counted but not checked. After the frame, the file must end or another frame must
/// begin, so that a wrong number of atoms is noticed.
///
/// # Errors
/// If the text is not a valid XYZ file, or has no such frame.
pub fn read(bytes: &[u8], frame: usize) -> Result<Atoms, XyzError> {
    let bytes = without_byte_order_mark(bytes);
    let mut lines = Lines { rest: bytes, line: 0 };
    let mut previous = None;
    let mut index = 0;
    while let Some(head) = next_head(&mut lines, index, previous)? {
        if index == frame {
            let atoms = read_atoms(&mut lines, head)?;
            next_head(&mut lines, index + 1, Some(head))?;
            return Ok(atoms);
        }
        skip_atoms(&mut lines, head)?;
        previous = Some(head);
        index += 1;
    }
    if index == 0 {
        return Err(XyzError::Empty);
    }
    Err(XyzError::NoSuchFrame { wanted: frame, frames: index })
}

/// Whether the first line that is not blank is a number, as in an XYZ file.
pub(super) fn starts(bytes: &[u8]) -> bool {
    let bytes = without_byte_order_mark(bytes);
    let first = bytes.trim_ascii_start().split(|byte| *byte == b'\n').next().unwrap_or_default();
    let first = first.trim_ascii_end();
    !first.is_empty() && first.iter().all(u8::is_ascii_digit)
}

/// How frames are found and read one by one.
pub(super) const FRAMES: Frames = Frames::Lines { find, read: read_frame };

/// Finds frames by their numbers of atoms; the lines of atoms are only counted.
fn find(lines: &mut LineReader<'_>, last: Option<usize>) -> io::Result<FrameIndex> {
    let mut found = FrameIndex::default();
    let mut previous = None;
    let problem = loop {
        let (start, lines_before, index) = (lines.offset, lines.line, found.frames.len());
        let Some(text) = lines.next()? else {
            found.is_whole = true;
            break (index == 0).then_some(XyzError::Empty);
        };
        let text = without_byte_order_mark(text);
        let line = lines_before + 1;
        let Ok(text) = std::str::from_utf8(text).map(str::trim) else {
            break Some(XyzError::NotText { line });
        };
        if text.is_empty() {
            continue;
        }
        let Ok(atoms) = text.parse() else {
            break Some(XyzError::Count { line, found: shortened(text), previous });
        };
        if last.is_some_and(|last| index > last) {
            break None;
        }
        let frame = DeclaredFrame { index, line, atoms };
        let _comment = lines.skip(1)?;
        let skipped = lines.skip(atoms)?;
        if skipped < atoms {
            break Some(XyzError::TooFewAtoms { frame, found: skipped });
        }
        found.frames.push(FrameSpan { bytes: start..lines.offset, lines_before });
        previous = Some(frame);
    };
    found.problem = problem.map(LoadError::from);
    Ok(found)
}

fn read_frame(frame: &FrameText<'_>, _: &Options) -> Result<Loaded, LoadError> {
    let text = without_byte_order_mark(frame.text);
    let mut lines = Lines { rest: text, line: frame.lines_before };
    let head = next_head(&mut lines, frame.index, None)?.ok_or(XyzError::Empty)?;
    Ok(loaded(read_atoms(&mut lines, head)?))
}

fn loaded(atoms: Atoms) -> Loaded {
    let Atoms { spheres, colors, species, unknown_species, columns, cell } = atoms;
    let mut loaded = Loaded::new(SphereArray::F64(spheres));
    loaded.colors = Some(colors);
    let species = Column { name: "species".to_owned(), values: ColumnValues::Labels(species) };
    loaded.columns = std::iter::once(species).chain(columns).collect();
    loaded.cell = cell;
    loaded.notes.extend(unknown_note(&unknown_species, "the file gives a color or radius or "));
    loaded
}

/// The lines of a text, which it counts.
struct Lines<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Lines<'a> {
    /// Returns the next line without its line end. The bytes may not be valid text.
    fn next_bytes(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.line += 1;
        let end = self.rest.iter().position(|byte| *byte == b'\n');
        let (line, rest) = match end {
            Some(end) => (&self.rest[..end], &self.rest[end + 1..]),
            None => (self.rest, &[][..]),
        };
        self.rest = rest;
        Some(line)
    }

    fn next(&mut self) -> Result<Option<&'a str>, XyzError> {
        let line = self.next_bytes();
        line.map(|bytes| std::str::from_utf8(bytes).map(str::trim))
            .transpose()
            .map_err(|_| XyzError::NotText { line: self.line })
    }
}

/// Reads the first line of the next frame and skips blank lines before it; `None` at the end of the file.
fn next_head(
    lines: &mut Lines<'_>,
    index: usize,
    previous: Option<DeclaredFrame>,
) -> Result<Option<DeclaredFrame>, XyzError> {
    while let Some(text) = lines.next()? {
        if text.is_empty() {
            continue;
        }
        let line = lines.line;
        let atoms =
            text.parse().map_err(|_| XyzError::Count { line, found: shortened(text), previous })?;
        return Ok(Some(DeclaredFrame { index, line, atoms }));
    }
    Ok(None)
}

fn skip_atoms(lines: &mut Lines<'_>, frame: DeclaredFrame) -> Result<(), XyzError> {
    // The comment line is not one of the atoms.
    let _comment = lines.next_bytes();
    for found in 0..frame.atoms {
        lines.next_bytes().ok_or(XyzError::TooFewAtoms { frame, found })?;
    }
    Ok(())
}

fn read_atoms(lines: &mut Lines<'_>, frame: DeclaredFrame) -> Result<Atoms, XyzError> {
    // The comment may have any encoding; the part that is read is ASCII.
    let comment = String::from_utf8_lossy(lines.next_bytes().unwrap_or_default());
    let refused = |message| XyzError::Properties { line: lines.line, message };
    let columns = Columns::from_comment(&comment).map_err(refused)?;
    let cell = cell_of(&comment).map_err(refused)?;
    let mut others: Vec<OtherValues> = columns.others.iter().map(OtherValues::new).collect();
    let (mut spheres, mut colors) = (Vec::new(), Vec::new());
    let (mut names, mut species_indices) = (Vec::new(), Vec::new());
    let mut unknown_species = Vec::new();
    let mut known: HashMap<&str, (u32, Appearance)> = HashMap::new();
    // Consecutive atoms often have the same species.
    let mut last: Option<(&str, (u32, Appearance))> = None;
    for found in 0..frame.atoms {
        let text = lines.next()?.ok_or(XyzError::TooFewAtoms { frame, found })?;
        let values = text.split_whitespace().collect();
        let atom = Atom { frame, line: lines.line, values };
        let species = atom.text(columns.species, "species")?;
        let (index, appearance) = match last {
            Some((name, found)) if name == species => found,
            _ => *known.entry(species).or_insert_with(|| {
                let appearance = appearance(species);
                if !appearance.is_element {
                    unknown_species.push(shortened(species));
                }
                names.push(shortened(species));
                // There are no more names than spheres, which are fewer than 2³².
                (names.len() as u32 - 1, appearance)
            }),
        };
        last = Some((species, (index, appearance)));
        let center = [
            atom.number(columns.position, "x coordinate")?,
            atom.number(columns.position + 1, "y coordinate")?,
            atom.number(columns.position + 2, "z coordinate")?,
        ];
        let radius = match columns.radius {
            Some(column) => atom.number(column, "radius")?,
            None => appearance.radius,
        };
        let color = match columns.color {
            Some(column) => atom.color(column)?,
            None => appearance.color,
        };
        let sphere = Sphere::new(center, radius, color);
        let out_of_range = |error| XyzError::Sphere { line: atom.line, atom: found, error };
        sphere.check().map_err(out_of_range)?;
        let [x, y, z] = center;
        spheres.push([x, y, z, radius]);
        colors.push(color);
        species_indices.push(index);
        for values in &mut others {
            values.push(&atom)?;
        }
    }
    let species = Labels { names, indices: species_indices };
    let columns = others.into_iter().map(OtherValues::into_column).collect();
    Ok(Atoms { spheres, colors, species, unknown_species, columns, cell })
}

/// The columns of an atom's line that hold its values, counted from 0.
struct Columns {
    species: usize,
    position: usize,
    radius: Option<usize>,
    color: Option<usize>,
    others: Vec<OtherColumn>,
}

impl Columns {
    fn from_comment(comment: &str) -> Result<Self, String> {
        let Some(properties) = value_of("Properties", comment) else {
            return Ok(Self {
                species: 0,
                position: 1,
                radius: None,
                color: None,
                others: Vec::new(),
            });
        };
        let fields: Vec<&str> = properties.split(':').collect();
        let mut column = 0_usize;
        let (mut species, mut position, mut radius, mut color) = (None, None, None, None);
        let mut others = Vec::new();
        for field in fields.chunks(3) {
            let &[name, kind, count] = field else {
                return Err(format!(
                    "Properties={} is not a list of name:type:columns triples",
                    shortened(properties)
                ));
            };
            let count: usize = count.parse().map_err(|_| {
                format!("Properties: `{count}` is not a valid number of columns for {name}")
            })?;
            match (name.to_ascii_lowercase().as_str(), kind, count) {
                ("species", "S", 1) => species = Some(column),
                // A column of symbols has precedence over one of atomic numbers, whichever comes first.
                ("z" | "numbers", "I", 1) => species = species.or(Some(column)),
                ("pos", "R", 3) => position = Some(column),
                ("radius", "R", 1) => radius = Some(column),
                ("color", "R", 3) => color = Some(column),
                _ => others.extend(OtherColumn::of_field(name, kind, column, count)?),
            }
            column = column
                .checked_add(count)
                .ok_or_else(|| format!("Properties: {name} has too many columns"))?;
        }
        Ok(Self {
            species: species.ok_or(
                "Properties has neither species:S:1 nor Z:I:1; one of them must name the elements",
            )?,
            position: position.ok_or("Properties has no pos:R:3, which must name the positions")?,
            radius,
            color,
            others,
        })
    }
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

/// The line of an atom, split into columns.
struct Atom<'a> {
    frame: DeclaredFrame,
    line: usize,
    values: Vec<&'a str>,
}

impl<'a> Atom<'a> {
    pub(super) fn text(&self, column: usize, what: &str) -> Result<&'a str, XyzError> {
        let Self { frame, line, ref values } = *self;
        let columns = values.len();
        let missing = || XyzError::MissingColumn { frame, line, what: what.to_owned(), columns };
        values.get(column).copied().ok_or_else(missing)
    }

    pub(super) fn number(&self, column: usize, what: &str) -> Result<f64, XyzError> {
        let text = self.text(column, what)?;
        parse_number(text).ok_or_else(|| XyzError::Number {
            line: self.line,
            what: what.to_owned(),
            found: shortened(text),
        })
    }

    /// Reads a colour: three sRGB values in [0, 1], as OVITO writes them.
    fn color(&self, column: usize) -> Result<LinearRgb, XyzError> {
        let mut bytes = [0_u8; 3];
        for (i, byte) in bytes.iter_mut().enumerate() {
            *byte = (self.number(column + i, "color")?.clamp(0.0, 1.0) * 255.0).round() as u8;
        }
        Ok(LinearRgb::from_srgb8(bytes))
    }
}

/// Parses a finite number, also with an exponent as Fortran writes it: `1.5D-3`.
fn parse_number(text: &str) -> Option<f64> {
    let number: f64 = text.parse().or_else(|_| text.replace(['d', 'D'], "e").parse()).ok()?;
    number.is_finite().then_some(number)
}
