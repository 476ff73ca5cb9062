//! Lit pictures of `pinhole render`.

use anyhow::Context;

#[cfg(feature = "gpu")]
use super::device::explained;
use super::failure::Failure;
use super::input::Input;
use super::patience::Patience;
#[cfg(feature = "gpu")]
use super::patience::Watching;
use super::views::Views;
#[cfg(feature = "gpu")]
use super::with_scene::with_accel;
#[cfg(feature = "gpu")]
use super::{interrupt, speak::tell};
use super::{memory, progress};
#[cfg(feature = "gpu")]
use crate::accel::AccelChoice;
use crate::camera::Camera;
use crate::cpu;
#[cfg(feature = "gpu")]
use crate::gpu::Headless;
use crate::image::{Image, LayerSet};
use crate::lighting::Lighting;

/// By the CPU reference.
pub(super) fn on_cpu(
    input: &Input,
    lighting: &Lighting,
    patience: &Patience,
    views: &Views<&dyn Camera>,
    layers: LayerSet,
) -> Result<Views<Image>, Failure> {
    patience.check_on_cpu()?;
    let Input { scene, film, size_from, .. } = input;
    memory::check(film, size_from, layers, views.bytes_beside(layers))?;
    progress::stage("rendering on the CPU reference");
    let images = views.try_each(|camera| cpu::render_lit(scene, *camera, film, lighting, layers));
    Ok(images.context("the CPU reference")?)
}

/// On an adapter.
#[cfg(feature = "gpu")]
pub(super) fn on_gpu(
    headless: &Headless,
    input: &Input,
    (lighting, patience): (&Lighting, &Patience),
    views: &Views<&dyn Camera>,
    layers: LayerSet,
    choice: AccelChoice,
) -> Result<Views<Image>, Failure> {
    let Input { scene, film, .. } = input;
    let plan = |choice| plan(headless, input, lighting, views, layers, choice);
    let rendered = with_accel(headless, scene, choice, plan, |accel| {
        let (done, is_stopped) = interrupt::on_device_keeping(|| {
            let buffers = headless.upload_lit(scene, &accel)?;
            drop(accel);
            progress::stage("preparing");
            views.try_each(|camera| {
                let watching = Watching::new(*patience, views.count(), film.pixel_count());
                let watch = &mut |progress: &_| watching.decide(progress);
                let view = (*camera, film);
                let picture =
                    headless.render_lit_uploaded(scene, &buffers, view, lighting, layers, watch)?;
                Ok((picture, watching))
            })
        });
        if is_stopped && !patience.keeps_partial() {
            return Err(Failure::Stopped);
        }
        Ok(done.map(|pictures| (pictures, is_stopped)))
    })?;
    let ((pictures, is_stopped), _) = rendered.map_err(|error| explained(headless, &error))?;
    let total = lighting.sampling.samples;
    for (picture, watching) in pictures.as_slice() {
        let verdict = watching.verdict(picture.samples, total, picture.noise, is_stopped);
        verdict.iter().for_each(tell);
    }
    Ok(pictures.map(|(picture, _)| picture.image))
}

/// What a lit picture will take.
#[cfg(feature = "gpu")]
pub(super) fn plan(
    headless: &Headless,
    input: &Input,
    lighting: &Lighting,
    views: &Views<&dyn Camera>,
    layers: LayerSet,
    choice: AccelChoice,
) -> crate::gpu::RenderPlan {
    let Input { scene, camera, film, .. } = input;
    // Every sample sends rays, and every surface.
    let accel = headless.plan(scene, choice);
    let view = (camera.as_ref(), film);
    headless.plan_lit(scene, accel, view, lighting, layers, views.bytes_beside(layers))
}
