//! Flags and commands that earlier versions had, and what to use instead.

use clap::error::{ContextKind, ContextValue};

/// Flags and commands that are gone, with what to use instead. The words of a command before a flag say that only this
/// command had it.
const REMOVED: &[(&str, &str)] = &[
    ("--samples-per-part", "divide pictures by `pinhole job split --tiles CxR`"),
    ("job join", "`pinhole job merge` puts all parts together in one pass"),
    ("job status --json", "`pinhole job status JOB --missing` lists units, one a line"),
    ("job submit", "submit an array of `pinhole job part` yourself; docs/scale.md has the scripts"),
];

/// Returns the message about a flag or a command that was removed. `arguments` are those of the program, without its
/// name. `None` if the error is about something else.
pub(super) fn message(error: &clap::Error, arguments: &[String]) -> Option<String> {
    let kinds = [ContextKind::InvalidArg, ContextKind::InvalidSubcommand];
    let names = kinds.into_iter().filter_map(|kind| match error.get(kind) {
        Some(ContextValue::String(name)) => Some(name),
        _ => None,
    });
    let is_named = |removed: &str| {
        let (command, last) = removed.rsplit_once(' ').unwrap_or(("", removed));
        let words = command.split_whitespace();
        names.clone().any(|name| name == last)
            && words
                .enumerate()
                .all(|(place, word)| arguments.get(place).is_some_and(|a| a == word))
    };
    let (removed, successor) = REMOVED.iter().find(|(removed, _)| is_named(removed))?;
    Some(format!("error: `{removed}` was removed; {successor}"))
}
