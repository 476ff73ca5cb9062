//! Positions in the text of a scene file, and errors with a position.

use std::fmt;
use std::ops::Range;

use toml::Spanned;

use crate::range::RangeError;

/// An error in a scene file, with its position.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct SceneFileError {
    /// Number of the line, from 1.
    pub line: usize,
    /// Number of the character in the line, from 1.
    pub column: usize,
    /// What is wrong, and what to do about it.
    pub message: String,
}

/// A value and its position in the text.
#[derive(Clone, Copy, Debug)]
pub(super) struct WithSpan<T> {
    pub(super) value: T,
    pub(super) span: Span,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    line: usize,
    column: usize,
}

impl Span {
    /// The start of the file, for errors without a more precise position.
    pub(super) const START: Self = Self { line: 1, column: 1 };

    pub(super) fn error(self, message: impl fmt::Display) -> SceneFileError {
        SceneFileError { line: self.line, column: self.column, message: message.to_string() }
    }
}

/// A text with the offsets of its lines.
pub(super) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        let ends = text.match_indices('\n').map(|(end, _)| end + 1);
        Self { text, starts: std::iter::once(0).chain(ends).collect() }
    }

    /// Returns the line and column of a byte.
    pub(super) fn span(&self, byte: usize) -> Span {
        // At least one line starts at or before any byte.
        let line = self.starts.partition_point(|start| *start <= byte);
        let before = self.text.get(self.starts[line - 1]..byte).unwrap_or_default();
        Span { line, column: before.chars().count() + 1 }
    }

    /// Adds the line and column to a value.
    pub(super) fn spanned<T>(&self, value: Spanned<T>) -> WithSpan<T> {
        WithSpan { span: self.span(value.span().start), value: value.into_inner() }
    }
}

/// A number and its position in bytes.
pub(super) type Number = Spanned<f64>;

/// The numbers of a table by their keys, to find the position of a number that is out of range.
pub(super) struct Keys<'a> {
    pub(super) lines: &'a Lines<'a>,
    pub(super) numbers: Vec<(&'static str, Option<Spanned<f64>>)>,
    /// Position of the table.
    pub(super) table: Span,
}

impl Keys<'_> {
    /// Returns the number of a key, if it is given, and checks that it lies within the bounds.
    pub(super) fn within(
        &self,
        key: &'static str,
        bounds: [f64; 2],
        range: &'static str,
    ) -> Result<Option<f64>, SceneFileError> {
        let Some(number) = self.number(key) else {
            return Ok(None);
        };
        let value = RangeError::unless_within(key, *number.get_ref(), bounds, range);
        value.map(Some).map_err(|error| self.refused(&error))
    }

    fn number(&self, key: &str) -> Option<&Number> {
        self.numbers.iter().find(|(name, _)| *name == key)?.1.as_ref()
    }

    /// Returns a range error at the position of its number, with the number as it is written in the file.
    pub(super) fn refused(&self, error: &RangeError) -> SceneFileError {
        match self.number(error.parameter) {
            Some(number) => {
                let span = self.lines.span(number.span().start);
                span.error(RangeError { value: *number.get_ref(), ..error.clone() })
            }
            None => self.table.error(error),
        }
    }
}

/// Converts a whole number, so that it can be one of the numbers of [`Keys`].
pub(super) fn whole(number: &Option<Spanned<u32>>) -> Option<Number> {
    let number = number.as_ref()?;
    Some(Spanned::new(number.span(), f64::from(*number.get_ref())))
}

/// Refuses keys that do not apply to the kind of their table. Each key has its position, if it is given, and whether it
/// applies.
pub(super) fn refuse_foreign(
    lines: &Lines<'_>,
    kind: &str,
    keys: &[(&str, Option<Range<usize>>, bool)],
) -> Result<(), SceneFileError> {
    let foreign = keys.iter().find_map(|(key, span, applies)| {
        span.as_ref().filter(|_| !applies).map(|span| (key, span.start))
    });
    match foreign {
        Some((key, start)) => Err(lines
            .span(start)
            .error(format!("`{key}` does not apply to the kind `{kind}`; remove it"))),
        None => Ok(()),
    }
}

/// Returns the position of a value in bytes, if it is given.
pub(super) fn range_of<T>(value: &Option<Spanned<T>>) -> Option<Range<usize>> {
    value.as_ref().map(Spanned::span)
}
