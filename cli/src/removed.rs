//! Flags and commands that earlier versions had, and what to use instead.

use clap::error::{ContextKind, ContextValue};

/// Flags, their values, and commands that are gone, with what to use instead. The words of a command before a flag say
/// that only this command had it.
const REMOVED: &[(&str, &str)] = &[
    ("--samples-per-part", "divide pictures by `pinhole job split --tiles CxR`"),
    ("job join", "`pinhole job merge` puts all parts together in one pass"),
    ("job status --json", "`pinhole job status JOB --missing` lists units, one a line"),
    ("job submit", "submit an array of `pinhole job part` yourself; docs/scale.md has the scripts"),
    ("--accel binary-tree", "use --accel tree"),
    ("--profile=", "use `--profile`, which prints the table"),
    ("bench --calibrate", "`--accel auto` follows a rule that needs no measured prices"),
    ("bench --counts", "`pinhole bench` measures the time of a ray"),
    ("bench --pictures", "the structure is the same for one picture and for many"),
];

/// Returns the message about a flag or a command that was removed. `arguments` are those of the program, without its
/// name. `None` if the error is about something else.
pub(super) fn message(error: &clap::Error, arguments: &[String]) -> Option<String> {
    let kinds =
        [ContextKind::InvalidArg, ContextKind::InvalidSubcommand, ContextKind::InvalidValue];
    let names = kinds.into_iter().filter_map(|kind| match error.get(kind) {
        // A flag with a value is named as `--accel <ACCEL>`.
        Some(ContextValue::String(name)) => name.split(' ').next(),
        _ => None,
    });
    let has_value = error.get(ContextKind::InvalidValue).is_some();
    let is_named = |removed: &str| {
        // A flag that has no value any more.
        if let Some(flag) = removed.strip_suffix('=') {
            return has_value && names.clone().any(|name| name == flag);
        }
        let (before, last) = removed.rsplit_once(' ').unwrap_or(("", removed));
        let mut words = before.split_whitespace().enumerate();
        names.clone().any(|name| name == last)
            && words.all(|(place, word)| {
                let is_command = arguments.get(place).is_some_and(|argument| argument == word);
                is_command || word.starts_with("--") && names.clone().any(|name| name == word)
            })
    };
    let (removed, successor) = REMOVED.iter().find(|(removed, _)| is_named(removed))?;
    Some(format!("error: `{removed}` was removed; {successor}"))
}
