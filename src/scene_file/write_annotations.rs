//! Writes the tables of a scene file that say what is drawn over the picture.

use super::write_values::{color, string};
use crate::annotate::{AnnotationPlan, LegendPlan, Panel, Position, ScaleBarPlan};
use crate::image::color::LinearRgb;

/// The tables, one text each.
pub(super) fn annotations(plan: &AnnotationPlan) -> Vec<String> {
    let AnnotationPlan { legend, scale_bar, labels, text_scale, color: text_color, panel } = plan;
    let at = |at: Option<Position>| at.map(|at| format!("position = {}", position(at)));
    let table = |header: &str, keys: Vec<Option<String>>| {
        let lines = [Some(format!("\n{header}"))].into_iter().chain(keys).flatten();
        lines.collect::<Vec<_>>().join("\n")
    };
    let mut tables = Vec::new();
    tables.extend(legend.as_ref().map(|LegendPlan { title, position }| {
        let title = title.as_ref().map(|title| format!("title = {}", string(title)));
        table("[legend]", vec![title, at(*position)])
    }));
    tables.extend(scale_bar.as_ref().map(|ScaleBarPlan { length, unit, position }| {
        let length = length.map(|length| format!("length = {length:?}"));
        let unit = (!unit.is_empty()).then(|| format!("unit = {}", string(unit)));
        table("[scale_bar]", vec![length, unit, at(*position)])
    }));
    tables.extend(labels.iter().map(|label| {
        let text = format!("text = {}", string(&label.text));
        table("[[labels]]", vec![Some(text), at(Some(label.position))])
    }));
    let text = vec![
        text_scale.map(|scale| format!("scale = {scale:?}")),
        text_color.map(|one| format!("color = {}", color(LinearRgb::from_srgb8(one)))),
        panel.map(|panel| {
            let name = match panel {
                Panel::Auto => "auto",
                Panel::Always => "always",
                Panel::Never => "never",
            };
            format!("panel = \"{name}\"")
        }),
    ];
    if text.iter().any(Option::is_some) {
        tables.push(table("[text]", text));
    }
    tables
}

fn position(position: Position) -> String {
    match position {
        Position::Anchor(anchor) => format!("\"{}\"", anchor.name()),
        Position::At([x, y]) => format!("[{x:?}, {y:?}]"),
    }
}
