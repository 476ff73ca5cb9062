//! The device that renders: the adapter that the user wants, and facts about adapters.

use std::panic::resume_unwind;
use std::thread::{self, ScopedJoinHandle};

use serde::Serialize;

use crate::flags::common::{AdapterArgs, Backend, DeviceArgs, Limits};
#[cfg(feature = "gpu")]
use crate::proof::quick_test::quick_warning;
#[cfg(feature = "gpu")]
pub(crate) use crate::render::with_scene::{explained, explained_alone};
use crate::terminal::failure::Failure;
#[cfg(feature = "gpu")]
use crate::terminal::interrupt;
#[cfg(feature = "gpu")]
use crate::terminal::profile;
use pinhole::accel::AccelChoice;
#[cfg(feature = "gpu")]
use pinhole::gpu::{GpuError, Headless, HeadlessOptions, LimitChoice, Wait, wgpu};
use pinhole::verify::run_file::Provenance;

/// The renderer that the flags ask for.
pub(crate) enum Device {
    Cpu,
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "read by the GPU path"))]
    Adapter {
        wanted: WantedAdapter,
        choice: AccelChoice,
        /// Whether the CPU reference renders if there is no adapter.
        or_cpu: bool,
    },
}

/// The adapter that the flags ask for. The default is the best one.
#[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "read by the GPU path"))]
pub(crate) struct WantedAdapter {
    name: Option<String>,
    limits: Option<Limits>,
    /// Whether the device is opened for ray queries.
    ray_query: bool,
}

impl Device {
    /// The best adapter, or the CPU if there is none.
    pub(crate) fn any() -> Self {
        let wanted = WantedAdapter { name: None, limits: None, ray_query: false };
        Self::Adapter { wanted, choice: AccelChoice::default(), or_cpu: true }
    }

    pub(crate) fn new(args: &DeviceArgs, accel: Option<AccelChoice>) -> Result<Self, Failure> {
        match (args.backend, args.adapter.first_given(accel)) {
            (Backend::Cpu, None) => Ok(Self::Cpu),
            (Backend::Cpu, Some(flag)) => {
                Err(Failure::usage(format!("{flag} and --backend cpu exclude each other; remove one of them")))
            }
            (backend, given) => Ok(Self::Adapter {
                wanted: WantedAdapter::new(&args.adapter).for_structures(accel),
                choice: accel.unwrap_or_default(),
                // A flag that applies only to adapters means that the user wants an adapter.
                or_cpu: backend == Backend::Auto && given.is_none(),
            }),
        }
    }
}

/// The renderer, opened and ready.
pub(crate) enum OpenDevice {
    Cpu,
    /// The CPU reference, used because there is no adapter.
    #[cfg(feature = "gpu")]
    CpuInstead,
    #[cfg(feature = "gpu")]
    Device {
        headless: Box<Headless>,
        choice: AccelChoice,
        /// A warning if the quick self-test failed.
        warning: Option<String>,
        /// True if the CPU reference may render in its place, because no flag asks for an adapter.
        or_cpu: bool,
    },
}

impl OpenDevice {
    pub(crate) fn adapter(&self) -> Option<&str> {
        match self {
            #[cfg(feature = "gpu")]
            Self::Device { headless, .. } => Some(&headless.adapter_info().name),
            _ => None,
        }
    }
}

impl Device {
    /// Opens the device and runs the quick part of its self-test.
    pub(crate) fn open(&self) -> Result<OpenDevice, Failure> {
        match self {
            Self::Cpu => Ok(OpenDevice::Cpu),
            #[cfg(feature = "gpu")]
            Self::Adapter { wanted, choice, or_cpu } => match interrupt::opening(|| wanted.tested())? {
                Ok((headless, warning)) => {
                    let (headless, choice, or_cpu) = (Box::new(headless), *choice, *or_cpu);
                    Ok(OpenDevice::Device { headless, choice, warning, or_cpu })
                }
                Err(_) if *or_cpu => Ok(OpenDevice::CpuInstead),
                Err(error) => Err(Failure::Job(error.into())),
            },
            #[cfg(not(feature = "gpu"))]
            Self::Adapter { or_cpu: true, .. } => Ok(OpenDevice::Cpu),
            #[cfg(not(feature = "gpu"))]
            Self::Adapter { or_cpu: false, .. } => {
                Err(Failure::usage("this program was built without the feature `gpu`; use --backend cpu"))
            }
        }
    }

