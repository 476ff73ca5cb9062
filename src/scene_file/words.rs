//! What is wrong with a scene file, in its writer's words.

use crate::camera::CameraKind;
use crate::text::{one_line, shortened};

/// Puts serde's words for an unknown key or name into a user's, with a suggestion.
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
        // toml's messages of its own are good, but may span lines.
        _ => return in_plain_words(message),
    };
    // unknown field `widht`, expected one of `width`, `height`
    let mut quoted = rest.split('`').step_by(2);
    let name = quoted.next().unwrap_or_default();
    let known: Vec<&str> = quoted.filter(|name| !name.is_empty()).collect();
    unknown(what, name, &known)
}

/// What to say of a name that is none of those that are known.
pub(super) fn unknown(what: &str, name: &str, known: &[&str]) -> String {
    let unknown = &shortened(name);
    let nearest = known.iter().copied().max_by(|a, b| {
        strsim::jaro_winkler(a, unknown).total_cmp(&strsim::jaro_winkler(b, unknown))
    });
    match nearest.filter(|name| strsim::jaro_winkler(name, unknown) > 0.75) {
        Some(nearest) => format!("unknown {what} `{unknown}`; did you mean `{nearest}`?"),
        None => format!("unknown {what} `{unknown}`; known here: {}", known.join(", ")),
    }
}

/// Puts Rust's words for types, and serde's for a missing key, into a user's.
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

/// `[camera.pinhole]` or …
fn camera_tables() -> String {
    let tables = CameraKind::ALL.iter().map(|kind| format!("`[camera.{}]`", kind.name()));
    tables.collect::<Vec<_>>().join(" or ")
}
