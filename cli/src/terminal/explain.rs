//! Errors for wrong arguments, on one line, with a proposal.

use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, CommandFactory};

use crate::command_line::Arguments;
use crate::terminal::failure;
use crate::terminal::progress::{answer, tell, tell_all};
use pinhole_figure::settings::flags::{Flag, Group};

/// Prints the help or the version as clap formats it, or an error on one line. `arguments` are those of the program,
/// without its name.
pub(crate) fn explain(error: &clap::Error, arguments: &[String]) -> ExitCode {
    if let Some(message) = removed_message(error, arguments) {
        tell(message);
        return failure::USAGE.into();
    }
    let text = error.to_string();
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => match answer(text.as_bytes()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(_) => failure::FAILED.into(),
        },
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            tell_all(&text);
            failure::USAGE.into()
        }
        ErrorKind::UnknownArgument => {
            tell(unknown_message(error, arguments).as_deref().unwrap_or(one_message(&text)));
            failure::USAGE.into()
        }
        _ => {
            tell(one_message(&text));
            failure::USAGE.into()
        }
    }
}

/// The message of an error without the usage, which would make it longer than a line.
pub(crate) fn one_message(text: &str) -> &str {
    let message = text.split("\n\nUsage:").next().unwrap_or_default();
    message.split("\n\nFor more information").next().unwrap_or_default()
}

/// Removed flags, values and commands, with their replacements. Words before the last one name the command, or the
/// flag of a value, to which an entry applies.
const REMOVED: &[(&str, &str)] = &[
    ("--samples-per-part", "divide pictures by `pinhole job split --tiles CxR`"),
    ("job join", "`pinhole job merge` puts all parts together in one pass"),
    ("job status --json", "`pinhole job status JOB --missing` lists units, one a line"),
    ("job submit", "submit an array of `pinhole job part`: docs/how-to/clusters.md has scripts"),
    ("--accel binary-tree", "use --accel tree"),
    ("--profile=", "use `--profile`, which prints the table"),
    ("bench --calibrate", "`--accel auto` follows a rule that needs no measured prices"),
    ("bench --counts", "`pinhole bench` measures the time of a ray"),
    ("bench --pictures", "the structure is the same for one picture and for many"),
];

/// Returns the message about a flag or a command that was removed. `arguments` are those of the program, without its
/// name. `None` if the error has another cause.
pub(crate) fn removed_message(error: &clap::Error, arguments: &[String]) -> Option<String> {
    let kinds = [ContextKind::InvalidArg, ContextKind::InvalidSubcommand, ContextKind::InvalidValue];
    let names = kinds.into_iter().filter_map(|kind| match error.get(kind) {
        // clap names a flag with a value as `--accel <ACCEL>`.
        Some(ContextValue::String(name)) => name.split(' ').next(),
        _ => None,
    });
    let has_value = error.get(ContextKind::InvalidValue).is_some();
    let is_named = |removed: &str| {
        // This flag has no value any more.
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

/// Commands that take scene files and have no flags for columns of data.
const SCENES: [&str; 3] = ["verify", "plan", "bench"];

/// The similarity from which a flag is proposed, from 0 to 1.
const ALIKE: f64 = 0.7;

/// Returns the message about an unknown flag: a similar flag, or the command of the flag, or the place where flags are
/// listed. `arguments` are those of the program, without its name. `None` if the error is not about a flag.
pub(crate) fn unknown_message(error: &clap::Error, arguments: &[String]) -> Option<String> {
    let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg) else { return None };
    if !flag.starts_with('-') {
        return None;
    }
    let mut program = Arguments::command();
    program.build();
    let command = arguments.iter().find_map(|argument| program.find_subcommand(argument));
    let hint = match command {
        Some(command) => {
            // Flags of `view` are flags of `render`.
            let others = program.get_subcommands().filter(|other| other.get_name() != "view");
            let others = others.filter(|other| flags(other).any(|f| f == *flag));
            let others: Vec<_> = others.map(|other| format!("`{}`", other.get_name())).collect();
            match nearest(flag, command) {
                _ if is_of_columns(flag) && SCENES.contains(&command.get_name()) => {
                    format!(
                        "it is a flag of `render`; with --print-scene, `pinhole render` writes a scene file that has it, for \
                     `{}`",
                        command.get_name()
                    )
                }
                _ if !others.is_empty() => format!("it is a flag of {}", others.join(", ")),
                Some(nearest) => format!("did you mean {nearest}?"),
                None => format!("`pinhole {} --help` lists the flags", command.get_name()),
            }
        }
        None => "`pinhole --help` lists the commands, which have the flags".to_owned(),
    };
    Some(format!("error: unexpected argument '{flag}' found; {hint}"))
}

fn is_of_columns(flag: &str) -> bool {
    let flag = flag.strip_prefix("--").and_then(Flag::of_name);
    flag.is_some_and(|flag| matches!(flag.group, Group::Color | Group::Annotation))
}

/// The long flags of a command, with both dashes.
fn flags(command: &Command) -> impl Iterator<Item = String> {
    command.get_opts().filter_map(|flag| flag.get_long()).map(|name| format!("--{name}"))
}

/// The most similar flag of a command, if one is similar enough.
fn nearest(unknown: &str, command: &Command) -> Option<String> {
    let unknown = unknown.to_lowercase();
    let likeness = |flag: &String| {
        let [flag, unknown] = [flag, &unknown].map(|name| name.trim_start_matches('-'));
        strsim::normalized_damerau_levenshtein(flag, unknown)
    };
    let all = flags(command).map(|flag| (likeness(&flag), flag));
    let best = all.max_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(likeness, _)| *likeness >= ALIKE).map(|(_, flag)| flag)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[test]
    fn a_flag_that_is_not_known_gets_a_useful_hint() {
        for (line, hint) in [
            ("render a.xyz --colours red", "did you mean --color?"),
            ("render a.xyz --Colour-by x", "did you mean --color-by?"),
            ("render a.xyz --sampels=4", "did you mean --samples?"),
            ("render a.xyz --lable b", "did you mean --label?"),
            ("render a.xyz --blur 5", "`pinhole render --help` lists the flags"),
            ("render a.xyz -z", "`pinhole render --help` lists the flags"),
            ("info a.xyz --color red", "it is a flag of `render`, `verify`"),
            (
                "verify a.xyz --radius-by r",
                "it is a flag of `render`; with --print-scene, `pinhole render` writes a scene file that has it, for \
                 `verify`",
            ),
            ("info a.xyz --color-by x", "it is a flag of `render`"),
            ("--color red", "`pinhole --help` lists the commands, which have the flags"),
        ] {
            let arguments: Vec<String> = line.split(' ').map(str::to_owned).collect();
            let all = ["pinhole"].into_iter().chain(line.split(' '));
            let error = Arguments::try_parse_from(all).unwrap_err();
            let message = unknown_message(&error, &arguments).unwrap();
            let flag = arguments.iter().find(|word| word.starts_with('-'));
            let flag = flag.unwrap().split('=').next().unwrap();
            assert!(message.contains(&format!("'{flag}' found; {hint}")), "{line}: {message}");
        }
        let error = Arguments::try_parse_from(["pinhole", "render", "a", "b"]).unwrap_err();
        assert_eq!(unknown_message(&error, &[]), None);
    }
}
