//! Joins the layers of settings: a style, a scene file, and flags. Each layer is TOML text. A value of a later layer takes
//! the place of the same key in an earlier one, and keeps the position at which it was said, for errors.

use std::ops::Range;

use pinhole_data::css;
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue, ValueDeserializer};

use super::places::{Key, Keys, Places, Scalar};
use crate::scene_file::span::{Lines, SceneFileError, explain, unknown};
use crate::style::Style;

/// Settings that a flag gives, or another place that is not a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layer {
    /// The flag, such as `--outline`, for errors.
    pub flag: &'static str,
    /// The settings: keys and tables of a scene file.
    pub text: String,
}

/// The texts from which settings are read, in the order of their precedence.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sources<'a> {
    /// The text of a scene file.
    pub file: &'a str,
    /// Flags, each of which takes precedence over the file and over flags before it.
    pub flags: &'a [Layer],
    /// The style if neither the file nor a flag names one.
    pub style: Option<Style>,
}

/// All layers, joined.
pub(crate) struct Joined<'a> {
    /// All keys.
    pub(crate) places: Places<'a>,
    pub(crate) style: Option<Style>,
    /// The keys that a style which a flag names does not decide, because the file gives other values.
    pub(crate) kept: Vec<String>,
    pub(crate) in_file: Keys,
    pub(crate) in_flags: Keys,
    pub(crate) in_style: Keys,
    table: DeTable<'a>,
}

/// Keys whose value in a later layer takes the place of the whole value in an earlier one, because the parts of two such
/// values exclude each other.
const WHOLE: [&str; 8] = ["arrows", "bonds", "box", "camera", "emission_by", "ground", "opacity_by", "radius_by"];

/// Lists that later layers make longer.
const LISTS: [&str; 2] = ["labels", "show"];

/// Keys of colours, which may be written as CSS colours.
const COLORS: [&str; 7] = ["ambient", "background", "color", "horizon", "missing", "nadir", "zenith"];

/// Keys about light sources. A file or a flag that has one of them gets none of the style's.
const LIGHT: [&str; 3] = ["lights", "sky", "sun"];

/// The outline that a flag widens where neither the style nor the file has one: [`Outline::thin`](pinhole::render::Outline::thin).
const THIN: &str = "studio.outline = { color = \"#343a46\", depth = 0.01, angle = 180 }";

impl<'a> Joined<'a> {
    /// Parses and joins all layers.
    pub(crate) fn read(sources: &Sources<'a>) -> Result<Self, SceneFileError> {
        let mut lines = Lines::default();
        let file = parse(sources.file, None, &mut lines)?;
        let (mut flags, mut sets) = (DeTable::new(), DeTable::new());
        for layer in sources.flags {
            let into = if layer.flag == "--set" { &mut sets } else { &mut flags };
            join(into, parse(&layer.text, Some(layer.flag), &mut lines)?);
        }
        let (in_file, mut in_flags) = (Keys::of(&file), Keys::of(&flags));
        in_flags.add(&sets);
        let named = |keys: &Keys| keys.get("style").map(|name| style_of(name, &lines)).transpose();
        let (by_flag, by_file) = (named(&in_flags)?, named(&in_file)?);
        let style = by_flag.or(by_file).or(sources.style);
        let mut table = parse(style.map_or("", Style::text), None, &mut lines)?;
        let in_style = Keys::of(&table);
        let kept = by_flag.map_or(Vec::new(), |_| in_style.differences(&in_file));
        if in_flags.has("studio.outline") && ![&in_file, &in_style].iter().any(|keys| keys.has("studio.outline")) {
            join(&mut table, parse(THIN, None, &mut lines)?);
        }
        let mut own = file;
        replace_whole(&mut own, &flags);
        join(&mut own, flags);
        if LIGHT.iter().any(|key| own.contains_key(*key)) {
            LIGHT.iter().for_each(|key| drop(table.remove(*key)));
        }
        replace_whole(&mut table, &own);
        join(&mut table, own);
        join(&mut table, sets);
        let keys = Keys::with_lists(&table);
        let places = Places { lines, keys };
        Ok(Self { places, style, kept, in_file, in_flags, in_style, table })
    }

    /// Whether the file or a flag gives a key.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.in_file.has(key) || self.in_flags.has(key)
    }

    /// The flags, by the keys that they give.
    pub(crate) fn flags(&self) -> Vec<(String, &'static str)> {
        let flag = |(path, key): (&String, &Key)| Some((path.clone(), self.places.lines.span(key.start).flag?));
        self.in_flags.iter().filter_map(flag).collect()
    }

    /// Takes a value out of the table that serde reads.
    pub(crate) fn take<T: DeserializeOwned>(&mut self, key: &str) -> Result<Option<T>, SceneFileError> {
        let Some(value) = take(&mut self.table, key) else { return Ok(None) };
        T::deserialize(ValueDeserializer::from(value)).map(Some).map_err(|e| self.explained(&e))
    }

    /// Reads the table.
    pub(crate) fn document<T: DeserializeOwned>(&mut self) -> Result<T, SceneFileError> {
        let table = Spanned::new(0..0, std::mem::take(&mut self.table));
        T::deserialize(toml::Deserializer::from(table)).map_err(|error| self.explained(&error))
    }

    fn explained(&self, error: &toml::de::Error) -> SceneFileError {
        self.places.explained(error, |flag, message| self.in_flag(flag, message))
    }

    /// The message of serde in the words of flags; `None` if it is as good in those of keys.
    fn in_flag(&self, flag: &str, message: &str) -> Option<String> {
        let mut words = message.split('`');
        match (words.next()?, words.next()?) {
            ("missing field ", "separation") => Some(format!("{flag} needs --separation; add --separation")),
            ("missing field ", "column") => {
                Some(format!("{flag} says how numbers become colors, but no column is named; add --color-by COLUMN"))
            }
            ("unknown field ", _) if flag != "--set" => {
                let keys = self.places.keys.iter();
                let mut kinds = keys.filter_map(|(key, _)| key.strip_prefix("camera."));
                let kind = kinds.next()?.split('.').next()?;
                Some(format!("{flag} does not apply to the {kind} camera; remove it"))
            }
            _ => None,
        }
    }
}

