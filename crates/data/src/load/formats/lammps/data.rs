//! Reads data files: a header with counts and the box, and sections. Spheres are made from the sections with atoms
//! and the descriptions of their types.

use std::collections::HashMap;

use super::types::{Types, name_types};
use super::{Cell, by_id, numbers, too_few_atoms, wrong_text};
use crate::load::bonds::{Numbered, ordered};
use crate::load::dataset::Dataset;
use crate::load::error::LoadError;
use crate::load::format::Options;
use crate::load::numbers::number;
use crate::load::rows::{self, Field, Kind, Lines, Rows, Values};
use crate::load::table::Table;
use pinhole::internals::text::{shortened, without_byte_order_mark};

/// Whether one of the first lines declares a number of atoms.
pub(crate) fn starts(bytes: &[u8]) -> bool {
    let lines = Lines::new(without_byte_order_mark(bytes)).skip(1).take(20);
    lines.map(without_comment).any(|line| count_of(line, b"atoms").is_some_and(|count| count.is_ok()))
}

pub(crate) fn read(bytes: &[u8], options: &Options) -> Result<Dataset, LoadError> {
    let mut file = File { lines: Lines::new(without_byte_order_mark(bytes)), line: 0 };
    // The first line is always a comment.
    file.next();
    let (mut count, mut ends, mut tilt) = (None, [None; 3], [0.0; 3]);
    let (mut atoms, mut velocities, mut bonds, mut types) = (None, None, None, Types::default());
    let (mut bond_count, mut counted) = (None, None);
    let mut lines_of_sections = HashMap::new();
    while let Some(text) = file.next() {
        let line = file.line;
        let content = without_comment(text);
        if content.is_empty() {
            continue;
        }
        let invalid = || wrong_text(line, content, "cannot be read");
        if !is_section(content) {
            if let Some((what, line_of_count, declared)) = counted {
                let what = format!(
                    "stands where a section must begin; {declared} {what} are declared on line {line_of_count}"
                );
                return Err(wrong_text(line, content, &what));
            }
            if let Some(atoms) = count_of(content, b"atoms") {
                let invalid = |text: &[u8]| wrong_text(line, text, "is not a valid number of atoms");
                count = Some((line, atoms.map_err(invalid)?));
            } else if let Some(bonds) = count_of(content, b"bonds") {
                let invalid = |text: &[u8]| wrong_text(line, text, "is not a valid number of bonds");
                bond_count = Some((line, bonds.map_err(invalid)?));
            } else if let Some(axis) =
                ["xlo xhi", "ylo yhi", "zlo zhi"].iter().position(|n| content.ends_with(n.as_bytes()))
            {
                let [low, high] = numbers_of(content).ok_or_else(invalid)?;
                ends[axis] = Some((low, high));
            } else if content.ends_with(b"xy xz yz") {
                tilt = numbers_of(content).ok_or_else(invalid)?;
            }
            continue;
        }
        // These sections have a declared number of lines, so a second section contradicts the first.
        if let Some(section) = ["Atoms", "Velocities", "Bonds"].into_iter().find(|name| content == name.as_bytes())
            && let Some(first_line) = lines_of_sections.insert(section, line)
        {
            let message = format!(
                "a second section {section} begins here; the first begins on line {first_line}; remove one of them"
            );
            return Err(LoadError::line(line, message));
        }
        file.skip_blank();
        let mut rows = || {
            let (line_of_count, declared) =
                count.ok_or_else(|| LoadError::line(line, "a line such as `100 atoms` must come before the atoms"))?;
            let too_few = |found| too_few_atoms(line_of_count, declared, found);
            file.take_rows(declared).map_err(too_few)
        };
        match content {
            b"Atoms" => {
                let (rows, style) = (rows()?, comment_of(text));
                counted = count.map(|(line, declared)| ("atoms", line, declared));
                atoms = Some((rows, fields_of(rows, style.as_deref(), &options.columns)?));
            }
            b"Velocities" => velocities = Some(rows()?),
            b"Bonds" => {
                let (line_of_count, declared) = bond_count.unwrap_or_else(|| (line, file.section_lines()));
                let too_few = |found| {
                    let message = format!("{declared} bonds are declared, but the file ends after {found}");
                    LoadError::line(line_of_count, message)
                };
                bonds = Some(file.take_rows(declared).map_err(too_few)?);
                counted = Some(("bonds", line_of_count, declared));
            }
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
    let mut notes = Vec::from_iter(name_types(&mut table, &types));
    let order = by_id(&mut table);
    let bonds = bonds.map(|rows| bonds_of(&table, rows)).transpose()?;
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
    loaded.has_all_bonds = bonds.is_some();
    loaded.bonds = bonds.unwrap_or_default();
    Ok(loaded)
}

/// Reads bonds, which have an id, a type and the ids of two atoms.
fn bonds_of(table: &Table, rows: Rows<'_>) -> Result<Vec<[u32; 2]>, LoadError> {
    let fields = [("id", Kind::Number), ("type", Kind::Text), ("atom1", Kind::Number), ("atom2", Kind::Number)];
    let columns = Table { columns: rows.read(&fields.map(|(name, kind)| Field::new(name, kind)))? };
    let [first, second] = ["atom1", "atom2"].map(|name| numbers(&columns, name).unwrap_or_default());
    let ids = Numbered::new(numbers(table, "id").unwrap_or_default().iter().map(|id| Some(*id as i64)));
    let pair = |(row, (a, b)): (usize, (&f64, &f64))| ids.pair(rows.lines_before + row + 1, [*a as i64, *b as i64]);
    let pairs: Vec<_> = first.iter().zip(second).enumerate().map(pair).collect::<Result<_, _>>()?;
    Ok(ordered(pairs))
}

/// Adds the velocities of the atoms with the same ids. Returns a note if there are velocities of other ids.
fn add_velocities(table: &mut Table, rows: Rows<'_>) -> Result<Option<String>, LoadError> {
    let fields = ["id", "vx", "vy", "vz"].map(|name| Field::new(name, Kind::Number));
    let rows = Rows { may_be_longer: true, ..rows };
    let mut velocities = Table { columns: rows.read(&fields)? };
    by_id(&mut velocities);
    if numbers(table, "id") != numbers(&velocities, "id") {
        return Ok(Some("the velocities are not used, because their ids are not those of the atoms".to_owned()));
    }
    table.columns.extend(velocities.columns.drain(1..));
    Ok(None)
}

/// The lines of the file, with the number of lines read.
struct File<'a> {
    lines: Lines<'a>,
    line: usize,
}

impl<'a> File<'a> {
    fn next(&mut self) -> Option<&'a [u8]> {
        let line = self.lines.next()?;
        self.line += 1;
        Some(line)
    }

    /// Returns the next line, without its comment, if it belongs to a section.
    fn peek(&self) -> Option<&'a [u8]> {
        let line = without_comment(self.lines.clone().next()?);
        (!line.is_empty() && !is_section(line)).then_some(line)
    }

    fn skip_blank(&mut self) {
        while self.lines.clone().next().is_some_and(|line| without_comment(line).is_empty()) {
            self.next();
        }
    }

    fn section_lines(&self) -> usize {
        let lines = self.lines.clone().map(without_comment);
        lines.take_while(|line| !line.is_empty() && !is_section(line)).count()
    }

    fn skip_section(&mut self) {
        while self.peek().is_some() {
            self.next();
        }
    }

    /// Calls a function for each line of a section, with the line's number and its first two values.
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

    /// Takes this number of lines, or returns how many there are before the end of the file.
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

