//! Reads lines of values into columns, on all cores: a row is a line, and white space separates its values.
//!
//! The text is cut into pieces at the ends of lines. The lines of every piece are counted, so that columns are
//! allocated once and every piece writes into its own range of them. The result is the same on any number of cores.

use memchr::{memchr, memchr_iter};

use super::dataset::{Dataset, Labels};
use super::error::{LoadError, Place};
use super::format::Options;
use super::labels::LabelsBuilder;
use super::numbers::number;
use super::table::{Table, TableColumn};
use pinhole::internals::parallel;
use pinhole::internals::text::shortened;
use pinhole::scene::sphere::check;
use pinhole::scene::sphere_array::SphereArray;

/// Number of bytes that one core reads at a time.
const PIECE: usize = 1 << 20;

#[derive(Clone, Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Number,
    Text,
}

impl Field {
    pub(super) fn new(name: impl Into<String>, kind: Kind) -> Self {
        Self { name: name.into(), kind }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Rows<'a> {
    /// The text, in which every line is a row. The last line may lack a line end.
    pub(super) text: &'a [u8],
    /// Number of lines before the text.
    pub(super) lines_before: usize,
    /// Whether a line may have values after those of the fields.
    pub(super) may_be_longer: bool,
}

impl Rows<'_> {
    /// Reads a column for each field that is not skipped.
    pub(super) fn read(self, fields: &[Field]) -> Result<Vec<TableColumn>, LoadError> {
        self.read_in_pieces(fields, PIECE)
    }

    fn read_in_pieces(self, fields: &[Field], size: usize) -> Result<Vec<TableColumn>, LoadError> {
        let texts = pieces(self.text, size);
        let counts = parallel::map_parts(texts.clone(), count_lines);
        let ends: Vec<usize> = counts
            .iter()
            .scan(0, |sum, count| {
                *sum += count;
                Some(*sum)
            })
            .collect();
        let rows = ends.last().copied().unwrap_or_default();
        // A value and its separator take at least two bytes. With less text a row is too short, and with far less the
        // columns would need far more memory than the text.
        if rows.saturating_mul(fields.len()) > 4 * self.text.len() {
            self.check_lengths(fields)?;
        }
        let of_kind = |kind| fields.iter().filter(move |field| field.kind == kind).count();
        let mut numbers = vec![vec![0.0; rows]; of_kind(Kind::Number)];
        let mut indices = vec![vec![0_u32; rows]; of_kind(Kind::Text)];
        let starts = std::iter::once(0).chain(ends.iter().copied());
        let mut parts: Vec<Piece<'_>> = texts
            .into_iter()
            .zip(starts)
            .map(|(text, start)| Piece {
                text,
                lines_before: self.lines_before + start,
                may_be_longer: self.may_be_longer,
                numbers: Vec::new(),
                indices: Vec::new(),
            })
            .collect();
        for column in &mut numbers {
            let slices = parallel::split_mut(column, ends.iter().copied());
            parts.iter_mut().zip(slices).for_each(|(part, slice)| part.numbers.push(slice));
        }
        for column in &mut indices {
            let slices = parallel::split_mut(column, ends.iter().copied());
            parts.iter_mut().zip(slices).for_each(|(part, slice)| part.indices.push(slice));
        }
        // The error names the first of several bad lines.
        let names = parallel::map_parts(parts, |part| part.read(fields)).into_iter().collect::<Result<Vec<_>, _>>()?;
        let mut numbers = numbers.into_iter();
        let mut labels = indices.into_iter().enumerate().map(|(text, indices)| merged(&names, text, indices, &ends));
        let columns = fields.iter().filter_map(|field| match field.kind {
            Kind::Number => Some(TableColumn::numbers(&field.name, numbers.next()?)),
            Kind::Text => Some(TableColumn::labels(&field.name, labels.next()?)),
        });
        Ok(columns.collect())
    }

    /// Refuses the first row that has too few values.
    fn check_lengths(self, fields: &[Field]) -> Result<(), LoadError> {
        for (row, line) in Lines::new(self.text).enumerate() {
            let found = Values { rest: line }.take(fields.len()).count();
            if let Some(field) = fields.get(found) {
                let columns = Values { rest: line }.count();
                return Err(missing(self.lines_before + row + 1, &field.name, found, columns));
            }
        }
        Ok(())
    }
}

/// Cuts a text into pieces of whole lines.
fn pieces(text: &[u8], size: usize) -> Vec<&[u8]> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let least = size.min(rest.len());
        let end = memchr(b'\n', &rest[least..]).map_or(rest.len(), |end| least + end + 1);
        let (piece, after) = rest.split_at(end);
        pieces.push(piece);
        rest = after;
    }
    pieces
}

