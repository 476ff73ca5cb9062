//! The process and its terminal: words, failures, signals, threads, memory, time.

pub(crate) mod explain;
pub(crate) mod failure;
pub(crate) mod interrupt;
pub(crate) mod memory;
#[cfg(feature = "gpu")]
pub(crate) mod profile;
pub(crate) mod progress;
pub(crate) mod text;
pub(crate) mod threads;

/// Without devices, no phase is measured.
#[cfg(not(feature = "gpu"))]
pub(crate) mod profile {
    pub(crate) struct NoPhase;

    impl Drop for NoPhase {
        /// Ends the phase, like that of a profile.
        fn drop(&mut self) {}
    }

    pub(crate) fn phase(_: &'static str) -> NoPhase {
        NoPhase
    }
}
