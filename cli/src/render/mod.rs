//! The job of `pinhole render`, and the pictures that a device or the CPU renders for it.

use std::iter::zip;
use std::path::Path;

use anyhow::Context;

use crate::bricks;
use crate::flags::common::{InputArgs, Stereo};
use crate::flags::render::RenderArgs;
use crate::flags::settings::Given;
use crate::input::{Input, Source};
use crate::output::annotations;
use crate::output::picture::Outputs;
#[cfg(feature = "gpu")]
use crate::render::device::explained;
use crate::render::device::{Device, OpenDevice};
#[cfg(feature = "gpu")]
use crate::render::renderer::tell_once;
use crate::render::stop_rule::{StopRule, Watching};
use crate::render::views::{Shot, extra_bytes_per_pixel, views_of};
#[cfg(feature = "gpu")]
use crate::render::with_scene::{upload, watch_upload, with_structures};
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, tell};
use crate::terminal::{interrupt, memory, profile};
#[cfg(feature = "gpu")]
use pinhole::accel::AccelChoice;
use pinhole::camera::film::Film;
#[cfg(feature = "gpu")]
use pinhole::camera::{Camera, View};
use pinhole::cpu::{self, SampledPicture, SearchPlan};
#[cfg(feature = "gpu")]
use pinhole::gpu::{GpuError, Headless, PictureRequest, RenderPlan, Wait};
use pinhole::image::encoding::Encoding;
use pinhole::image::{Image, LayerSet};
use pinhole::render::{Picture, RenderSettings};
#[cfg(feature = "gpu")]
use pinhole::scene::Scene;
use pinhole_figure::annotate::Annotations;

pub(crate) mod device;
pub(crate) mod ghosts;
pub(crate) mod renderer;
pub(crate) mod stop_rule;
pub(crate) mod views;
#[cfg(feature = "gpu")]
pub(crate) mod with_scene;

/// A render job, checked as far as is possible before the input is read.
pub(crate) struct Job {
    pub(crate) source: Source,
    pub(crate) outputs: Outputs,
    pub(crate) stop_rule: StopRule,
    pub(crate) device: Device,
    pub(crate) stereo: Option<Stereo>,
}

impl Job {
    pub(crate) fn new(args: &RenderArgs, output: &Path) -> Result<Self, Failure> {
        Self::with_outputs(args, Outputs::new(output, &args.layers)?)
    }

    pub(crate) fn with_outputs(args: &RenderArgs, outputs: Outputs) -> Result<Self, Failure> {
        let InputArgs { path, view } = &args.input;
        let given = view.given.clone().and(&args.look.given);
        let job = Self::on_cpu(path, &given, StopRule::new(&args.stop_rule)?, outputs)?;
        Ok(Self { device: Device::new(&args.device, args.accel.accel)?, stereo: args.stereo, ..job })
    }

    /// A job of settings alone, for the CPU reference.
    pub(crate) fn on_cpu(path: &Path, given: &Given, stop_rule: StopRule, outputs: Outputs) -> Result<Self, Failure> {
        annotations::check(given, outputs.format)?;
        let source = Source::lit(path, given, stop_rule.open_end())?;
        let source = Source { output: outputs.format, ..source };
        Ok(Self { source, outputs, stop_rule, device: Device::Cpu, stereo: None })
    }

    /// Applies the flags for the picture's file to an input. Returns the encoding and the annotations of the picture.
    /// Calls `note` with notes.
    pub(crate) fn finish(
        &self,
        input: &mut Input,
        note: impl Fn(&dyn std::fmt::Display),
    ) -> Result<(Encoding, Annotations), Failure> {
        let mut encoding = input.encoding;
        encoding.background = input.settings.visible_background();
        input.settings.is_transparent = encoding.transparent;
        if input.settings.integrator.is_primary() {
            self.stop_rule.check_without_light()?;
        }
        input.settings.notes(&input.scene).iter().for_each(|text| note(text));
        Ok((encoding, annotations::for_input(input, self.outputs.format, note)?))
    }
}

/// Renders a part of the picture of each eye: the raw values, before noise is removed and outlines are drawn.
pub(crate) fn render_part(
    input: &mut Input,
    part: Film,
    layers: LayerSet,
    opened: &OpenDevice,
) -> Result<Vec<Image>, Failure> {
    let layers = input.settings.layers_for(layers);
    let unfinished = input.settings.unfinished();
    let finished = std::mem::replace(&mut input.settings, unfinished);
    let (views, stop_rule) = (&views_of(input, part), StopRule::default());
    let images = render_views(&Shot::new(input, views, layers, stop_rule, opened));
    input.settings = finished;
    images
}

