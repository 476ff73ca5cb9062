//! Handles Ctrl-C and other signals that ask the program to end. No incomplete file is left behind.
//!
//! The program normally exits at once. While a driver is at work, or on a picture that will be kept in part, the first
//! signal asks the work to stop and a second one exits. Files have temporary names, and are removed at a signal. They
//! get their final names under the lock of the signal handler, so either all files exist or none.

use std::path::PathBuf;
#[cfg(feature = "gpu")]
use std::sync::OnceLock;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use anyhow::Context;

use crate::terminal::failure::{DEVICE, Failure, NOTHING_WRITTEN, STOPPED};
#[cfg(unix)]
use crate::terminal::memory::ignores_hang_up;
use crate::terminal::progress::{self, tell};
#[cfg(feature = "gpu")]
use pinhole::gpu::Decision;

static STATE: Mutex<State> =
    Mutex::new(State { phase: Phase::Free, is_requested: false, temporaries: Vec::new(), message: NOTHING_WRITTEN });

struct State {
    phase: Phase,
    is_requested: bool,
    /// Temporary files to remove. The list may include files that were renamed or removed since.
    temporaries: Vec<PathBuf>,
    /// The message if the program is ended now.
    message: &'static str,
}

/// The work that a signal would interrupt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Work that can be interrupted at any time.
    Free,
    /// Work of a driver, whose threads must not be stopped abruptly, or on a picture that will be kept in part.
    Device,
    /// A pause during work with a driver, in which the driver has nothing to do and can be interrupted.
    #[cfg(feature = "gpu")]
    Rest,
}

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts to listen for Ctrl-C and other signals that end programs.
pub(crate) fn install() -> Result<(), Failure> {
    Ok(listen().context("the program cannot listen for signals such as Ctrl-C")?)
}

#[cfg(unix)]
fn listen() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    // With a handler for SIGXFSZ, a file that exceeds its size limit causes an ordinary error instead of ending
    // the program.
    signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default())?;
    let mut signals = vec![SIGINT, SIGTERM];
    // A handler for SIGHUP would undo the effect of `nohup`.
    if !ignores_hang_up() {
        signals.push(SIGHUP);
    }
    let mut signals = signal_hook::iterator::Signals::new(signals)?;
    std::thread::Builder::new().spawn(move || signals.forever().for_each(|_| on_signal()))?;
    Ok(())
}

#[cfg(not(unix))]
fn listen() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(on_signal)
}

/// Handles a signal, on a thread of its own.
fn on_signal() {
    let mut state = state();
    if state.phase == Phase::Device && !state.is_requested {
        state.is_requested = true;
        return;
    }
    for path in state.temporaries.drain(..) {
        let _ = std::fs::remove_file(path);
    }
    progress::close();
    tell(state.message);
    // The lock is still held, so no file is created or renamed.
    std::process::exit(STOPPED.into());
}

/// Runs work with a driver, which should end soon after [`decide`] returns `Stop`.
#[cfg(feature = "gpu")]
pub(crate) fn on_device<T>(work: impl FnOnce() -> T) -> Result<T, Failure> {
    state().phase = Phase::Device;
    let result = work();
    let mut state = state();
    state.phase = Phase::Free;
    if state.is_requested { Err(Failure::Stopped) } else { Ok(result) }
}

/// Records whether the driver has nothing to do during its work, so that a signal may end the program.
#[cfg(feature = "gpu")]
pub(crate) fn driver_rests(rests: bool) {
    let mut state = state();
    state.phase = match state.phase {
        Phase::Free => Phase::Free,
        Phase::Device | Phase::Rest if rests => Phase::Rest,
        Phase::Device | Phase::Rest => Phase::Device,
    };
}

/// Runs work, on a device or not, that should end soon after [`is_requested`] returns true. Returns the result, and
/// whether the program was asked to end.
pub(crate) fn keeping<T>(work: impl FnOnce() -> T) -> (T, bool) {
    state().phase = Phase::Device;
    let result = work();
    let mut state = state();
    state.phase = Phase::Free;
    (result, std::mem::take(&mut state.is_requested))
}

/// Whether the program was asked to end, so that work should stop.
pub(crate) fn is_requested() -> bool {
    state().is_requested
}

/// Returns whether work on the device continues or stops.
#[cfg(feature = "gpu")]
pub(crate) fn decide() -> Decision {
    if is_requested() { Decision::Stop } else { Decision::GoOn }
}

/// Creates a temporary file that is removed if the program is stopped.
pub(crate) fn creating<F, E>(create: impl FnOnce() -> Result<F, E>, path: impl FnOnce(&F) -> PathBuf) -> Result<F, E> {
    let mut state = state();
    let file = create()?;
    state.temporaries.push(path(&file));
    Ok(file)
}

/// Gives files their final names, if there are `any`. A signal is handled only afterwards.
pub(crate) fn all_or_nothing<E>(any: bool, name: impl FnOnce() -> Result<(), E>) -> Result<(), E> {
    let mut state = state();
    name()?;
    if any {
        state.message = "stopped; all files were already complete";
    }
    Ok(())
}

/// Changes the message if the program is stopped from now on.
pub(crate) fn set_message(message: &'static str) {
    state().message = message;
}

/// Work that must end in time. Dropping the value marks the end of the work.
pub(crate) struct Deadline {
    _ended: Sender<()>,
}

impl Deadline {
    /// Ends the program after this time, with the exit code for unresponsive devices. `what` completes the message.
    pub(crate) fn new(limit: Duration, what: String) -> Self {
        let (ended, is_ended) = channel();
        let watch = move || {
            if is_ended.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                give_up(&format!("{what} within {} s", limit.as_secs_f64()));
            }
        };
        if let Err(error) = std::thread::Builder::new().spawn(watch) {
            tell(format_args!("note: --timeout has no effect, because a thread cannot be started: {error}"));
        }
        Self { _ended: ended }
    }
}

/// The time that opening and testing a device may take.
#[cfg(feature = "gpu")]
static OPENING: OnceLock<Duration> = OnceLock::new();

/// Limits the time of each [`opening`] from now on.
#[cfg(feature = "gpu")]
pub(crate) fn limit_opening(limit: Duration) {
    let _ = OPENING.set(limit);
}

/// Opens a device, and ends the program if that takes longer than allowed.
#[cfg(feature = "gpu")]
pub(crate) fn opening<T>(open: impl FnOnce() -> T) -> T {
    let limit = OPENING.get();
    let _deadline = limit.map(|limit| Deadline::new(*limit, "no device was ready".to_owned()));
    open()
}

/// Ends the program with the exit code for devices that do not answer.
fn give_up(why: &str) -> ! {
    progress::close();
    tell(format_args!("error: {why}; the device may hang: try again"));
    // A driver may hang at the end of a process as well.
    let _ = std::thread::Builder::new().spawn(|| {
        std::thread::sleep(Duration::from_secs(5));
        std::process::abort();
    });
    // The lock of signals is not held, so a file is either renamed completely or not at all.
    std::process::exit(DEVICE.into());
}
