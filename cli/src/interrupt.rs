//! Handles Ctrl-C and other signals that ask the program to end. No incomplete file is left behind.
//!
//! The program normally exits at once. While a driver is at work, or a picture of which a part will be kept, the first
//! signal asks the work to stop and a second one exits. Files are written under temporary names, which are removed at a signal. They get their final names while
//! the lock is held that the signal handler needs, so there are all of the files or none.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::Context;

use super::failure::{Failure, NOTHING_WRITTEN, STOPPED};
#[cfg(unix)]
use super::process::ignores_hang_up;
use super::progress;
use super::speak::tell;
#[cfg(feature = "gpu")]
use pinhole::gpu::Decision;

static STATE: Mutex<State> = Mutex::new(State {
    phase: Phase::Free,
    is_requested: false,
    temporaries: Vec::new(),
    message: NOTHING_WRITTEN,
});

struct State {
    phase: Phase,
    /// Whether there was a signal.
    is_requested: bool,
    /// Temporary files to remove. The list may include files that were renamed or removed since.
    temporaries: Vec<PathBuf>,
    /// The message if the program ends now.
    message: &'static str,
}

/// The work that a signal would interrupt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Work that can be interrupted at any time.
    Free,
    /// Work of a driver, whose threads must not be stopped abruptly, or on a picture of which a part is kept.
    Device,
    /// Work with a driver that has nothing to do for a while, which can be interrupted.
    #[cfg(feature = "gpu")]
    Rest,
}

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts to listen for Ctrl-C and other signals that end programs.
pub(super) fn install() -> Result<(), Failure> {
    Ok(listen().context("the program cannot listen for signals such as Ctrl-C")?)
}

#[cfg(unix)]
fn listen() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    // With a handler for SIGXFSZ, a file that exceeds its size limit gives an ordinary error and does not end the
    // program.
    signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default())?;
    let mut signals = vec![SIGINT, SIGTERM];
    // A handler for SIGHUP would undo what `nohup` did.
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

/// Runs work with a driver. The work should end soon after [`decide`] returns `Stop`.
#[cfg(feature = "gpu")]
pub(super) fn on_device<T>(work: impl FnOnce() -> T) -> Result<T, Failure> {
    state().phase = Phase::Device;
    let result = work();
    let mut state = state();
    state.phase = Phase::Free;
    if state.is_requested { Err(Failure::Stopped) } else { Ok(result) }
}

/// Says whether the driver has nothing to do during work with it, so that a signal may end the program.
#[cfg(feature = "gpu")]
pub(super) fn driver_rests(rests: bool) {
    let mut state = state();
    state.phase = match state.phase {
        Phase::Free => Phase::Free,
        Phase::Device | Phase::Rest if rests => Phase::Rest,
        Phase::Device | Phase::Rest => Phase::Device,
    };
}

/// Runs work, on a device or not, that should end soon after [`is_requested`] returns true. Returns the result, and
/// whether the program was asked to end.
pub(super) fn keeping<T>(work: impl FnOnce() -> T) -> (T, bool) {
    state().phase = Phase::Device;
    let result = work();
    let mut state = state();
    state.phase = Phase::Free;
    (result, std::mem::take(&mut state.is_requested))
}

/// Whether the program was asked to end, so that work which it awaits should stop.
pub(super) fn is_requested() -> bool {
    state().is_requested
}

/// Returns whether work on the device continues or stops.
#[cfg(feature = "gpu")]
pub(super) fn decide() -> Decision {
    if is_requested() { Decision::Stop } else { Decision::GoOn }
}

/// Creates a temporary file that is removed if the program is stopped.
pub(super) fn creating<F, E>(
    create: impl FnOnce() -> Result<F, E>,
    path: impl FnOnce(&F) -> PathBuf,
) -> Result<F, E> {
    let mut state = state();
    let file = create()?;
    state.temporaries.push(path(&file));
    Ok(file)
}

/// Gives files their final names, if there are `any`. A signal is handled only afterwards.
pub(super) fn all_or_nothing<E>(any: bool, name: impl FnOnce() -> Result<(), E>) -> Result<(), E> {
    let mut state = state();
    name()?;
    if any {
        state.message = "stopped; all files were already complete";
    }
    Ok(())
}

/// Changes the message if the program is stopped from now on.
pub(super) fn set_message(message: &'static str) {
    state().message = message;
}
