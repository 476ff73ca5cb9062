//! `pinhole render`.

use anyhow::Context;

use super::args::RenderArgs;
#[cfg(feature = "gpu")]
use super::device::explained;
use super::device::{Device, Opened};
use super::encoding::EncodingFlags;
use super::failure::Failure;
use super::input::{Input, Source};
use super::memory;
use super::picture::Outputs;
use super::progress;
use super::speak::tell;
use super::threads;
#[cfg(feature = "gpu")]
use super::with_scene::with_scene;
#[cfg(feature = "gpu")]
use crate::accel::AccelChoice;
use crate::color::LinearRgb;
use crate::cpu;
#[cfg(feature = "gpu")]
use crate::gpu::Headless;
use crate::image::{Image, LayerSet};

/// A render, checked as far as it can be before the input is read.
struct Job {
    source: Source,
    outputs: Outputs,
    encoding: EncodingFlags,
    device: Device,
}

impl Job {
    fn new(args: &RenderArgs) -> Result<Self, Failure> {
        let outputs = Outputs::new(&args.output, &args.layers)?;
        Ok(Self {
            source: Source::new(&args.input)?,
            encoding: EncodingFlags::new(&args.encoding, outputs.format())?,
            outputs,
            device: Device::new(&args.device, args.accel.accel)?,
        })
    }
}

pub(super) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let job = Job::new(args)?;
    threads::start()?;
    // Loading a driver and reading a file leave each other half of the time.
    let (mut input, opened) = job.device.open_beside(|| job.source.load())?;
    job.outputs.spare(&input.files)?;
    for note in &input.notes {
        tell(format_args!("note: {note}"));
    }
    let encoding = job.encoding.over(input.encoding);
    if encoding.transparent() {
        input.settings = input.settings.with_background(LinearRgb::BLACK);
    }
    let image = render(&input, job.outputs.layers(&encoding), &opened)?;
    job.outputs.write(&image, &encoding, opened.adapter(), None)?;
    Ok(())
}

/// Renders on the device, and says so if that is not what the user would expect.
pub(super) fn render(input: &Input, layers: LayerSet, opened: &Opened) -> Result<Image, Failure> {
    match opened {
        Opened::Cpu => on_cpu(input, layers),
        #[cfg(feature = "gpu")]
        Opened::CpuInstead => {
            memory::check(&input.film, &input.size_from, layers)?;
            tell(
                "note: no Vulkan, Metal or DX12 adapter was found; \
                 rendering on the CPU reference, which is slower",
            );
            on_cpu(input, layers)
        }
        #[cfg(feature = "gpu")]
        Opened::Device { headless, choice, doubt } => {
            doubt.iter().for_each(tell);
            on_gpu(headless, input, layers, *choice)
        }
    }
}

fn on_cpu(input: &Input, layers: LayerSet) -> Result<Image, Failure> {
    let Input { scene, camera, film, settings, size_from, .. } = input;
    memory::check(film, size_from, layers)?;
    progress::stage("rendering on the CPU reference");
    let image = cpu::render(scene, camera.as_ref(), film, settings, layers);
    Ok(image.context("the CPU reference")?)
}

#[cfg(feature = "gpu")]
fn on_gpu(
    headless: &Headless,
    input: &Input,
    layers: LayerSet,
    choice: AccelChoice,
) -> Result<Image, Failure> {
    let Input { scene, camera, film, settings, .. } = input;
    let encoding = memory::ENCODING_BYTES_PER_PIXEL;
    let plan = |accel| headless.plan_render(scene, accel, film, layers, encoding);
    let rendered = with_scene(headless, input, choice, plan, |buffers, watch| {
        headless.render_uploaded(buffers, camera.as_ref(), film, settings, layers, watch)
    })?;
    Ok(rendered.map_err(|error| explained(headless, &error))?.0)
}
