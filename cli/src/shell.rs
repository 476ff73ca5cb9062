//! Words of command lines for shells, so that people and scripts can give them again.

/// A word for a shell, which is left as it is if no character has a meaning of its own there.
pub(super) fn in_quotes(text: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "/._-=+,%:@".contains(c);
    match !text.is_empty() && text.chars().all(is_plain) {
        true => text.to_owned(),
        false if cfg!(windows) => format!("\"{text}\""),
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(not(windows))]
    fn words_are_quoted_where_a_shell_needs_it() {
        assert_eq!(in_quotes("/a/b-1_2.png"), "/a/b-1_2.png");
        assert_eq!(in_quotes("/a b/f%04d.png"), "'/a b/f%04d.png'");
        assert_eq!(in_quotes("it's"), r"'it'\''s'");
        assert_eq!(in_quotes(""), "''");
        assert_eq!(in_quotes("$(rm)"), "'$(rm)'");
    }
}
