//! What a device did with paths, for the checker: their state after every dispatch on its way back to the host, and
//! the numbers that the device was given.

use std::ops::Range;

use wgpu::Device;

use super::look::Lit;
use super::records::{Look, PATH_SLOTS};
use super::renderer::LitKey;
use super::run::Run;
use super::tile::TileBuffers;
use super::{frames, seen};
use crate::camera::View;
use crate::film::Film;
use crate::gpu::error::GpuError;
use crate::gpu::frame::iteration_limit;
use crate::gpu::headless::Headless;
use crate::gpu::progress::{Decision, Progress, Watch};
use crate::gpu::readback::ReadableBuffer;
use crate::gpu::recording::requested_view;
use crate::gpu::records::Hit;
use crate::gpu::scene_buffers::SceneBuffers;
use crate::gpu::tiles::Tile;
use crate::lighting::SkyLight;
use crate::render::{Integrator, RenderSettings};
use crate::verify::{
    PathRecording, PathState, RecordedSample, RecordedSurface, UploadedLook, UploadedSky,
};

const _: () = assert!(PATH_SLOTS == PathState::SLOTS as u64);

/// The longest side of the rectangle whose paths are recorded, in pixels: a sample of eight surfaces then takes
/// 130 MB of the host's memory.
const LONGEST_SIDE: u32 = 256;

/// After which dispatch of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Moment {
    Started,
    Traced,
    Scattered,
    Occluded,
    Deposited,
}

/// What is kept of the samples of a tile.
#[derive(Debug)]
pub(super) struct Keeper {
    paths: ReadableBuffer,
    hits: ReadableBuffer,
    pixels: usize,
    sample: RecordedSample,
}

impl Keeper {
    fn new(device: &Device, tile: &TileBuffers, pixels: usize) -> Self {
        Self {
            paths: ReadableBuffer::new(device, "pinhole paths read-back", tile.paths.size()),
            hits: ReadableBuffer::new(device, "pinhole hits read-back", tile.hits.size()),
            pixels,
            sample: RecordedSample::default(),
        }
    }

    fn read_states(&self) -> Result<Vec<PathState>, GpuError> {
        let pixels = self.pixels;
        self.paths.read(|vectors: &[[u32; 4]]| {
            let state = |index: usize| {
                let slots = std::array::from_fn(|slot| vectors[slot * pixels + index]);
                PathState { slots }
            };
            (0..pixels).map(state).collect()
        })
    }
}

impl Run<'_> {
    /// Reads what a dispatch has changed, if that is wanted.
    pub(super) fn keep(&mut self, moment: Moment) -> Result<(), GpuError> {
        let Some(keeper) = self.keeper.take() else {
            return Ok(());
        };
        let kept = self.keep_in(keeper, moment);
        self.keeper = Some(keeper);
        kept
    }

    fn keep_in(&mut self, keeper: &mut Keeper, moment: Moment) -> Result<(), GpuError> {
        let tile = self.tile;
        match moment {
            Moment::Traced => {
                keeper.hits.record_copy(self.encoder(), &tile.hits);
                self.run_gathered(&[keeper.hits.buffer()])?;
                let pixels = keeper.pixels;
                let hits = keeper.hits.read(|hits: &[Hit]| hits[..pixels].to_vec())?;
                keeper.sample.surfaces.push(RecordedSurface { hits, ..RecordedSurface::default() });
            }
            Moment::Started | Moment::Scattered | Moment::Occluded => {
                keeper.paths.record_copy(self.encoder(), &tile.paths);
                self.run_gathered(&[keeper.paths.buffer()])?;
                let states = keeper.read_states()?;
                let open = |states: &[PathState]| {
                    states.iter().map(|state| state.slots[PathState::PENDING][3]).collect()
                };
                match (moment, keeper.sample.surfaces.last_mut()) {
                    (Moment::Scattered, Some(surface)) => {
                        surface.open = open(&states);
                        surface.scattered = states;
                    }
                    (Moment::Occluded, Some(surface)) => surface.open = open(&states),
                    _ => keeper.sample.start = states,
                }
            }
            Moment::Deposited => {
                tile.record_copy_film(self.encoder());
                tile.record_copy_status(self.encoder());
                self.run_gathered(&[tile.film_back.buffer(), tile.status_back.buffer()])?;
                let used = 2 * keeper.pixels;
                keeper.sample.sums = tile.film_back.read(|sums: &[[u32; 4]]| {
                    sums[..used].chunks_exact(2).map(|sum| [sum[0], sum[1]]).collect()
                })?;
                if tile.status_back.read(|words: &[u32]| words[0])? != 0 {
                    return Err(GpuError::Steps);
                }
            }
        }
        Ok(())
    }
}

