//! Where each key stands in the layers, and errors at these places.

use std::collections::BTreeMap;

use pinhole::range::RangeError;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::scene_file::span::{KeyError, Lines, SceneFileError, Span, explain};

/// The texts of all layers, and the places of all keys in them.
pub(crate) struct Places<'a> {
    pub(crate) lines: Lines<'a>,
    pub(crate) keys: Keys,
}

/// The keys of a layer, such as `studio.outline`, `studio.outline.width` and `lights.0.radius`.
#[derive(Debug, Default)]
pub(crate) struct Keys(BTreeMap<String, Key>);

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Key {
    pub(crate) start: usize,
    pub(crate) value: Scalar,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Scalar {
    Text(String),
    Number(f64),
    Boolean(bool),
    Other,
}

/// The longest list whose elements have places of their own. A scene may have a million spheres.
const LONGEST: usize = 1000;

impl Places<'_> {
    /// The position of a key, or of the innermost table around it.
    pub(crate) fn span(&self, key: &str) -> Span {
        match (self.keys.get(key), key.rsplit_once('.')) {
            (Some(key), _) => self.lines.span(key.start),
            (None, Some((table, _))) => self.span(table),
            (None, None) => Span::START,
        }
    }

    /// An error about a key of a table, at its position. A number is shown as it was written.
    pub(crate) fn refused(&self, table: &str, error: impl Into<KeyError>) -> SceneFileError {
        let path = |key: &str| match table {
            "" => key.to_owned(),
            table => format!("{table}.{key}"),
        };
        match error.into() {
            KeyError::Range(error) => {
                let path = path(error.parameter);
                let value = match self.keys.get(&path).map(|key| &key.value) {
                    Some(Scalar::Number(value)) => *value,
                    _ => error.value,
                };
                self.span(&path).refused(&RangeError { value, ..error })
            }
            KeyError::Text(message) => {
                let key = message.split('`').nth(1).filter(|_| message.starts_with('`'));
                self.span(&path(key.unwrap_or_default())).error(message)
            }
        }
    }

    /// Says where a message of serde applies, and explains it. `also` changes the words for a place in a flag.
    pub(crate) fn explained(
        &self,
        error: &toml::de::Error,
        also: impl Fn(&str, &str) -> Option<String>,
    ) -> SceneFileError {
        let start = error.span().map_or(0, |span| span.start);
        let (start, kind) = self.inside(start, error.message());
        let span = self.lines.span(start);
        let in_flag = span.flag.and_then(|flag| also(flag, error.message()));
        span.error(in_flag.unwrap_or_else(|| explain(error.message(), kind.as_deref())))
    }

    /// The value that a message is about, in the table that starts at a place: serde forgets places in tables with a
    /// `kind`. Also returns that kind.
    fn inside(&self, start: usize, message: &str) -> (usize, Option<String>) {
        let is_table = |key: &Key| key.start == start && key.value == Scalar::Other;
        for (path, _) in self.keys.0.iter().filter(|(_, key)| is_table(key)) {
            let Some((kind, _)) = self.keys.text(&format!("{path}.kind")) else { continue };
            let named = message.split('`').nth(1).and_then(|key| self.keys.get(&format!("{path}.{key}")));
            let inside = format!("{path}.");
            let mut values = self.keys.0.range(inside.clone()..);
            let mut values = values.by_ref().take_while(|(key, _)| key.starts_with(&inside));
            let found = named.or_else(|| values.find(|(_, key)| key.value.is_shown_in(message)).map(|(_, key)| key));
            return (found.map_or(start, |key| key.start), Some(kind.to_owned()));
        }
        (start, None)
    }
}

impl Scalar {
    /// Whether a message of serde quotes the value.
    fn is_shown_in(&self, message: &str) -> bool {
        match self {
            Self::Text(text) => message.contains(&format!("`{text}`")) || message.contains(&format!("string {text:?}")),
            Self::Number(number) => {
                message.contains(&format!("integer `{number}`"))
                    || message.contains(&format!("floating point `{number}`"))
            }
            Self::Boolean(is) => message.contains(&format!("boolean `{is}`")),
            Self::Other => false,
        }
    }
}

impl Keys {
    /// The keys of a table. Those of tables in lists are left out.
    pub(crate) fn of(table: &DeTable<'_>) -> Self {
        let mut keys = Self::default();
        keys.add(table);
        keys
    }

    /// The keys of a table, with those of tables in lists.
    pub(crate) fn with_lists(table: &DeTable<'_>) -> Self {
        let mut keys = Self::default();
        keys.add_below(table, "", LONGEST);
        keys
    }

    pub(crate) fn add(&mut self, table: &DeTable<'_>) {
        self.add_below(table, "", 0);
    }

    fn add_below(&mut self, table: &DeTable<'_>, path: &str, longest: usize) {
        for (name, value) in table {
            self.add_value(value, format!("{path}{}", name.get_ref()), longest);
        }
    }

    fn add_value(&mut self, value: &Spanned<DeValue<'_>>, path: String, longest: usize) {
        let number = |text: &str| text.parse().map_or(Scalar::Other, Scalar::Number);
        let scalar = match value.get_ref() {
            DeValue::String(text) => Scalar::Text(text.to_string()),
            DeValue::Integer(integer) => number(integer.as_str()),
            DeValue::Float(float) => number(float.as_str()),
            DeValue::Boolean(is) => Scalar::Boolean(*is),
            DeValue::Table(inner) => {
                self.add_below(inner, &format!("{path}."), longest);
                Scalar::Other
            }
            DeValue::Array(list) if list.len() <= longest => {
                for (index, value) in list.iter().enumerate() {
                    self.add_value(value, format!("{path}.{index}"), longest);
                }
                Scalar::Other
            }
            _ => Scalar::Other,
        };
        self.0.insert(path, Key { start: value.span().start, value: scalar });
    }

    pub(crate) fn get(&self, key: &str) -> Option<&Key> {
        self.0.get(key)
    }

    pub(crate) fn has(&self, key: &str) -> bool {
        self.0.contains_key(key)
    }

    /// The paths of all keys, with their positions.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&String, &Key)> {
        self.0.iter()
    }

    /// The position of a key in bytes.
    pub(crate) fn start(&self, key: &str) -> Option<usize> {
        self.get(key).map(|key| key.start)
    }

    /// The text of a key, and its position.
    pub(crate) fn text(&self, key: &str) -> Option<(&str, usize)> {
        match self.get(key)? {
            Key { start, value: Scalar::Text(text) } => Some((text, *start)),
            _ => None,
        }
    }

    /// Whether a key is `false`.
    pub(crate) fn is_off(&self, key: &str) -> bool {
        self.get(key).is_some_and(|key| key.value == Scalar::Boolean(false))
    }

    /// The keys to which `other` gives other values.
    pub(crate) fn differences(&self, other: &Self) -> Vec<String> {
        let is_outer = |path: &String| self.0.keys().any(|key| key.starts_with(&format!("{path}.")));
        let differs = |(path, key): &(&String, &Key)| {
            let is_other = |other: &Key| other.value == Scalar::Other || other.value != key.value;
            !is_outer(path) && other.get(path).is_some_and(is_other)
        };
        self.0.iter().filter(differs).map(|(path, _)| path.clone()).collect()
    }
}
