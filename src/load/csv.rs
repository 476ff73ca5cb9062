//! Reads tables of text, such as CSV and TSV.
//!
//! Values are separated by commas, tabs, semicolons or white space, whichever the first row has. Lines that begin with `#`
//! are comments, and the last comment before the first row may have the names of the columns. What the names mean is the
//! same as in all tables. A value that is missing (empty, `NaN`, `NA`, `null`) is NaN.

mod first;
#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the answers are exact")]
mod tests;

pub(super) use first::starts;
use first::{First, Separator};

use super::error::LoadError;
use super::format::Options;
use super::labels::LabelsBuilder;
use super::loaded::{ColumnValues, Loaded};
use super::rows::{self, Lines, Values, number};
use super::table::{self, Table, TableColumn};
use crate::text::without_byte_order_mark;

/// Reads a table.
///
/// # Errors
/// If the columns have no names, a row has more or fewer values than the others, or positions or radii are not numbers.
pub fn read(bytes: &[u8], options: &Options) -> Result<Loaded, LoadError> {
    let text = without_byte_order_mark(bytes);
    let first = First::of(text, &options.columns)?;
    let mut columns: Vec<Building> = first.names.iter().map(|name| Building::new(name)).collect();
    // A column is of text if any of its values is; that is known after all rows, which are read again then.
    if read_rows(&first, &mut columns)? {
        columns.iter_mut().for_each(Building::clear);
        read_rows(&first, &mut columns)?;
    }
    let columns = first.names.iter().zip(columns).map(|(name, column)| column.into_column(name));
    let table = Table { columns: columns.collect() };
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

/// The values of a column so far.
struct Building {
    is_text: bool,
    numbers: Vec<f64>,
    labels: LabelsBuilder,
}

impl Building {
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

/// Reads all rows. Returns whether a column has turned out to be of text, so that its values are not whole.
fn read_rows(first: &First<'_>, columns: &mut [Building]) -> Result<bool, LoadError> {
    let declared = columns.len();
    let mut is_new_text = false;
    first.each_row(|line, values| {
        let mut found = 0;
        for value in values {
            let column = found;
            found += 1;
            let Some(building) = columns.get_mut(column) else { continue };
            if !building.is_text {
                let parsed = if is_missing(value) { Some(f64::NAN) } else { number(value) };
                if let Some(parsed) = parsed {
                    building.numbers.push(parsed);
                    continue;
                }
                if table::must_be_numbers(&first.names[column]) {
                    return Err(rows::not_a_number(value, line, column, &first.names[column]));
                }
                (building.is_text, is_new_text) = (true, true);
            }
            if !value.is_ascii() && std::str::from_utf8(value).is_err() {
                return Err(rows::not_text(line));
            }
            building.labels.push(value);
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
        || [&b"nan"[..], b"na", b"n/a", b"null", b"none"]
            .iter()
            .any(|name| value.eq_ignore_ascii_case(name))
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
