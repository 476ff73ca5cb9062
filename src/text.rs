//! Fitting foreign text into a one-line message.

/// The text on one line, whatever white space it has.
#[cfg(any(feature = "scene-file", feature = "cli"))]
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The text, cut off where it becomes too long for a message.
#[cfg(feature = "xyz")]
pub(crate) fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    if text.chars().count() <= MOST {
        return text.to_owned();
    }
    text.chars().take(MOST).chain(['…']).collect()
}
