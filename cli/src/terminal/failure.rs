//! Failures of the program, with their messages and exit codes.

use std::fmt;
use std::process::ExitCode;

/// Exit code of a job that failed.
pub(crate) const FAILED: u8 = 1;

/// Exit code of wrong usage.
pub(crate) const USAGE: u8 = 2;

/// Exit code of a check that found something wrong.
pub(crate) const CHECK_FAILED: u8 = 3;

/// Exit code of a check that found nothing wrong, but could not decide enough.
pub(crate) const UNDECIDED: u8 = 4;

/// Exit code of a job whose device was lost or did not answer in time. Another try may succeed.
pub(crate) const DEVICE: u8 = 5;

/// Exit code of a job that a signal stopped, as shells use it for SIGINT.
pub(crate) const STOPPED: u8 = 130;

/// The message of a stopped job.
pub(crate) const NOTHING_WRITTEN: &str = "stopped; nothing was written";

/// A failure: one line for the user, and an exit code.
#[derive(Debug)]
pub(crate) enum Failure {
    Usage(anyhow::Error),
    Job(anyhow::Error),
    /// The job was done, and its check found a violation.
    CheckFailed(anyhow::Error),
    /// The job was done, and its check found no violation, but left too much undecided.
    Undecided(anyhow::Error),
    /// The device was lost or did not answer in time.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "without a device there is none"))]
    Device(anyhow::Error),
    /// The user stopped the job while a device was at work.
    Stopped,
    /// The user stopped the job after some of several files were complete, as the message says.
    StoppedBetween(&'static str),
}

impl Failure {
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self::Usage(anyhow::Error::msg(message.into()))
    }

    /// Returns the error with all its contexts.
    pub(crate) fn message(&self) -> String {
        match self {
            Self::Usage(error)
            | Self::Job(error)
            | Self::CheckFailed(error)
            | Self::Undecided(error)
            | Self::Device(error) => format!("{error:#}"),
            Self::Stopped => NOTHING_WRITTEN.to_owned(),
            Self::StoppedBetween(message) => (*message).to_owned(),
        }
    }

    pub(crate) fn exit_code(&self) -> ExitCode {
        match self {
            Self::Usage(_) => USAGE.into(),
            Self::Job(_) => FAILED.into(),
            Self::CheckFailed(_) => CHECK_FAILED.into(),
            Self::Undecided(_) => UNDECIDED.into(),
            Self::Device(_) => DEVICE.into(),
            Self::Stopped | Self::StoppedBetween(_) => STOPPED.into(),
        }
    }
}

impl From<anyhow::Error> for Failure {
    fn from(error: anyhow::Error) -> Self {
        Self::Job(error)
    }
}

impl fmt::Display for Failure {
    /// Writes the line that the program prints before it ends.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stopped | Self::StoppedBetween(_) => f.write_str(&self.message()),
            _ => write!(f, "error: {}", self.message()),
        }
    }
}
