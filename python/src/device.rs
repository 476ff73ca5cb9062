//! The device that all threads of a process share, which is opened when first needed, and the free memory.

use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;

use crate::fault::{Fault, Outcome};
use crate::look::Look;
use crate::worker;
use pinhole::LayerSet;
use pinhole::cpu::{SampledPicture, SearchPlan};
use pinhole::gpu::{GpuError, Headless, HeadlessOptions, SelfTestExtent, Wait, adapter};

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Backend {
    /// An adapter, or the CPU if there is none.
    Auto,
    Gpu,
    Cpu,
}

impl Backend {
    /// The backend of this name.
    pub(crate) fn of_name(name: &str) -> Outcome<Self> {
        match name {
            "auto" => Ok(Self::Auto),
            "gpu" => Ok(Self::Gpu),
            "cpu" => Ok(Self::Cpu),
            other => Err(Fault::Input(format!("backend is {other:?}; it must be \"auto\", \"gpu\" or \"cpu\""))),
        }
    }
}

/// An open device, with the note about it.
pub(crate) struct OpenDevice {
    pub(crate) headless: Headless,
    /// A warning if the quick self-test failed.
    pub(crate) warning: Option<String>,
}

struct SharedDevice {
    process: u32,
    /// The device; `None` if there is no adapter.
    opened: Option<Arc<OpenDevice>>,
}

/// A part of the wanted adapter's name; `None` for the best adapter.
static WANTED: Mutex<Option<String>> = Mutex::new(None);

static SHARED: Mutex<Option<SharedDevice>> = Mutex::new(None);

/// The shared device; `None` if the CPU renders.
pub(crate) fn device(backend: Backend) -> Outcome<Option<Arc<OpenDevice>>> {
    if backend == Backend::Cpu {
        return Ok(None);
    }
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    let opened = match &*shared {
        Some(found) if found.process == process => found.opened.clone(),
        Some(SharedDevice { opened: Some(_), .. }) => {
            return Err(Fault::Device(
                "this process was forked from one that had opened a device, which does not survive that; start \
                 processes with multiprocessing.get_context(\"spawn\"), or render with backend=\"cpu\""
                    .to_owned(),
            ));
        }
        _ => {
            let opened = open()?.map(Arc::new);
            *shared = Some(SharedDevice { process, opened: opened.clone() });
            opened
        }
    };
    match (opened, backend) {
        (None, Backend::Gpu) => Err(Fault::Device(GpuError::NoAdapter.to_string())),
        (opened, _) => Ok(opened),
    }
}

fn open() -> Outcome<Option<OpenDevice>> {
    let adapter = WANTED.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let headless = match Headless::open(&HeadlessOptions { adapter, ..HeadlessOptions::default() }).wait() {
        Ok(headless) => headless,
        Err(GpuError::NoAdapter) => return Ok(None),
        Err(error) => return Err(error.into()),
    };
    let name = headless.adapter_info().name.clone();
    let failed = match headless.self_test(SelfTestExtent::Quick).wait() {
        Ok(report) => report.first_failure().map(|first| format!("fails the self-test ({first})")),
        Err(error) => Some(format!("cannot run the self-test ({error})")),
    };
    let warning = failed.map(|failed| format!("{name} {failed}; its pictures may be wrong: verify them"));
    Ok(Some(OpenDevice { headless, warning }))
}

/// The names of all adapters of this machine, the best first.
#[pyfunction]
pub(crate) fn adapters(py: Python<'_>) -> Vec<String> {
    py.detach(|| adapter::adapters().wait().iter().map(|found| found.get_info().name).collect())
}

/// Chooses the adapter whose name contains a text, or the best one if it is None, for all later pictures.
#[pyfunction]
#[pyo3(signature = (name=None))]
pub(crate) fn use_adapter(py: Python<'_>, name: Option<String>) -> PyResult<()> {
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    // A device of a parent process cannot be replaced, and `device` reports that.
    shared.take_if(|shared| shared.process == std::process::id());
    drop(shared);
    let before = std::mem::replace(&mut *WANTED.lock().unwrap_or_else(PoisonError::into_inner), name);
    let opened = worker::run(py, None, |_| device(Backend::Gpu).map(drop));
    if opened.is_err() {
        *WANTED.lock().unwrap_or_else(PoisonError::into_inner) = before;
    }
    Ok(opened?)
}

/// Forgets a device that was lost, so that the next caller opens a new one.
pub(crate) fn forget(lost: &Arc<OpenDevice>) {
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    let is_shared = shared.as_ref().and_then(|shared| shared.opened.as_ref());
    if is_shared.is_some_and(|opened| Arc::ptr_eq(opened, lost)) {
        *shared = None;
    }
}

/// The most bytes per pixel that encoding needs besides the picture: 8 for the encoded pixels and 8 for the PNG made of
/// them; or 8 for one and 12 for an array.
pub(crate) const ENCODING_BYTES_PER_PIXEL: u64 = 20;

/// The bytes that are free on this machine or in the control group of the process; `None` if they are not known, as
/// on systems other than Linux, so that only allocations can fail.
pub(crate) fn available() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    let of_group = |name: &str| -> Option<u64> {
        std::fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?.trim().parse().ok()
    };
    let group = of_group("memory.max").zip(of_group("memory.current"));
    let group = group.map_or(u64::MAX, |(most, used)| most.saturating_sub(used));
    Some(group.min(kibibytes.saturating_mul(1024)))
}

/// Refuses a picture of the CPU for which there is not enough memory. The plan of a device includes its own memory.
pub(crate) fn check_on_cpu(plan: &SearchPlan<'_>, look: &Look, layers: LayerSet) -> Outcome<()> {
    let Some(available) = available() else { return Ok(()) };
    let views = if look.eyes.is_some() { 4 } else { 1 };
    let is_lit = !look.settings.integrator.is_primary();
    let sums = if is_lit { SampledPicture::BYTES_PER_PIXEL } else { 0 };
    let per_pixel = views * layers.bytes_per_pixel() + ENCODING_BYTES_PER_PIXEL + sums;
    let pictures = look.film.pixel_count().saturating_mul(per_pixel);
    let needed = pictures.saturating_add(plan.bytes());
    if needed <= available {
        return Ok(());
    }
    let (width, height) = (look.film.width(), look.film.height());
    Err(Fault::Input(format!(
        "a picture of {width}x{height} of {} spheres needs {needed} bytes of memory, but only {available} are free; choose a \
         smaller size or fewer spheres",
        plan.scene().len()
    )))
}
