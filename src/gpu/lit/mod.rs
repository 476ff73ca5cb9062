//! Lit pictures: many samples of every pixel, surface by surface, on a device of our own.
//!
//! Between two dispatches a path is in a buffer (`shaders/path_state.wgsl`). A sample starts at the camera; then one
//! kernel finds what all rays meet, one shades it and makes new rays, one finds whether lights are hidden. Samples
//! are taken in batches of fixed sizes, so that sums do not depend on tiles or time.

use std::ops::ControlFlow;

use self::film::Sums;
use self::look::Lit;
use self::run::Run;
use self::tile::{FRAMES, TileBuffers, lit_tile_size};
use super::error::GpuError;
use super::frame::iteration_limit;
use super::headless::{Headless, with_structures};
use super::records::Frame;
use super::scene_buffers::SceneBuffers;
use super::seen::Seen;
use super::tiles::{Groups, Tile, tiles};
use crate::accel::Accel;
use crate::camera::Camera;
use crate::film::Film;
use crate::image::{Image, Layer, LayerSet};
use crate::lighting::Lighting;
use crate::outline;
use crate::scene::Scene;
use crate::settings::Settings;

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

/// A scene on a device, for lit pictures of one lighting after another.
#[derive(Debug)]
pub struct LitScene {
    all: SceneBuffers,
    /// What casts shadows in a studio, unless that is all.
    opaque: Option<SceneBuffers>,
}

/// How far a lit picture is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LitProgress {
    /// Samples that every pixel has.
    pub samples: u32,
    /// How many it will have.
    pub total: u32,
    /// All work that is done, from 0 to 1.
    pub part: f64,
    /// The noise that is left: the root of the mean variance of pixels, over the mean luminance.
    pub noise: Option<f64>,
}

/// What is to be done about a lit picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LitDecision {
    /// More of it.
    GoOn,
    /// Take it as it is; with no sample of every pixel there is none.
    Finish,
    /// Give it up.
    Stop,
}

/// Told of progress after every submission; decides how the render goes on.
pub type LitWatch<'a> = dyn FnMut(&LitProgress) -> LitDecision + 'a;

/// What became of a lit picture.
#[derive(Clone, Debug, PartialEq)]
pub struct LitPicture {
    /// The picture, with the layers that were asked for.
    pub image: Image,
    /// How many samples every pixel has.
    pub samples: u32,
    /// See [`LitProgress::noise`].
    pub noise: Option<f64>,
    /// How many of the camera's rays met something, all samples together; weighted by opacity.
    pub hits: f64,
}

/// How many samples are taken after so many: sums of a batch are in f32, and of batches in f64.
fn batch(done: u32, total: u32) -> u32 {
    done.clamp(1, 32).min(total - done)
}

impl Headless {
    /// Copies a scene to the device for lit pictures. What casts shadows in a studio, if that is not all, gets a
    /// structure of the same family.
    ///
    /// # Errors
    /// As [`Headless::upload`].
    pub fn upload_lit(&self, scene: &Scene, accel: &Accel) -> Result<LitScene, GpuError> {
        let all = self.upload(scene, accel)?;
        let opaque = match scene.opaque() {
            None => None,
            Some(opaque) => {
                let choice = accel.structure().choice();
                let accel = self.plan(&opaque, choice).build(opaque.spheres());
                Some(self.upload(&opaque, &accel)?)
            }
        };
        Ok(LitScene { all, opaque })
    }

    /// Renders a lit picture.
    ///
    /// # Errors
    /// If the lighting or a material is out of range, and as [`Headless::render`].
    pub fn render_lit(
        &self,
        scene: &Scene,
        camera: &dyn Camera,
        film: &Film,
        lighting: &Lighting,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        let plan = |choice| self.plan(scene, choice);
        let picture = with_structures(scene, plan, |accel| {
            let buffers = self.upload_lit(scene, &accel)?;
            drop(accel);
            let go_on = &mut |_: &LitProgress| LitDecision::GoOn;
            self.render_lit_uploaded(scene, &buffers, (camera, film), lighting, layers, go_on)
        })?;
        Ok(picture.image)
    }

    /// As [`Headless::render_lit`], of a scene that is on this device already. `watch` is told of progress.
    ///
    /// # Errors
    /// As [`Headless::render_lit`]; [`GpuError::Stopped`] if `watch` says so.
    pub fn render_lit_uploaded(
        &self,
        scene: &Scene,
        buffers: &LitScene,
        (camera, film): (&dyn Camera, &Film),
        lighting: &Lighting,
        layers: LayerSet,
        watch: &mut LitWatch<'_>,
    ) -> Result<LitPicture, GpuError> {
        lighting.check(scene)?;
        let wanted = lighting.layers_for(layers);
        let mut image = self.data_layers(&buffers.all, camera, film, wanted)?;
        let lit = Lit::new(lighting, scene, camera);
        let mut sums = Sums::new(film)?;
        self.gather(buffers, (camera, film), lighting, &lit, &mut sums, watch)?;
        sums.write(&mut image);
        if lighting.is_denoised {
            image = self.denoise(&image)?;
        }
        if let Some(lines) = lighting.studio().and_then(|studio| studio.outline) {
            outline::draw(&mut image, &lines);
        }
        image.keep(layers);
        let (samples, noise, hits) = (sums.samples(), sums.noise(), sums.hits());
        Ok(LitPicture { image, samples, noise, hits })
    }

