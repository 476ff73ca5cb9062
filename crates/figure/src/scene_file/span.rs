//! Positions in the text of a scene file, errors with a position in the words of scene files, and types of values that
//! occur in several tables: colours and vectors.

use std::fmt;

use pinhole::camera::CameraKind;
use pinhole::image::color::LinearRgb;
use pinhole::internals::text::{shortened, whole_line};
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
        let Some(Text { text, start, starts, flag }) = self.texts.get(texts.saturating_sub(1)) else {
            return Span::START;
        };
        let byte = byte - start;
        // At least one line starts at or before any byte.
        let line = starts.partition_point(|start| *start <= byte);
        let before = text.get(starts[line - 1]..byte).unwrap_or_default();
        Span { line, column: before.chars().count() + 1, flag: *flag }
    }
}

/// Checks that a number, if it is given, is finite and greater than 0.
pub(super) fn positive(key: &'static str, value: Option<f64>) -> Result<Option<f64>, RangeError> {
    let range = "finite and greater than 0";
    let within = |value| RangeError::unless_within(key, value, [f64::from_bits(1), f64::MAX], range);
    value.map(within).transpose()
}

/// An error about a key of a table, whose message begins with the key in backticks if it is about one key.
pub(crate) enum KeyError {
    Range(RangeError),
    Text(String),
}

impl fmt::Display for KeyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(error) => error.fmt(f),
            Self::Text(message) => f.write_str(message),
        }
    }
}

impl From<RangeError> for KeyError {
    fn from(error: RangeError) -> Self {
        Self::Range(error)
    }
}

impl From<String> for KeyError {
    fn from(message: String) -> Self {
        Self::Text(message)
    }
}

impl From<&str> for KeyError {
    fn from(message: &str) -> Self {
        Self::Text(message.to_owned())
    }
}

/// Colour of spheres without a colour, in 8-bit sRGB: a light grey.
pub const DEFAULT_COLOR: [u8; 3] = [0xcc; 3];

pub(super) fn default_color() -> LinearRgb {
    LinearRgb::from_srgb8(DEFAULT_COLOR)
}

/// Multiplies a colour by a number that was checked. The result is light that `what` emits, and may be too bright.
pub(super) fn scaled(color: LinearRgb, by: f64, what: &str) -> Result<LinearRgb, String> {
    let rgb = color.to_array().map(|c| (f64::from(c) * by) as f32);
    let too_bright = || SettingsError::TooBright { what: what.to_owned(), rgb }.to_string();
    let is_bearable = rgb.iter().all(|c| *c <= BRIGHTEST);
    LinearRgb::new(rgb).ok().filter(|_| is_bearable).ok_or_else(too_bright)
}

/// Rewrites a message of serde or toml. A message about an unknown key or name also gets a suggestion. `kind` is that of
/// the table, if it has one.
pub(crate) fn explain(message: &str, kind: Option<&str>) -> String {
    let (what, rest) = match message.split_once(" `") {
        Some(("unknown field", rest)) => ("key", rest),
        Some(("unknown variant", rest)) => ("name", rest),
        // The camera is the only enumeration whose variants have contents.
        _ if message.starts_with("wanted exactly 1 element, more") => {
            return "a scene has one camera, whose keys are in one table such as `[camera.pinhole]`; remove the others"
                .to_owned();
        }
        _ if message.starts_with("wanted exactly 1 element") || message.starts_with("invalid type: unit variant") => {
            return format!("a camera is a table; write {}", camera_tables());
        }
        // The messages of toml itself are good, but may have several lines.
        _ => return in_plain_words(message),
    };
    // For example: unknown field `widht`, expected one of `width`, `height`
    let mut quoted = rest.split('`').step_by(2);
    let name = quoted.next().unwrap_or_default();
    let known: Vec<&str> = quoted.filter(|name| !name.is_empty()).collect();
    match (kind, nearest(name, &known)) {
        (Some(kind), None) if what == "key" => {
            format!("`{}` does not apply to the kind `{kind}`; remove it", shortened(name))
        }
        _ => unknown(what, name, &known),
    }
}

/// Returns the message for a name that is not one of the known names.
pub(crate) fn unknown(what: &str, name: &str, known: &[&str]) -> String {
    let unknown = &shortened(name);
    match nearest(unknown, known) {
        Some(nearest) => format!("unknown {what} `{unknown}`; did you mean `{nearest}`?"),
        None => format!("unknown {what} `{unknown}`; valid here: {}", known.join(", ")),
    }
}

/// The known name that is spelled like this one.
fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let likeness = |known: &str| strsim::jaro_winkler(known, name);
    let nearest = known.iter().copied().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    nearest.filter(|known| likeness(known) > 0.75)
}

/// Replaces Rust's names of types, and serde's term for a key, by plain words.
fn in_plain_words(message: &str) -> String {
    let mut text = whole_line(message);
    for (rust, plain) in [
        ("expected f64", "expected a number"),
        ("expected f32", "expected a number"),
        ("expected u32", "expected a whole number from 0 to 4294967295"),
        ("expected usize", "expected a whole number, 0 or more"),
        ("missing field", "missing key"),
    ] {
        text = text.replace(rust, plain);
    }
    if text.starts_with("missing key") { text + "; add it" } else { text }
}

/// Lists the tables of all cameras: `[camera.pinhole]` or …
fn camera_tables() -> String {
    let tables = CameraKind::ALL.iter().map(|kind| format!("`[camera.{}]`", kind.name()));
    tables.collect::<Vec<_>>().join(" or ")
}