/// Number of lines, the last of which may lack a line end.
fn count_lines(text: &[u8]) -> usize {
    let is_cut = text.last().is_some_and(|byte| *byte != b'\n');
    memchr_iter(b'\n', text).count() + usize::from(is_cut)
}

/// Some of the lines, and the ranges of columns for their values.
struct Piece<'a> {
    text: &'a [u8],
    lines_before: usize,
    may_be_longer: bool,
    numbers: Vec<&'a mut [f64]>,
    indices: Vec<&'a mut [u32]>,
}

impl Piece<'_> {
    /// Reads all lines, and returns the different texts of each text column. Indices count from 0 in every piece.
    fn read(mut self, fields: &[Field]) -> Result<Vec<Vec<String>>, LoadError> {
        let mut labels: Vec<LabelsBuilder> = self.indices.iter().map(|_| LabelsBuilder::default()).collect();
        for (row, line) in Lines::new(self.text).enumerate() {
            let number = self.lines_before + row + 1;
            let mut values = Values { rest: line };
            let (mut next_number, mut next_text) = (0, 0);
            for (column, field) in fields.iter().enumerate() {
                let Some(value) = values.next() else {
                    let columns = Values { rest: line }.count();
                    return Err(missing(number, &field.name, column, columns));
                };
                match field.kind {
                    Kind::Number => {
                        let parsed = self::number(value);
                        let parsed = parsed.ok_or_else(|| not_a_number(value, number, column, &field.name))?;
                        self.numbers[next_number][row] = parsed;
                        next_number += 1;
                    }
                    Kind::Text => {
                        if !value.is_ascii() && std::str::from_utf8(value).is_err() {
                            return Err(not_text(number));
                        }
                        self.indices[next_text][row] = labels[next_text].index(value);
                        next_text += 1;
                    }
                }
            }
            if !self.may_be_longer && values.next().is_some() {
                let columns = Values { rest: line }.count();
                return Err(too_many(number, columns, fields.len()));
            }
        }
        Ok(labels.into_iter().map(|labels| labels.names).collect())
    }
}

/// The error of a line that has `columns` values, so that the one at the index `column` is missing.
pub(super) fn missing(line: usize, name: &str, column: usize, columns: usize) -> LoadError {
    let (what, column) = (shortened(name), column + 1);
    let values = if columns == 1 { "column" } else { "columns" };
    let message = format!("{what}, which is column {column}, is missing; the line has {columns} {values}");
    LoadError::line(line, message)
}

pub(super) fn too_many(line: usize, columns: usize, declared: usize) -> LoadError {
    let message = format!("this line has {columns} columns, but only {declared} have names");
    LoadError::line(line, message)
}

pub(super) fn not_text(line: usize) -> LoadError {
    LoadError::line(line, "this line is not UTF-8 text, as it must be")
}

/// The error of a value, at the index `column`, that is not a number.
pub(super) fn not_a_number(value: &[u8], line: usize, column: usize, name: &str) -> LoadError {
    let Ok(found) = std::str::from_utf8(value) else { return not_text(line) };
    let (what, found) = (shortened(name), shortened(found));
    let place = Place::Column { line, column: column + 1 };
    LoadError::at(place, format!("{what} is `{found}`, which is not a number"))
}

/// Joins the texts of all pieces, and renumbers the indices.
fn merged(names: &[Vec<Vec<String>>], text: usize, mut indices: Vec<u32>, ends: &[usize]) -> Labels {
    let mut all = LabelsBuilder::default();
    let renumbered: Vec<Vec<u32>> =
        names.iter().map(|piece| piece[text].iter().map(|name| all.index(name.as_bytes())).collect()).collect();
    let slices = parallel::split_mut(&mut indices, ends.iter().copied());
    parallel::for_each(slices.into_iter().zip(renumbered).collect(), |(slice, renumbered)| {
        for index in slice {
            *index = renumbered[*index as usize];
        }
    });
    Labels { names: all.names, indices }
}

#[derive(Clone, Debug)]
pub(super) struct Lines<'a> {
    pub(super) rest: &'a [u8],
}

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { rest: text }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let end = memchr(b'\n', self.rest).unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(end);
        self.rest = rest.get(1..).unwrap_or_default();
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }
}

/// The values of a line, between white space.
#[derive(Clone, Debug)]
pub(super) struct Values<'a> {
    pub(super) rest: &'a [u8],
}

