//! Values that other programs give to flags of the same name.

use pinhole_data::css;
use pinhole_data::select::Selection;
use pinhole_data::show::ShowStyle;
use strsim::normalized_levenshtein;

use crate::terminal::failure::Failure;

/// Frequent colors, to tell a misspelt one from a column.
const COLORS: [&str; 13] = [
    "black",
    "white",
    "gray",
    "grey",
    "green",
    "yellow",
    "orange",
    "purple",
    "brown",
    "tomato",
    "steelblue",
    "skyblue",
    "lightgray",
];

/// Names of styles that there are not, of which an error says what is closest.
const NO_STYLES: [&str; 7] = ["cpk", "surface", "surf", "quicksurf", "mesh", "isosurface", "msms"];

/// Columns that other programs write at each atom.
const OF_ATOMS: [&str; 11] =
    ["atom", "chain", "element", "index", "name", "resi", "resid", "resn", "resname", "serial", "symbol"];

/// The flag and its value that are meant by a flag of the program with a value. `has` tells which flags there are.
pub(super) fn meant<'a>(name: &'a str, text: &str, has: impl Fn(&str) -> bool) -> Result<(&'a str, String), Failure> {
    if ["color", "radius"].contains(&name) && text.contains('=') {
        return Err(Failure::usage(format!(
            "--{name} {text}: this is one {name} for all; for a part: --show 'SELECTION = spacefill, {name}=VALUE', and for each \
             kind: --set 'elements.NAME.{name}=VALUE'"
        )));
    }
    if name == "color" && text.eq_ignore_ascii_case("colorid") {
        return Err(Failure::usage("--color ColorID: colors have names, such as --color green, or --color '#22aa55'"));
    }
    let first = text.split([',', ' ']).next().unwrap_or_default();
    if name == "color" && text.contains(',') && css::color(text).is_err() && css::color(first).is_ok() {
        return Err(Failure::usage(format!(
            "--color '{text}': this is one color for all; for a part: --show 'chain A = spacefill, color={first}' --show 'rest \
             = spacefill'"
        )));
    }
    if name == "label" && is_of_atoms(text) {
        return Err(Failure::usage(format!(
            "--label {text}: texts at atoms, or of frames, are not drawn; --label TEXT writes a text at a place of the picture"
        )));
    }
    if name == "turn" && text.contains(',') {
        return Err(Failure::usage(format!(
            "--turn {text}: --view 90,0 is from the side; --turn 90 turns the picture"
        )));
    }
    if name == "set"
        && let Some(words) = super::hints::of_setting(text.split('=').next().unwrap_or_default().trim())
    {
        return Err(Failure::usage(format!("--set {text}: {words}")));
    }
    if name == "distance" && text.parse::<f64>().is_err() {
        return Err(Failure::usage(format!(
            "--distance {text}: this is the distance of the view plane; distances between atoms are not drawn"
        )));
    }
    if name == "style" && text.contains([',', ';']) && drawn_as(first).is_some() {
        return Err(Failure::usage(format!(
            "--style {text}: a style for each part: --show 'protein = trace' --show 'resname HEM = sticks'"
        )));
    }
    let is_number = text.trim_end_matches('%').parse::<f64>().is_ok();
    // A name that is not a color is a column, unless it is nearly one.
    let is_color = || css::color(text).is_ok() || COLORS.iter().any(|color| normalized_levenshtein(color, text) > 0.7);
    Ok(match name {
        "color" if has("color-by") && !is_color() => ("color-by", text.to_owned()),
        "radius" if has("radius-by") && !is_number => ("radius-by", text.to_owned()),
        "zoom" if has("focus") && !is_number => ("focus", text.to_owned()),
        // A style of other programs is one of what is drawn.
        "style" if has("show") => match drawn_as(text) {
            Some(style) => ("show", style),
            None => (name, text.to_owned()),
        },
        // The camera of some programs is called a view.
        "camera" if ["ortho", "orthogonal", "parallel"].contains(&text) => (name, "orthographic".to_owned()),
        "camera" if text == "perspective" => (name, "pinhole".to_owned()),
        "view" if text == "perspective" => ("camera", "pinhole".to_owned()),
        _ => (name, text.to_owned()),
    })
}

/// The flag with a value that is meant by a flag that the program does not have, with a value.
pub(super) fn replaced(name: &str, text: &str) -> Result<Option<String>, Failure> {
    let number = text.parse::<f64>().ok();
    Ok(match (name, number) {
        ("transparency", Some(part)) if (0.0..=1.0).contains(&part) => Some(format!("--opacity={}", 1.0 - part)),
        // As ASE says it.
        ("show-unit-cell", _) if text == "0" => Some("--box=false".to_owned()),
        ("show-unit-cell", _) if ["1", "2"].contains(&text) => Some("--box".to_owned()),
        ("scale", Some(factor)) if factor > 10.0 => {
            return Err(Failure::usage(format!(
                "--scale {text}: --size WIDTHxHEIGHT is that of the picture, and --radius-scale multiplies radii"
            )));
        }
        _ => None,
    })
}

/// The name of a style of what is drawn, which VMD writes with numbers for its details.
fn drawn_as(text: &str) -> Option<String> {
    let mut words = text.split_whitespace();
    let style = words.next()?;
    let is_style = ShowStyle::of_name(style).is_some() || NO_STYLES.iter().any(|name| name.eq_ignore_ascii_case(style));
    (is_style && words.all(|word| word.parse::<f64>().is_ok())).then(|| style.to_owned())
}

/// Tells whether a text is meant for each atom: the name of a column, or a letter after `%` as in VMD.
fn is_of_atoms(text: &str) -> bool {
    let is_format = ["{step}", "{frame}", "{time}", "{timestep}"].iter().any(|part| text.contains(part))
        || text.starts_with('%') && text.split('%').skip(1).all(|part| part.starts_with(char::is_alphabetic));
    let is_selection = text.contains(" and ") && text.parse::<Selection>().is_ok();
    is_format || is_selection || OF_ATOMS.contains(&text)
}