    /// Opens the device while `work` runs. If both fail, the failure is that of `work`.
    pub(crate) fn open_beside<T>(&self, work: impl FnOnce() -> Result<T, Failure>) -> Result<(T, OpenDevice), Failure> {
        thread::scope(|scope| {
            let opening = match self {
                Self::Cpu => None,
                // If no other thread can be started, the device is opened after the work.
                Self::Adapter { .. } => thread::Builder::new().spawn_scoped(scope, || self.open()).ok(),
            };
            let done = work()?;
            let opened = match opening.map(ScopedJoinHandle::join) {
                Some(Ok(opened)) => opened?,
                Some(Err(panic)) => resume_unwind(panic),
                None => self.open()?,
            };
            Ok((done, opened))
        })
    }
}

impl WantedAdapter {
    pub(crate) fn new(args: &AdapterArgs) -> Self {
        Self { name: args.adapter.clone(), limits: args.limits, ray_query: false }
    }

    /// The same adapter, opened with the features that these structures need.
    pub(crate) fn for_structures(self, structures: impl IntoIterator<Item = AccelChoice>) -> Self {
        let ray_query = structures.into_iter().any(|structure| structure == AccelChoice::RayQuery);
        Self { ray_query, ..self }
    }

    /// Asks for the adapter of this name with all its limits; without a name, for the best adapter.
    #[cfg(feature = "gpu")]
    pub(crate) fn named(name: Option<String>) -> Self {
        Self { name, limits: None, ray_query: false }
    }

    /// Opens the adapter. The inner error means that there is no adapter, which some callers accept.
    #[cfg(feature = "gpu")]
    pub(crate) fn open(&self) -> Result<Result<Headless, GpuError>, Failure> {
        let options = HeadlessOptions {
            adapter: self.name.clone(),
            limits: match self.limits {
                Some(Limits::Webgpu) => LimitChoice::WebGpu,
                Some(Limits::Adapter) | None => LimitChoice::Adapter,
            },
            profile: profile::of_device(),
            ray_query: self.ray_query,
            ..HeadlessOptions::default()
        };
        let phase = profile::phase("open device");
        let opened = interrupt::on_device(|| Headless::open(&options).wait())?;
        drop(phase);
        match opened {
            Ok(headless) => Ok(Ok(headless)),
            Err(error @ GpuError::NoAdapter) => Ok(Err(error)),
            Err(error @ GpuError::UnknownAdapter { .. }) => Err(Failure::Usage(error.into())),
            Err(error) => Err(Failure::Job(error.into())),
        }
    }

    /// Opens the adapter and runs the quick part of its self-test, which may give a warning.
    #[cfg(feature = "gpu")]
    fn tested(&self) -> Result<Result<(Headless, Option<String>), GpuError>, Failure> {
        let headless = match self.open()? {
            Ok(headless) => headless,
            Err(error) => return Ok(Err(error)),
        };
        let _phase = profile::phase("self-test");
        let warning = interrupt::on_device(|| quick_warning(&headless))??;
        Ok(Ok((headless, warning)))
    }

    /// Opens the adapter, or fails if there is none.
    #[cfg(feature = "gpu")]
    pub(crate) fn open_any(&self) -> Result<Headless, Failure> {
        self.open()?.map_err(|error| Failure::Job(error.into()))
    }
}

/// Name of the device's own clock.
#[cfg(feature = "gpu")]
pub(crate) const DEVICE_CLOCK: &str = "device";

/// Name of the host's clock. A software device's own clock shows when commands were queued, not when they ran.
#[cfg(feature = "gpu")]
const HOST_CLOCK: &str = "host";

#[derive(Serialize)]
pub(crate) struct AdapterReport {
    pub(crate) name: String,
    pub(crate) backend: String,
    pub(crate) device_type: String,
    pub(crate) driver: String,
    pub(crate) driver_info: String,
}

impl AdapterReport {
    #[cfg(feature = "gpu")]
    pub(crate) fn of(info: &wgpu::AdapterInfo) -> Self {
        Self {
            name: info.name.clone(),
            backend: format!("{:?}", info.backend),
            device_type: format!("{:?}", info.device_type),
            driver: info.driver.clone(),
            driver_info: info.driver_info.clone(),
        }
    }

    pub(crate) fn of_run(provenance: &Provenance) -> Self {
        let Provenance { adapter, backend, device_type, driver, driver_info, .. } = provenance;
        Self {
            name: adapter.clone(),
            backend: backend.clone(),
            device_type: device_type.clone(),
            driver: driver.clone(),
            driver_info: driver_info.clone(),
        }
    }

    /// Returns the clock that measures the work of this adapter.
    #[cfg(feature = "gpu")]
    pub(crate) fn clock(&self) -> &'static str {
        if self.device_type == "Cpu" { HOST_CLOCK } else { DEVICE_CLOCK }
    }

    pub(crate) fn line(&self) -> String {
        let Self { name, backend, device_type, driver, driver_info } = self;
        format!("{name} ({backend}, {device_type}), driver: {driver} {driver_info}")
    }
}
