//! Positions in the text of a scene file, errors with a position in the words of scene files, and types of values that
//! occur in several tables: colours and vectors.

use std::fmt;
use std::ops::Range;

use serde::{Deserialize, de};
use toml::Spanned;

use pinhole::camera::CameraKind;
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact;
use pinhole::internals::text::{one_line, shortened};
use pinhole::range::RangeError;
use pinhole::render::{BRIGHTEST, SettingsError};

/// An error in the text of a scene file or of a flag, with its position.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{message}", self.place())]
pub struct SceneFileError {
    /// Number of the line, from 1.
    pub line: usize,
    /// Number of the character in the line, from 1.
    pub column: usize,
    /// What is wrong, and what to do about it.
    pub message: String,
    /// The flag that is wrong, if it is not the file.
    pub flag: Option<&'static str>,
}

impl SceneFileError {
    fn place(&self) -> String {
        match self.flag {
            // A value out of range stands behind its flag.
            Some(flag) if self.message.starts_with(flag) => String::new(),
            Some(flag) => format!("{flag}: "),
            None => format!("line {}, column {}: ", self.line, self.column),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct WithSpan<T> {
    pub(super) value: T,
    pub(super) span: Span,
}

/// A position in one of the layers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    line: usize,
    column: usize,
    pub(crate) flag: Option<&'static str>,
}

impl Span {
    /// The start of the file, for errors without a more precise position.
    pub(crate) const START: Self = Self { line: 1, column: 1, flag: None };

    pub(crate) fn error(self, message: impl fmt::Display) -> SceneFileError {
        let Self { line, column, flag } = self;
        SceneFileError { line, column, message: message.to_string(), flag }
    }

    /// An error about a number at this position.
    pub(crate) fn refused(self, error: &RangeError) -> SceneFileError {
        match self.flag {
            // The value alone does not say which key it is of.
            Some(flag) if flag != "--set" => {
                self.error(format!("{flag} {}: it must be {}", error.value(), error.range))
            }
            _ => self.error(error),
        }
    }
}

/// The texts of all layers, one behind the other, with the offsets of their lines.
#[derive(Default)]
pub(crate) struct Lines<'a> {
    texts: Vec<Text<'a>>,
}

struct Text<'a> {
    text: &'a str,
    start: usize,
    starts: Vec<usize>,
    flag: Option<&'static str>,
}

impl<'a> Lines<'a> {
    /// The lines of one text.
    pub(super) fn of(text: &'a str) -> Self {
        let mut lines = Self::default();
        lines.add(text, None);
        lines
    }

    /// Adds a text, and returns the offset of its first byte.
    pub(crate) fn add(&mut self, text: &'a str, flag: Option<&'static str>) -> usize {
        let start = self.texts.last().map_or(0, |last| last.start + last.text.len() + 1);
        let ends = text.match_indices('\n').map(|(end, _)| end + 1);
        let starts = std::iter::once(0).chain(ends).collect();
        self.texts.push(Text { text, start, starts, flag });
        start
    }

    pub(crate) fn span(&self, byte: usize) -> Span {
        let texts = self.texts.partition_point(|text| text.start <= byte);
        let Some(Text { text, start, starts, flag }) = self.texts.get(texts.saturating_sub(1))
        else {
            return Span::START;
        };
        let byte = byte - start;
        // At least one line starts at or before any byte.
        let line = starts.partition_point(|start| *start <= byte);
        let before = text.get(starts[line - 1]..byte).unwrap_or_default();
        Span { line, column: before.chars().count() + 1, flag: *flag }
    }

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
                span.refused(&RangeError { value: *number.get_ref(), ..error.clone() })
            }
            None => self.table.error(error),
        }
    }
}

/// The name of a kind in scene files, each of which is one word.
pub(super) fn name_of(kind: &impl fmt::Debug) -> String {
    format!("{kind:?}").to_lowercase()
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

/// Colour of spheres without a colour, in 8-bit sRGB: a light grey.
pub const DEFAULT_COLOR: [u8; 3] = [0xcc; 3];

pub(super) fn default_color() -> LinearRgb {
    LinearRgb::from_srgb8(DEFAULT_COLOR)
}

#[derive(Clone, Copy)]
pub(super) struct Vector(pub(super) [f64; 3]);

impl<'de> Deserialize<'de> for Vector {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        exact::array(deserializer).map(Self)
    }
}

/// Multiplies a colour by a number that was checked. The result is light that `what` emits, and may be too bright.
pub(super) fn scaled(color: LinearRgb, by: f64, what: &str) -> Result<LinearRgb, SettingsError> {
    let rgb = color.to_array().map(|c| (f64::from(c) * by) as f32);
    let too_bright = || SettingsError::TooBright { what: what.to_owned(), rgb };
    let is_bearable = rgb.iter().all(|c| *c <= BRIGHTEST);
    LinearRgb::new(rgb).ok().filter(|_| is_bearable).ok_or_else(too_bright)
}

/// Rewrites a message of serde or toml. A message about an unknown key or name also gets a suggestion.
pub(crate) fn explain(message: &str) -> String {
    let (what, rest) = match message.split_once(" `") {
        Some(("unknown field", rest)) => ("key", rest),
        Some(("unknown variant", rest)) => ("name", rest),
        // The camera is the only enumeration whose variants have contents.
        _ if message.starts_with("wanted exactly 1 element, more") => {
            return "a scene has one camera; remove the other tables `[camera.…]`".to_owned();
        }
        _ if message.starts_with("wanted exactly 1 element")
            || message.starts_with("invalid type: unit variant") =>
        {
            return format!("a camera is a table; write {}", camera_tables());
        }
        // The messages of toml itself are good, but may have several lines.
        _ => return in_plain_words(message),
    };
    // For example: unknown field `widht`, expected one of `width`, `height`
    let mut quoted = rest.split('`').step_by(2);
    let name = quoted.next().unwrap_or_default();
    let known: Vec<&str> = quoted.filter(|name| !name.is_empty()).collect();
    unknown(what, name, &known)
}

/// Returns the message for a name that is not one of the known names.
pub(crate) fn unknown(what: &str, name: &str, known: &[&str]) -> String {
    let unknown = &shortened(name);
    let nearest = known.iter().copied().max_by(|a, b| {
        strsim::jaro_winkler(a, unknown).total_cmp(&strsim::jaro_winkler(b, unknown))
    });
    match nearest.filter(|name| strsim::jaro_winkler(name, unknown) > 0.75) {
        Some(nearest) => format!("unknown {what} `{unknown}`; did you mean `{nearest}`?"),
        None => format!("unknown {what} `{unknown}`; valid here: {}", known.join(", ")),
    }
}

/// Replaces Rust's names of types, and serde's term for a key, by plain words.
fn in_plain_words(message: &str) -> String {
    let mut text = one_line(message);
    for (rust, plain) in [
        ("expected f64", "expected a number"),
        ("expected f32", "expected a number"),
        ("expected u32", "expected a whole number from 0 to 4294967295"),
        ("expected usize", "expected a whole number, 0 or more"),
        ("missing field", "missing key"),
    ] {
        text = text.replace(rust, plain);
    }
    text
}

/// Lists the tables of all cameras: `[camera.pinhole]` or …
fn camera_tables() -> String {
    let tables = CameraKind::ALL.iter().map(|kind| format!("`[camera.{}]`", kind.name()));
    tables.collect::<Vec<_>>().join(" or ")
}
