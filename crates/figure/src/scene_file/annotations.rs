//! Reads the tables `[legend]`, `[scale_bar]`, `[[labels]]` and `[text]`.

use std::fmt;

use serde::de::{Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, de};
use toml::Spanned;

use super::span::{Keys, Lines, Number, SceneFileError, Span};
use crate::annotate::{
    AnnotationPlan, Annotations, Label, LegendPlan, Panel, Position, ScaleBarPlan,
};
use pinhole::LinearRgb;
use pinhole::internals::exact::{self, Table};

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct LegendTable {
    title: Option<String>,
    position: Option<PositionValue>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct ScaleBarTable {
    length: Option<Number>,
    unit: String,
    position: Option<PositionValue>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LabelTable {
    text: String,
    position: Option<PositionValue>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct TextTable {
    scale: Option<Number>,
    color: Option<LinearRgb>,
    panel: Option<Panel>,
}

/// A position: a name, or two fractions.
struct PositionValue(Position);

impl<'de> Deserialize<'de> for PositionValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PositionVisitor;

        impl<'de> Visitor<'de> for PositionVisitor {
            type Value = PositionValue;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a position in quotes such as \"top-left\", or two fractions [x, y]")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<PositionValue, E> {
                text.parse().map(PositionValue).map_err(E::custom)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<PositionValue, A::Error> {
                let fractions = exact::elements(seq, &self)?;
                Position::at(fractions).map(PositionValue).map_err(de::Error::custom)
            }
        }

        deserializer.deserialize_any(PositionVisitor)
    }
}

/// Reads the tables of what is drawn over the picture.
pub(super) fn read_annotations(
    legend: Option<Table<LegendTable>>,
    scale_bar: Option<Table<ScaleBarTable>>,
    labels: Vec<Table<LabelTable>>,
    text: Option<Table<TextTable>>,
    lines: &Lines<'_>,
) -> Result<AnnotationPlan, SceneFileError> {
    let position = |value: Option<PositionValue>| value.map(|value| value.0);
    let text = text.unwrap_or_default().0;
    let keys = Keys { lines, numbers: vec![("scale", text.scale)], table: Span::START };
    let text_scale = keys.within("scale", Annotations::TEXT_SCALES, "from 0.2 to 10")?;
    Ok(AnnotationPlan {
        legend: legend.map(|Table(table)| LegendPlan {
            title: table.title,
            position: position(table.position),
        }),
        scale_bar: scale_bar.map(|Table(table)| ScaleBarPlan {
            length: table.length.map(Spanned::into_inner),
            unit: table.unit,
            position: position(table.position),
        }),
        labels: labels
            .into_iter()
            .map(|Table(LabelTable { text, position: at })| Label {
                text,
                position: position(at).unwrap_or(Position::TOP_LEFT),
            })
            .collect(),
        text_scale: text_scale.map(|scale| scale as f32),
        color: text.color.map(LinearRgb::to_srgb8),
        panel: text.panel,
    })
}
