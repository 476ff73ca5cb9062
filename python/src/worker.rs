//! Runs work on a thread of its own, without the GIL, while the caller's thread looks for signals such as Ctrl-C.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::Duration;

use pinhole::render::Decision;
use pyo3::prelude::*;

use crate::fault::{Fault, Outcome};

/// How often Python is asked whether there was a signal.
const SIGNALS_EVERY: Duration = Duration::from_millis(50);

/// What the thread that works and the thread that waits tell each other.
#[derive(Default)]
pub(crate) struct Stop {
    is_wanted: AtomicBool,
    /// The bits of the part of the work that is done.
    part: AtomicU64,
}

impl Stop {
    /// Whether the work should stop.
    pub(crate) fn is_wanted(&self) -> bool {
        self.is_wanted.load(Ordering::Relaxed)
    }

    /// What a render should do next.
    pub(crate) fn decision(&self) -> Decision {
        if self.is_wanted() { Decision::Stop } else { Decision::GoOn }
    }

    /// Says how much of the work is done, from 0 to 1.
    pub(crate) fn report(&self, part: f64) {
        // Several threads report. The bits of positive numbers are in their order.
        self.part.fetch_max(part.to_bits(), Ordering::Relaxed);
    }

    /// Tells a Python function how much is done, if there is one.
    fn tell(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        let Some(progress) = progress else { return Ok(()) };
        progress.call1(py, (f64::from_bits(self.part.load(Ordering::Relaxed)),)).map(drop)
    }
}

/// Runs work on a thread of its own without the GIL, and waits for it. If Python has a signal to handle that raises an
/// exception, the work is asked to stop, and the exception is the result. A panic becomes an exception. Meanwhile
/// `progress` is called with the part of the work that is done.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Stop) -> Outcome<T> + Send,
) -> Outcome<T> {
    let stop = Stop::default();
    let (sender, receiver) = sync_channel(1);
    // The GIL is released by a closure that may run on any thread, so what it uses must be shared.
    let receiver = Mutex::new(receiver);
    let wait = || {
        let receiver = receiver.lock().unwrap_or_else(PoisonError::into_inner);
        receiver.recv_timeout(SIGNALS_EVERY)
    };
    thread::scope(|scope| {
        let stop = &stop;
        let spawned =
            thread::Builder::new().name("pinhole".to_owned()).spawn_scoped(scope, move || {
                let done = catch_unwind(AssertUnwindSafe(|| on_live_threads(|| work(stop))));
                let done = done.unwrap_or_else(|panic| Err(internal(panic.as_ref())));
                // The receiver waits until this arrives.
                let _ = sender.send(done);
            });
        spawned.map_err(|error| Fault::Device(format!("no thread can be started: {error}")))?;
        let mut raised = None;
        loop {
            let waited = py.detach(wait);
            match (waited, &raised) {
                (Ok(_), Some(_)) | (Err(RecvTimeoutError::Disconnected), Some(_)) => break,
                (Ok(done), None) => return done,
                (Err(RecvTimeoutError::Disconnected), None) => {
                    return Err(internal(&"the thread ended without a result"));
                }
                (Err(RecvTimeoutError::Timeout), Some(_)) => {}
                (Err(RecvTimeoutError::Timeout), None) => {
                    let told = py.check_signals().and_then(|()| stop.tell(py, progress));
                    if let Err(error) = told {
                        stop.is_wanted.store(true, Ordering::Relaxed);
                        raised = Some(error);
                    }
                }
            }
        }
        Err(raised.map_or(Fault::Stopped, Fault::Python))
    })
}

/// The panic of a defect, in one line.
fn internal(panic: &(dyn Any + Send)) -> Fault {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    Fault::Internal(format!("a defect of pinhole, please report it: {}", text.replace('\n', " ")))
}

/// The process that used threads first.
static FIRST: OnceLock<u32> = OnceLock::new();

/// Whether this process was forked from one that had used threads, which do not survive that.
fn is_forked() -> bool {
    *FIRST.get_or_init(std::process::id) != std::process::id()
}

/// Runs work on threads that exist: after a fork, on new ones.
fn on_live_threads<T: Send>(work: impl FnOnce() -> Outcome<T> + Send) -> Outcome<T> {
    static POOL: Mutex<Option<(u32, std::sync::Arc<rayon::ThreadPool>)>> = Mutex::new(None);
    if !is_forked() {
        return work();
    }
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    let threads = match pool.as_ref().filter(|(of, _)| *of == process) {
        Some((_, threads)) => std::sync::Arc::clone(threads),
        None => {
            let made = rayon::ThreadPoolBuilder::new().build();
            let made =
                made.map_err(|error| Fault::Device(format!("threads cannot be started: {error}")))?;
            let made = std::sync::Arc::new(made);
            // The threads of a parent process are not here to be ended.
            std::mem::forget(pool.replace((process, std::sync::Arc::clone(&made))));
            made
        }
    };
    drop(pool);
    threads.install(work)
}
