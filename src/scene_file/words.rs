//! Rewrites the messages of serde and toml in the words of scene files.

use crate::camera::CameraKind;
use crate::text::{one_line, shortened};

/// Rewrites a message of serde or toml. A message about an unknown key or name also gets a suggestion.
pub(super) fn explain(message: &str) -> String {
    let (what, rest) = match message.split_once(" `") {
        Some(("unknown field", rest)) => ("key", rest),
        Some(("unknown variant", rest)) => ("name", rest),
        // The camera is the only enumeration whose variants have contents.
        _ if message.starts_with("wanted exactly 1 element, more") => {
            return "a scene has one camera; remove the other tables `[camera.…]`".to_owned();
        }
        _ if message.starts_with("wanted exactly 1 element")
            || message.starts_with("invalid type: unit variant") =>
        {
            return format!("a camera is a table; write {}", camera_tables());
        }
        // The messages of toml itself are good, but may have several lines.
        _ => return in_plain_words(message),
    };
    // For example: unknown field `widht`, expected one of `width`, `height`
    let mut quoted = rest.split('`').step_by(2);
    let name = quoted.next().unwrap_or_default();
    let known: Vec<&str> = quoted.filter(|name| !name.is_empty()).collect();
    unknown(what, name, &known)
}

/// Returns the message for a name that is not one of the known names.
pub(super) fn unknown(what: &str, name: &str, known: &[&str]) -> String {
    let unknown = &shortened(name);
    let nearest = known.iter().copied().max_by(|a, b| {
        strsim::jaro_winkler(a, unknown).total_cmp(&strsim::jaro_winkler(b, unknown))
    });
    match nearest.filter(|name| strsim::jaro_winkler(name, unknown) > 0.75) {
        Some(nearest) => format!("unknown {what} `{unknown}`; did you mean `{nearest}`?"),
        None => format!("unknown {what} `{unknown}`; valid here: {}", known.join(", ")),
    }
}

/// Replaces Rust's names of types, and serde's term for a key, by plain words.
fn in_plain_words(message: &str) -> String {
    let mut text = one_line(message);
    for (rust, plain) in [
        ("expected f64", "expected a number"),
        ("expected f32", "expected a number"),
        ("expected u32", "expected a whole number from 0 to 4294967295"),
        ("expected usize", "expected a whole number, 0 or more"),
        ("missing field", "missing key"),
    ] {
        text = text.replace(rust, plain);
    }
    text
}

/// Lists the tables of all cameras: `[camera.pinhole]` or …
fn camera_tables() -> String {
    let tables = CameraKind::ALL.iter().map(|kind| format!("`[camera.{}]`", kind.name()));
    tables.collect::<Vec<_>>().join(" or ")
}
