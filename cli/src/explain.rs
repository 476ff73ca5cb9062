//! What the program says about a command line that it does not understand.

use std::process::ExitCode;

use clap::error::ErrorKind;

use super::speak::{answer, tell, tell_all};
use super::{failure, removed, unknown_flag};

/// Prints the help or the version as clap formats it, and an error on one line. `arguments` are those of the program,
/// without its name.
pub(super) fn explain(error: &clap::Error, arguments: &[String]) -> ExitCode {
    if let Some(message) = removed::message(error, arguments) {
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
            tell(unknown_flag::message(error, arguments).as_deref().unwrap_or(one_message(&text)));
            failure::USAGE.into()
        }
        _ => {
            tell(one_message(&text));
            failure::USAGE.into()
        }
    }
}

/// The message of an error without the usage, which would make it longer than a line.
pub(super) fn one_message(text: &str) -> &str {
    let message = text.split("\n\nUsage:").next().unwrap_or_default();
    message.split("\n\nFor more information").next().unwrap_or_default()
}
