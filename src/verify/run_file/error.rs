//! Errors of run files, and the format's version and digest.

use sha2::{Digest, Sha256};

/// The version of the format that this crate writes and reads.
pub const VERSION: &str = "8";

/// Why bytes are not a valid run file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RunFileError {
    /// The file has another format.
    #[error("this is not a run file; `pinhole verify --save` writes one")]
    NotRun,
    /// The end of the file is missing.
    #[error("the run file is cut off: it has {found} bytes of {expected}; copy it again")]
    Truncated {
        /// Number of bytes in the file.
        found: u64,
        /// Number of bytes that the header promises.
        expected: u64,
    },
    /// The file has another version of the format.
    #[error("run file of version {0}; this program reads version {VERSION}; record it again with `verify --save`")]
    Version(String),
    /// The file cannot be read.
    #[error("the run file cannot be read: {0}")]
    Unreadable(String),
    /// The file differs from the file that was written.
    #[error("the run file was altered after it was written: its SHA-256 digest does not match; copy it again")]
    Altered,
    /// The file is unaltered, but its contents are not valid.
    #[error("the run file contradicts itself: {0}")]
    Contents(String),
    /// There is not enough memory.
    #[error("there is not enough memory for the run's {name}, which need {bytes} bytes")]
    Memory {
        /// Name of the array.
        name: String,
        /// Size of the array in bytes.
        bytes: u64,
    },
}

impl From<std::io::Error> for RunFileError {
    fn from(error: std::io::Error) -> Self {
        Self::Unreadable(error.to_string())
    }
}

/// A finished digest in hexadecimal digits.
pub(crate) fn hex(digest: Sha256) -> String {
    data_encoding::HEXLOWER.encode(&digest.finalize())
}