impl<'a> Iterator for Values<'a> {
    type Item = &'a [u8];

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let is_blank = |byte: &u8| *byte <= b' ';
        let start = self.rest.iter().position(|byte| !is_blank(byte))?;
        let rest = &self.rest[start..];
        let end = rest.iter().position(is_blank).unwrap_or(rest.len());
        let (value, rest) = rest.split_at(end);
        self.rest = rest;
        Some(value)
    }
}

/// Makes spheres from a table. An error in a row names the line.
pub(super) fn into_loaded(
    table: Table,
    options: &Options,
    line_of: impl Fn(usize) -> usize,
) -> Result<Dataset, LoadError> {
    let loaded = table.into_loaded(options).map_err(|error| match error.place {
        Place::Row(row) => LoadError { place: Place::Line(line_of(row)), ..error },
        _ => error,
    })?;
    let SphereArray::F64(spheres) = &loaded.spheres else { return Ok(loaded) };
    match spheres.iter().enumerate().find_map(|(row, sphere)| Some((row, check(*sphere).err()?))) {
        Some((row, error)) => Err(LoadError::line(line_of(row), error.to_string())),
        None => Ok(loaded),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::dataset::ColumnValues;

    fn fields() -> Vec<Field> {
        vec![
            Field::new("species", Kind::Text),
            Field::new("x", Kind::Number),
            Field::new("mark", Kind::Text),
            Field::new("y", Kind::Number),
            Field::new("name", Kind::Text),
        ]
    }

    fn rows(text: &str) -> Rows<'_> {
        Rows { text: text.as_bytes(), lines_before: 2, may_be_longer: false }
    }

    fn values(columns: Vec<TableColumn>) -> Vec<(String, ColumnValues)> {
        columns.into_iter().map(|column| (column.name, column.values)).collect()
    }

    /// Columns with a row for each of these lines would take 80 GB.
    #[test]
    fn short_lines_of_many_columns_take_little_memory() {
        let fields = vec![Field::new("a", Kind::Number); 100_000];
        let lines = "1\n".repeat(100_000);
        let error = rows(&lines).read(&fields).map(drop).unwrap_err();
        assert_eq!(error, missing(3, "a", 1, 1));
    }

    #[test]
    fn pieces_are_joined_in_order() {
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..50 {
            let mut wanted = (Vec::new(), Vec::new());
            let text: String = (0..random.usize(..60))
                .map(|_| {
                    let (x, name) = (random.f64(), random.u8(..9));
                    wanted.0.push(x);
                    wanted.1.push(format!("a_rather_long_name_{name}"));
                    format!(" H{}\t{x} - 1e-3  a_rather_long_name_{name} \r\n", random.bool())
                })
                .collect();
            let text = text.trim_end_matches('\n');
            let whole = values(rows(text).read(&fields()).unwrap());
            for size in [1, 7, 100, 1 << 20] {
                assert_eq!(values(rows(text).read_in_pieces(&fields(), size).unwrap()), whole);
            }
            let names: Vec<&str> = whole.iter().map(|(name, _)| name.as_str()).collect();
            assert_eq!(names, ["species", "x", "mark", "y", "name"]);
            assert_eq!(whole[1].1, ColumnValues::Numbers(wanted.0));
            let ColumnValues::Labels(labels) = &whole[4].1 else { panic!("no text") };
            let found: Vec<_> = labels.indices.iter().map(|i| labels.names[*i as usize].clone()).collect();
            assert_eq!(found, wanted.1);
        }
    }

    #[test]
    fn the_first_bad_line_is_named() {
        let good = "H 1 2 3 n\n".repeat(20);
        for size in [1, 30, 1 << 20] {
            let refused = |text: &str| rows(text).read_in_pieces(&fields(), size).unwrap_err().to_string();
            assert_eq!(
                refused(&format!("{good}H 1 2 x n\nH z\n{good}H y\n")),
                "line 23, column 4: y is `x`, which is not a number"
            );
            assert_eq!(
                refused(&format!("{good}H 1 2\nH z\n")),
                "line 23: y, which is column 4, is missing; the line has 3 columns"
            );
            assert_eq!(
                refused(&format!("{good}H 1 2 3 n 5 6\n")),
                "line 23: this line has 7 columns, but only 5 have names"
            );
            assert_eq!(
                refused(&format!("{good}\n")),
                "line 23: species, which is column 1, is missing; the line has 0 columns"
            );
        }
        for bad in [&b"H\xff 1 2 3 n"[..], b"H 1 2 \xff n"] {
            let rows = Rows { text: bad, lines_before: 0, may_be_longer: false };
            assert_eq!(rows.read(&fields()).map(drop), Err(not_text(1)));
        }
    }
}
