//! Reads data files: a header with counts and the box, and sections, of which the atoms and what their types are make
//! spheres.

use std::collections::HashMap;

use super::cell::Cell;
use super::elements::{self, Types};
use super::styles::fields_of;
use super::{order, too_few_atoms, wrong_text};
use crate::load::error::LoadError;
use crate::load::format::Options;
use crate::load::loaded::{ColumnValues, Loaded};
use crate::load::rows::{self, Field, Kind, Lines, Rows, Values, number};
use crate::load::table::Table;
use crate::text::{shortened, without_byte_order_mark};

/// Whether one of the first lines declares a number of atoms.
pub(in crate::load) fn starts(bytes: &[u8]) -> bool {
    let lines = Lines::new(without_byte_order_mark(bytes)).skip(1).take(20);
    lines
        .map(without_comment)
        .any(|line| count_of(line, b"atoms").is_some_and(|count| count.is_ok()))
}

/// Reads a data file.
pub(in crate::load) fn read(bytes: &[u8], options: &Options) -> Result<Loaded, LoadError> {
    let mut file = File::new(without_byte_order_mark(bytes));
    // The first line is a comment, whatever it is.
    file.next();
    let (mut count, mut ends, mut tilt) = (None, [None; 3], [0.0; 3]);
    let (mut atoms, mut velocities, mut types) = (None, None, Types::default());
    let mut lines_of_sections = HashMap::new();
    while let Some(text) = file.next() {
        let line = file.line;
        let content = without_comment(text);
        if content.is_empty() {
            continue;
        }
        let invalid = || wrong_text(line, content, "cannot be read");
        if !is_section(content) {
            if atoms.is_some() {
                let (line_of_count, declared) = count.unwrap_or_default();
                let what = format!(
                    "stands where a section must begin; {declared} atoms are declared on line {line_of_count}"
                );
                return Err(wrong_text(line, content, &what));
            }
            if let Some(atoms) = count_of(content, b"atoms") {
                let invalid =
                    |text: &[u8]| wrong_text(line, text, "is not a valid number of atoms");
                count = Some((line, atoms.map_err(invalid)?));
            } else if let Some(axis) = ["xlo xhi", "ylo yhi", "zlo zhi"]
                .iter()
                .position(|n| content.ends_with(n.as_bytes()))
            {
                let [low, high] = numbers_of(content).ok_or_else(invalid)?;
                ends[axis] = Some((low, high));
            } else if content.ends_with(b"xy xz yz") {
                tilt = numbers_of(content).ok_or_else(invalid)?;
            }
            continue;
        }
        // These sections have a line for each atom, so a second one contradicts the first.
        if let Some(section) =
            ["Atoms", "Velocities"].into_iter().find(|name| content == name.as_bytes())
            && let Some(first_line) = lines_of_sections.insert(section, line)
        {
            let message = format!(
                "a second section {section} begins here; the first begins on line {first_line}; remove one of them"
            );
            return Err(LoadError::line(line, message));
        }
        file.skip_blank();
        let mut rows = || {
            let (line_of_count, declared) = count.ok_or_else(|| {
                LoadError::line(line, "a line such as `100 atoms` must come before the atoms")
            })?;
            let too_few = |found| too_few_atoms(line_of_count, declared, found);
            file.take_rows(declared).map_err(too_few)
        };
        match content {
            b"Atoms" => {
                let (rows, style) = (rows()?, comment_of(text));
                atoms = Some((rows, fields_of(rows, style.as_deref(), &options.columns)?));
            }
            b"Velocities" => velocities = Some(rows()?),
            b"Masses" => file.each_pair(|line, name, value| {
                let mass = number(value).filter(|mass| mass.is_finite());
                let mass = mass.ok_or_else(|| {
                    let found = shortened(&String::from_utf8_lossy(value));
                    let message = format!("the mass is `{found}`, which is not a finite number");
                    LoadError::line(line, message)
                })?;
                types.add_mass(String::from_utf8_lossy(name).into_owned(), mass);
                Ok(())
            })?,
            b"Atom Type Labels" => file.each_pair(|_, name, label| {
                let text = |text| String::from_utf8_lossy(text).into_owned();
                types.add_label(text(name), text(label));
                Ok(())
            })?,
            _ => file.skip_section(),
        }
    }
    let Some((rows, fields)) = atoms else {
        return Err(LoadError::new("there is no section Atoms; a data file of LAMMPS has one"));
    };
    let mut table = Table { columns: rows.read(&fields)? };
    let mut notes = Vec::from_iter(elements::name_types(&mut table, &types));
    let order = order::by_id(&mut table);
    if let Some(rows) = velocities {
        notes.extend(add_velocities(&mut table, rows)?);
    }
    let line_of = |row| {
        let row = order.as_ref().map_or(row, |order| order[row] as usize);
        rows.lines_before + row + 1
    };
    let mut loaded = rows::into_loaded(table, options, line_of)?;
    if let [Some(x), Some(y), Some(z)] = ends {
        let cell = Cell::tilted([x.0, y.0, z.0], [x.1, y.1, z.1], tilt);
        (loaded.cell, loaded.cell_origin) = (Some(cell.edges), cell.origin);
    }
    loaded.notes.extend(notes);
    Ok(loaded)
}

