//! Why the program ends without having done its job.

use std::fmt;
use std::process::ExitCode;

/// Exit code of a job that failed.
pub(super) const FAILED: u8 = 1;

/// Exit code of wrong usage.
pub(super) const USAGE: u8 = 2;

/// One line for the user, and an exit code.
#[derive(Debug)]
pub(super) enum Failure {
    /// The arguments cannot be what was meant.
    Usage(anyhow::Error),
    /// The job could not be done.
    Job(anyhow::Error),
}

impl Failure {
    pub(super) fn usage(message: impl Into<String>) -> Self {
        Self::Usage(anyhow::Error::msg(message.into()))
    }

    pub(super) fn exit_code(&self) -> ExitCode {
        match self {
            Self::Usage(_) => USAGE.into(),
            Self::Job(_) => FAILED.into(),
        }
    }
}

impl From<anyhow::Error> for Failure {
    fn from(error: anyhow::Error) -> Self {
        Self::Job(error)
    }
}

impl fmt::Display for Failure {
    /// The error with all its contexts.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Usage(error) | Self::Job(error)) = self;
        write!(f, "{error:#}")
    }
}
