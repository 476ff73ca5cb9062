//! Fits text from files into one-line messages.

/// A text that came from a file as it may be shown in a terminal, in JSON, on a page and in an error: on one line, with
/// control characters escaped, and with an ellipsis after 200 characters.
#[must_use]
pub fn one_line(text: &str) -> String {
    fitted(text, 200)
}

/// One line with an ellipsis after 40 characters, for a word within a sentence.
#[must_use]
pub fn shortened(text: &str) -> String {
    fitted(text, 40)
}

/// One line for a whole line of the program, which may quote several texts and paths: at most 10,000 characters.
#[must_use]
pub fn whole_line(text: &str) -> String {
    fitted(text, 10_000)
}

/// Returns true if a character can change how a terminal or a browser shows the text around it: a control character of
/// the sets C0 and C1, or one that changes the direction of text.
#[must_use]
pub fn is_control(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Makes one space of each run of white space, escapes control characters, and cuts after `most` characters.
fn fitted(text: &str, most: usize) -> String {
    let mut shown = String::new();
    let all = text.split_whitespace().flat_map(|word| std::iter::once(' ').chain(word.chars())).skip(1);
    for (index, c) in all.enumerate() {
        if index == most {
            shown.push('…');
            break;
        }
        if is_control(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_from_files_is_one_short_line_without_control_characters() {
        let shown = one_line("a \n\tb \u{1b}]0;x\u{7} \u{9b}2J \u{202e}c\u{2069}");
        assert_eq!(shown, "a b \\u{1b}]0;x\\u{7} \\u{9b}2J \\u{202e}c\\u{2069}");
        assert_eq!(one_line(&"(".repeat(1 << 20)).chars().count(), 201);
        assert_eq!(shortened(&"ü".repeat(41)), "ü".repeat(40) + "…");
        let all = (0..=u32::from(char::MAX)).filter_map(char::from_u32).map(String::from);
        assert!(all.map(|c| whole_line(&c)).all(|shown| !shown.contains(is_control)));
    }
}
