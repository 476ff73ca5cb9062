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
use crate::gpu::shader::Kernel;
use crate::gpu::shader::records::FrameParameters;
use crate::render::RenderSettings;
pub(crate) use frame::LightingBuffers;
pub(crate) use frame::{Frames, LitFrame, MAX_DISPATCHES, RecordedBy};
use kernels::ShapeStructures;
pub(crate) use kernels::{LitKey, Mode};
pub(crate) use lighting::LightingData;
pub(crate) use live::{LiveKey, LivePasses, LiveView};
pub(crate) use passes::{LitLayouts, LitPasses};
pub(crate) use recorder::Recorder;
pub(crate) use records::LitSizes;
pub(crate) use round::{Moment, Round, SampleStrategy, Step};

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
            structures: ShapeStructures::of(&all.kinds()),
            occluders: ShapeStructures::of(&occluders.kinds()),
            exclude_by: [all, occluders].map(|scene| scene.exclude_by),
            several_bricks: all.bricks.len() > 1,
            one_pass: lighting
                .one_pass(all.bricks.len())
                .filter(|_| !all.has_cones())
                .filter(|pass| !pass.is_paths() || all.shape.paths_in_one_pass)
                .filter(|_| lighting.loops_of_path() <= round::MOST_LOOPS)
                .filter(|_| kernels::one_pass_fits(all.structure(), limits))
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
                FrameParameters::of_tile(view, &scene.space, tile, groups, limit).in_order_of(all.shape)
            });
            (tile, frames)
        }
    }
}

/// Returns one kernel for every camera, structure, kind of lighting and schedule.
pub(crate) fn all_kernels() -> Vec<Kernel> {
    let mut all = kernels::kernels();
    all.extend(live::live_kernels());
    all
}
