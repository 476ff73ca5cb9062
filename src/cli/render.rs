//! `pinhole render`.

use anyhow::Context;

use super::args::{Backend, DeviceArgs, RenderArgs};
use super::failure::Failure;
use super::input::{Input, Source};
use super::memory;
use super::output::Outputs;
use super::speak::tell;
use super::threads;
use crate::cpu;
#[cfg(feature = "gpu")]
use crate::gpu::{GpuError, Headless, HeadlessOptions};
use crate::image::{Image, LayerSet};

/// A render, checked as far as it can be before the input is read.
struct Job {
    source: Source,
    outputs: Outputs,
    device: Device,
}

/// What renders.
pub(super) enum Device {
    /// The CPU reference.
    Cpu,
    /// An adapter, or if there is none at all and `or_cpu` is set, the CPU reference.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "read by the GPU path"))]
    Adapter { name: Option<String>, or_cpu: bool },
}

impl Device {
    pub(super) fn new(args: &DeviceArgs) -> Result<Self, Failure> {
        let name = args.adapter.clone();
        match (args.backend, &name) {
            (Backend::Cpu, None) => Ok(Self::Cpu),
            (Backend::Cpu, Some(_)) => {
                Err(Failure::usage("--adapter and --backend cpu exclude each other; drop one"))
            }
            (Backend::Gpu, _) => Ok(Self::Adapter { name, or_cpu: false }),
            // Who names an adapter wants that one.
            (Backend::Auto, _) => Ok(Self::Adapter { or_cpu: name.is_none(), name }),
        }
    }
}

impl Job {
    fn new(args: &RenderArgs) -> Result<Self, Failure> {
        Ok(Self {
            source: Source::new(&args.input)?,
            outputs: Outputs::new(&args.output, &args.layers)?,
            device: Device::new(&args.device)?,
        })
    }
}

pub(super) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let job = Job::new(args)?;
    threads::start()?;
    let input = job.source.load()?;
    for note in &input.notes {
        tell(format_args!("note: {note}"));
    }
    let layers = job.outputs.layers().fold(LayerSet::COLOR, LayerSet::with);
    let image = render(&input, layers, &job.device)?;
    job.outputs.write(&image, None)?;
    Ok(())
}

/// Renders on the device, and says so if that is not what the user would expect.
pub(super) fn render(input: &Input, layers: LayerSet, device: &Device) -> Result<Image, Failure> {
    memory::check(&input.film, &input.size_from, layers)?;
    match device {
        Device::Cpu => on_cpu(input, layers),
        #[cfg(feature = "gpu")]
        Device::Adapter { name, or_cpu } => match Headless::open(&HeadlessOptions {
            adapter: name.clone(),
            ..HeadlessOptions::default()
        }) {
            Ok(headless) => on_gpu(&headless, input, layers),
            Err(GpuError::NoAdapter) if *or_cpu => {
                tell(
                    "note: no Vulkan, Metal or DX12 adapter was found; \
                     rendering on the CPU reference, which is slower",
                );
                on_cpu(input, layers)
            }
            Err(error @ GpuError::UnknownAdapter { .. }) => Err(Failure::Usage(error.into())),
            Err(error) => Err(Failure::Job(error.into())),
        },
        #[cfg(not(feature = "gpu"))]
        Device::Adapter { or_cpu: true, .. } => on_cpu(input, layers),
        #[cfg(not(feature = "gpu"))]
        Device::Adapter { or_cpu: false, .. } => Err(Failure::usage(
            "this program was built without the feature `gpu`; use --backend cpu",
        )),
    }
}

fn on_cpu(input: &Input, layers: LayerSet) -> Result<Image, Failure> {
    let Input { scene, camera, film, settings, .. } = input;
    let image = cpu::render(scene, camera.as_ref(), film, settings, layers);
    Ok(image.context("the CPU reference")?)
}

#[cfg(feature = "gpu")]
fn on_gpu(headless: &Headless, input: &Input, layers: LayerSet) -> Result<Image, Failure> {
    let Input { scene, camera, film, settings, .. } = input;
    headless.render(scene, camera.as_ref(), film, settings, layers).map_err(|error| {
        let adapter = headless.adapter_info().name.clone();
        let remedy = if matches!(error, GpuError::Limit { .. }) {
            "; --backend cpu has no such limit"
        } else {
            ""
        };
        Failure::Job(anyhow::anyhow!("{adapter}: {error}{remedy}"))
    })
}