/// Adds the velocities of the atoms with the same ids. Returns a note if there are others.
fn add_velocities(table: &mut Table, rows: Rows<'_>) -> Result<Option<String>, LoadError> {
    let fields = ["id", "vx", "vy", "vz"].map(|name| Field::new(name, Kind::Number));
    let rows = Rows { may_be_longer: true, ..rows };
    let mut velocities = Table { columns: rows.read(&fields)? };
    order::by_id(&mut velocities);
    let ids = |table: &Table| {
        let column = table.columns.iter().find(|column| column.name == "id")?;
        match &column.values {
            ColumnValues::Numbers(ids) => Some(ids.clone()),
            ColumnValues::Labels(_) => None,
        }
    };
    if ids(table) != ids(&velocities) {
        return Ok(Some(
            "the velocities are not used, because their ids are not those of the atoms".to_owned(),
        ));
    }
    table.columns.extend(velocities.columns.drain(1..));
    Ok(None)
}

/// The lines of the file, which it counts.
struct File<'a> {
    lines: Lines<'a>,
    line: usize,
}

impl<'a> File<'a> {
    fn new(text: &'a [u8]) -> Self {
        Self { lines: Lines::new(text), line: 0 }
    }

    fn next(&mut self) -> Option<&'a [u8]> {
        let line = self.lines.next()?;
        self.line += 1;
        Some(line)
    }

    /// The next line, without its comment, if it is one of a section.
    fn peek(&self) -> Option<&'a [u8]> {
        let line = without_comment(self.lines.clone().next()?);
        (!line.is_empty() && !is_section(line)).then_some(line)
    }

    fn skip_blank(&mut self) {
        while self.lines.clone().next().is_some_and(|line| without_comment(line).is_empty()) {
            self.next();
        }
    }

    fn skip_section(&mut self) {
        while self.peek().is_some() {
            self.next();
        }
    }

    /// Calls a function with the line and the first two values of each line of a section.
    fn each_pair(
        &mut self,
        mut each: impl FnMut(usize, &[u8], &[u8]) -> Result<(), LoadError>,
    ) -> Result<(), LoadError> {
        while let Some(text) = self.peek() {
            self.next();
            let mut values = Values { rest: text };
            let (Some(first), Some(second)) = (values.next(), values.next()) else {
                return Err(wrong_text(self.line, text, "cannot be read"));
            };
            each(self.line, first, second)?;
        }
        Ok(())
    }

    /// Takes lines, or returns how many there are before the end of the file.
    fn take_rows(&mut self, count: usize) -> Result<Rows<'a>, usize> {
        let (start, lines_before) = (self.lines.rest, self.line);
        for found in 0..count {
            self.next().ok_or(found)?;
        }
        let text = &start[..start.len() - self.lines.rest.len()];
        // A comment may follow the values of any line.
        let may_be_longer = memchr::memchr(b'#', text).is_some();
        Ok(Rows { text, lines_before, may_be_longer })
    }
}

fn without_comment(line: &[u8]) -> &[u8] {
    let end = memchr::memchr(b'#', line).unwrap_or(line.len());
    line[..end].trim_ascii()
}

fn comment_of(line: &[u8]) -> Option<String> {
    let start = memchr::memchr(b'#', line)?;
    let comment = String::from_utf8_lossy(&line[start + 1..]).trim().to_owned();
    (!comment.is_empty()).then_some(comment)
}

fn is_section(line: &[u8]) -> bool {
    const NAMES: [&[u8]; 11] = [
        b"Atoms",
        b"Velocities",
        b"Masses",
        b"Ellipsoids",
        b"Lines",
        b"Triangles",
        b"Bodies",
        b"Bonds",
        b"Angles",
        b"Dihedrals",
        b"Impropers",
    ];
    NAMES.contains(&line) || line.ends_with(b" Coeffs") || line.ends_with(b" Type Labels")
}

/// The number before a word that ends the line, if it ends it.
fn count_of<'a>(line: &'a [u8], word: &[u8]) -> Option<Result<usize, &'a [u8]>> {
    let text = line
        .strip_suffix(word)?
        .strip_suffix(b" ")
        .or_else(|| line.strip_suffix(word)?.strip_suffix(b"\t"))?;
    let text = text.trim_ascii();
    Some(String::from_utf8_lossy(text).parse().map_err(|_| text))
}

fn numbers_of<const COUNT: usize>(line: &[u8]) -> Option<[f64; COUNT]> {
    let mut numbers = [0.0; COUNT];
    let mut values = Values { rest: line };
    for value in &mut numbers {
        *value = values.next().and_then(number).filter(|number| number.is_finite())?;
    }
    Some(numbers)
}