/// Returns the number before a word that ends the line; `None` if the line does not end with this word.
fn count_of<'a>(line: &'a [u8], word: &[u8]) -> Option<Result<usize, &'a [u8]>> {
    let text = line.strip_suffix(word)?.strip_suffix(b" ").or_else(|| line.strip_suffix(word)?.strip_suffix(b"\t"))?;
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

/// The columns of each style, as the manual's page of `read_data` lists them.
const STYLES: [(&str, &str); 22] = [
    ("angle", "id mol type x y z"),
    ("atomic", "id type x y z"),
    ("body", "id type bodyflag mass x y z"),
    ("bond", "id mol type x y z"),
    ("charge", "id type q x y z"),
    ("dielectric", "id type q x y z mux muy muz area ed em epsilon curvature"),
    ("dipole", "id type q x y z mux muy muz"),
    ("dpd", "id type theta x y z"),
    ("edpd", "id type edpd_temp edpd_cv x y z"),
    ("electron", "id type q espin eradius x y z"),
    ("ellipsoid", "id type ellipsoidflag density x y z"),
    ("full", "id mol type q x y z"),
    ("line", "id mol type lineflag density x y z"),
    ("mdpd", "id type rho x y z"),
    ("molecular", "id mol type x y z"),
    ("peri", "id type volume density x y z"),
    ("rheo", "id type status rho x y z"),
    ("sph", "id type rho esph cv x y z"),
    ("sphere", "id type diameter density x y z"),
    ("spin", "id type x y z spx spy spz sp"),
    ("template", "id type mol template_index template_atom x y z"),
    ("tri", "id mol type triangleflag density x y z"),
];

