//! `pinhole render`.

use anyhow::Context;

use super::args::{RenderArgs, Stereo};
#[cfg(feature = "gpu")]
use super::device::explained;
use super::device::{Device, Opened};
use super::encoding::EncodingFlags;
use super::failure::Failure;
use super::input::{Input, Source};
use super::light::{self, LightFlags};
use super::memory;
use super::patience::Patience;
use super::picture::Outputs;
use super::progress;
use super::render_lit;
use super::speak::tell;
use super::threads;
use super::views::Views;
#[cfg(feature = "gpu")]
use super::with_scene::with_scene;
#[cfg(feature = "gpu")]
use crate::accel::AccelChoice;
use crate::camera::Camera;
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
    patience: Patience,
    device: Device,
    stereo: Option<Stereo>,
}

impl Job {
    fn new(args: &RenderArgs) -> Result<Self, Failure> {
        let outputs = Outputs::new(&args.output, &args.layers)?;
        let patience = Patience::new(&args.patience)?;
        let light = LightFlags::new(&args.light)?;
        let light = if patience.is_open_ended() { light.open_ended() } else { light };
        Ok(Self {
            source: Source::new(&args.input)?.with_light(light),
            patience,
            encoding: EncodingFlags::new(&args.encoding, outputs.format())?,
            outputs,
            device: Device::new(&args.device, args.accel.accel)?,
            stereo: args.stereo,
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
    match &mut input.lighting {
        Some(lighting) => {
            lighting.is_transparent = encoding.transparent();
            for note in light::notes(lighting, &input.scene) {
                tell(format_args!("note: {note}"));
            }
        }
        None => job.patience.check_without_light()?,
    }
    let layers = job.outputs.layers(&encoding);
    let views = Views::of(&input);
    if job.stereo.is_some() && views.count() == 1 {
        return Err(Failure::usage(
            "--stereo concerns two eyes, and the camera has one; give it `stereo`, or --separation",
        ));
    }
    let adapter = opened.adapter();
    if job.stereo == Some(Stereo::TwoFiles) {
        let outputs = job.outputs.of_eyes()?;
        outputs.iter().try_for_each(|outputs| outputs.spare(&input.files))?;
        let images = render_views(&input, &job.patience, &views, layers, &opened)?;
        return Ok(Outputs::write_both(&outputs, images.as_slice(), &encoding, adapter)?);
    }
    let image = match render_views(&input, &job.patience, &views, layers, &opened)? {
        Views::One(image) => image,
        Views::Two([left, right]) => {
            Image::side_by_side([&left, &right]).context("both eyes in one picture")?
        }
    };
    Ok(job.outputs.write(&image, &encoding, adapter, None)?)
}

/// Renders what the camera, or the one between two eyes, sees.
pub(super) fn render(input: &Input, layers: LayerSet, opened: &Opened) -> Result<Image, Failure> {
    let view = Views::One(input.camera.as_ref());
    match render_views(input, &Patience::default(), &view, layers, opened)? {
        Views::One(image) | Views::Two([image, _]) => Ok(image),
    }
}

/// Renders on the device, and says so if that is not what the user would expect.
fn render_views(
    input: &Input,
    patience: &Patience,
    views: &Views<&dyn Camera>,
    layers: LayerSet,
    opened: &Opened,
) -> Result<Views<Image>, Failure> {
    match opened {
        Opened::Cpu => on_cpu(input, patience, views, layers),
        #[cfg(feature = "gpu")]
        Opened::CpuInstead => {
            if input.lighting.is_some() {
                patience.check_on_cpu()?;
            }
            memory::check(&input.film, &input.size_from, layers, views.bytes_beside(layers))?;
            tell(
                "note: no Vulkan, Metal or DX12 adapter was found; \
                 rendering on the CPU reference, which is slower",
            );
            on_cpu(input, patience, views, layers)
        }
        #[cfg(feature = "gpu")]
        Opened::Device { headless, choice, doubt } => {
            doubt.iter().for_each(tell);
            match &input.lighting {
                Some(lighting) => {
                    let light = (lighting, patience);
                    render_lit::on_gpu(headless, input, light, views, layers, *choice)
                }
                None => on_gpu(headless, input, views, layers, *choice),
            }
        }
    }
}

fn on_cpu(
    input: &Input,
    patience: &Patience,
    views: &Views<&dyn Camera>,
    layers: LayerSet,
) -> Result<Views<Image>, Failure> {
    if let Some(lighting) = &input.lighting {
        return render_lit::on_cpu(input, lighting, patience, views, layers);
    }
    let Input { scene, film, settings, size_from, .. } = input;
    memory::check(film, size_from, layers, views.bytes_beside(layers))?;
    progress::stage("rendering on the CPU reference");
    let images = views.try_each(|camera| cpu::render(scene, *camera, film, settings, layers));
    Ok(images.context("the CPU reference")?)
}

#[cfg(feature = "gpu")]
fn on_gpu(
    headless: &Headless,
    input: &Input,
    views: &Views<&dyn Camera>,
    layers: LayerSet,
    choice: AccelChoice,
) -> Result<Views<Image>, Failure> {
    let Input { scene, film, settings, .. } = input;
    let beside = views.bytes_beside(layers);
    let plan = |accel| headless.plan_render(scene, accel, film, layers, beside);
    let rendered = with_scene(headless, input, choice, plan, |buffers, watch| {
        views.try_each(|camera| {
            headless.render_uploaded(buffers, *camera, film, settings, layers, watch)
        })
    })?;
    Ok(rendered.map_err(|error| explained(headless, &error))?.0)
}
