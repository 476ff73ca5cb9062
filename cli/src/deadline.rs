//! Ends the program if a driver does not answer in time, because one that hangs cannot be stopped in any other way.

#[cfg(feature = "gpu")]
use std::sync::OnceLock;
#[cfg(feature = "gpu")]
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use super::failure::DEVICE;
use super::progress;
use super::speak::tell;

/// The time that opening and testing a device may take, and what is called with the reason when it took longer.
#[cfg(feature = "gpu")]
static OPENING: OnceLock<(Duration, Box<Late>)> = OnceLock::new();

#[cfg(feature = "gpu")]
type Late = dyn Fn(&str) + Send + Sync;

/// Limits the time of each [`opening`] from now on. `late` is called before the program ends.
#[cfg(feature = "gpu")]
pub(super) fn limit_opening(limit: Duration, late: impl Fn(&str) + Send + Sync + 'static) {
    let _ = OPENING.set((limit, Box::new(late)));
}

/// Opens a device, and ends the program if that takes longer than it may.
#[cfg(feature = "gpu")]
pub(super) fn opening<T>(open: impl FnOnce() -> T) -> T {
    let Some((limit, late)) = OPENING.get() else {
        return open();
    };
    let (opened, is_opened) = channel::<()>();
    let watch = move || {
        if is_opened.recv_timeout(*limit) == Err(RecvTimeoutError::Timeout) {
            let why = format!("no device was ready within {} s", limit.as_secs_f64());
            late(&why);
            give_up(&why);
        }
    };
    if let Err(error) = std::thread::Builder::new().spawn(watch) {
        say_unlimited(&error);
    }
    let result = open();
    drop(opened);
    result
}

/// Says that nothing ends a driver that hangs.
pub(super) fn say_unlimited(error: &std::io::Error) {
    tell(format_args!(
        "note: --timeout has no effect, because a thread cannot be started: {error}"
    ));
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
