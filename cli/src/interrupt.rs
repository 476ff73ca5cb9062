//! Ctrl-C, and what else asks the program to end: no file is left that is not complete.
//!
//! Where nothing is at stake the program exits at once. While a driver is at work it is asked to stop, and a
//! second signal exits. What is being written has no name yet and is removed; files get their names under
//! the lock that a signal needs, so that there are all of them or none.

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
    words: NOTHING_WRITTEN,
});

struct State {
    phase: Phase,
    /// There was a signal.
    is_requested: bool,
    /// Files without a name. Those that have got one, or are gone, do no harm here.
    temporaries: Vec<PathBuf>,
    /// What is said if the program ends now.
    words: &'static str,
}

/// What a signal would interrupt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Nothing that minds.
    Free,
    /// A driver, whose threads must not be pulled away.
    Device,
}

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Listens for Ctrl-C, or whatever else the system ends programs with.
pub(super) fn install() -> Result<(), Failure> {
    Ok(listen().context("signals cannot be listened for")?)
}

#[cfg(unix)]
fn listen() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    // A file that may not grow is then an error like others, and not the end.
    signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default())?;
    let mut signals = vec![SIGINT, SIGTERM];
    // Listening would take back what `nohup` did.
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

/// On a thread of its own.
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
    tell(state.words);
    // The lock is still held, so that no file gets a name or is created.
    std::process::exit(STOPPED.into());
}

/// Does work with a driver, which should end soon after [`decide`] says so.
#[cfg(feature = "gpu")]
pub(super) fn on_device<T>(work: impl FnOnce() -> T) -> Result<T, Failure> {
    state().phase = Phase::Device;
    let result = work();
    let mut state = state();
    state.phase = Phase::Free;
    if state.is_requested { Err(Failure::Stopped) } else { Ok(result) }
}

/// As [`on_device`], where a result that is there counts although the program was asked to end; says whether it was.
#[cfg(feature = "gpu")]
pub(super) fn on_device_keeping<T>(work: impl FnOnce() -> T) -> (T, bool) {
    state().phase = Phase::Device;
    let result = work();
    let mut state = state();
    state.phase = Phase::Free;
    (result, std::mem::take(&mut state.is_requested))
}

/// Whether the program was asked to end, so that work on the device should stop.
#[cfg(feature = "gpu")]
pub(super) fn is_requested() -> bool {
    state().is_requested
}

/// Whether the work on the device should go on.
#[cfg(feature = "gpu")]
pub(super) fn decide() -> Decision {
    if is_requested() { Decision::Stop } else { Decision::GoOn }
}

/// Creates a file that is removed if the program is stopped.
pub(super) fn creating<F, E>(
    create: impl FnOnce() -> Result<F, E>,
    path: impl FnOnce(&F) -> PathBuf,
) -> Result<F, E> {
    let mut state = state();
    let file = create()?;
    state.temporaries.push(path(&file));
    Ok(file)
}

/// Gives files their names, if there are `any`; a signal waits until it is done.
pub(super) fn all_or_nothing<E>(any: bool, name: impl FnOnce() -> Result<(), E>) -> Result<(), E> {
    let mut state = state();
    name()?;
    if any {
        state.words = "stopped; the files were complete";
    }
    Ok(())
}

/// Changes what is said if the program is stopped from now on.
pub(super) fn words(words: &'static str) {
    state().words = words;
}
