//! Reads tables of text, such as CSV and TSV.
//!
//! Values are separated by commas, tabs, semicolons or white space, depending on the first row. Lines that begin with
//! `#` are comments. The last comment before the first row may have the names of the columns. Names mean the same as in
//! all tables. A missing value (empty, `NaN`, `NA`, `null`) is NaN.

use crate::load::cone_kind::ConeKind;
use crate::load::dataset::{ColumnValues, Dataset};
use crate::load::error::LoadError;
use crate::load::format::Options;
use crate::load::labels::LabelsBuilder;
use crate::load::numbers::number;
use crate::load::rows::{Lines, Values};
use crate::load::table::{Columns, Table, TableColumn};
use crate::load::{rows, table};
use pinhole::internals::text::without_byte_order_mark;

/// Reads a table.
///
/// # Errors
/// Returns an error if columns have no names, rows differ in length, or positions or radii are not numbers.
pub fn read(bytes: &[u8], options: &Options) -> Result<Dataset, LoadError> {
    let text = without_byte_order_mark(bytes);
    let example = |columns| {
        let names = if columns == 3 { "x,y,z" } else { "x,y,z,radius" };
        format!("name its {columns} columns in their order, such as with --columns {names}")
    };
    let first = First::of(text, &options.columns, example)?;
    let table = Table { columns: columns_of(&first, table::must_be_numbers)? };
    let line_of = |wanted: usize| {
        let (mut row, mut line) = (0, 0);
        drop(first.each_row(|number, _| {
            if row == wanted {
                line = number;
            }
            row += 1;
            Ok(())
        }));
        line
    };
    rows::into_loaded(table, options, line_of)
}

/// Reads the columns of a table of cylinders or cones.
pub(in crate::load) fn columns(bytes: &[u8], kind: ConeKind) -> Result<Columns, LoadError> {
    let header = kind.names().join(",").replace('.', "_");
    let first = First::of(without_byte_order_mark(bytes), &[], |_| format!("add one, such as {header}"))?;
    Ok((columns_of(&first, table::is_of_cones)?, Vec::new()))
}

/// Reads all rows. A column is text if any of its values is, which is known only after all rows; they are then read again.
/// Text in a column whose name must be one of numbers is an error.
fn columns_of(first: &First<'_>, must_be_numbers: fn(&str) -> bool) -> Result<Vec<TableColumn>, LoadError> {
    let mut columns: Vec<_> = first.names.iter().map(|name| ColumnBuilder::new(name)).collect();
    if read_rows(first, &mut columns, must_be_numbers)? {
        columns.iter_mut().for_each(ColumnBuilder::clear);
        read_rows(first, &mut columns, must_be_numbers)?;
    }
    let columns = first.names.iter().zip(columns).map(|(name, column)| column.into_column(name));
    Ok(columns.collect())
}

struct ColumnBuilder {
    is_text: bool,
    numbers: Vec<f64>,
    labels: LabelsBuilder,
}

impl ColumnBuilder {
    fn new(name: &str) -> Self {
        let is_text = table::is_element(name);
        Self { is_text, numbers: Vec::new(), labels: LabelsBuilder::default() }
    }

    fn clear(&mut self) {
        self.numbers.clear();
        self.labels = LabelsBuilder::default();
    }

    fn into_column(self, name: &str) -> TableColumn {
        if self.is_text {
            let values = ColumnValues::Labels(self.labels.into_labels());
            return TableColumn { name: name.to_owned(), values, full: None };
        }
        TableColumn::numbers(name, self.numbers)
    }
}

