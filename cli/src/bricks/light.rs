//! Pictures of files of bricks with light, on a device: for each step of all paths, one brick after the other is read,
//! searched and dropped.

use anyhow::Context;
use pinhole::LinearRgb;
use pinhole::accel::AccelChoice;
use pinhole::camera::View;
use pinhole::gpu::{GpuError, Headless, PartsOptions, UploadProgress, UploadWatch, wgpu};
use pinhole::image::{Image, Layer, LayerSet};
use pinhole::render::{Nearest, RenderSettings, Watch};
use pinhole::scene::{PartExtent, ScenePart, SceneParts, Whole};

use super::BrickFile;
use super::picture::{Look, nearest_of};
use crate::device::{Opened, explained};
use crate::failure::Failure;
use crate::input::Input;
use crate::stop_rule::{StopRule, Watching};
use crate::views::Views;
use crate::{interrupt, memory, progress};

/// The bytes of paths, and of bricks that stay, on a device with memory of its own, of which nobody says how much is free.
const IN_OWN_MEMORY: u64 = 2 << 30;

/// Bytes of paths below which nothing is gained by trying with fewer.
const LEAST_IN_FLIGHT: u64 = 100 << 20;

/// The bricks of a file as parts of a scene.
struct Parts<'a> {
    file: &'a BrickFile,
    color: LinearRgb,
}

impl SceneParts for Parts<'_> {
    fn whole(&self) -> Whole {
        *self.file.whole()
    }

    fn extents(&self) -> Vec<PartExtent> {
        let extent = |brick: usize| {
            let [min, max] = self.file.corners(brick)?;
            Some(PartExtent { count: u32::try_from(self.file.count(brick)).ok()?, min, max })
        };
        (0..self.file.len()).filter_map(extent).collect()
    }

    fn read(&mut self, part: usize) -> Result<ScenePart, String> {
        self.file.read(part, self.color).map_err(|error| format!("{error:#}"))
    }
}

/// Renders the picture of each view.
pub(super) fn light(
    file: &BrickFile,
    input: &Input,
    views: &Views<View<'_>>,
    layers: LayerSet,
    opened: &Opened,
    (headless, choice): (&Headless, AccelChoice),
) -> Result<Views<Image>, Failure> {
    let wanted = input.settings.layers_for(layers);
    let images = by_one_ray(file, input, views, wanted, opened)?;
    let mut images = images.as_slice().iter();
    let mut options = options(file, input, views, layers, (headless, choice))?;
    views.try_each(|view| {
        let image = images.next().context("a picture is missing")?;
        loop {
            match of_view(file, input, view, image.clone(), layers, (headless, options))? {
                Err(GpuError::OutOfMemory) if options.bytes_in_flight > LEAST_IN_FLIGHT => {
                    options.bytes_in_flight /= 4;
                    options.bytes_kept = 0;
                }
                done => return done.map_err(|error| explained(headless, &error)),
            }
        }
    })
}

/// The layers of one ray for each pixel, of which light needs none; other layers are empty.
fn by_one_ray(
    file: &BrickFile,
    input: &Input,
    views: &Views<View<'_>>,
    wanted: LayerSet,
    opened: &Opened,
) -> Result<Views<Image>, Failure> {
    if wanted.iter().any(Layer::is_of_one_ray) {
        let look = Look { color: input.color, settings: &RenderSettings::default() };
        let nearest = nearest_of(file, 0..file.len(), look, views, wanted, opened)?;
        return Ok(nearest.map(Nearest::into_image));
    }
    views.try_each(|view| {
        let image = Image::new(view.film.width(), view.film.height(), wanted);
        image.map_err(|error| Failure::Job(error.into()))
    })
}

/// How much memory paths and bricks may take beside the largest brick: a quarter and half of what is free.
fn options(
    file: &BrickFile,
    input: &Input,
    views: &Views<View<'_>>,
    layers: LayerSet,
    (headless, choice): (&Headless, AccelChoice),
) -> Result<PartsOptions, Failure> {
    progress::stage("planning");
    let view = views.as_slice().first().context("there is no picture")?;
    let largest = file.largest_scene(input.color)?;
    let extra = views.extra_bytes_per_pixel(layers);
    let plan = headless.plan(&largest, view, &input.settings, layers, choice, extra);
    let available = memory::available();
    plan.check(&headless.device().limits(), available)
        .map_err(|error| explained(headless, &error))?;
    // Beside what is planned there are the spheres of a brick and their ids.
    let brick = 2 * file.largest() * 20;
    let free = available.unwrap_or(0).saturating_sub(plan.host_bytes + brick);
    let has_own = headless.adapter_info().device_type == wgpu::DeviceType::DiscreteGpu;
    let [bytes_in_flight, bytes_kept] =
        if has_own { [IN_OWN_MEMORY; 2] } else { [free / 4, free / 2] };
    Ok(PartsOptions { choice, bytes_in_flight, bytes_kept })
}

/// Renders one view. The inner errors are those of the device.
fn of_view(
    file: &BrickFile,
    input: &Input,
    view: &View<'_>,
    image: Image,
    layers: LayerSet,
    (headless, options): (&Headless, PartsOptions),
) -> Result<Result<Image, GpuError>, Failure> {
    let mut parts = Parts { file, color: input.color };
    let watching = Watching::new(StopRule::default(), 1, view.film.pixel_count(), true);
    let (done, is_stopped) = interrupt::keeping(|| {
        let watches: (&mut UploadWatch<'_>, &mut Watch<'_>) =
            (&mut |_: &UploadProgress| interrupt::decide(), &mut |progress| {
                watching.decide(progress)
            });
        headless.light_parts(&mut parts, view, &input.settings, image, layers, options, watches)
    });
    if is_stopped { Err(Failure::Stopped) } else { Ok(done.map(|picture| picture.image)) }
}
