//! Writes the keys of a scene file that concern its data.

use super::data::Data;
use super::write_surfaces::Surfaces;
use super::write_values::{color, string, strings};
use crate::added::BondLength;
use crate::color_by::{ColorBy, Limit, Limits, MISSING, Mapping};
use crate::image::color::LinearRgb;
use crate::scene::material::SurfaceProperties;

/// The keys at the top of the file that concern its data.
pub(super) fn data_keys(data: &Data, surfaces: &mut Surfaces) -> Vec<String> {
    let mut lines = vec![format!("data = {}", string(&data.file))];
    lines.extend(data.format.as_ref().map(|name| format!("format = {}", string(name))));
    lines.extend(data.frame.map(|frame| format!("frame = {frame}")));
    lines.extend(data.topology.as_ref().map(|file| format!("topology = {}", string(file))));
    if !data.columns.is_empty() {
        lines.push(format!("columns = {}", strings(&data.columns)));
    }
    lines.extend(data.radius.map(|radius| format!("radius = {radius:?}")));
    if data.radius_scale.to_bits() != 1.0_f64.to_bits() {
        lines.push(format!("radius_scale = {:?}", data.radius_scale));
    }
    lines.extend(data.color.map(|one| format!("color = {}", color(one))));
    lines.extend(surfaces.key(data.surface, SurfaceProperties::default()));
    if !data.elements_by.is_empty() {
        lines.push(format!("elements_by = {}", strings(&data.elements_by)));
    }
    if !data.leave_out.is_empty() {
        let columns = data.leave_out.iter();
        let columns = columns.map(|(name, list)| format!("{} = {}", string(name), strings(list)));
        lines.push(format!("leave_out = {{ {} }}", columns.collect::<Vec<_>>().join(", ")));
    }
    lines.extend(
        data.select.as_ref().map(|select| format!("select = {}", string(&select.to_string()))),
    );
    mapping_keys(&data.mapping, &mut lines);
    lines.extend(data.additions.cell.as_ref().map(|cell| match cell.width {
        Some(width) => format!("box = {{ width = {width:?} }}"),
        None => "box = true".to_owned(),
    }));
    lines.extend(data.additions.bonds.as_ref().map(|bonds| match bonds.length {
        BondLength::Covalent(factor) => format!("bonds = {factor:?}"),
        BondLength::Below(length) => format!("bonds = {{ length = {length:?} }}"),
    }));
    lines
}

/// The keys by which columns decide how spheres look.
fn mapping_keys(mapping: &Mapping, lines: &mut Vec<String>) {
    let Mapping { color, radius, opacity, emission } = mapping;
    lines.extend(color.as_ref().map(color_by));
    let with_factor = |key: &str, column: &str, factor: f64| {
        format!("{key} = {{ column = {}, factor = {factor:?} }}", string(column))
    };
    lines.extend(radius.as_ref().map(|by| with_factor("radius_by", &by.column, by.factor)));
    lines.extend(opacity.as_ref().map(|column| format!("opacity_by = {}", string(column))));
    lines.extend(emission.as_ref().map(|by| with_factor("emission_by", &by.column, by.factor)));
}

fn color_by(by: &ColorBy) -> String {
    // Categories are given only between the frames of a movie.
    let ColorBy { column, map, is_reversed, limits, is_log, missing, categories: _ } = by;
    let mut keys = vec![format!("column = {}", string(column))];
    keys.extend(map.map(|map| {
        let ending = if map.is_reversed() { "_r" } else { "" };
        format!("map = \"{}{ending}\"", map.name())
    }));
    if *is_reversed {
        keys.push("reverse = true".to_owned());
    }
    if *limits != Limits::default() {
        let limit = |limit| match limit {
            Limit::Automatic => "\"\"".to_owned(),
            Limit::Value(value) => format!("{value:?}"),
            Limit::Percentile(percent) => format!("\"{percent:?}%\""),
        };
        keys.push(format!("range = [{}, {}]", limit(limits.low), limit(limits.high)));
    }
    if *is_log {
        keys.push("log = true".to_owned());
    }
    if *missing != MISSING {
        keys.push(format!("missing = {}", color(LinearRgb::from_srgb8(*missing))));
    }
    format!("color_by = {{ {} }}", keys.join(", "))
}
