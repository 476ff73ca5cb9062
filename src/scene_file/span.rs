//! Spans of the text, and what is wrong there.

use std::fmt;
use std::ops::Range;

use toml::Spanned;

use crate::range::RangeError;

/// What is wrong with a scene file, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct SceneFileError {
    /// From 1.
    pub line: usize,
    /// From 1, in characters.
    pub column: usize,
    /// What is wrong, and what to do.
    pub message: String,
}

/// A value and where it is in the text.
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
    /// Where nothing more precise is known.
    pub(super) const START: Self = Self { line: 1, column: 1 };

    pub(super) fn error(self, message: impl fmt::Display) -> SceneFileError {
        SceneFileError { line: self.line, column: self.column, message: message.to_string() }
    }
}

/// Where the lines of a text start.
pub(super) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        let ends = text.match_indices('\n').map(|(end, _)| end + 1);
        Self { text, starts: std::iter::once(0).chain(ends).collect() }
    }

    /// Line and column of a byte.
    pub(super) fn span(&self, byte: usize) -> Span {
        // At least one line starts at or before any byte.
        let line = self.starts.partition_point(|start| *start <= byte);
        let before = self.text.get(self.starts[line - 1]..byte).unwrap_or_default();
        Span { line, column: before.chars().count() + 1 }
    }

    /// A value and where it is.
    pub(super) fn spanned<T>(&self, value: Spanned<T>) -> WithSpan<T> {
        WithSpan { span: self.span(value.span().start), value: value.into_inner() }
    }
}

/// A number and where it is.
pub(super) type Number = Spanned<f64>;

/// The keys of a table that have numbers, to say where one is that is out of range.
pub(super) struct Keys<'a> {
    pub(super) lines: &'a Lines<'a>,
    pub(super) numbers: Vec<(&'static str, Option<Spanned<f64>>)>,
    /// Where the table begins.
    pub(super) table: Span,
}

impl Keys<'_> {
    /// The number of a key, if it is there; at least `low` and at most `high`.
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

    /// The error where its number is, which is given as it was written.
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

/// A whole number among others.
pub(super) fn whole(number: &Option<Spanned<u32>>) -> Option<Number> {
    let number = number.as_ref()?;
    Some(Spanned::new(number.span(), f64::from(*number.get_ref())))
}

/// Refuses keys of a table that do not concern its kind: each with where it is, and whether it does.
pub(super) fn refuse_foreign(
    lines: &Lines<'_>,
    kind: &str,
    keys: &[(&str, Option<Range<usize>>, bool)],
) -> Result<(), SceneFileError> {
    let foreign = keys.iter().find_map(|(key, span, concerns)| {
        span.as_ref().filter(|_| !concerns).map(|span| (key, span.start))
    });
    match foreign {
        Some((key, start)) => Err(lines
            .span(start)
            .error(format!("`{key}` does not concern the kind `{kind}`; drop it"))),
        None => Ok(()),
    }
}

/// Where a value is, if it is there.
pub(super) fn range_of<T>(value: &Option<Spanned<T>>) -> Option<Range<usize>> {
    value.as_ref().map(Spanned::span)
}
