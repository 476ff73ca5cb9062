//! Looks at the first lines of a table: what separates values, and where names of columns are.

use crate::load::error::LoadError;
use crate::load::rows::{Lines, Values, number};
use crate::load::table;
use crate::text::without_byte_order_mark;

/// What separates the values of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    Blank,
    Byte(u8),
}

/// What the first lines of a table say.
pub(super) struct First<'a> {
    pub(super) names: Vec<String>,
    pub(super) separator: Separator,
    /// The rows, without a header.
    pub(super) rows: &'a [u8],
    pub(super) lines_before: usize,
}

/// A line and its number.
#[derive(Clone, Copy)]
struct Line<'a> {
    text: &'a [u8],
    number: usize,
}

impl<'a> First<'a> {
    pub(super) fn of(text: &'a [u8], given: &[String]) -> Result<Self, LoadError> {
        let (comment, first, after) = first_line(text)
            .ok_or_else(|| LoadError::new("there are no rows; a table has one on each line"))?;
        let separator = separator_of(first.text);
        let values = values_of(first.text, separator);
        let line = first.number;
        let is_header = values.iter().all(|value| !is_value(value));
        let start = text.len() - after.len();
        let row = &text[..start];
        let rows_with_first = &text[row.len() - line_length(row)..];
        let (names, rows, lines_before) = if is_header {
            if !given.is_empty() {
                let message =
                    "the table has a header here; remove the names of columns that are given";
                return Err(LoadError::line(line, message));
            }
            (values, after, line)
        } else if given.is_empty() {
            let comment = comment.map(|comment| comment.text.trim_ascii_start());
            let comment = comment.and_then(|text| text.strip_prefix(b"#"));
            let names = comment.and_then(|comment| {
                let separators = [separator, separator_of(comment), Separator::Blank];
                let mut names = separators.iter().map(|separator| values_of(comment, *separator));
                names.find(|names| {
                    names.len() == values.len() && !names.iter().any(|name| is_value(name))
                })
            });
            let columns = values.len();
            let example = if columns == 3 { "x,y,z" } else { "x,y,z,radius" };
            let names = names.ok_or_else(|| {
                let message = format!(
                    "the table has no header; name its {columns} columns in their order, such as with --columns {example}"
                );
                LoadError::line(line, message)
            })?;
            (names, rows_with_first, line - 1)
        } else {
            if given.len() != values.len() {
                let (names, columns) = (given.len(), values.len());
                let message = format!(
                    "there are {names} names of columns, but this row has {columns} values"
                );
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
pub(in crate::load) fn starts(bytes: &[u8]) -> bool {
    let text = without_byte_order_mark(bytes);
    let is_text =
        |text: &[u8]| !text.iter().any(|byte| *byte < b' ' && !byte.is_ascii_whitespace());
    if !is_text(text) {
        return false;
    }
    if let Ok(first) = First::of(text, &[]) {
        return table::has_positions(&first.names);
    }
    let lines = Lines::new(text)
        .map(<[u8]>::trim_ascii)
        .filter(|line| !line.is_empty() && !line.starts_with(b"#"));
    // The last line may be cut.
    let mut rows = lines.take(2).map(|line| values_of(line, separator_of(line)));
    rows.next().is_some_and(|first| {
        let all_numbers = |row: &[String]| {
            row.len() >= 3 && row.iter().all(|value| number(value.as_bytes()).is_some())
        };
        all_numbers(&first)
            && rows.next().is_some_and(|second| all_numbers(&second) && second.len() == first.len())
    })
}

/// The last comment before the first line that is neither blank nor a comment, this line, and what follows it.
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
            let mut reader = ::csv::ReaderBuilder::new()
                .delimiter(separator)
                .has_headers(false)
                .flexible(true)
                .from_reader(line);
            let mut record = ::csv::ByteRecord::new();
            match reader.read_byte_record(&mut record) {
                Ok(true) => record.iter().map(text).collect(),
                _ => Vec::new(),
            }
        }
    }
}

/// Whether a text is a value rather than a name.
fn is_value(text: &str) -> bool {
    number(text.as_bytes()).is_some()
}
