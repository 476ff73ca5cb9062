//! Runs work on a separate thread, without the GIL, while the caller's thread watches for signals such as Ctrl-C.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, OnceLock, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use pinhole::render::Decision;
use pyo3::prelude::*;

use crate::fault::{Fault, Outcome};

/// Time between two checks for signals in Python.
const SIGNALS_EVERY: Duration = Duration::from_millis(50);

/// The messages between the working thread and the waiting thread.
#[derive(Default)]
pub(crate) struct Stop {
    is_wanted: AtomicBool,
    /// The bits of the fraction of the work that is done.
    part: AtomicU64,
}

impl Stop {
    /// Whether the work should stop.
    pub(crate) fn is_wanted(&self) -> bool {
        self.is_wanted.load(Ordering::Relaxed)
    }

    /// The next step of a render: to go on, or to stop.
    pub(crate) fn decision(&self) -> Decision {
        if self.is_wanted() { Decision::Stop } else { Decision::GoOn }
    }

    /// Reports the fraction of the work that is done, from 0 to 1.
    pub(crate) fn report(&self, part: f64) {
        // Several threads report. The bits of positive numbers have the same order as the numbers.
        self.part.fetch_max(part.to_bits(), Ordering::Relaxed);
    }

    /// Calls a Python function, if there is one, with the fraction that is done.
    fn tell(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        let Some(progress) = progress else { return Ok(()) };
        progress.call1(py, (f64::from_bits(self.part.load(Ordering::Relaxed)),)).map(drop)
    }
}

/// Time after which a caller no longer waits for work that was asked to stop. Structures are built without
/// interruption, which takes a few seconds for many millions of spheres.
const PATIENCE: Duration = Duration::from_millis(500);

/// The number of working threads without a waiting caller.
static LEFT_ALONE: AtomicUsize = AtomicUsize::new(0);

/// The state that a working thread and the thread that waits for it share.
struct State<T> {
    stop: Stop,
    done: Mutex<Option<Outcome<T>>>,
    is_done: Condvar,
}

/// Runs work on a separate thread without the GIL, and waits for it. If a signal in Python raises an exception, the
/// work is asked to stop, and the exception is the result. A panic becomes an exception. Meanwhile `progress` is
/// called with the fraction of the work that is done.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Stop) -> Outcome<T> + Send + 'static,
) -> Outcome<T> {
    let shared = Arc::new(State { stop: Stop::default(), done: Mutex::new(None), is_done: Condvar::new() });
    let of_thread = Arc::clone(&shared);
    let spawned = thread::Builder::new().name("pinhole".to_owned()).spawn(move || {
        let done = catch_unwind(AssertUnwindSafe(|| on_live_threads(|| work(&of_thread.stop))));
        let done = done.unwrap_or_else(|panic| Err(internal(panic.as_ref())));
        *of_thread.done.lock().unwrap_or_else(PoisonError::into_inner) = Some(done);
        of_thread.is_done.notify_all();
    });
    let thread = spawned.map_err(|error| Fault::Device(format!("no thread can be started: {error}")))?;
    loop {
        if let Some(done) = py.detach(|| shared.wait(SIGNALS_EVERY)) {
            return done;
        }
        let told = py.check_signals().and_then(|()| shared.stop.tell(py, progress));
        if let Err(raised) = told {
            shared.stop.is_wanted.store(true, Ordering::Relaxed);
            if py.detach(|| shared.wait(PATIENCE)).is_none() {
                leave_alone(thread);
            }
            return Err(Fault::Python(raised));
        }
    }
}

impl<T> State<T> {
    /// Returns the result, if there is one within a time.
    fn wait(&self, time: Duration) -> Option<Outcome<T>> {
        let done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.is_done.wait_timeout_while(done, time, |done| done.is_none());
        waited.unwrap_or_else(PoisonError::into_inner).0.take()
    }
}

/// Lets a thread end without a waiting caller.
fn leave_alone(thread: JoinHandle<()>) {
    LEFT_ALONE.fetch_add(1, Ordering::AcqRel);
    let joined = thread::Builder::new().spawn(move || {
        let _ = thread.join();
        LEFT_ALONE.fetch_sub(1, Ordering::AcqRel);
    });
    if joined.is_err() {
        LEFT_ALONE.fetch_sub(1, Ordering::AcqRel);
    }
}

/// Waits for threads without a waiting caller, because drivers do not survive the end of a process during their work.
#[pyfunction]
pub(crate) fn wait_for_threads(py: Python<'_>) {
    py.detach(|| {
        while !is_forked() && LEFT_ALONE.load(Ordering::Acquire) > 0 {
            thread::sleep(SIGNALS_EVERY);
        }
    });
}

/// Makes a fault of one line from a panic, which is a defect.
fn internal(panic: &(dyn Any + Send)) -> Fault {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    Fault::Internal(format!("a defect of pinhole, please report it: {}", text.replace('\n', " ")))
}

/// The process that was the first to use threads.
static FIRST: OnceLock<u32> = OnceLock::new();

/// Whether this process was forked from one that used threads, which do not survive a fork.
fn is_forked() -> bool {
    *FIRST.get_or_init(std::process::id) != std::process::id()
}

/// Runs work on threads that exist, which are new ones after a fork.
fn on_live_threads<T: Send>(work: impl FnOnce() -> Outcome<T> + Send) -> Outcome<T> {
    static POOL: Mutex<Option<(u32, Arc<rayon::ThreadPool>)>> = Mutex::new(None);
    if !is_forked() {
        return work();
    }
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    let threads = match pool.as_ref().filter(|(of, _)| *of == process) {
        Some((_, threads)) => Arc::clone(threads),
        None => {
            let made = rayon::ThreadPoolBuilder::new().build();
            let made = made.map_err(|error| Fault::Device(format!("threads cannot be started: {error}")))?;
            let made = Arc::new(made);
            // The threads of a parent process do not exist here, so the pool must not end them.
            std::mem::forget(pool.replace((process, Arc::clone(&made))));
            made
        }
    };
    drop(pool);
    threads.install(work)
}