impl Headless {
    /// Follows some samples of a scene's paths, and keeps their state after every dispatch: everything by which
    /// [`Checker::certify_paths`](crate::verify::Checker::certify_paths) judges the device. Of a film with a side of
    /// more than 256 pixels, those of a rectangle in its middle.
    ///
    /// # Errors
    /// [`GpuError::NotPaths`] if the integrator is not `path`; as [`Headless::render_uploaded`]; [`GpuError::Stopped`]
    /// if `watch` says anything but to go on.
    pub fn record_paths(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        samples: Range<u32>,
        watch: &mut Watch<'_>,
    ) -> Result<PathRecording, GpuError> {
        settings.check_with(scene.appearance())?;
        let Integrator::Path(path) = &settings.integrator else {
            return Err(GpuError::NotPaths);
        };
        let lit = Lit::new(settings, scene.summary(), view.camera);
        let searched = [scene; 2];
        let key = LitKey {
            camera: view.camera.kind(),
            mode: lit.mode,
            structure: scene.structure(),
            occluders: scene.structure(),
        };
        let tile = middle_of(&view.film);
        let (camera, uploaded) = requested_view(scene.space(), view.camera);
        let mut recording = PathRecording {
            camera,
            uploaded,
            film: view.film,
            origin: tile.origin,
            size: tile.size,
            settings: settings.clone(),
            max_depth: path.max_depth,
            look: uploaded_look(&lit.look),
            tables: lit.tables.iter().map(|four| four.map(f32::to_bits)).collect(),
            sky: uploaded_sky(settings),
            samples: Vec::new(),
        };
        self.with_lit_renderer(key, |renderer| {
            let (device, queue) = (self.device(), self.queue());
            let tile_buffers =
                TileBuffers::new(device, queue, renderer, tile.size, &lit, settings)?;
            let limit = iteration_limit(device);
            let frames = frames(searched, view, seen(scene, view, settings), tile, limit);
            let pixels = tile.size[0] as usize * tile.size[1] as usize;
            let mut keeper = Keeper::new(device, &tile_buffers, pixels);
            let total = samples.end.saturating_sub(samples.start);
            for (done, sample) in (0..).zip(samples) {
                let part = f64::from(done) / f64::from(total);
                let progress = Progress { samples: done, total, part, noise: None };
                let mut after = || match watch(&progress) {
                    Decision::GoOn | Decision::MeasureNoise => Ok(()),
                    Decision::Finish | Decision::Stop => Err(GpuError::Stopped),
                };
                keeper.sample = RecordedSample { sample, ..RecordedSample::default() };
                let mut run = Run::new(self, renderer, &tile_buffers, searched, frames, &mut after);
                run.keeper = Some(&mut keeper);
                tile_buffers.record_clear(run.encoder());
                run.sample(sample, &lit, settings)?;
                recording.samples.push(std::mem::take(&mut keeper.sample));
            }
            Ok(recording)
        })
    }
}

/// The rectangle in the middle of a film.
fn middle_of(film: &Film) -> Tile {
    let film = [film.width(), film.height()];
    let size = film.map(|side| side.min(LONGEST_SIDE));
    let origin = [0, 1].map(|axis| (film[axis] - size[axis]) / 2);
    Tile { origin, size, in_target: [0, 0] }
}

fn uploaded_look(look: &Look) -> UploadedLook {
    let mut filter_table: Vec<f32> = look.filter_table.iter().flatten().copied().collect();
    // Rows of four; the last has one.
    filter_table.truncate(257);
    UploadedLook {
        background: look.background,
        flags: look.flags,
        light_count: look.light_count,
        zenith: look.zenith,
        horizon: look.horizon,
        nadir: look.nadir,
        roulette_from: look.roulette_from,
        source_count: look.source_count,
        light_sampling: look.light_sampling,
        ground_normal: look.ground_normal,
        ground_point: look.ground_point,
        ground_color: look.ground_color,
        seed: look.seed,
        emitter_first: look.emitter_first,
        emitter_count: look.emitter_count,
        material_first: look.material_first,
        environment_size: look.environment_size,
        environment_rotation: look.environment_rotation,
        environment_strength: look.environment_strength,
        lamp_sources: look.lamp_sources,
        filter_table,
    }
}

fn uploaded_sky(settings: &RenderSettings) -> Option<UploadedSky> {
    match &settings.sky.light {
        SkyLight::Image { environment, .. } => Some(UploadedSky {
            texels: environment.texels().to_vec(),
            shares: environment.rows().iter().chain(environment.columns()).copied().collect(),
        }),
        SkyLight::Constant(_) | SkyLight::Gradient { .. } => None,
    }
}
