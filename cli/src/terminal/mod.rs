//! The process and its terminal: output, failures, signals, threads, memory and time.

pub(crate) mod explain;
pub(crate) mod failure;
pub(crate) mod interrupt;
pub(crate) mod memory;
#[cfg(feature = "gpu")]
pub(crate) mod profile;
pub(crate) mod progress;
pub(crate) mod text;
pub(crate) mod threads;

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
