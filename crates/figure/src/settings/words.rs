//! Turns the values of flags into TOML.

use std::fmt::Write;

use pinhole::camera::Viewpoint;

use crate::annotate::Position;
use crate::scene_file::unknown_style;
use pinhole_data::show::ShowStyle;

/// A text in quotes, as TOML writes it.
#[must_use]
pub fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

pub(super) fn text(text: &str) -> String {
    quoted(text)
}

pub(super) fn number(text: &str) -> Result<String, String> {
    let number = text.trim().parse::<f64>().map_err(|_| "write a number".to_owned())?;
    Ok(toml_number(number))
}

/// A number as TOML writes it.
fn toml_number(number: f64) -> String {
    if number.is_nan() { "nan".to_owned() } else { format!("{number:?}") }
}

pub(super) fn whole(text: &str) -> Result<String, String> {
    let number = text.trim().parse::<i64>();
    number.map(|number| number.to_string()).map_err(|_| "write a whole number".to_owned())
}

/// Reads the number of a frame, or `last`.
pub(super) fn frame(text: &str) -> Result<String, String> {
    if text == "last" { Ok("-1".to_owned()) } else { whole(text) }
}

pub(super) fn switch(text: &str) -> Result<String, String> {
    match text {
        "true" | "false" => Ok(text.to_owned()),
        _ => Err("write true or false".to_owned()),
    }
}

pub(super) fn numbers(text: &str, count: usize) -> Result<String, String> {
    let numbers: Vec<String> = list_of(text, count)?.into_iter().map(toml_number).collect();
    Ok(format!("[{}]", numbers.join(", ")))
}

/// Reads numbers that are separated by commas.
///
/// # Errors
/// Says in words what to write if there are not `count` numbers.
pub fn list_of(text: &str, count: usize) -> Result<Vec<f64>, String> {
    let example = if count == 2 { "1,0.75" } else { "0,1,-8" };
    let wanted = || format!("write {count} numbers with commas between them, such as {example}");
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    numbers.ok().filter(|numbers| numbers.len() == count).ok_or_else(wanted)
}

pub(super) fn names(text: &str) -> Result<String, String> {
    let names: Vec<String> = text.split(',').map(quoted).collect();
    Ok(format!("[{}]", names.join(", ")))
}

pub(super) fn size(text: &str) -> Result<String, String> {
    let [width, height] = size_of(text)?;
    Ok(format!("film.width = {width}\nfilm.height = {height}"))
}

/// Reads a size such as `800x600` or `800,600`, or the width of a picture that is three quarters as high.
///
/// # Errors
/// Says in words what to write.
pub fn size_of(text: &str) -> Result<[u32; 2], String> {
    let sides = match text.split_once(['x', 'X', ',']) {
        Some((width, height)) => width.parse().ok().zip(height.trim().parse().ok()).map(|(w, h)| [w, h]),
        None => text.parse().ok().map(|width: u32| [width, (width - width / 4).max(1)]),
    };
    sides.ok_or_else(|| "write WIDTHxHEIGHT in pixels, such as 800x600".to_owned())
}

/// Reads a key with its value, which is a text unless TOML reads something else.
pub(super) fn set(text: &str) -> Result<String, String> {
    let wanted = || "write KEY=VALUE, such as studio.outline.width=2".to_owned();
    let (key, value) = text.split_once('=').ok_or_else(wanted)?;
    let (key, value) = (key.trim(), value.trim());
    let is_name = |part: &str| !part.is_empty() && part.chars().all(|c| c.is_alphanumeric() || "-_".contains(c));
    if !key.split('.').all(is_name) || value.is_empty() {
        return Err(wanted());
    }
    let as_it_stands = format!("{key} = {value}");
    let is_toml = toml::from_str::<toml::Table>(&as_it_stands).is_ok();
    Ok(if is_toml { as_it_stands } else { format!("{key} = {}", quoted(value)) })
}

pub(super) fn view(text: &str) -> Result<String, String> {
    text.parse::<Viewpoint>().map(|view| quoted(&view.to_string())).map_err(|e| e.to_string())
}

/// Reads a part of a whole, such as 0.1 or 10%.
pub(super) fn part(text: &str) -> Result<String, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number, 100.0),
        None => (text, 1.0),
    };
    let number = number.trim().parse::<f64>();
    let number = number.map_err(|_| "write a part such as 0.1 or 10%".to_owned())?;
    Ok(toml_number(number / unit))
}

