//! Reads XYZ and extended XYZ.
//!
//! XYZ: a line with the number of atoms, a comment line, then a line `species x y z …` per atom;
//! a trajectory is such frames one after the other. Extended XYZ (the comment line has
//! `Properties=name:type:columns:…`, as ASE and OVITO write it) names the columns; of these `species`
//! (or `Z`), `pos`, `radius` and `color` are used. Lengths are taken as they are, in Å.

use std::collections::HashMap;

use super::elements::{Appearance, appearance, unknown_note};
use super::error::LoadError;
use super::format::Options;
use super::loaded::{Column, ColumnValues, Labels, Loaded};
use crate::image::color::LinearRgb;
use crate::scene::sphere::{Sphere, SphereError};
use crate::scene::sphere_array::SphereArray;
use crate::text::shortened;

/// The atoms of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Atoms {
    /// The centre and radius of each atom, in the order of the file.
    pub spheres: Vec<[f64; 4]>,
    /// The colour of each atom.
    pub colors: Vec<LinearRgb>,
    /// The species of each atom.
    pub species: Labels,
    /// Species that are no chemical element, each once, in order of appearance.
    pub unknown_species: Vec<String>,
}

/// Why a file is no XYZ file, or has no such frame. Lines count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum XyzError {
    /// A frame must start with the number of its atoms.
    #[error("line {line}: `{found}` is no number of atoms{}", after_frame(previous))]
    Count {
        /// Where.
        line: usize,
        /// The line as it is.
        found: String,
        /// The frame before, if there is one.
        previous: Option<DeclaredFrame>,
    },
    /// There is no frame at all.
    #[error("the file is empty; an XYZ file starts with the number of its atoms")]
    Empty,
    /// The file ends before the frame does.
    #[error(
        "line {}: frame {} declares {} atoms, but the file ends after {found}",
        frame.line, frame.index, frame.atoms
    )]
    TooFewAtoms {
        /// The frame.
        frame: DeclaredFrame,
        /// How many atom lines it has.
        found: usize,
    },
    /// An atom's line has too few columns.
    #[error(
        "line {line}: the {what} is missing; the line has {columns} columns (frame {} declares {} atoms on line {})",
        frame.index, frame.atoms, frame.line
    )]
    MissingColumn {
        /// The frame.
        frame: DeclaredFrame,
        /// Where.
        line: usize,
        /// Which value.
        what: &'static str,
        /// How many columns there are.
        columns: usize,
    },
    /// A value is no finite number.
    #[error("line {line}: the {what} is `{found}`, which is no finite number")]
    Number {
        /// Where.
        line: usize,
        /// Which value.
        what: &'static str,
        /// The text as it is.
        found: String,
    },
    /// An atom is out of range.
    #[error("line {line}: atom {atom}: {error}")]
    Sphere {
        /// Where.
        line: usize,
        /// Its number in the frame, from 0.
        atom: usize,
        /// What is wrong with it.
        error: SphereError,
    },
    /// The list of properties of an extended XYZ frame cannot be used.
    #[error("line {line}: {message}")]
    Properties {
        /// Where.
        line: usize,
        /// What is wrong with it.
        message: String,
    },
    /// A line is not UTF-8.
    #[error("line {line}: this is no text; an XYZ file is plain text")]
    NotText {
        /// Where.
        line: usize,
    },
    /// The trajectory is shorter.
    #[error("there is no frame {wanted}; the file has {frames} frames, counted from 0")]
    NoSuchFrame {
        /// The frame that was asked for.
        wanted: usize,
        /// How many there are.
        frames: usize,
    },
}

/// The head of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeclaredFrame {
    /// Number of the frame, from 0.
    pub index: usize,
    /// Where its number of atoms stands.
    pub line: usize,
    /// How many atoms it declares.
    pub atoms: usize,
}

fn after_frame(previous: &Option<DeclaredFrame>) -> String {
    previous.map_or_else(String::new, |frame| {
        format!("; frame {} declares {} atoms on line {}", frame.index, frame.atoms, frame.line)
    })
}

/// Reads one frame, counted from 0.
///
/// What stands before the frame is only counted; the line behind it must be the end or another frame's
/// number of atoms, so that a wrong count is noticed.
///
/// # Errors
/// If the text is no XYZ, or has no such frame.
pub fn read(bytes: &[u8], frame: usize) -> Result<Atoms, XyzError> {
    // Some editors put a byte order mark before UTF-8.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
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

/// Whether the first line is a number, as that of atoms is.
pub(super) fn starts(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let first = bytes.trim_ascii_start().split(|byte| *byte == b'\n').next().unwrap_or_default();
    let first = first.trim_ascii_end();
    !first.is_empty() && first.iter().all(u8::is_ascii_digit)
}

/// Reads one frame, with the colours of its elements.
pub(super) fn load(bytes: &[u8], options: &Options) -> Result<Loaded, LoadError> {
    let Atoms { spheres, colors, species, unknown_species } =
        read(bytes, options.frame.unwrap_or_default())?;
    let mut loaded = Loaded::new(SphereArray::F64(spheres));
    loaded.colors = Some(colors);
    loaded
        .columns
        .push(Column { name: "species".to_owned(), values: ColumnValues::Labels(species) });
    loaded.notes.extend(unknown_note(&unknown_species, " if the file gives none"));
    Ok(loaded)
}

/// Lines of text, counted.
struct Lines<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Lines<'a> {
    /// The next line without its end, not yet checked to be text.
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

/// The head of the next frame, or `None` at the end; blank lines before it are passed over.
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
    // The comment line belongs to the frame, but not to its atoms.
    let _comment = lines.next_bytes();
    for found in 0..frame.atoms {
        lines.next_bytes().ok_or(XyzError::TooFewAtoms { frame, found })?;
    }
    Ok(())
}