/// Completes the pictures of all eyes that were joined from parts, and puts them side by side.
pub(crate) fn finish_joined(
    images: Vec<Image>,
    settings: &RenderSettings,
    layers: LayerSet,
    opened: &OpenDevice,
) -> Result<Image, Failure> {
    let finished = images.into_iter().map(|image| finish(image, settings, layers, opened));
    joined(finished.collect::<Result<_, _>>()?)
}

/// Completes a picture that was joined from parts.
pub(crate) fn finish(
    image: Image,
    settings: &RenderSettings,
    layers: LayerSet,
    opened: &OpenDevice,
) -> Result<Image, Failure> {
    match opened {
        #[cfg(feature = "gpu")]
        OpenDevice::Device { headless, .. } => {
            let finished = headless.finish(image, settings, layers).wait();
            finished.map_err(|error| explained(headless, &error))
        }
        _ => Ok(cpu::finish(image, settings, layers)),
    }
}

/// Renders the view of the camera, or from the middle between two eyes.
pub(crate) fn render(input: &Input, layers: LayerSet, on: &OpenDevice) -> Result<Image, Failure> {
    let (views, stop_rule) = (&[input.view()], StopRule::default());
    joined(render_views(&Shot::new(input, views, layers, stop_rule, on))?)
}

/// Renders the picture, or the pictures of both eyes side by side, with ghosts.
pub(crate) fn render_joined(shot: &Shot<'_>) -> Result<Image, Failure> {
    joined(with_ghosts(shot)?)
}

fn joined(mut images: Vec<Image>) -> Result<Image, Failure> {
    if let [left, right] = &images[..] {
        let joined = Image::side_by_side([left, right]);
        return Ok(joined.context("the pictures of both eyes cannot be joined")?);
    }
    Ok(images.pop().context("there is no picture")?)
}

/// Renders the views with the ghosts of the scene over them.
pub(crate) fn with_ghosts(shot: &Shot<'_>) -> Result<Vec<Image>, Failure> {
    let Some(ghosts) = shot.scene.ghosts() else { return render_views(shot) };
    let settings = &shot.settings.for_ghosts();
    let layers: LayerSet = shot.layers.iter().chain(LayerSet::OF_GHOSTS.iter()).collect();
    let images = render_views(&Shot { layers, ..*shot })?;
    let over = render_views(&Shot { scene: ghosts, settings, layers: LayerSet::OF_GHOSTS, ..*shot })?;
    Ok(zip(images, over).map(|(image, over)| image.with_ghosts(&over, shot.layers)).collect())
}

/// Renders on the device, and tells the user if it is not the expected one.
pub(crate) fn render_views(shot: &Shot<'_>) -> Result<Vec<Image>, Failure> {
    check_device(shot)?;
    if let Some(bricks) = &shot.input.bricks {
        return bricks::render(bricks, shot);
    }
    match shot.opened {
        #[cfg(feature = "gpu")]
        OpenDevice::Device { headless, choice, .. } => on_gpu(headless, shot, *choice),
        _ => on_cpu(shot),
    }
}

/// Refuses pictures of the CPU that do not fit into memory, and prints one line if the device is not the expected one.
pub(crate) fn check_device(shot: &Shot<'_>) -> Result<(), Failure> {
    match shot.opened {
        OpenDevice::Cpu => check_on_cpu(shot),
        #[cfg(feature = "gpu")]
        OpenDevice::CpuInstead => {
            check_on_cpu(shot)?;
            tell_once(|| format!("note: rendering on the CPU reference, which is slower: {}", GpuError::NoAdapter));
            Ok(())
        }
        #[cfg(feature = "gpu")]
        OpenDevice::Device { warning, .. } => {
            warning.iter().for_each(|warning| tell_once(|| warning.clone()));
            Ok(())
        }
    }
}

/// Refuses pictures that do not fit into memory.
fn check_on_cpu(shot: &Shot<'_>) -> Result<(), Failure> {
    let Shot { input, settings, views, layers, .. } = *shot;
    let is_lit = !settings.integrator.is_primary();
    let sums = if is_lit { SampledPicture::BYTES_PER_PIXEL } else { 0 };
    let extra = extra_bytes_per_pixel(views, layers) + sums;
    memory::check(&shot.film(), &input.size_from, layers, extra)
}

