//! What the program says about a flag that it does not know.

use clap::error::{ContextKind, ContextValue};
use clap::{Command, CommandFactory};

use super::color_flags;
use super::commands::Arguments;

/// Commands that take scene files and have no flags for columns of data.
const SCENES: [&str; 3] = ["verify", "plan", "bench"];

/// How alike a flag must be to be proposed, from 0 to 1.
const ALIKE: f64 = 0.7;

/// Returns the message about an unknown flag: a flag that is spelled alike, or where the flag belongs, or where all flags
/// are listed. `arguments` are those of the program, without its name. `None` if the error is not about a flag.
pub(super) fn message(error: &clap::Error, arguments: &[String]) -> Option<String> {
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
                _ if is_of_columns(flag, &program) && SCENES.contains(&command.get_name()) => {
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

/// Whether a flag says what the columns of data mean.
fn is_of_columns(flag: &str, program: &Command) -> bool {
    let render = program.find_subcommand("render");
    let of_columns = |arg: &&clap::Arg| arg.get_help_heading() == Some(color_flags::HEADING);
    let mut names = render.into_iter().flat_map(Command::get_opts).filter(of_columns);
    names.any(|arg| arg.get_long().is_some_and(|name| flag.strip_prefix("--") == Some(name)))
}

/// The long flags of a command, with both dashes.
fn flags(command: &Command) -> impl Iterator<Item = String> {
    command.get_opts().filter_map(|flag| flag.get_long()).map(|name| format!("--{name}"))
}

/// The flag of a command that is spelled most alike, if one is.
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
    use clap::Parser;

    use super::*;

    #[test]
    fn a_flag_that_is_not_known_gets_a_useful_hint() {
        for (line, hint) in [
            ("render a.xyz --colour red", "did you mean --color?"),
            ("render a.xyz --Colour-by x", "did you mean --color-by?"),
            ("render a.xyz --sampels=4", "did you mean --samples?"),
            ("render a.xyz --lable b", "did you mean --label?"),
            ("render a.xyz --width 5", "`pinhole render --help` lists the flags"),
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
            let message = message(&error, &arguments).unwrap();
            let flag = arguments.iter().find(|word| word.starts_with('-'));
            let flag = flag.unwrap().split('=').next().unwrap();
            assert!(message.contains(&format!("'{flag}' found; {hint}")), "{line}: {message}");
        }
        let error = Arguments::try_parse_from(["pinhole", "render", "a", "b"]).unwrap_err();
        assert_eq!(message(&error, &[]), None);
    }
}
