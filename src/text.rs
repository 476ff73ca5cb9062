//! Fits text from files into one-line messages.

/// The text on one line: runs of white space become one space, and control characters are escaped.
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

/// The text, shortened to 40 characters and an ellipsis if it is longer, with control characters escaped.
#[must_use]
pub fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    let mut shown = String::new();
    for (index, c) in text.chars().enumerate() {
        match c {
            _ if index == MOST => {
                shown.push('…');
                break;
            }
            c if c.is_control() => shown.extend(c.escape_default()),
            c => shown.push(c),
        }
    }
    shown
}

/// The first names, at most `most` of them, with an ellipsis if there are more.
pub fn listed(mut names: impl Iterator<Item = String>, most: usize) -> String {
    let shown: Vec<String> = names.by_ref().take(most).collect();
    shown.join(", ") + if names.next().is_some() { ", …" } else { "" }
}

/// The text without the byte order mark that some editors put before UTF-8.
#[must_use]
pub fn without_byte_order_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}
