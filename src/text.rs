//! Fitting foreign text into a one-line message.

/// The text on one line, whatever white space it has; control characters are escaped.
#[must_use]
pub fn one_line(text: &str) -> String {
    let mut line = String::new();
    for c in text.split_whitespace().collect::<Vec<_>>().join(" ").chars() {
        if c.is_control() {
            line.extend(c.escape_default());
        } else {
            line.push(c);
        }
    }
    line
}

/// The text, cut off where it becomes too long for a message.
#[cfg(any(feature = "scene-file", feature = "xyz", feature = "npy", feature = "run-file"))]
pub(crate) fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    if text.chars().count() <= MOST {
        return text.to_owned();
    }
    text.chars().take(MOST).chain(['…']).collect()
}
