//! The names of columns that mean something.

/// Names of the components of a position, a colour and so on: any one of these sets.
pub(super) type Sets = &'static [[&'static str; 3]];

pub(super) const POSITIONS: Sets = &[
    ["x", "y", "z"],
    ["position.x", "position.y", "position.z"],
    ["positions.x", "positions.y", "positions.z"],
    ["pos.x", "pos.y", "pos.z"],
    ["points.x", "points.y", "points.z"],
    ["coordinates.x", "coordinates.y", "coordinates.z"],
    ["center.x", "center.y", "center.z"],
];

pub(super) const COLORS: Sets = &[
    ["red", "green", "blue"],
    ["r", "g", "b"],
    ["diffuse.red", "diffuse.green", "diffuse.blue"],
    ["color.x", "color.y", "color.z"],
    ["colour.x", "colour.y", "colour.z"],
    ["colors.x", "colors.y", "colors.z"],
    ["rgb.x", "rgb.y", "rgb.z"],
    ["color.r", "color.g", "color.b"],
    ["colour.r", "colour.g", "colour.b"],
    ["color.0", "color.1", "color.2"],
    ["colors.0", "colors.1", "colors.2"],
    ["rgb.0", "rgb.1", "rgb.2"],
    ["rgba.0", "rgba.1", "rgba.2"],
];

pub(super) const RADII: &[&str] = &["radius", "radii", "particle.radius", "sphere.radius"];
pub(super) const DIAMETERS: &[&str] = &["diameter", "diameters", "particle.diameter"];
pub(super) const OPACITIES: &[&str] =
    &["opacity", "alpha", "color.3", "colors.3", "rgba.3", "color.a"];
pub(super) const TRANSPARENCIES: &[&str] = &["transparency"];
pub(super) const ELEMENTS: &[&str] =
    &["species", "element", "elements", "symbol", "symbols", "type.symbol", "particle.type"];
pub(super) const COLOR_NAMES: &[&str] = &["color", "colour", "colors"];

/// The name of a column in lower case, with dots for what separates words.
pub(super) fn plain(name: &str) -> String {
    let name = name.trim().to_lowercase();
    let dotted = name.replace([' ', '_', '-', '[', '(', ':'], ".");
    dotted.trim_end_matches([']', ')']).to_owned()
}

/// Whether a column with this name must have numbers, because positions or radii follow from it.
pub(in crate::load) fn must_be_numbers(name: &str) -> bool {
    let name = plain(name);
    let name = name.as_str();
    POSITIONS.as_flattened().contains(&name) || RADII.contains(&name) || DIAMETERS.contains(&name)
}

/// Whether a column with this name has chemical elements, which may be atomic numbers.
pub(in crate::load) fn is_element(name: &str) -> bool {
    ELEMENTS.contains(&plain(name).as_str())
}

/// Whether columns with these names have positions.
pub(in crate::load) fn has_positions(names: &[String]) -> bool {
    let names: Vec<String> = names.iter().map(|name| plain(name)).collect();
    POSITIONS.iter().any(|set| set.iter().all(|wanted| names.iter().any(|name| name == wanted)))
}
