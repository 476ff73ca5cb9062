//! Reads the keys `color_by`, `radius_by`, `opacity_by` and `emission_by`.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde::{Deserialize, de};
use toml::Spanned;

use super::span::{Lines, Number, SceneFileError};
use crate::color_by::{ColorBy, EmissionBy, Limit, Limits, MISSING, MapName, Mapping, RadiusBy};
use pinhole::LinearRgb;

/// A table that may also be written as a text, the name of its column.
pub(super) struct ByColumn<T>(T);

impl<'de, T: Deserialize<'de> + From<String>> Deserialize<'de> for ByColumn<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TextOrMap<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de> + From<String>> Visitor<'de> for TextOrMap<T> {
            type Value = ByColumn<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a column, or a table with the key `column`")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<ByColumn<T>, E> {
                Ok(ByColumn(text.to_owned().into()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ByColumn<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(ByColumn)
            }
        }

        deserializer.deserialize_any(TextOrMap(PhantomData))
    }
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ColorTable {
    column: String,
    map: Option<Spanned<String>>,
    #[serde(default)]
    reverse: bool,
    range: Option<Spanned<Vec<LimitValue>>>,
    #[serde(default)]
    log: bool,
    missing: Option<LinearRgb>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ColumnTable {
    column: String,
    factor: Option<Number>,
}

impl From<String> for ColorTable {
    fn from(column: String) -> Self {
        Self { column, ..Self::default() }
    }
}

impl From<String> for ColumnTable {
    fn from(column: String) -> Self {
        Self { column, ..Self::default() }
    }
}

/// An end of a range: a number, or a percentile as text.
struct LimitValue(Limit);

impl<'de> Deserialize<'de> for LimitValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct LimitVisitor;

        impl Visitor<'_> for LimitVisitor {
            type Value = LimitValue;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, or a percentile in quotes such as \"2%\"")
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<LimitValue, E> {
                Ok(LimitValue(Limit::Value(value)))
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<LimitValue, E> {
                self.visit_f64(value as f64)
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<LimitValue, E> {
                text.parse().map(LimitValue).map_err(E::custom)
            }
        }

        deserializer.deserialize_any(LimitVisitor)
    }
}

/// Reads the keys by which columns decide how spheres look.
pub(super) fn read_mapping(
    color: Option<Spanned<ByColumn<ColorTable>>>,
    [radius, opacity, emission]: [Option<Spanned<ByColumn<ColumnTable>>>; 3],
    lines: &Lines<'_>,
) -> Result<Mapping, SceneFileError> {
    let opacity = opacity.map(|table| table.into_inner().0);
    if let Some(factor) = opacity.as_ref().and_then(|table| table.factor.as_ref()) {
        let message =
            "`factor` does not apply to `opacity_by`, whose numbers are opacities; remove it";
        return Err(lines.span(factor.span().start).error(message));
    }
    let with_factor = |table: Spanned<ByColumn<ColumnTable>>| {
        let ColumnTable { column, factor } = table.into_inner().0;
        (column, factor.map_or(1.0, Spanned::into_inner))
    };
    let radius = radius.map(with_factor);
    let emission = emission.map(with_factor);
    Ok(Mapping {
        color: color.map(|table| color_by(table.into_inner().0, lines)).transpose()?,
        radius: radius.map(|(column, factor)| RadiusBy { column, factor }),
        opacity: opacity.map(|table| table.column),
        emission: emission.map(|(column, factor)| EmissionBy { column, factor }),
    })
}

fn color_by(table: ColorTable, lines: &Lines<'_>) -> Result<ColorBy, SceneFileError> {
    let map = table.map.map(|map| {
        let parsed = map.get_ref().parse::<MapName>();
        parsed.map_err(|error| lines.span(map.span().start).error(error))
    });
    let limits = table.range.map(|range| {
        let span = lines.span(range.span().start);
        match &range.into_inner()[..] {
            [low, high] => Ok(Limits { low: low.0, high: high.0 }),
            _ => Err(span.error("a range has two ends, such as [0, 1] or [\"2%\", \"98%\"]")),
        }
    });
    Ok(ColorBy {
        column: table.column,
        map: map.transpose()?,
        is_reversed: table.reverse,
        limits: limits.transpose()?.unwrap_or_default(),
        is_log: table.log,
        missing: table.missing.map_or(MISSING, LinearRgb::to_srgb8),
        categories: None,
    })
}
