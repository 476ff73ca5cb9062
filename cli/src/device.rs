//! Chooses and opens what renders: an adapter or the CPU reference.

use std::panic::resume_unwind;
use std::thread::{self, ScopedJoinHandle};

use super::args::{AdapterArgs, Backend, DeviceArgs, Limits, Structure};
#[cfg(feature = "gpu")]
pub(super) use super::device_error::{explained, explained_alone};
use super::failure::Failure;
#[cfg(feature = "gpu")]
use super::quick_test::quick_warning;
#[cfg(feature = "gpu")]
use super::{deadline, interrupt, profile};
use pinhole::accel::AccelChoice;
#[cfg(feature = "gpu")]
use pinhole::gpu::{GpuError, Headless, HeadlessOptions, LimitChoice};

/// What renders, as the flags ask for it.
pub(super) enum Device {
    /// The CPU reference.
    Cpu,
    /// An adapter.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "read by the GPU path"))]
    Adapter {
        /// The adapter that the flags ask for.
        wanted: WantedAdapter,
        /// The acceleration structure.
        choice: AccelChoice,
        /// Whether the CPU reference renders if there is no adapter.
        or_cpu: bool,
    },
}

/// The adapter that the flags ask for; without a name, the best one.
#[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "read by the GPU path"))]
pub(super) struct WantedAdapter {
    name: Option<String>,
    limits: Option<Limits>,
    /// Whether the device is opened for ray queries.
    ray_query: bool,
}

impl Device {
    pub(super) fn new(args: &DeviceArgs, accel: Option<Structure>) -> Result<Self, Failure> {
        let AdapterArgs { adapter, limits } = &args.adapter;
        let given = [
            ("--adapter", adapter.is_some()),
            ("--accel", accel.is_some()),
            ("--limits", limits.is_some()),
        ];
        let given = given.into_iter().find(|(_, is_given)| *is_given);
        match (args.backend, given) {
            (Backend::Cpu, None) => Ok(Self::Cpu),
            (Backend::Cpu, Some((flag, _))) => Err(Failure::usage(format!(
                "{flag} and --backend cpu exclude each other; remove one of them"
            ))),
            (backend, given) => Ok(Self::Adapter {
                wanted: WantedAdapter::new(&args.adapter).for_structures(accel),
                choice: choice(accel),
                // A flag that only adapters have means that the user wants an adapter.
                or_cpu: backend == Backend::Auto && given.is_none(),
            }),
        }
    }
}

/// Returns the structure that the flag asks for, or the automatic choice.
pub(super) fn choice(accel: Option<Structure>) -> AccelChoice {
    accel.unwrap_or(Structure::Auto).into()
}

/// What renders, opened and ready.
pub(super) enum Opened {
    /// The CPU reference.
    Cpu,
    /// The CPU reference, used because there is no adapter.
    #[cfg(feature = "gpu")]
    CpuInstead,
    /// The device of an adapter.
    #[cfg(feature = "gpu")]
    Device {
        /// The open device.
        headless: Box<Headless>,
        /// The acceleration structure.
        choice: AccelChoice,
        /// A warning if the quick self-test failed.
        warning: Option<String>,
    },
}

impl Opened {
    /// Returns the name of the adapter, if an adapter renders.
    pub(super) fn adapter(&self) -> Option<&str> {
        match self {
            #[cfg(feature = "gpu")]
            Self::Device { headless, .. } => Some(&headless.adapter_info().name),
            #[cfg(feature = "gpu")]
            Self::CpuInstead => None,
            Self::Cpu => None,
        }
    }
}

impl Device {
    /// Opens the device and runs the quick part of its self-test.
    pub(super) fn open(&self) -> Result<Opened, Failure> {
        match self {
            Self::Cpu => Ok(Opened::Cpu),
            #[cfg(feature = "gpu")]
            Self::Adapter { wanted, choice, or_cpu } => {
                match deadline::opening(|| wanted.tested())? {
                    Ok((headless, warning)) => {
                        let (headless, choice) = (Box::new(headless), *choice);
                        Ok(Opened::Device { headless, choice, warning })
                    }
                    Err(_) if *or_cpu => Ok(Opened::CpuInstead),
                    Err(error) => Err(Failure::Job(error.into())),
                }
            }
            #[cfg(not(feature = "gpu"))]
            Self::Adapter { or_cpu: true, .. } => Ok(Opened::Cpu),
            #[cfg(not(feature = "gpu"))]
            Self::Adapter { or_cpu: false, .. } => Err(Failure::usage(
                "this program was built without the feature `gpu`; use --backend cpu",
            )),
        }
    }

    /// Opens the device while `work` is done. If both fail, the failure is that of `work`.
    pub(super) fn open_beside<T>(
        &self,
        work: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<(T, Opened), Failure> {
        thread::scope(|scope| {
            let opening = match self {
                Self::Cpu => None,
                // If no other thread can be started, the device is opened afterwards.
                Self::Adapter { .. } => {
                    thread::Builder::new().spawn_scoped(scope, || self.open()).ok()
                }
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
    pub(super) fn new(args: &AdapterArgs) -> Self {
        Self { name: args.adapter.clone(), limits: args.limits, ray_query: false }
    }

    /// The same adapter, opened for what these structures need.
    pub(super) fn for_structures(self, structures: impl IntoIterator<Item = Structure>) -> Self {
        let ray_query = structures.into_iter().any(|structure| structure == Structure::Query);
        Self { ray_query, ..self }
    }

    /// Asks for the adapter of this name with all its limits; without a name, for the best adapter.
    #[cfg(feature = "gpu")]
    pub(super) fn named(name: Option<String>) -> Self {
        Self { name, limits: None, ray_query: false }
    }

    /// Opens the adapter. The inner error means that there is no adapter, which is not a failure for every caller.
    #[cfg(feature = "gpu")]
    pub(super) fn open(&self) -> Result<Result<Headless, GpuError>, Failure> {
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
        let opened = interrupt::on_device(|| Headless::open(&options))?;
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

    /// Opens the adapter; it is a failure if there is none.
    #[cfg(feature = "gpu")]
    pub(super) fn open_any(&self) -> Result<Headless, Failure> {
        self.open()?.map_err(|error| Failure::Job(error.into()))
    }
}
