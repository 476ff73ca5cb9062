//! Renders files of bricks. One brick after the other is read, traced and dropped, and each pixel keeps the nearest hit
//! so far. Bricks that are hidden by nearer ones are not read.

use std::ops::Range;

use anyhow::{Context, anyhow};

use super::BrickFile;
#[cfg(feature = "gpu")]
use crate::render::device::{OpenDevice, explained};
use crate::render::views::Shot;
#[cfg(feature = "gpu")]
use crate::render::with_scene::{watch_upload, with_structures};
use crate::terminal::failure::Failure;
use crate::terminal::{interrupt, memory, progress};
use pinhole::camera::View;
use pinhole::cpu::{self, SearchPlan};
use pinhole::glam::DVec2;
#[cfg(feature = "gpu")]
use pinhole::gpu::{Headless, PictureRequest, Wait};
use pinhole::image::Image;
#[cfg(feature = "gpu")]
use pinhole::render::Decision;
use pinhole::render::{NearestPicture, RenderSettings};
use pinhole::scene::Scene;

pub(crate) fn render(file: &BrickFile, shot: &Shot<'_>) -> Result<Vec<Image>, Failure> {
    let nearest = nearest_of(file, 0..file.len(), shot)?;
    Ok(nearest.into_iter().map(NearestPicture::into_image).collect())
}

/// Refuses light, which needs all spheres at once.
pub(crate) fn check_without_light(file: &BrickFile, settings: &RenderSettings) -> Result<(), Failure> {
    if settings.integrator.is_primary() {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "{}: light needs all spheres in memory, and bricks are rendered one by one; choose --style fast, or render the \
         data that was sorted, if it fits into memory",
        file.path.display()
    )))
}

/// The nearest hit in some bricks for each pixel, in each view.
pub(crate) fn nearest_of(
    file: &BrickFile,
    bricks: Range<usize>,
    shot: &Shot<'_>,
) -> Result<Vec<NearestPicture>, Failure> {
    let Shot { input, views, .. } = *shot;
    check_without_light(file, &input.settings)?;
    // Both eyes see the bricks in about the same order.
    let order = nearest_first(file, bricks, &views[0]);
    let mut nearest: Vec<NearestPicture> = Vec::new();
    for (number, brick) in order.iter().enumerate() {
        let bounds = file.bounds(*brick).with_context(|| file.path.display().to_string())?;
        let is_hidden =
            |(view, nearest): (&View<'_>, &NearestPicture)| nearest.hides(view, &file.whole().bounds, &bounds);
        if !nearest.is_empty() && views.iter().zip(&nearest).all(is_hidden) {
            continue;
        }
        let of = format!("brick {} of {}", number + 1, order.len());
        progress::stage(format!("reading {}: {of}", file.path.display()));
        let read = file.read(*brick, input.color)?;
        let new = of_scene(&read.scene, shot)?.into_iter().map(|new| new.with_ids(&read.ids));
        if nearest.is_empty() {
            nearest = new.collect();
        } else {
            for (nearest, new) in nearest.iter_mut().zip(new) {
                nearest.keep_nearer(&new).map_err(|error| anyhow!(error))?;
            }
        }
        if interrupt::is_requested() {
            return Err(Failure::Stopped);
        }
    }
    if nearest.is_empty() {
        return Err(Failure::Job(anyhow!("{}: there are no such bricks", file.path.display())));
    }
    Ok(nearest)
}

/// Sorts bricks by the distance of their boxes from the camera. The picture does not depend on the order.
fn nearest_first(file: &BrickFile, bricks: Range<usize>, view: &View<'_>) -> Vec<usize> {
    let eye = view.camera.ray_in_world(DVec2::ZERO).origin;
    let distance = |brick: usize| {
        file.bounds(brick)
            .map_or(f64::INFINITY, |bounds| (eye - eye.clamp(bounds.min(), bounds.max())).length_squared())
    };
    let mut order: Vec<(f64, usize)> = bricks.map(|brick| (distance(brick), brick)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.into_iter().map(|(_, brick)| brick).collect()
}

fn of_scene(scene: &Scene, shot: &Shot<'_>) -> Result<Vec<NearestPicture>, Failure> {
    let Shot { input, views, layers, opened, .. } = *shot;
    match opened {
        #[cfg(feature = "gpu")]
        OpenDevice::Device { headless, choice, .. } => {
            views.iter().map(|view| on_gpu(headless, scene, shot, view, *choice)).collect()
        }
        _ => {
            let plan = SearchPlan::new(scene);
            let what = format!("a structure of {} spheres needs", scene.len());
            memory::check_bytes(&what, plan.bytes(), "smaller bricks")?;
            let structure = plan.build().context("the structure cannot be built")?;
            let pictures = views.iter().map(|view| {
                let done = cpu::render_nearest(&structure, view, &input.settings, layers);
                let done = done.context("the CPU cannot render this picture")?;
                Ok(done.context("this picture has light")?)
            });
            pictures.collect()
        }
    }
}

#[cfg(feature = "gpu")]
fn on_gpu(
    headless: &Headless,
    scene: &Scene,
    shot: &Shot<'_>,
    view: &View<'_>,
    choice: pinhole::accel::AccelChoice,
) -> Result<NearestPicture, Failure> {
    let (settings, layers) = (&shot.input.settings, shot.layers);
    let host_bytes_per_pixel = memory::ENCODING_BYTES_PER_PIXEL + NearestPicture::BYTES_PER_PIXEL;
    let request = PictureRequest::new(scene, view, settings, layers);
    let request = PictureRequest { host_bytes_per_pixel, ..request };
    let plan = |choice| headless.plan(&request, choice);
    let rendered = with_structures(headless, choice, plan, |plan| {
        let name = plan.accel.structure.name();
        let (done, is_stopped) = interrupt::keeping(|| {
            let upload_watch = &mut |progress: &_| watch_upload(name, progress);
            let watch = &mut |_: &_| match interrupt::is_requested() {
                true => Decision::Stop,
                false => Decision::GoOn,
            };
            headless.render_nearest(&request, plan, upload_watch, watch).wait()
        });
        if is_stopped { Err(Failure::Stopped) } else { Ok(done) }
    })?;
    let (nearest, _) = rendered.map_err(|error| explained(headless, &error))?;
    Ok(nearest)
}