/// Reads all rows. Returns whether a column turned out to be text, so that its values are incomplete.
fn read_rows(
    first: &First<'_>,
    columns: &mut [ColumnBuilder],
    must_be_numbers: fn(&str) -> bool,
) -> Result<bool, LoadError> {
    let declared = columns.len();
    let mut is_new_text = false;
    first.each_row(|line, values| {
        let mut found = 0;
        for value in values {
            let column = found;
            found += 1;
            let Some(builder) = columns.get_mut(column) else { continue };
            if !builder.is_text {
                let parsed = if is_missing(value) { Some(f64::NAN) } else { number(value) };
                if let Some(parsed) = parsed {
                    builder.numbers.push(parsed);
                    continue;
                }
                if must_be_numbers(&first.names[column]) {
                    return Err(rows::not_a_number(value, line, column, &first.names[column]));
                }
                (builder.is_text, is_new_text) = (true, true);
            }
            if !value.is_ascii() && std::str::from_utf8(value).is_err() {
                return Err(rows::not_text(line));
            }
            builder.labels.push(value);
        }
        if found < declared {
            return Err(rows::missing(line, &first.names[found], found, found));
        }
        if found > declared {
            return Err(rows::too_many(line, found, declared));
        }
        Ok(())
    })?;
    Ok(is_new_text)
}

fn is_missing(value: &[u8]) -> bool {
    value.is_empty()
        || [&b"nan"[..], b"na", b"n/a", b"null", b"none"].iter().any(|name| value.eq_ignore_ascii_case(name))
}

impl First<'_> {
    /// Calls a function with the line of each row and its values.
    fn each_row(
        &self,
        mut each: impl FnMut(usize, &mut dyn Iterator<Item = &[u8]>) -> Result<(), LoadError>,
    ) -> Result<(), LoadError> {
        let separator = match self.separator {
            Separator::Byte(separator) => separator,
            Separator::Blank => {
                for (index, line) in Lines::new(self.rows).enumerate() {
                    let line = line.trim_ascii();
                    if !line.is_empty() && !line.starts_with(b"#") {
                        each(self.lines_before + index + 1, &mut Values { rest: line })?;
                    }
                }
                return Ok(());
            }
        };
        let mut reader = ::csv::ReaderBuilder::new()
            .delimiter(separator)
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .trim(::csv::Trim::All)
            .from_reader(self.rows);
        let mut record = ::csv::ByteRecord::new();
        loop {
            let before = reader.position().line() as usize;
            match reader.read_byte_record(&mut record) {
                Ok(true) => {}
                Ok(false) => return Ok(()),
                Err(_) => return Err(rows::not_text(self.lines_before + before)),
            }
            let line = record.position().map_or(before, |position| position.line() as usize);
            // A line with nothing but white space is not a row.
            if record.len() == 1 && record.get(0).is_some_and(<[u8]>::is_empty) {
                continue;
            }
            each(self.lines_before + line, &mut record.iter())?;
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Blank,
    Byte(u8),
}

/// The separator, the names and the place of the rows, from the first lines of a table.
struct First<'a> {
    names: Vec<String>,
    separator: Separator,
    /// The rows, without a header.
    rows: &'a [u8],
    lines_before: usize,
}

#[derive(Clone, Copy)]
struct Line<'a> {
    text: &'a [u8],
    number: usize,
}

