//! The process and its terminal: words, output, failures, signals, threads, memory and time.

use std::ffi::OsString;
use std::sync::Mutex;

pub(crate) mod explain;
pub(crate) mod failure;
pub(crate) mod habits;
pub(crate) mod interrupt;
pub(crate) mod memory;
#[cfg(feature = "gpu")]
pub(crate) mod profile;
pub(crate) mod progress;
pub(crate) mod text;
pub(crate) mod threads;

/// The words of the command line as clap parsed them, with the name of the program.
static WORDS: Mutex<Vec<OsString>> = Mutex::new(Vec::new());

/// The words of the command line as clap parsed them, with the name of the program.
pub(crate) fn words() -> Vec<OsString> {
    WORDS.lock().map(|words| words.clone()).unwrap_or_default()
}

/// Keeps the words of the command line for [`words`].
pub(crate) fn keep_words(words: Vec<OsString>) {
    if let Ok(mut kept) = WORDS.lock() {
        *kept = words;
    }
}

/// Without devices, phases are not measured.
#[cfg(not(feature = "gpu"))]
pub(crate) mod profile {
    pub(crate) struct NoPhase;

    impl Drop for NoPhase {
        /// Ends the phase, as the one of a profile does.
        fn drop(&mut self) {}
    }

    pub(crate) fn phase(_: &'static str) -> NoPhase {
        NoPhase
    }
}
