//! Reads dumps: text in which each frame has a step, a number of atoms, a box, and a line for each atom.

use std::io;

use super::{Cell, Shape, by_id, periodic_of, repeated_ids, too_few_atoms, wrong_text};
use crate::load::dataset::{ColumnValues, Dataset};
use crate::load::elements::appearance;
use crate::load::error::{LoadError, LoadErrorKind};
use crate::load::format::{FrameIndex, FrameSpan, FrameText, Frames, Options};
use crate::load::numbers::number;
use crate::load::rows::{Field, Kind, Lines, Rows, Values};
use crate::load::source::LineReader;
use crate::load::table::{Table, TableColumn};
use crate::load::{rows, table};
use pinhole::internals::text::without_byte_order_mark;

pub(crate) const FRAMES: Frames = Frames::Lines { find, read };

/// Names of positions, in the order in which they are preferred, and whether they are fractions of the box.
const POSITIONS: [([&str; 3], bool); 4] =
    [(["x", "y", "z"], false), (["xu", "yu", "zu"], false), (["xs", "ys", "zs"], true), (["xsu", "ysu", "zsu"], true)];

/// Whether the first item is one with which a dump begins.
pub(crate) fn starts(bytes: &[u8]) -> bool {
    let bytes = without_byte_order_mark(bytes).trim_ascii_start();
    [&b"ITEM: TIMESTEP"[..], b"ITEM: UNITS", b"ITEM: TIME"].iter().any(|item| bytes.starts_with(item))
}

/// Finds frames by their items. The lines of atoms are only counted.
fn find(lines: &mut LineReader<'_>, last: Option<usize>) -> io::Result<FrameIndex> {
    let mut found = FrameIndex::default();
    let (mut first, mut atoms, mut previous) = (None, None, None);
    let problem = loop {
        let (offset, lines_before) = (lines.offset, lines.line);
        let line = lines_before + 1;
        let Some(text) = lines.next()? else {
            found.is_whole = true;
            break match first {
                Some((_, before)) => Some(cut_off(before + 1)),
                None => found
                    .frames
                    .is_empty()
                    .then(|| LoadError::new("the file is empty; a dump of LAMMPS starts with ITEM: TIMESTEP")),
            };
        };
        let text = String::from_utf8_lossy(without_byte_order_mark(text).trim_ascii()).into_owned();
        if text.is_empty() {
            continue;
        }
        let Some(item) = text.strip_prefix("ITEM:").map(str::trim) else {
            let before = previous.map_or_else(String::new, |(line, atoms): (usize, usize)| {
                format!("; the frame before it declares {atoms} atoms on line {line}")
            });
            let what = format!("stands where ITEM: must begin an item{before}");
            break Some(wrong_text(line, text.as_bytes(), &what));
        };
        if last.is_some_and(|last| found.frames.len() > last) {
            break None;
        }
        let (start, before) = *first.get_or_insert((offset, lines_before));
        match item {
            "UNITS" | "TIME" | "TIMESTEP" => drop(lines.skip(1)?),
            "NUMBER OF ATOMS" => {
                let line = line + 1;
                let text = String::from_utf8_lossy(lines.next()?.unwrap_or_default()).into_owned();
                let Ok(count) = text.trim().parse::<usize>() else {
                    break Some(wrong_text(line, text.as_bytes(), "is not a valid number of atoms"));
                };
                atoms = Some((line, count));
            }
            _ if item.starts_with("BOX BOUNDS") => drop(lines.skip(3)?),
            _ if item == "ATOMS" || item.starts_with("ATOMS ") => {
                let Some((declared_on, declared)) = atoms.take() else {
                    break Some(missing(line, "ITEM: NUMBER OF ATOMS"));
                };
                let skipped = lines.skip(declared)?;
                if skipped < declared {
                    break Some(too_few_atoms(declared_on, declared, skipped));
                }
                found.frames.push(FrameSpan { bytes: start..lines.offset, lines_before: before });
                previous = Some((declared_on, declared));
                first = None;
            }
            _ => {
                let what = "is not an item of a dump of atoms";
                break Some(wrong_text(line, text.as_bytes(), what));
            }
        }
    };
    found.problem = problem;
    Ok(found)
}