impl<'a> First<'a> {
    /// Finds the names, which a header has, or `given`. `advice` says what to do without them, by the number of columns.
    fn of(text: &'a [u8], given: &[String], advice: impl Fn(usize) -> String) -> Result<Self, LoadError> {
        let (comment, first, after) =
            first_line(text).ok_or_else(|| LoadError::new("there are no rows; a table has one on each line"))?;
        let separator = separator_of(first.text);
        let values = values_of(first.text, separator);
        let line = first.number;
        let is_header = values.iter().all(|value| !is_value(value));
        let start = text.len() - after.len();
        let row = &text[..start];
        let rows_with_first = &text[row.len() - line_length(row)..];
        let (names, rows, lines_before) = if is_header {
            // Names that are given take the place of those of the header.
            if !given.is_empty() && given.len() != values.len() {
                let (names, columns) = (given.len(), values.len());
                let message =
                    format!("the table has a header of {columns} names here, but {names} are given; leave them out");
                return Err(LoadError::line(line, message));
            }
            (if given.is_empty() { values } else { given.to_vec() }, after, line)
        } else if given.is_empty() {
            let comment = comment.map(|comment| comment.text.trim_ascii_start());
            let comment = comment.and_then(|text| text.strip_prefix(b"#"));
            let names = comment.and_then(|comment| {
                let separators = [separator, separator_of(comment), Separator::Blank];
                let mut names = separators.iter().map(|separator| values_of(comment, *separator));
                names.find(|names| names.len() == values.len() && !names.iter().any(|name| is_value(name)))
            });
            let names = names
                .ok_or_else(|| LoadError::line(line, format!("the table has no header; {}", advice(values.len()))))?;
            (names, rows_with_first, line - 1)
        } else {
            if given.len() != values.len() {
                let (names, columns) = (given.len(), values.len());
                let message = format!("there are {names} names of columns, but this row has {columns} values");
                return Err(LoadError::line(line, message));
            }
            (given.to_vec(), rows_with_first, line - 1)
        };
        // A separator at the end of the header leaves a column without a name.
        let named = |(index, name): (usize, String)| {
            if name.is_empty() { format!("column {}", index + 1) } else { name }
        };
        let names = names.into_iter().enumerate().map(named).collect();
        Ok(Self { names, separator, rows, lines_before })
    }
}

/// Whether the first lines have names of positions, or a few numbers in each line.
pub(super) fn starts(bytes: &[u8]) -> bool {
    let text = without_byte_order_mark(bytes);
    let is_text = |text: &[u8]| !text.iter().any(|byte| *byte < b' ' && !byte.is_ascii_whitespace());
    if !is_text(text) {
        return false;
    }
    if let Ok(first) = First::of(text, &[], |_| String::new()) {
        return table::has_positions(&first.names);
    }
    let lines = Lines::new(text).map(<[u8]>::trim_ascii).filter(|line| !line.is_empty() && !line.starts_with(b"#"));
    // The last line may be incomplete.
    let mut rows = lines.take(2).map(|line| values_of(line, separator_of(line)));
    rows.next().is_some_and(|first| {
        let all_numbers = |row: &[String]| row.len() >= 3 && row.iter().all(|value| number(value.as_bytes()).is_some());
        all_numbers(&first) && rows.next().is_some_and(|second| all_numbers(&second) && second.len() == first.len())
    })
}

/// Returns the last comment before the first row, this row, which is not blank, and the text after it.
fn first_line(text: &[u8]) -> Option<(Option<Line<'_>>, Line<'_>, &[u8])> {
    let mut lines = Lines::new(text);
    let (mut comment, mut number) = (None, 0);
    while let Some(text) = lines.next() {
        number += 1;
        let content = text.trim_ascii();
        if content.starts_with(b"#") {
            comment = Some(Line { text, number });
        } else if !content.is_empty() {
            return Some((comment, Line { text, number }, lines.rest));
        }
    }
    None
}

/// Number of bytes of the last line, with its line end.
fn line_length(text: &[u8]) -> usize {
    let inner = text.strip_suffix(b"\n").unwrap_or(text);
    text.len() - memchr::memrchr(b'\n', inner).map_or(0, |end| end + 1)
}

fn separator_of(line: &[u8]) -> Separator {
    let separator = [b'\t', b';', b','].into_iter().find(|byte| line.trim_ascii().contains(byte));
    separator.map_or(Separator::Blank, Separator::Byte)
}

fn values_of(line: &[u8], separator: Separator) -> Vec<String> {
    let text = |value: &[u8]| String::from_utf8_lossy(value).trim().to_owned();
    match separator {
        Separator::Blank => Values { rest: line }.map(text).collect(),
        Separator::Byte(separator) => {
            let mut reader =
                ::csv::ReaderBuilder::new().delimiter(separator).has_headers(false).flexible(true).from_reader(line);
            let mut record = ::csv::ByteRecord::new();
            match reader.read_byte_record(&mut record) {
                Ok(true) => record.iter().map(text).collect(),
                _ => Vec::new(),
            }
        }
    }
}

fn is_value(text: &str) -> bool {
    number(text.as_bytes()).is_some()
}