    /// The layers that are not averaged: of the ray through each pixel's centre.
    fn data_layers(
        &self,
        scene: &SceneBuffers,
        camera: &dyn Camera,
        film: &Film,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        let by_one_ray = [Layer::Depth, Layer::Normal, Layer::Id, Layer::Position];
        if !by_one_ray.iter().any(|layer| layers.contains(*layer)) {
            return Ok(Image::new(film.width(), film.height(), layers)?);
        }
        let go_on = &mut |_| ControlFlow::Continue(());
        self.render_uploaded(scene, camera, film, &Settings::default(), layers, go_on)
    }

    fn gather(
        &self,
        buffers: &LitScene,
        (camera, film): (&dyn Camera, &Film),
        lighting: &Lighting,
        lit: &Lit,
        sums: &mut Sums,
        watch: &mut LitWatch<'_>,
    ) -> Result<(), GpuError> {
        let scenes = [&buffers.all, buffers.occluders(lighting)];
        let key = LitKey {
            camera: camera.kind(),
            mode: lit.mode,
            structure: scenes[0].structure(),
            occluders: scenes[1].structure(),
        };
        self.with_lit_renderer(key, |renderer| {
            let (device, queue) = (self.device(), self.queue());
            let size = lit_tile_size(&device.limits(), film);
            let tile_buffers = TileBuffers::new(device, queue, renderer, size, lit, lighting)?;
            let limit = iteration_limit(device);
            let total = lighting.sampling.samples;
            let seen = seen(scenes[0], (camera, film), lighting);
            let tile_list: Vec<Tile> = tiles(film, size).collect();
            while sums.samples() < total {
                let first = sums.samples();
                let count = batch(first, total);
                let mut progress =
                    LitProgress { samples: first, total, part: 0.0, noise: sums.noise() };
                let mut finished = false;
                // All tiles' sums, so that a batch counts as a whole or not at all.
                let mut gathered = Vec::new();
                for (number, tile) in tile_list.iter().enumerate() {
                    let frames = frames(scenes, (camera, film), seen, *tile, limit);
                    let tiles_done = number as f64 / tile_list.len() as f64;
                    progress.part =
                        (f64::from(first) + f64::from(count) * tiles_done) / f64::from(total);
                    let mut after = || match watch(&progress) {
                        LitDecision::GoOn => Ok(()),
                        LitDecision::Stop => Err(GpuError::Stopped),
                        LitDecision::Finish => {
                            finished = true;
                            Err(GpuError::Stopped)
                        }
                    };
                    let mut run =
                        Run::new(self, renderer, &tile_buffers, scenes, frames, &mut after);
                    let result = run.batch(first..first + count, lit, lighting, *tile);
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
fn seen(
    scene: &SceneBuffers,
    (camera, film): (&dyn Camera, &Film),
    lighting: &Lighting,
) -> Option<Seen> {
    // Wherever there is ground there is something to be seen.
    lighting.ground.is_none().then(|| {
        let around = lighting.sampling.filter.radius();
        Seen::of(camera, scene.space(), film).widened(around)
    })
}

/// Records of all of a tile; of where the scene may be seen; the same for what casts shadows.
fn frames(
    scenes: [&SceneBuffers; 2],
    (camera, film): (&dyn Camera, &Film),
    seen: Option<Seen>,
    tile: Tile,
    limit: u32,
) -> [Frame; FRAMES] {
    let all = Groups::of_size(tile.size);
    let traced = seen.map_or(all, |seen| seen.groups_of(tile));
    let [scene, occluders] = scenes.map(SceneBuffers::space);
    [(scene, all), (scene, traced), (occluders, traced)]
        .map(|(space, groups)| Frame::of_tile(camera, space, film, tile, groups, limit))
}

impl LitScene {
    /// What casts shadows.
    fn occluders(&self, lighting: &Lighting) -> &SceneBuffers {
        match (&self.opaque, lighting.studio()) {
            (Some(opaque), Some(_)) => opaque,
            _ => &self.all,
        }
    }

    /// Bytes of all its buffers on the device.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.all.bytes() + self.opaque.as_ref().map_or(0, SceneBuffers::bytes)
    }
}