fn parse<'a>(text: &'a str, flag: Option<&'static str>, lines: &mut Lines<'a>) -> Result<DeTable<'a>, SceneFileError> {
    let start = lines.add(text, flag);
    let table = DeTable::parse(text).map_err(|error| {
        let at = start + error.span().map_or(0, |span| span.start);
        lines.span(at).error(explain(error.message(), None))
    })?;
    prepared_table(table.into_inner(), (start, false), lines)
}

fn style_of(name: &Key, lines: &Lines<'_>) -> Result<Style, SceneFileError> {
    let text = match &name.value {
        Scalar::Text(text) => text,
        _ => "",
    };
    Style::of_name(text).ok_or_else(|| {
        let names: Vec<&str> = Style::ALL.iter().map(|style| style.name()).collect();
        lines.span(name.start).error(unknown("style", text, &names))
    })
}

/// Removes the values from `below` that keys of `above` replace as a whole.
fn replace_whole(below: &mut DeTable<'_>, above: &DeTable<'_>) {
    for key in WHOLE.iter().filter(|key| above.contains_key(**key)) {
        below.remove(*key);
    }
    // Another column has a map, a range and a title of its own.
    let names_column = match above.get("color_by").map(Spanned::get_ref) {
        Some(DeValue::Table(table)) => table.contains_key("column"),
        by => by.is_some(),
    };
    if names_column {
        below.remove("color_by");
        if let Some(DeValue::Table(legend)) = below.get_mut("legend").map(Spanned::get_mut) {
            legend.remove("title");
        }
    }
}

/// Puts the values of `above` into `below`. Tables are joined key by key, and some lists are appended.
fn join<'a>(below: &mut DeTable<'a>, above: DeTable<'a>) {
    for (key, value) in above {
        let (span, name) = (value.span(), key.get_ref().as_ref());
        match (below.get_mut(name).map(Spanned::get_mut), value.into_inner()) {
            (Some(DeValue::Table(below)), DeValue::Table(above)) => join(below, above),
            (Some(DeValue::Array(below)), DeValue::Array(above)) if LISTS.contains(&name) => {
                above.into_iter().for_each(|item| below.push(item));
            }
            // The name of a column stands for a table with this column.
            (Some(column @ DeValue::String(_)), DeValue::Table(above)) if name == "color_by" => {
                let name = Spanned::new(key.span(), "column".into());
                let mut table = DeTable::new();
                table.insert(name, Spanned::new(key.span(), column.clone()));
                join(&mut table, above);
                *column = DeValue::Table(table);
            }
            (_, value) => drop(below.insert(key.clone(), Spanned::new(span, value))),
        }
    }
}

fn take<'a>(table: &mut DeTable<'a>, key: &str) -> Option<Spanned<DeValue<'a>>> {
    match key.split_once('.') {
        None => table.remove(key),
        Some((first, rest)) => match table.get_mut(first)?.get_mut() {
            DeValue::Table(inner) => take(inner, rest),
            _ => None,
        },
    }
}

/// Moves the positions of a layer to where its text begins among all, and writes CSS colours as `#rrggbb`, but not where
/// their keys may also name columns.
fn prepared_table<'a>(
    table: DeTable<'a>,
    (start, in_columns): (usize, bool),
    lines: &Lines<'_>,
) -> Result<DeTable<'a>, SceneFileError> {
    let entry = |(key, value): (Spanned<DeString<'a>>, Spanned<DeValue<'a>>)| {
        let name = key.get_ref().as_ref();
        let has_columns = name == "show";
        let value = prepared(value, COLORS.contains(&name) && !in_columns, (start, in_columns || has_columns), lines)?;
        Ok((Spanned::new(moved(&key.span(), start), key.into_inner()), value))
    };
    table.into_iter().map(entry).collect()
}

fn prepared<'a>(
    value: Spanned<DeValue<'a>>,
    is_color: bool,
    (start, in_columns): (usize, bool),
    lines: &Lines<'_>,
) -> Result<Spanned<DeValue<'a>>, SceneFileError> {
    let span = moved(&value.span(), start);
    let value = match value.into_inner() {
        DeValue::String(text) if is_color => {
            let color = css::color(&text).map_err(|error| lines.span(span.start).error(error))?;
            let [r, g, b] = color.to_srgb8();
            DeValue::String(format!("#{r:02x}{g:02x}{b:02x}").into())
        }
        DeValue::Array(array) => {
            let items = array.into_iter().map(|value| prepared(value, false, (start, in_columns), lines));
            // Only a list that a header makes, such as `[[lights]]`, may be extended by one.
            DeValue::Array(items.collect::<Result<_, _>>()?)
        }
        DeValue::Table(table) => DeValue::Table(prepared_table(table, (start, in_columns), lines)?),
        value => value,
    };
    Ok(Spanned::new(span, value))
}

fn moved(span: &Range<usize>, by: usize) -> Range<usize> {
    span.start + by..span.end + by
}
