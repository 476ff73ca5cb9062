//! The device that all threads of a process share. It is opened when it is first needed.

use std::sync::{Arc, Mutex, PoisonError};

use pinhole::gpu::adapter;
use pinhole::gpu::{GpuError, Headless, HeadlessOptions, SelfTestExtent};

use pyo3::prelude::*;

use crate::fault::{Fault, Outcome};
use crate::worker;

/// What renders.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Backend {
    /// An adapter, or the CPU if there is none.
    Auto,
    /// An adapter.
    Gpu,
    /// The CPU.
    Cpu,
}

impl Backend {
    /// The backend of this name.
    pub(crate) fn of_name(name: &str) -> Outcome<Self> {
        match name {
            "auto" => Ok(Self::Auto),
            "gpu" => Ok(Self::Gpu),
            "cpu" => Ok(Self::Cpu),
            other => Err(Fault::Input(format!(
                "backend is {other:?}; it must be \"auto\", \"gpu\" or \"cpu\""
            ))),
        }
    }
}

/// An open device, with the note about it.
pub(crate) struct Opened {
    pub(crate) headless: Headless,
    /// A warning if the quick self-test failed.
    pub(crate) warning: Option<String>,
}

struct Shared {
    process: u32,
    /// The device; `None` if there is no adapter.
    opened: Option<Arc<Opened>>,
}

/// A part of the name of the adapter that is wanted; `None` for the best.
static WANTED: Mutex<Option<String>> = Mutex::new(None);

static SHARED: Mutex<Option<Shared>> = Mutex::new(None);

/// The shared device; `None` if the CPU renders.
pub(crate) fn device(backend: Backend) -> Outcome<Option<Arc<Opened>>> {
    if backend == Backend::Cpu {
        return Ok(None);
    }
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    let opened = match &*shared {
        Some(found) if found.process == process => found.opened.clone(),
        Some(Shared { opened: Some(_), .. }) => {
            return Err(Fault::Device(
                "this process was forked from one that had opened a device, which does not survive that; start \
                 processes with multiprocessing.get_context(\"spawn\"), or render with backend=\"cpu\""
                    .to_owned(),
            ));
        }
        _ => {
            let opened = open()?.map(Arc::new);
            *shared = Some(Shared { process, opened: opened.clone() });
            opened
        }
    };
    match (opened, backend) {
        (None, Backend::Gpu) => Err(Fault::Device(GpuError::NoAdapter.to_string())),
        (opened, _) => Ok(opened),
    }
}

fn open() -> Outcome<Option<Opened>> {
    let adapter = WANTED.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let headless = match Headless::open(&HeadlessOptions { adapter, ..HeadlessOptions::default() })
    {
        Ok(headless) => headless,
        Err(GpuError::NoAdapter) => return Ok(None),
        Err(error) => return Err(error.into()),
    };
    let name = headless.adapter_info().name.clone();
    let failed = match headless.self_test(SelfTestExtent::Quick) {
        Ok(report) => report.first_failure().map(|first| format!("fails the self-test ({first})")),
        Err(error) => Some(format!("cannot run the self-test ({error})")),
    };
    let warning =
        failed.map(|failed| format!("{name} {failed}; its pictures may be wrong: verify them"));
    Ok(Some(Opened { headless, warning }))
}

/// The names of all adapters of this machine, the best first.
#[pyfunction]
pub(crate) fn adapters(py: Python<'_>) -> Vec<String> {
    py.detach(|| adapter::adapters().iter().map(|found| found.get_info().name).collect())
}

/// Renders from now on with the adapter whose name contains a text, or with the best one if it is None.
#[pyfunction]
#[pyo3(signature = (name=None))]
pub(crate) fn use_adapter(py: Python<'_>, name: Option<String>) -> PyResult<()> {
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    // A device of a parent process cannot be replaced, and `device` says so.
    shared.take_if(|shared| shared.process == std::process::id());
    drop(shared);
    let before =
        std::mem::replace(&mut *WANTED.lock().unwrap_or_else(PoisonError::into_inner), name);
    let opened = worker::run(py, None, |_| device(Backend::Gpu).map(drop));
    if opened.is_err() {
        *WANTED.lock().unwrap_or_else(PoisonError::into_inner) = before;
    }
    Ok(opened?)
}

/// Forgets a device that was lost, so that the next caller opens a new one.
pub(crate) fn forget(lost: &Arc<Opened>) {
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    let is_shared = shared.as_ref().and_then(|shared| shared.opened.as_ref());
    if is_shared.is_some_and(|opened| Arc::ptr_eq(opened, lost)) {
        *shared = None;
    }
}