fn columns_of(style: &str) -> Option<Vec<&'static str>> {
    let (_, columns) = STYLES.iter().find(|(name, _)| *name == style)?;
    Some(columns.split(' ').collect())
}

/// Lists the columns of a style by its name, for messages.
fn listed(style: &str) -> String {
    columns_of(style).unwrap_or_default().join(",")
}

/// Returns the columns of the rows: the given ones, or those of the style, or those of the only style that fits. Three
/// further whole numbers count how often the atom has crossed the box.
fn fields_of(rows: Rows<'_>, style: Option<&str>, given: &[String]) -> Result<Vec<Field>, LoadError> {
    let line = rows.lines_before + 1;
    let first: Vec<&[u8]> = Values { rest: Lines::new(rows.text).next().unwrap_or_default() }
        .take_while(|value| !value.starts_with(b"#"))
        .collect();
    let found = first.len();
    let is_whole = |value: &&[u8]| std::str::from_utf8(value).is_ok_and(|text| text.parse::<i64>().is_ok());
    let has_images = |count: usize| found == count + 3 && first[count..].iter().all(is_whole);
    // The order of a hybrid style's columns follows from the names of its parts; the first part decides.
    let style = style.and_then(|style| style.split_whitespace().next()).map(str::to_owned);
    let names: Vec<String> = if given.is_empty() {
        let columns = match &style {
            Some(style) => columns_of(style).ok_or_else(|| {
                let style = shortened(style);
                let message = format!(
                    "the columns of the style {style} are not known; name them, such as with --columns id,type,x,y,z"
                );
                LoadError::line(line, message)
            })?,
            None if found == 5 || has_images(5) => columns_of("atomic").unwrap_or_default(),
            None if rows.text.is_empty() => columns_of("atomic").unwrap_or_default(),
            None => {
                let message = format!(
                    "atoms have {found} columns, and the file does not say which; name their style, as in `Atoms # full`, \
                     or the columns, as with --columns {}",
                    listed("charge")
                );
                return Err(LoadError::line(line, message));
            }
        };
        columns.into_iter().map(str::to_owned).collect()
    } else {
        given.to_vec()
    };
    let images = if has_images(names.len()) { &["ix", "iy", "iz"][..] } else { &[] };
    if found != names.len() + images.len() && !rows.text.is_empty() {
        let (names, declared) = (names.join(" "), names.len());
        let message = format!(
            "this line has {found} columns, but {declared} have names ({names}); three whole numbers may follow"
        );
        return Err(LoadError::line(line, message));
    }
    let field = |name: &str| {
        let is_text = matches!(name, "type" | "element");
        Field::new(name, if is_text { Kind::Text } else { Kind::Number })
    };
    Ok(names.iter().map(String::as_str).chain(images.iter().copied()).map(field).collect())
}
