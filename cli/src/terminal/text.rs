//! Tables for people, shell quoting, so that command lines can be repeated, and parsers for named values.

use anyhow::Context;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use pinhole::internals::text::is_control;

/// Formats a report as JSON. Its texts keep their control characters, but as `\u009b`, so that a terminal may show it.
pub(crate) fn json(report: &impl serde::Serialize) -> anyhow::Result<String> {
    let text = serde_json::to_string_pretty(report).context("the report cannot be written as JSON")?;
    let escaped = |c| if c != '\n' && is_control(c) { format!("\\u{:04x}", u32::from(c)) } else { String::from(c) };
    Ok(text.chars().map(escaped).collect::<String>() + "\n")
}

/// Formats rows under a heading, indented by two spaces.
#[cfg(feature = "gpu")]
pub(crate) fn table<const N: usize>(heading: [&str; N], rows: &[[String; N]]) -> String {
    let heading = heading.map(str::to_owned);
    let all = || std::iter::once(&heading).chain(rows);
    let mut widths = [0; N];
    for row in all() {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = cell.chars().count().max(*width);
        }
    }
    let mut text = String::new();
    for row in all() {
        let cells = row.iter().zip(widths).enumerate().map(|(column, (cell, width))| {
            if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        let line = cells.collect::<Vec<_>>().join("  ");
        text += &format!("  {}\n", line.trim_end());
    }
    text
}

/// A parser of names. Each has its help, which is not shown if empty, and its value.
pub(crate) fn one_of<T: Copy + Send + Sync + 'static>(
    all: &'static [(&'static str, &'static str, T)],
) -> impl TypedValueParser<Value = T> {
    let names = all.iter().map(|(name, help, _)| match *help {
        "" => PossibleValue::new(*name),
        help => PossibleValue::new(*name).help(help),
    });
    PossibleValuesParser::new(names).try_map(|name| {
        let found = all.iter().find(|(other, ..)| *other == name);
        found.map(|(.., value)| *value).ok_or("this name has no meaning here")
    })
}

/// Quotes a word for a shell. A word without special characters stays as it is.
pub(crate) fn in_quotes(text: &str) -> String {
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
    #[cfg(feature = "gpu")]
    fn columns_are_as_wide_as_their_widest_cell() {
        let rows = [["a".to_owned(), "1".to_owned()], ["bcd".to_owned(), "23456".to_owned()]];
        assert_eq!(table(["x", "n"], &rows), "  x        n\n  a        1\n  bcd  23456\n");
    }

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
