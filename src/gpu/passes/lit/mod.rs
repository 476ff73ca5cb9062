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

mod all_kernels;
mod frame;
mod kernels;
mod lighting;
mod lighting_buffers;
mod live;
mod make;
mod one_pass;
mod pass;
mod passes;
mod plan;
mod recorder;
pub(in crate::gpu) mod records;
mod round;
mod sizes;
pub(in crate::gpu) mod sums;

use crate::camera::View;
use crate::gpu::passes::tiles::{Groups, Tile};
use crate::gpu::passes::visible_region::VisibleRegion;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::records::FrameParameters;
use crate::render::RenderSettings;

pub(in crate::gpu) use all_kernels::all_kernels;
pub(in crate::gpu) use frame::{Frames, LitFrame, MAX_DISPATCHES, RecordedBy};
pub(in crate::gpu) use kernels::Mode;
pub(in crate::gpu) use lighting::LightingData;
pub(in crate::gpu) use lighting_buffers::LightingBuffers;
pub(in crate::gpu) use live::{LiveKey, LivePasses, LiveView};
pub(in crate::gpu) use make::{bind_group, buffer, whole};
pub(in crate::gpu) use passes::{AllLitPasses, LitKey, LitLayouts, LitPasses};
pub(in crate::gpu) use recorder::Recorder;
pub(in crate::gpu) use round::{AT_ONCE, Moment, Round, Step};
pub(in crate::gpu) use sizes::LitSizes;

/// The buffers of a scene that a lit picture uses.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct LitScene<'a> {
    pub(in crate::gpu) all: &'a SceneBuffers,
    /// The spheres that cast shadows.
    pub(in crate::gpu) occluders: &'a SceneBuffers,
}

impl LitScene<'_> {
    /// The key of the passes that the picture needs.
    pub(in crate::gpu) fn key(
        &self,
        view: &View<'_>,
        lighting: &LightingData,
        limits: &wgpu::Limits,
    ) -> LitKey {
        LitKey {
            camera: view.camera.kind(),
            mode: lighting.mode,
            structure: self.all.structure(),
            occluders: self.occluders.structure(),
            exclude_by: [self.all, self.occluders].map(SceneBuffers::exclude_by),
            several_bricks: self.all.bricks().len() > 1,
            one_pass: lighting
                .one_pass(self.all.bricks().len())
                .filter(|pass| !pass.is_paths() || self.all.shape().paths_in_one_pass)
                .filter(|_| lighting.loops_of_path() <= round::MOST_LOOPS)
                .filter(|_| one_pass::one_pass_fits(self.all.structure(), limits))
                .filter(|_| {
                    let rays = lighting.rays_of_sample();
                    self.all.rays_at_once(rays) == rays
                }),
        }
    }

    /// The region of the film in which the scene may be visible; `None` for the whole film.
    pub(in crate::gpu) fn visible_region(
        &self,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Option<VisibleRegion> {
        // The ground may be visible everywhere.
        settings.ground.is_none().then(|| {
            let around = settings.sampling.filter.radius();
            VisibleRegion::of(view, self.all.space()).widened(around)
        })
    }

    /// The records of a tile.
    pub(in crate::gpu) fn frames(
        &self,
        view: &View<'_>,
        region: Option<VisibleRegion>,
        tile: Tile,
        iteration_limit: u32,
    ) -> Frames {
        let all = Groups::of_size(tile.size);
        let traced = region.map_or(all, |region| region.groups_of(tile));
        let [scene, occluders] = [self.all, self.occluders].map(SceneBuffers::space);
        [(scene, all), (scene, traced), (occluders, traced)].map(|(space, groups)| {
            FrameParameters::of_tile(view, space, tile, groups, iteration_limit)
                .in_order_of(self.all.shape())
        })
    }
}
