//! Ends the program if a driver does not answer in time, because one that hangs cannot be stopped in any other way.

#[cfg(feature = "gpu")]
use std::sync::OnceLock;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use super::failure::DEVICE;
use super::progress;
use super::speak::tell;

/// Work that must end in time. Dropping it says that the work has ended.
pub(super) struct Deadline {
    _ended: Sender<()>,
}

impl Deadline {
    /// Ends the program after this time, with the exit code for devices that do not answer and with what did not happen.
    pub(super) fn new(limit: Duration, what: String) -> Self {
        let (ended, is_ended) = channel();
        let watch = move || {
            if is_ended.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                give_up(&format!("{what} within {} s", limit.as_secs_f64()));
            }
        };
        if let Err(error) = std::thread::Builder::new().spawn(watch) {
            tell(format_args!(
                "note: --timeout has no effect, because a thread cannot be started: {error}"
            ));
        }
        Self { _ended: ended }
    }
}

/// The time that opening and testing a device may take.
#[cfg(feature = "gpu")]
static OPENING: OnceLock<Duration> = OnceLock::new();

/// Limits the time of each [`opening`] from now on.
#[cfg(feature = "gpu")]
pub(super) fn limit_opening(limit: Duration) {
    let _ = OPENING.set(limit);
}

/// Opens a device, and ends the program if that takes longer than it may.
#[cfg(feature = "gpu")]
pub(super) fn opening<T>(open: impl FnOnce() -> T) -> T {
    let limit = OPENING.get();
    let _deadline = limit.map(|limit| Deadline::new(*limit, "no device was ready".to_owned()));
    open()
}

/// Ends the program with the exit code for devices that do not answer.
fn give_up(why: &str) -> ! {
    progress::close();
    tell(format_args!("error: {why}; the device may hang: try again"));
    // What a driver does at the end of a process may hang as well.
    let _ = std::thread::Builder::new().spawn(|| {
        std::thread::sleep(Duration::from_secs(5));
        std::process::abort();
    });
    // The lock of signals is not held, so a file that is being renamed is renamed or not.
    std::process::exit(DEVICE.into());
}