fn positive(text: &str) -> Result<String, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.map(toml_number).ok_or_else(|| "write a number that is finite and greater than 0".to_owned())
}

pub(super) fn cell(text: &str) -> Result<String, String> {
    match text {
        "" => Ok("true".to_owned()),
        "false" => Ok("false".to_owned()),
        width => positive(width).map(|width| format!("{{ width = {width} }}")),
    }
}

pub(super) fn bonds(text: &str) -> Result<String, String> {
    match text {
        "" => Ok("true".to_owned()),
        factor => {
            let factor = positive(factor)?;
            let is_length = factor.parse::<f64>().is_ok_and(|factor| factor > 1.5);
            let remedy = || format!("this is a factor of covalent radii, at most 1.5; a length: --bond-length {text}");
            if is_length { Err(remedy()) } else { Ok(factor) }
        }
    }
}

pub(super) fn bond_length(text: &str) -> Result<String, String> {
    positive(text).map(|length| format!("{{ length = {length} }}"))
}

/// Reads `KEY=VALUE`.
fn pair(part: &str) -> Result<String, String> {
    let wanted = || format!("`{}` is not KEY=VALUE, such as scale=2", part.trim());
    let (key, value) = part.split_once('=').ok_or_else(wanted)?;
    let value = value.trim().parse::<f64>().map_or_else(|_| quoted(value.trim()), toml_number);
    Ok(format!("{} = {value}", quoted(key.trim())))
}

/// Reads `VECTOR[,KEY=VALUE]...`.
pub(super) fn arrows(text: &str) -> Result<String, String> {
    let mut parts = text.split(',').map(str::trim);
    let vector = parts.next().unwrap_or_default();
    let pairs: Vec<String> = parts.map(pair).collect::<Result<_, String>>()?;
    let vector = quoted(vector);
    Ok(if pairs.is_empty() { vector } else { format!("{{ vector = {vector}, {} }}", pairs.join(", ")) })
}

/// Reads `SELECTION = STYLE[, KEY=VALUE]...`, or a style for all spheres.
pub(super) fn show(text: &str) -> Result<String, String> {
    let style_of = |part: &str| {
        let name = part.split(',').next().unwrap_or_default().trim().to_owned();
        ShowStyle::of_name(&name).map(|_| name)
    };
    let mut places = text.match_indices(['=', ':']).filter_map(|(at, _)| Some((at, style_of(&text[at + 1..])?)));
    let (selection, rest, style) = match (places.next(), style_of(text)) {
        (Some((at, style)), _) => (Some(text[..at].trim()), &text[at + 1..], style),
        (None, Some(style)) => (None, text, style),
        (None, None) => {
            let last =
                text.rsplit(['=', ':']).next().and_then(|part| part.split(',').next()).unwrap_or_default().trim();
            return Err(format!("{}; write SELECTION = STYLE, such as 'resname HEM = sticks'", unknown_style(last)));
        }
    };
    // The spheres stand before the style.
    let pair =
        |part| pair(part).map_err(|problem| format!("{problem}; for some spheres, write '{} = {style}'", part.trim()));
    let pairs = rest.split(',').skip(1).map(pair).collect::<Result<Vec<_>, _>>()?;
    let select = selection.filter(|text| !text.is_empty()).map(|text| format!("select = {}", quoted(text)));
    let keys: Vec<String> = select.into_iter().chain([format!("as = {}", quoted(&style))]).chain(pairs).collect();
    Ok(format!("show = [{{ {} }}]", keys.join(", ")))
}

pub(super) fn hide(text: &str) -> Result<String, String> {
    Ok(rule_of(text, "hidden"))
}

pub(super) fn ghost(text: &str) -> Result<String, String> {
    Ok(rule_of(text, "ghost"))
}

fn rule_of(selection: &str, style: &str) -> String {
    format!("show = [{{ select = {}, as = {} }}]", quoted(selection), quoted(style))
}

/// Reads `NAME=SELECTION`.
pub(super) fn define(text: &str) -> Result<String, String> {
    let (name, selection) =
        text.split_once('=').ok_or("write NAME=SELECTION, such as 'pocket=within 5 of resname HEM'")?;
    Ok(format!("selections = {{ {} = {} }}", quoted(name.trim()), quoted(selection.trim())))
}

/// Reads the ends of a range: numbers, percentiles, or nothing.
pub(super) fn range(text: &str) -> Result<String, String> {
    text.parse::<crate::color_by::Limits>().map_err(|error| error.to_string())?;
    let end = |text: &str| match text.trim().parse::<f64>() {
        Ok(number) => toml_number(number),
        Err(_) => quoted(text.trim()),
    };
    let ends: Vec<String> = text.split(',').map(end).collect();
    Ok(format!("[{}]", ends.join(", ")))
}

