//! Renders files of bricks: one brick after the other is read, traced and dropped, and of all of them each pixel keeps what
//! is nearest. Bricks that are hidden by nearer ones are not read.

use std::ops::Range;

use anyhow::{Context, anyhow};

use super::BrickFile;
use crate::device::Opened;
#[cfg(feature = "gpu")]
use crate::device::explained;
use crate::failure::Failure;
use crate::input::Input;
use crate::views::Views;
#[cfg(feature = "gpu")]
use crate::with_scene::{watch_upload, with_structures};
use crate::{interrupt, memory, progress};
use pinhole::camera::View;
use pinhole::cpu::{self, SearchPlan};
use pinhole::glam::DVec2;
#[cfg(feature = "gpu")]
use pinhole::gpu::{Headless, UploadWatch};
use pinhole::image::{Image, LayerSet};
#[cfg(feature = "gpu")]
use pinhole::render::{Decision, Watch};
use pinhole::render::{Nearest, RenderSettings};
use pinhole::scene::Scene;

/// Renders the picture of each view.
pub(crate) fn render(
    file: &BrickFile,
    input: &Input,
    views: &Views<View<'_>>,
    layers: LayerSet,
    opened: &Opened,
) -> Result<Views<Image>, Failure> {
    let nearest = nearest_of(file, 0..file.len(), input, views, layers, opened)?;
    Ok(nearest.map(Nearest::into_image))
}

/// Refuses light, for which all spheres must be there.
pub(crate) fn check_without_light(
    file: &BrickFile,
    settings: &RenderSettings,
) -> Result<(), Failure> {
    if settings.integrator.is_primary() {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "{}: light needs all spheres in memory, and bricks are rendered one by one; choose --style fast, or render the \
         data that was sorted, if it fits into memory",
        file.path.display()
    )))
}

/// What is nearest of some bricks, in each view.
pub(crate) fn nearest_of(
    file: &BrickFile,
    bricks: Range<usize>,
    input: &Input,
    views: &Views<View<'_>>,
    layers: LayerSet,
    opened: &Opened,
) -> Result<Views<Nearest>, Failure> {
    check_without_light(file, &input.settings)?;
    // The left and the right eye see the bricks in the same order, more or less.
    let first = match views {
        Views::One(view) | Views::Two([view, _]) => view,
    };
    let order = nearest_first(file, bricks, first);
    let mut nearest: Views<Option<Nearest>> = views.try_each(|_| Ok::<_, Failure>(None))?;
    for (number, brick) in order.iter().enumerate() {
        let bounds = file.bounds(*brick).with_context(|| file.path.display().to_string())?;
        let is_hidden = |view: &View<'_>, nearest: &Option<Nearest>| {
            nearest.as_ref().is_some_and(|seen| seen.hides(view, &file.whole().bounds, &bounds))
        };
        let mut pairs = views.as_slice().iter().zip(nearest.as_slice());
        if pairs.all(|(view, nearest)| is_hidden(view, nearest)) {
            continue;
        }
        let of = format!("brick {} of {}", number + 1, order.len());
        progress::stage(format!("reading {}: {of}", file.path.display()));
        let read = file.read(*brick, input.color)?;
        let of_brick = of_scene(&read.scene, input, views, layers, opened)?;
        for (nearest, new) in nearest.as_mut_slice().iter_mut().zip(into_vec(of_brick)) {
            let new = new.with_ids(&read.ids);
            match nearest {
                Some(nearest) => nearest.keep_nearer(&new).map_err(|error| anyhow!(error))?,
                None => *nearest = Some(new),
            }
        }
        if interrupt::is_requested() {
            return Err(Failure::Stopped);
        }
    }
    let none = || Failure::Job(anyhow!("{}: there are no such bricks", file.path.display()));
    let mut left = into_vec(nearest).into_iter().map(|nearest| nearest.ok_or_else(none));
    views.try_each(|_| left.next().unwrap_or_else(|| Err(none())))
}

fn into_vec<T>(views: Views<T>) -> Vec<T> {
    match views {
        Views::One(one) => vec![one],
        Views::Two(two) => two.into(),
    }
}

/// The bricks by the distance of their boxes from the camera. The picture does not depend on the order.
fn nearest_first(file: &BrickFile, bricks: Range<usize>, view: &View<'_>) -> Vec<usize> {
    let eye = view.camera.ray_in_world(DVec2::ZERO).origin;
    let distance = |brick: usize| {
        file.bounds(brick).map_or(f64::INFINITY, |bounds| {
            (eye - eye.clamp(bounds.min(), bounds.max())).length_squared()
        })
    };
    let mut order: Vec<(f64, usize)> = bricks.map(|brick| (distance(brick), brick)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.into_iter().map(|(_, brick)| brick).collect()
}

/// The pictures of one brick.
fn of_scene(
    scene: &Scene,
    input: &Input,
    views: &Views<View<'_>>,
    layers: LayerSet,
    opened: &Opened,
) -> Result<Views<Nearest>, Failure> {
    match opened {
        #[cfg(feature = "gpu")]
        Opened::Device { headless, choice, .. } => {
            views.try_each(|view| on_gpu(headless, scene, input, view, layers, *choice))
        }
        _ => {
            let plan = SearchPlan::new(scene);
            let what = format!("a structure of {} spheres needs", scene.len());
            memory::check_bytes(&what, plan.bytes(), "smaller bricks")?;
            let structure = plan.build().context("the structure cannot be built")?;
            views.try_each(|view| {
                let done = cpu::render_nearest(&structure, view, &input.settings, layers);
                let done = done.context("the CPU cannot render this picture")?;
                Ok(done.context("this picture has light")?)
            })
        }
    }
}

#[cfg(feature = "gpu")]
fn on_gpu(
    headless: &Headless,
    scene: &Scene,
    input: &Input,
    view: &View<'_>,
    layers: LayerSet,
    choice: pinhole::accel::AccelChoice,
) -> Result<Nearest, Failure> {
    let settings = &input.settings;
    let extra = memory::ENCODING_BYTES_PER_PIXEL + Nearest::BYTES_PER_PIXEL;
    let plan = |choice| headless.plan(scene, view, settings, layers, choice, extra);
    let rendered = with_structures(headless, choice, plan, |plan| {
        let name = plan.accel.structure.name();
        let (done, is_stopped) = interrupt::keeping(|| {
            let watches: (&mut UploadWatch<'_>, &mut Watch<'_>) =
                (&mut |progress| watch_upload(name, progress), &mut |_| {
                    if interrupt::is_requested() { Decision::Stop } else { Decision::GoOn }
                });
            headless.render_nearest(scene, plan, view, settings, layers, watches)
        });
        if is_stopped { Err(Failure::Stopped) } else { Ok(done) }
    })?;
    let (nearest, _) = rendered.map_err(|error| explained(headless, &error))?;
    Ok(nearest)
}