fn read_atoms(lines: &mut Lines<'_>, frame: DeclaredFrame) -> Result<Atoms, XyzError> {
    // In whatever encoding; what matters of it is ASCII.
    let comment = String::from_utf8_lossy(lines.next_bytes().unwrap_or_default());
    let columns = Columns::from_comment(&comment)
        .map_err(|message| XyzError::Properties { line: lines.line, message })?;
    let (mut spheres, mut colors) = (Vec::new(), Vec::new());
    let (mut names, mut species_indices) = (Vec::new(), Vec::new());
    let mut unknown_species = Vec::new();
    let mut known: HashMap<&str, (u32, Appearance)> = HashMap::new();
    // Neighbours are often of one species.
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
                // No more than spheres, which are fewer than 2³².
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
    }
    let species = Labels { names, indices: species_indices };
    Ok(Atoms { spheres, colors, species, unknown_species })
}

/// Where an atom's line has what, counted in columns from 0.
struct Columns {
    species: usize,
    position: usize,
    radius: Option<usize>,
    color: Option<usize>,
}

impl Columns {
    fn from_comment(comment: &str) -> Result<Self, String> {
        let Some(properties) = value_of("Properties", comment) else {
            return Ok(Self { species: 0, position: 1, radius: None, color: None });
        };
        let fields: Vec<&str> = properties.split(':').collect();
        let mut column = 0_usize;
        let (mut species, mut position, mut radius, mut color) = (None, None, None, None);
        for field in fields.chunks(3) {
            let &[name, kind, count] = field else {
                return Err(format!(
                    "Properties={} is no list of name:type:columns triples",
                    shortened(properties)
                ));
            };
            let count: usize = count
                .parse()
                .map_err(|_| format!("Properties: `{count}` of {name} is no number of columns"))?;
            match (name.to_ascii_lowercase().as_str(), kind, count) {
                ("species", "S", 1) => species = Some(column),
                // A symbol tells more than a number, wherever it stands.
                ("z" | "numbers", "I", 1) => species = species.or(Some(column)),
                ("pos", "R", 3) => position = Some(column),
                ("radius", "R", 1) => radius = Some(column),
                ("color", "R", 3) => color = Some(column),
                _ => {}
            }
            column = column
                .checked_add(count)
                .ok_or_else(|| format!("Properties: {name} has too many columns"))?;
        }
        Ok(Self {
            species: species.ok_or("Properties has neither species:S:1 nor Z:I:1")?,
            position: position.ok_or("Properties lacks pos:R:3")?,
            radius,
            color,
        })
    }
}

/// The value of `key=value` or `key="value"` in an extended XYZ comment.
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

/// The columns of one line.
struct Atom<'a> {
    frame: DeclaredFrame,
    line: usize,
    values: Vec<&'a str>,
}

impl<'a> Atom<'a> {
    fn text(&self, column: usize, what: &'static str) -> Result<&'a str, XyzError> {
        let Self { frame, line, ref values } = *self;
        let columns = values.len();
        let missing = XyzError::MissingColumn { frame, line, what, columns };
        values.get(column).copied().ok_or(missing)
    }

    fn number(&self, column: usize, what: &'static str) -> Result<f64, XyzError> {
        let text = self.text(column, what)?;
        parse_number(text).ok_or_else(|| XyzError::Number {
            line: self.line,
            what,
            found: shortened(text),
        })
    }

    /// Three display values in [0, 1], as OVITO writes them; they are sRGB.
    fn color(&self, column: usize) -> Result<LinearRgb, XyzError> {
        let mut bytes = [0_u8; 3];
        for (i, byte) in bytes.iter_mut().enumerate() {
            *byte = (self.number(column + i, "color")?.clamp(0.0, 1.0) * 255.0).round() as u8;
        }
        Ok(LinearRgb::from_srgb8(bytes))
    }
}

/// Also with the exponents of Fortran: `1.5D-3`.
fn parse_number(text: &str) -> Option<f64> {
    let number: f64 = text.parse().or_else(|_| text.replace(['d', 'D'], "e").parse()).ok()?;
    number.is_finite().then_some(number)
}
