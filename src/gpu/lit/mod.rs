//! Lit pictures: many samples of every pixel, surface by surface, on a device of our own.
//!
//! Between two dispatches a path is in a buffer (`shaders/path_state.wgsl`). A sample starts at the camera; then one
//! kernel finds what all rays meet, one shades it and makes new rays, one finds whether lights are hidden. Samples
//! are taken in batches of fixed sizes, so that sums do not depend on tiles or time.

use self::film::Sums;
use self::look::Lit;
use self::run::Run;
use self::tile::{FRAMES, TileBuffers, lit_tile_size};
use super::error::GpuError;
use super::frame::iteration_limit;
use super::headless::Headless;
use super::progress::{Decision, Picture, Progress, Watch, go_on};
use super::records::Frame;
use super::scene_buffers::SceneBuffers;
use super::seen::Seen;
use super::tiles::{Groups, Tile, tiles};
use crate::camera::View;
use crate::image::{Image, Layer, LayerSet};
use crate::outline;
use crate::render::{PrimaryLook, RenderSettings};

mod film;
mod kernels;
mod look;
mod plan;
mod recording;
pub(super) mod records;
mod renderer;
mod run;
mod tile;
mod trace;

#[cfg(test)]
pub(super) use kernels::all_kernels;
pub(super) use renderer::{LitKey, LitRenderer, LitRenderers};

/// How many samples are taken after so many: sums of a batch are in f32, and of batches in f64.
fn batch(done: u32, total: u32) -> u32 {
    done.clamp(1, 32).min(total - done)
}

impl Headless {
    /// Renders a lit picture of a scene that is on this device.
    pub(super) fn render_lit(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, GpuError> {
        settings.check_with(scene.appearance())?;
        let occluders = scene.occluders(settings)?;
        let wanted = settings.layers_for(layers);
        let mut image = self.data_layers(scene, view, wanted)?;
        let lit = Lit::new(settings, scene.summary(), view.camera);
        let mut sums = Sums::new(&view.film)?;
        self.gather([scene, occluders], view, settings, &lit, &mut sums, watch)?;
        sums.write(&mut image);
        if settings.is_denoised {
            image = self.denoise(&image)?;
        }
        if let Some(lines) = settings.studio_parameters().and_then(|studio| studio.outline) {
            outline::draw(&mut image, &lines);
        }
        image.keep(layers);
        let (samples, noise, hits) = (sums.samples(), sums.noise(), Some(sums.hits()));
        Ok(Picture { image, samples, noise, hits })
    }

    /// The layers that are not averaged: of the ray through each pixel's centre.
    fn data_layers(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        let by_one_ray = [Layer::Depth, Layer::Normal, Layer::Id, Layer::Position];
        if !by_one_ray.iter().any(|layer| layers.contains(*layer)) {
            return Ok(Image::new(view.film.width(), view.film.height(), layers)?);
        }
        self.render_primary(scene, view, &PrimaryLook::default(), layers, &mut go_on)
    }

    fn gather(
        &self,
        scenes: [&SceneBuffers; 2],
        view: &View<'_>,
        settings: &RenderSettings,
        lit: &Lit,
        sums: &mut Sums,
        watch: &mut Watch<'_>,
    ) -> Result<(), GpuError> {
        let key = LitKey {
            camera: view.camera.kind(),
            mode: lit.mode,
            structure: scenes[0].structure(),
            occluders: scenes[1].structure(),
        };
        self.with_lit_renderer(key, |renderer| {
            let (device, queue) = (self.device(), self.queue());
            let size = lit_tile_size(&device.limits(), &view.film);
            let tile_buffers = TileBuffers::new(device, queue, renderer, size, lit, settings)?;
            let limit = iteration_limit(device);
            let total = settings.sampling.samples;
            let seen = seen(scenes[0], view, settings);
            let tile_list: Vec<Tile> = tiles(&view.film, size).collect();
            while sums.samples() < total {
                let first = sums.samples();
                let count = batch(first, total);
                let mut progress =
                    Progress { samples: first, total, part: 0.0, noise: sums.noise() };
                let mut finished = false;
                // All tiles' sums, so that a batch counts as a whole or not at all.
                let mut gathered = Vec::new();
                for (number, tile) in tile_list.iter().enumerate() {
                    let frames = frames(scenes, view, seen, *tile, limit);
                    let tiles_done = number as f64 / tile_list.len() as f64;
                    progress.part =
                        (f64::from(first) + f64::from(count) * tiles_done) / f64::from(total);
                    let mut after = || match watch(&progress) {
                        Decision::GoOn | Decision::MeasureNoise => Ok(()),
                        Decision::Stop => Err(GpuError::Stopped),
                        Decision::Finish => {
                            finished = true;
                            Err(GpuError::Stopped)
                        }
                    };
                    let mut run =
                        Run::new(self, renderer, &tile_buffers, scenes, frames, &mut after);
                    let result = run.batch(first..first + count, lit, settings, *tile);
                    match result {
                        Ok(found) => gathered.push(found),
                        Err(GpuError::Stopped) if finished && first > 0 => return Ok(()),
                        Err(error) => return Err(error),
                    }
                }
                for (tile, found) in tile_list.iter().zip(&gathered) {
                    sums.add(*tile, found);
                }
                sums.count(count);
            }
            Ok(())
        })
    }
}

/// Where the scene may be seen; `None` for everywhere.
fn seen(scene: &SceneBuffers, view: &View<'_>, settings: &RenderSettings) -> Option<Seen> {
    // Wherever there is ground there is something to be seen.
    settings.ground.is_none().then(|| {
        let around = settings.sampling.filter.radius();
        Seen::of(view, scene.space()).widened(around)
    })
}

/// Records of all of a tile; of where the scene may be seen; the same for what casts shadows.
fn frames(
    scenes: [&SceneBuffers; 2],
    view: &View<'_>,
    seen: Option<Seen>,
    tile: Tile,
    limit: u32,
) -> [Frame; FRAMES] {
    let all = Groups::of_size(tile.size);
    let traced = seen.map_or(all, |seen| seen.groups_of(tile));
    let [scene, occluders] = scenes.map(SceneBuffers::space);
    [(scene, all), (scene, traced), (occluders, traced)]
        .map(|(space, groups)| Frame::of_tile(view, space, tile, groups, limit))
}