fn on_cpu(shot: &Shot<'_>) -> Result<Vec<Image>, Failure> {
    let Shot { scene, settings, views, layers, stop_rule, .. } = *shot;
    let pixels = shot.film().pixel_count();
    let plan = SearchPlan::new(scene);
    let what = format!("a structure of {} spheres needs", scene.len());
    memory::check_bytes(&what, plan.bytes(), "fewer spheres")?;
    progress::stage("building the structure");
    let phase = profile::phase("build");
    let structure = plan.build().context("the structure cannot be built")?;
    drop(phase);
    let _phase = profile::phase("render on the CPU");
    let is_lit = !settings.integrator.is_primary();
    let mut too_short = None;
    let mut render = || {
        let pictures = views.iter().map(|view| {
            let watching = Watching::new(stop_rule, views.len(), pixels, is_lit);
            let watch = &mut |progress: &_| watching.decide(progress);
            let picture = cpu::render_watched(&structure, view, settings, layers, watch);
            too_short = watching.too_short();
            Ok((picture?, watching))
        });
        pictures.collect::<Result<Vec<_>, cpu::RenderError>>()
    };
    // If nothing would be kept, a signal may end the program at any time.
    let (done, is_stopped) = if stop_rule.keeps_partial() { interrupt::keeping(render) } else { (render(), false) };
    if let Some(failure) = too_short {
        return Err(failure);
    }
    let pictures = done.context("the CPU cannot render this picture")?;
    Ok(judged(pictures, settings.sampling.samples, is_stopped))
}

/// Tells the user about pictures that stopped early or have more noise than wanted, and returns the images.
fn judged(pictures: Vec<(Picture, Watching)>, total: u32, is_stopped: bool) -> Vec<Image> {
    for (picture, watching) in &pictures {
        let verdict = watching.verdict(picture.samples, total, picture.noise, is_stopped);
        verdict.iter().for_each(tell);
        if picture.crowded > 0 {
            tell(
                "note: around some places there are so many spheres that some do not dim ambient light or cast no shadows; --ao \
                  takes random rays, which meet all of them",
            );
        }
    }
    pictures.into_iter().map(|(picture, _)| picture.image).collect()
}

/// The most pictures of one scene, such as those of two eyes, each of which is rendered as if there were no other.
#[cfg(feature = "gpu")]
pub(crate) const MOST_BY_TILES: usize = 2;

#[cfg(feature = "gpu")]
fn on_gpu(headless: &Headless, shot: &Shot<'_>, choice: AccelChoice) -> Result<Vec<Image>, Failure> {
    let Shot { input, scene, settings, views, layers, stop_rule, .. } = *shot;
    let is_lit = !settings.integrator.is_primary();
    let pixels = shot.film().pixel_count();
    let subject = (scene, settings, input.camera.as_ref());
    let plan = |choice| plan_of(headless, subject, views, layers, choice, views.len() <= MOST_BY_TILES);
    let rendered = with_structures(headless, choice, plan, |plan| {
        let mut too_short = None;
        let (done, is_stopped) = interrupt::keeping(|| {
            let keeps_nothing = plan.by_tiles || (!is_lit && views.len() == 1);
            let kept = if keeps_nothing { None } else { Some(upload(headless, scene, plan)?) };
            if kept.is_some() {
                progress::stage("preparing");
            }
            let pictures = views.iter().map(|view| {
                let watching = Watching::new(stop_rule, views.len(), pixels, is_lit);
                let watch = &mut |progress: &_| watching.decide(progress);
                let picture = match &kept {
                    Some(buffers) => headless.render_uploaded(buffers, view, settings, layers, watch).wait(),
                    None => {
                        let upload_watch = &mut |progress: &_| watch_upload(plan.structure().name(), progress);
                        let request = PictureRequest::new(scene, view, settings, layers);
                        headless.render_planned(&request, plan, upload_watch, watch).wait()
                    }
                };
                too_short = watching.too_short();
                Ok((picture?, watching))
            });
            pictures.collect::<Result<Vec<_>, GpuError>>()
        });
        if let Some(failure) = too_short {
            return Err(failure);
        }
        if is_stopped && !stop_rule.keeps_partial() {
            return Err(Failure::Stopped);
        }
        Ok(done.map(|pictures| (pictures, is_stopped)))
    })?;
    let ((pictures, is_stopped), _) = rendered.map_err(|error| explained(headless, &error))?;
    Ok(judged(pictures, settings.sampling.samples, is_stopped))
}

/// Plans the device memory for the pictures of an input. `is_only` as in [`PictureRequest`].
#[cfg(feature = "gpu")]
pub(crate) fn plan(
    headless: &Headless,
    input: &Input,
    views: &[View<'_>],
    layers: LayerSet,
    choice: AccelChoice,
    is_only: bool,
) -> RenderPlan {
    plan_of(headless, (&input.scene, &input.settings, input.camera.as_ref()), views, layers, choice, is_only)
}

#[cfg(feature = "gpu")]
fn plan_of(
    headless: &Headless,
    (scene, settings, camera): (&Scene, &RenderSettings, &dyn Camera),
    views: &[View<'_>],
    layers: LayerSet,
    choice: AccelChoice,
    is_only: bool,
) -> RenderPlan {
    let host_bytes_per_pixel = extra_bytes_per_pixel(views, layers);
    let view = View::new(camera, views[0].film);
    let request = PictureRequest::new(scene, &view, settings, layers);
    headless.plan(&PictureRequest { host_bytes_per_pixel, is_only, ..request }, choice)
}