fn read(frame: &FrameText<'_>, options: &Options) -> Result<Dataset, LoadError> {
    let mut lines = Lines::new(without_byte_order_mark(frame.text));
    let mut line = frame.lines_before;
    let (mut cell, mut is_periodic) = (None, [true; 3]);
    let names = loop {
        let Some(text) = lines.next() else {
            return Err(cut_off(frame.lines_before + 1));
        };
        line += 1;
        let text = String::from_utf8_lossy(text.trim_ascii());
        let item = text.strip_prefix("ITEM:").map(str::trim).unwrap_or_default();
        if item.starts_with("BOX BOUNDS") {
            let shape = Shape::of_item(item);
            is_periodic = periodic_of(item);
            let bounds = [(); 3].map(|()| lines.next().unwrap_or_default());
            cell = Some(Cell::of_dump(shape, bounds).map_err(|index| {
                let what = format!("is not a line of the box; {}", shape.values());
                wrong_text(line + index + 1, bounds[index], &what)
            })?);
            line += 3;
        } else if let Some(names) = item.strip_prefix("ATOMS") {
            break names.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        }
    };
    let cell = cell.ok_or_else(|| missing(line, "ITEM: BOX BOUNDS"))?;
    let names = match (names.is_empty(), options.columns.is_empty()) {
        (false, true) => names,
        (true, false) => options.columns.clone(),
        (true, true) => {
            let message = "the columns have no names; name them in the order of the file, such as with --columns \
                           id,type,xs,ys,zs";
            return Err(LoadError::line(line, message));
        }
        (false, false) => {
            let message = "the file names its columns; remove the names that are given";
            return Err(LoadError::line(line, message));
        }
    };
    let rows = Rows { text: lines.rest, lines_before: line, may_be_longer: false };
    let mut table = Table { columns: rows.read(&fields(names, lines.rest))? };
    make_positions(&mut table, &cell);
    let is_noted = types_as_elements(&mut table);
    let order = by_id(&mut table);
    let repeated = repeated_ids(&table);
    let line_of = |row| line + 1 + order.as_ref().map_or(row, |order| order[row] as usize);
    let columns = table.names();
    let mut loaded = rows::into_loaded(table, options, line_of).map_err(|error| match error.kind {
        LoadErrorKind::NoPositions => {
            let message = format!(
                "there are no positions among the columns {columns}; they are x y z, xu yu zu, xs ys zs or xsu ysu zsu"
            );
            LoadError::line(line, message).of_kind(error.kind)
        }
        _ => error,
    })?;
    (loaded.cell, loaded.cell_origin, loaded.is_periodic) = (Some(cell.edges), cell.origin, is_periodic);
    loaded.notes.extend(repeated);
    if is_noted {
        loaded.notes.push("the types are the symbols of chemical elements, and are taken as such".to_owned());
    }
    Ok(loaded)
}

/// The error of a file that ends within the frame that begins in this line.
fn cut_off(line: usize) -> LoadError {
    LoadError::line(line, "the file ends within the frame that begins here, before its atoms")
}

fn missing(line: usize, item: &str) -> LoadError {
    LoadError::line(line, format!("{item} is missing before ITEM: ATOMS"))
}

/// Chooses the kinds of the columns. Types are always text; the first line decides on other columns.
fn fields(names: Vec<String>, text: &[u8]) -> Vec<Field> {
    let first = Lines::new(text).next().unwrap_or_default();
    let mut values = Values { rest: first };
    let kind = |name: &str| {
        let is_number = values.next().is_none_or(|value| number(value).is_some());
        let must_be_number =
            name == "id" || table::must_be_numbers(name) || POSITIONS.iter().any(|(names, _)| names.contains(&name));
        let is_text = matches!(name, "type" | "typelabel" | "element") || !(is_number || must_be_number);
        if is_text { Kind::Text } else { Kind::Number }
    };
    let kinds: Vec<Kind> = names.iter().map(String::as_str).map(kind).collect();
    names.into_iter().zip(kinds).map(|(name, kind)| Field { name, kind }).collect()
}

/// Renames the preferred positions to x, y and z, and converts them if they are fractions of the box.
fn make_positions(table: &mut Table, cell: &Cell) {
    let indices = |names: [&str; 3]| {
        let index = |name| table.columns.iter().position(|column| column.name == name);
        let [x, y, z] = names.map(index);
        Some([x?, y?, z?])
    };
    let found = POSITIONS.iter().find_map(|(names, scaled)| Some((indices(*names)?, *scaled)));
    let Some((indices, is_scaled)) = found else { return };
    if is_scaled {
        let numbers = indices.map(|index| match &mut table.columns[index].values {
            ColumnValues::Numbers(numbers) => std::mem::take(numbers),
            ColumnValues::Labels(_) => Vec::new(),
        });
        let [mut x, mut y, mut z] = numbers;
        for ((x, y), z) in x.iter_mut().zip(&mut y).zip(&mut z) {
            [*x, *y, *z] = cell.place([*x, *y, *z]);
        }
        for (index, numbers) in indices.into_iter().zip([x, y, z]) {
            if let ColumnValues::Numbers(values) = &mut table.columns[index].values {
                *values = numbers;
            }
        }
    }
    for (index, name) in indices.into_iter().zip(["x", "y", "z"]) {
        name.clone_into(&mut table.columns[index].name);
    }
}

/// Takes types as chemical elements if there is no column of elements and all types are symbols of elements.
fn types_as_elements(table: &mut Table) -> bool {
    if table.columns.iter().any(|column| column.name == "element") {
        return false;
    }
    let is_symbol = |name: &String| name.parse::<f64>().is_err() && appearance(name).is_element;
    let types = table.columns.iter().find_map(|column| match &column.values {
        ColumnValues::Labels(labels) if ["type", "typelabel"].contains(&column.name.as_str()) => {
            let all = !labels.names.is_empty() && labels.names.iter().all(is_symbol);
            all.then(|| labels.clone())
        }
        _ => None,
    });
    let species = types.map(|types| TableColumn::labels("species", types));
    let is_found = species.is_some();
    table.columns.extend(species);
    is_found
}
