//! Lit pictures, which take many samples of every pixel and trace them surface by surface.
//!
//! Between two dispatches the state of all paths is in a buffer (`shaders/path/state.wgsl`). A sample starts at the
//! camera. For each surface, one pass finds the hits of all rays, one shades them and scatters new rays, and one tests
//! whether the sampled lights are occluded. Only the device knows which paths continue: passes append them to lists,
//! and the sizes of dispatches follow the lengths of the lists. The sums of samples stay on the device and are
//! accumulated in the order of the samples, so that a picture depends only on scene, size, samples and seed.
//!
//! Nothing here submits or waits: [`Round::steps`] lists the dispatches of some samples, and [`Recorder`] records them
//! into any encoder.

mod frame;
mod kernels;
mod lighting;
mod live;
mod one_pass;
mod passes;
mod plan;
mod recorder;
pub(crate) mod records;
mod round;
pub(crate) mod sums;

use wgpu::Device;

use crate::camera::View;
use crate::gpu::error::GpuError;
use crate::gpu::passes::frame::iteration_limit;
use crate::gpu::passes::tiles::{Groups, Tile};
use crate::gpu::passes::visible_bricks::VisibleRegion;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::records::FrameParameters;
use crate::render::RenderSettings;

use crate::accel::Structure;
use crate::camera::CameraKind;
use crate::gpu::passes::lit::kernels::{
    Materials, Schedule, SkyKind, Sources, accumulate_kernel, advance_kernel, ambient_kernel,
    extend_kernel, gather_kernel, illuminate_kernel, noise_kernel, occlude_kernel, scatter_kernel,
    shadow_kernel, start_kernel, surface_kernel,
};
use crate::gpu::passes::lit::live::live_kernels;
use crate::gpu::passes::lit::one_pass::OnePass;
use crate::gpu::scene::scene_summary::ExcludeBy;
use crate::gpu::shader::{BrickPass, Kernel};
pub(crate) use frame::LightingBuffers;
pub(crate) use frame::{Frames, LitFrame, MAX_DISPATCHES, RecordedBy};
pub(crate) use kernels::Mode;
pub(crate) use lighting::LightingData;
pub(crate) use live::{LiveKey, LivePasses, LiveView};
pub(crate) use passes::{LitKey, LitLayouts, LitPasses};
pub(crate) use recorder::Recorder;
pub(crate) use records::LitSizes;
pub(crate) use round::{Attempt, Moment, Round, Step};

/// A scene as a lit picture shows it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LitScene<'a> {
    pub(crate) all: &'a SceneBuffers,
    /// The spheres that cast shadows.
    pub(crate) occluders: &'a SceneBuffers,
    pub(crate) view: &'a View<'a>,
    pub(crate) settings: &'a RenderSettings,
}

impl<'a> LitScene<'a> {
    /// Checks the settings.
    pub(crate) fn new(
        all: &'a SceneBuffers,
        view: &'a View<'a>,
        settings: &'a RenderSettings,
    ) -> Result<Self, GpuError> {
        settings.check_with(all.appearance())?;
        Ok(Self { all, occluders: all.occluders(settings)?, view, settings })
    }

    pub(crate) fn lighting(&self) -> LightingData {
        LightingData::new(self.settings, &self.all.summary, self.view.camera)
    }

    /// The key of the passes that the picture needs.
    pub(crate) fn key(&self, lighting: &LightingData, limits: &wgpu::Limits) -> LitKey {
        let Self { all, occluders, view, .. } = *self;
        LitKey {
            camera: view.camera.kind(),
            mode: lighting.mode,
            structure: all.structure(),
            occluders: occluders.structure(),
            exclude_by: [all, occluders].map(|scene| scene.exclude_by),
            several_bricks: all.bricks.len() > 1,
            one_pass: lighting
                .one_pass(all.bricks.len())
                .filter(|pass| !pass.is_paths() || all.shape.paths_in_one_pass)
                .filter(|_| lighting.loops_of_path() <= round::MOST_LOOPS)
                .filter(|_| one_pass::one_pass_fits(all.structure(), limits))
                .filter(|_| {
                    let rays = lighting.rays_of_sample();
                    all.rays_at_once(rays) == rays
                }),
        }
    }

    /// The records of tiles.
    pub(crate) fn records(self, device: &Device) -> impl Fn(Tile) -> (Tile, Frames) + 'a {
        let Self { all, occluders, view, settings } = self;
        let limit = iteration_limit(device);
        // The region in which the scene may be visible. The ground may be visible everywhere.
        let region = settings.ground.is_none().then(|| {
            let around = settings.sampling.filter.radius();
            VisibleRegion::of(view, &all.space).widened(around)
        });
        move |tile| {
            let whole = Groups::of_size(tile.size);
            let traced = region.map_or(whole, |region| region.groups_of(tile));
            let areas = [(all, whole), (all, traced), (occluders, traced)];
            let frames = areas.map(|(scene, groups)| {
                FrameParameters::of_tile(view, &scene.space, tile, groups, limit)
                    .in_order_of(all.shape)
            });
            (tile, frames)
        }
    }
}

/// Returns one kernel for every camera, structure, kind of lighting and schedule.
pub(crate) fn all_kernels() -> Vec<Kernel> {
    const SCHEDULES: [Schedule; 2] = [Schedule::Pixels, Schedule::Queue];
    let mut modes = vec![Mode::Studio];
    for materials in [Materials::Matt, Materials::Any] {
        for sources in [Sources::None, Sources::Any] {
            for sky in [SkyKind::Plain, SkyKind::Image] {
                modes.push(Mode::Path(materials, sources, sky));
            }
        }
    }
    let mut kernels = vec![advance_kernel(), noise_kernel(), illuminate_kernel(), gather_kernel()];
    for &mode in &modes {
        kernels.push(accumulate_kernel(mode));
        if let Mode::Path(materials, sources, sky) = mode {
            kernels.extend(SCHEDULES.map(|by| scatter_kernel(by, materials, sources, sky)));
        }
        let cameras = CameraKind::ALL.iter();
        kernels.extend(cameras.map(|camera| start_kernel(*camera, mode)));
    }
    for (&structure, exclude_by) in Structure::WITH_KERNELS
        .iter()
        .flat_map(|of| ExcludeBy::ALL.map(|exclude_by| (of, exclude_by)))
    {
        for brick_pass in [BrickPass::First, BrickPass::Later] {
            kernels
                .extend(SCHEDULES.map(|by| extend_kernel(structure, exclude_by, brick_pass, by)));
        }
        let cameras = CameraKind::ALL.iter();
        kernels.extend(cameras.flat_map(|camera| {
            OnePass::ALL.map(|pass| pass.kernel(*camera, structure, exclude_by))
        }));
        kernels.extend(modes.iter().map(|mode| occlude_kernel(structure, exclude_by, *mode)));
        kernels.extend([shadow_kernel, ambient_kernel].map(|of| of(structure, exclude_by)));
    }
    kernels.extend(live_kernels());
    kernels.extend(SCHEDULES.map(surface_kernel));
    kernels
}