/// Reads `COLUMN*F`, a column and a factor.
pub(super) fn with_factor(text: &str) -> Result<String, String> {
    let factor = text.rsplit_once('*').and_then(|(column, factor)| Some((column, factor.trim().parse::<f64>().ok()?)));
    Ok(match factor {
        Some((column, factor)) => {
            let (column, factor) = (quoted(column.trim()), toml_number(factor));
            format!("{{ column = {column}, factor = {factor} }}")
        }
        None => quoted(text),
    })
}

fn position(position: Position) -> String {
    match position {
        Position::Anchor(anchor) => quoted(anchor.name()),
        Position::At([x, y]) => format!("[{x:?}, {y:?}]"),
    }
}

pub(super) fn legend(text: &str) -> Result<String, String> {
    let at = text.parse::<Position>().map_err(|error| error.to_string())?;
    Ok(format!("legend.position = {}", position(at)))
}

pub(super) fn axes(text: &str) -> Result<String, String> {
    if text.is_empty() {
        return Ok("axes = {}".to_owned());
    }
    let at = text.parse::<Position>().map_err(|error| error.to_string())?;
    Ok(format!("axes = {{ position = {} }}", position(at)))
}

/// Splits `TEXT@POSITION`. The part after the last @ belongs to the text unless it is a position.
fn at_position(text: &str) -> (&str, Option<Position>) {
    let split =
        text.rsplit_once('@').and_then(|(text, position)| Some((text, Some(position.parse::<Position>().ok()?))));
    split.unwrap_or((text, None))
}

pub(super) fn label(text: &str) -> Result<String, String> {
    let (text, at) = at_position(text);
    let at = at.map_or(String::new(), |at| format!(", position = {}", position(at)));
    Ok(format!("labels = [{{ text = {}{at} }}]", quoted(text)))
}

/// Reads a length, a unit, or both.
pub(super) fn scale_bar(text: &str) -> Result<String, String> {
    let (text, at) = at_position(text);
    let text = text.trim();
    // The longest beginning that is a number.
    let ends = text.char_indices().map(|(start, c)| start + c.len_utf8()).rev();
    let number = ends.filter_map(|end| Some((text[..end].trim_end().parse::<f64>().ok()?, end)));
    let number = number.into_iter().find(|(length, _)| length.is_finite());
    let (length, unit) = match number {
        Some((length, end)) => (Some(length), &text[end..]),
        None => (None, text),
    };
    let keys = [
        Some(format!("unit = {}", quoted(unit.trim()))),
        length.map(|length| format!("length = {length:?}")),
        at.map(|at| format!("position = {}", position(at))),
    ];
    let keys: Vec<String> = keys.into_iter().flatten().collect();
    Ok(format!("scale_bar = {{ {} }}", keys.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_bar_has_a_length_and_a_unit() {
        for (text, toml) in [
            ("", "unit = \"\""),
            ("20 Å", "unit = \"Å\", length = 20.0"),
            ("2.5e3", "unit = \"\", length = 2500.0"),
            ("5eV", "unit = \"eV\", length = 5.0"),
            ("µm@bottom-right", "unit = \"µm\", position = \"bottom-right\""),
            ("inf", "unit = \"inf\""),
        ] {
            assert_eq!(scale_bar(text).unwrap(), format!("scale_bar = {{ {toml} }}"));
        }
    }

    #[test]
    fn a_label_ends_before_its_position() {
        assert_eq!(label("me@home").unwrap(), "labels = [{ text = \"me@home\" }]");
        assert_eq!(label("a@b@0.5,1").unwrap(), "labels = [{ text = \"a@b\", position = [0.5, 1.0] }]");
    }

    #[test]
    fn any_key_gets_a_number_a_list_or_a_text() {
        for (text, toml) in [
            ("studio.outline.width=2", "studio.outline.width = 2"),
            ("background=white", "background = \"white\""),
            ("studio.ambient = [1, 0.5, 0]", "studio.ambient = [1, 0.5, 0]"),
            ("select=x == 1", "select = \"x == 1\""),
        ] {
            assert_eq!(set(text).unwrap(), toml);
        }
        for text in ["width", "=3", "a..b=1", "a=", "a b=1"] {
            assert!(set(text).is_err(), "{text}");
        }
    }
}
