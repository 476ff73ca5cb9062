//! Ends the program if a driver does not answer in time, because one that hangs cannot be stopped in any other way.

#[cfg(feature = "gpu")]
use std::sync::OnceLock;
#[cfg(feature = "gpu")]
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use super::failure::DEVICE;
use super::progress;
use super::speak::tell;

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
    let Some(limit) = OPENING.get() else {
        return open();
    };
    let (opened, is_opened) = channel::<()>();
    let watch = move || {
        if is_opened.recv_timeout(*limit) == Err(RecvTimeoutError::Timeout) {
            give_up(&format!("no device was ready within {} s", limit.as_secs_f64()));
        }
    };
    let _ = std::thread::Builder::new().spawn(watch);
    let result = open();
    drop(opened);
    result
}

/// Ends the program with the exit code for devices that do not answer.
pub(super) fn give_up(why: &str) -> ! {
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
