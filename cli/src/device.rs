//! What renders, as it was asked for, and opening it.

use std::panic::resume_unwind;
use std::thread::{self, ScopedJoinHandle};

use super::args::{AdapterArgs, Backend, DeviceArgs, Limits, Structure};
use super::failure::Failure;
#[cfg(feature = "gpu")]
use super::{interrupt, self_test};
use pinhole::accel::AccelChoice;
#[cfg(feature = "gpu")]
use pinhole::gpu::{GpuError, Headless, HeadlessOptions, LimitChoice};

/// What renders.
pub(super) enum Device {
    /// The CPU reference.
    Cpu,
    /// An adapter.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "read by the GPU path"))]
    Adapter {
        /// Which.
        wanted: WantedAdapter,
        /// What finds spheres.
        choice: AccelChoice,
        /// If there is no adapter at all, the CPU reference.
        or_cpu: bool,
    },
}

/// An adapter that is asked for.
#[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "read by the GPU path"))]
pub(super) struct WantedAdapter {
    name: Option<String>,
    limits: Option<Limits>,
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
                "{flag} and --backend cpu exclude each other; drop one"
            ))),
            (backend, given) => Ok(Self::Adapter {
                wanted: WantedAdapter::new(&args.adapter),
                choice: choice(accel),
                // Who asks for something that the reference has not wants an adapter.
                or_cpu: backend == Backend::Auto && given.is_none(),
            }),
        }
    }
}

/// What is asked for, where that is left open.
pub(super) fn choice(accel: Option<Structure>) -> AccelChoice {
    accel.unwrap_or(Structure::Auto).into()
}

/// What renders, ready to.
pub(super) enum Opened {
    /// The CPU reference.
    Cpu,
    /// The CPU reference, because there is no adapter.
    #[cfg(feature = "gpu")]
    CpuInstead,
    /// An adapter's device.
    #[cfg(feature = "gpu")]
    Device {
        /// The device.
        headless: Box<Headless>,
        /// What finds spheres.
        choice: AccelChoice,
        /// What is wrong with how it computes.
        doubt: Option<String>,
    },
}

impl Opened {
    /// The name of the adapter, if it is one.
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
    /// Opens it, and sees whether it computes as it should.
    pub(super) fn open(&self) -> Result<Opened, Failure> {
        match self {
            Self::Cpu => Ok(Opened::Cpu),
            #[cfg(feature = "gpu")]
            Self::Adapter { wanted, choice, or_cpu } => match wanted.open()? {
                Ok(headless) => {
                    let doubt = interrupt::on_device(|| self_test::doubt(&headless))?;
                    Ok(Opened::Device { headless: Box::new(headless), choice: *choice, doubt })
                }
                Err(_) if *or_cpu => Ok(Opened::CpuInstead),
                Err(error) => Err(Failure::Job(error.into())),
            },
            #[cfg(not(feature = "gpu"))]
            Self::Adapter { or_cpu: true, .. } => Ok(Opened::Cpu),
            #[cfg(not(feature = "gpu"))]
            Self::Adapter { or_cpu: false, .. } => Err(Failure::usage(
                "this program was built without the feature `gpu`; use --backend cpu",
            )),
        }
    }

    /// Opens it while other work is done, whose failure comes first.
    pub(super) fn open_beside<T>(
        &self,
        work: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<(T, Opened), Failure> {
        thread::scope(|scope| {
            let opening = match self {
                Self::Cpu => None,
                // Without another thread, it is opened afterwards.
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
        Self { name: args.adapter.clone(), limits: args.limits }
    }

    /// With all its limits; without a name, the best.
    #[cfg(feature = "gpu")]
    pub(super) fn named(name: Option<String>) -> Self {
        Self { name, limits: None }
    }

    /// Opens it. The error within is that there is no adapter, which some can do without.
    #[cfg(feature = "gpu")]
    pub(super) fn open(&self) -> Result<Result<Headless, GpuError>, Failure> {
        let options = HeadlessOptions {
            adapter: self.name.clone(),
            limits: match self.limits {
                Some(Limits::Webgpu) => LimitChoice::WebGpu,
                Some(Limits::Adapter) | None => LimitChoice::Adapter,
            },
            ..HeadlessOptions::default()
        };
        match interrupt::on_device(|| Headless::open(&options))? {
            Ok(headless) => Ok(Ok(headless)),
            Err(error @ GpuError::NoAdapter) => Ok(Err(error)),
            Err(error @ GpuError::UnknownAdapter { .. }) => Err(Failure::Usage(error.into())),
            Err(error) => Err(Failure::Job(error.into())),
        }
    }

    /// Opens it; that there is none is a failure.
    #[cfg(feature = "gpu")]
    pub(super) fn open_any(&self) -> Result<Headless, Failure> {
        self.open()?.map_err(|error| Failure::Job(error.into()))
    }
}

/// The line for an error of a device, with its name and what may help.
#[cfg(feature = "gpu")]
pub(super) fn explained(headless: &Headless, error: &GpuError) -> Failure {
    let remedy = match error {
        GpuError::Limit { .. } => "; --backend cpu has no such limit",
        _ => "",
    };
    named(headless, error, remedy)
}

/// As [`explained`], where the CPU reference is no remedy.
#[cfg(feature = "gpu")]
pub(super) fn explained_alone(headless: &Headless, error: &GpuError) -> Failure {
    named(headless, error, "")
}

#[cfg(feature = "gpu")]
fn named(headless: &Headless, error: &GpuError, remedy: &str) -> Failure {
    let adapter = &headless.adapter_info().name;
    match error {
        GpuError::Stopped => Failure::Stopped,
        _ => Failure::Job(anyhow::anyhow!("{adapter}: {error}{remedy}")),
    }
}
