//! Writes single values of a scene file.

use std::fmt::Write as _;

use crate::image::color::LinearRgb;

/// A colour: in 8-bit sRGB if that is exact, and as a linear triple otherwise.
pub(super) fn color(color: LinearRgb) -> String {
    let [r, g, b] = color.to_srgb8();
    if LinearRgb::from_srgb8([r, g, b]) == color {
        return format!("\"#{r:02x}{g:02x}{b:02x}\"");
    }
    format!("{:?}", color.to_array())
}

/// An angle in degrees from which `is_same` finds the same radians: a round number if one does.
pub(super) fn degrees_of(radians: f64, is_same: impl Fn(f64) -> bool) -> f64 {
    let exact = radians.to_degrees();
    let round = [1e2, 1e6, 1e9].map(|digits| (exact * digits).round() / digits);
    let near = [exact, exact.next_up(), exact.next_down()];
    let further = [exact.next_up().next_up(), exact.next_down().next_down()];
    let all = round.into_iter().chain(near).chain(further);
    all.into_iter().find(|degrees| is_same(degrees.to_radians())).unwrap_or(exact)
}

/// A text in quotes.
pub(super) fn string(text: &str) -> String {
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

/// Texts in quotes, as a list.
pub(super) fn strings(list: &[String]) -> String {
    let quoted: Vec<String> = list.iter().map(|one| string(one)).collect();
    format!("[{}]", quoted.join(", "))
}
