//! Recording paths for the checker: their state after every pass, and the numbers that the device was given.

use std::ops::Range;

use crate::camera::View;
use crate::camera::film::Film;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::lit_flow::Flow;
use crate::gpu::headless::progress::{Decision, Progress, Watch};
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::headless::recording::requested_view;
use crate::gpu::passes::frame::iteration_limit;
use crate::gpu::passes::lit::records::{FILM_SLOTS, LightingParameters};
use crate::gpu::passes::lit::{
    AT_ONCE, LightingData, LitFrame, LitKey, LitPasses, LitScene, LitSizes, Mode, Moment,
    RecordedBy, Round,
};
use crate::gpu::passes::tiles::Tile;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::records::SceneSpace;
use crate::light::SkyLight;
use crate::render::{Integrator, RenderSettings};
use crate::verify::{
    PathRecording, PathState, RecordedSample, RecordedSurface, UploadedLighting, UploadedSky,
};

/// Maximum side in pixels of the rectangle whose paths are recorded. A sample of eight surfaces then takes 130 MB of
/// host memory.
const LONGEST_SIDE: u32 = 256;

/// Collects the recorded states of the samples of a tile.
struct PathRecorder<'a> {
    frame: &'a LitFrame,
    paths: ReadableBuffer,
    pixels: usize,
    slots: [SlotSource; PathState::SLOTS],
    sample: RecordedSample,
}

impl PathRecorder<'_> {
    /// Reads the state that a pass has changed.
    async fn read(&mut self, flow: &mut Flow<'_>, moment: Moment) -> Result<(), GpuError> {
        let frame = self.frame;
        if moment == Moment::Accumulated {
            frame.record_copy_film(flow.encoder(), 0);
            frame.record_copy_spent(flow.encoder());
            flow.finish(&[frame.film_back.buffer(), frame.spent_back.buffer()]).await?;
            let used = FILM_SLOTS as usize * self.pixels;
            self.sample.sums = frame.film_back.read(|sums: &[[u32; 4]]| {
                let sums = sums[..used].chunks_exact(FILM_SLOTS as usize);
                // The sum of a single sample has no rounding remainder.
                sums.map(|sum| [sum[0], sum[2]]).collect()
            })?;
            return frame.read_spent();
        }
        self.paths.record_copy(flow.encoder(), &frame.paths);
        flow.finish(&[self.paths.buffer()]).await?;
        let pixels = self.pixels;
        let (states, hits) = self.paths.read(|vectors: &[[u32; 4]]| {
            let slot = |which: usize, index: usize| vectors[which * pixels + index];
            let state = |index| PathState {
                slots: self.slots.map(|source| match source {
                    SlotSource::Device(which) => slot(which, index),
                    SlotSource::Constant(bits) => bits,
                }),
            };
            let states: Vec<PathState> = (0..pixels).map(state).collect();
            let hits: Vec<[u32; 4]> = (0..pixels).map(|index| slot(HIT, index)).collect();
            (states, hits)
        })?;
        let open = |states: &[PathState]| {
            states.iter().map(|state| state.slots[PathState::PENDING][3]).collect()
        };
        match (moment, self.sample.surfaces.last_mut()) {
            (Moment::Extended, _) => {
                self.sample.surfaces.push(RecordedSurface { hits, ..RecordedSurface::default() });
            }
            (Moment::Scattered, Some(surface)) => {
                surface.open = open(&states);
                surface.scattered = states;
            }
            (Moment::Occluded, Some(surface)) => surface.open = open(&states),
            _ => self.sample.start = states,
        }
        Ok(())
    }
}

/// Index of the slot of the hit, `HIT` in `shaders/path/state.wgsl`.
const HIT: usize = 6;

/// The source of a slot of a [`PathState`].
#[derive(Clone, Copy, Debug)]
enum SlotSource {
    /// A slot on the device, by its index.
    Device(usize),
    /// A constant, because the pictures need no such slot on the device.
    Constant([u32; 4]),
}

/// The sources of all slots, in the order of [`PathState`].
fn slot_sources(mode: Mode) -> [SlotSource; PathState::SLOTS] {
    let zero = SlotSource::Constant([0; 4]);
    let no_direction = SlotSource::Constant([0, 0, 1.0_f32.to_bits(), 0]);
    let light_sample =
        if mode.samples_light() { [7, 8].map(SlotSource::Device) } else { [no_direction, zero] };
    let medium = if mode.has_medium() { SlotSource::Device(9) } else { zero };
    std::array::from_fn(|slot| match slot {
        0..=5 => SlotSource::Device(slot),
        6..=7 => light_sample[slot - 6],
        _ => medium,
    })
}

impl Headless {
    /// Records paths like [`Headless::record_paths`], without blocking the thread.
    ///
    /// # Errors
    /// The same as for [`Headless::record_paths`].
    pub async fn record_paths_async(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        samples: Range<u32>,
        watch: &mut Watch<'_>,
    ) -> Result<PathRecording, GpuError> {
        settings.check_with(scene.appearance())?;
        if !matches!(settings.integrator, Integrator::Path(_)) {
            return Err(GpuError::NotPaths);
        }
        let lighting = LightingData::new(settings, scene.summary(), view.camera);
        let scenes = LitScene { all: scene, occluders: scene };
        let tile = middle_of(&view.film);
        let mut recording = new_recording(scene.space(), view, settings, &lighting);
        // What is recorded lies between the passes.
        let key = LitKey { one_pass: None, ..scenes.key(view, &lighting, &self.device().limits()) };
        self.with_lit_passes(key, async |passes: &LitPasses| {
            let (region, limit) =
                (scenes.visible_region(view, settings), iteration_limit(self.device()));
            let frames = scenes.frames(view, region, tile, limit);
            let sizes = LitSizes::of_one_sample(tile.size, lighting.mode);
            let tiles = std::iter::once((tile, frames));
            let frame = LitFrame::new(
                (self.device(), self.queue()),
                passes,
                sizes,
                &lighting,
                RecordedBy::Headless,
                tiles,
            )
            .await?;
            recording.samples =
                self.record_samples(passes, scenes, &frame, &lighting, samples, watch).await?;
            Ok(recording)
        })
        .await
    }

    async fn record_samples(
        &self,
        passes: &LitPasses,
        LitScene { all, occluders }: LitScene<'_>,
        frame: &LitFrame,
        lighting: &LightingData,
        samples: Range<u32>,
        watch: &mut Watch<'_>,
    ) -> Result<Vec<RecordedSample>, GpuError> {
        let room = frame.sizes.room();
        let round = Round { passes, lighting, scene: all, occluders, room, at_once: AT_ONCE };
        let mut recorder = PathRecorder {
            frame,
            paths: ReadableBuffer::new(
                self.device(),
                "pinhole paths read-back",
                frame.paths.size(),
            ),
            pixels: room as usize,
            slots: slot_sources(lighting.mode),
            sample: RecordedSample::default(),
        };
        let total = samples.end.saturating_sub(samples.start);
        let mut recorded = Vec::new();
        for (done, sample) in (0..).zip(samples) {
            let part = f64::from(done) / f64::from(total);
            let progress = Progress { samples: done, total, part, noise: None };
            let mut after = || match watch(&progress) {
                Decision::GoOn | Decision::MeasureNoise => Ok(()),
                Decision::Finish | Decision::Stop => Err(GpuError::Stopped),
            };
            recorder.sample = RecordedSample { sample, ..RecordedSample::default() };
            let mut flow = Flow::new(self, frame, passes, all);
            frame.record_clear_film(flow.encoder(), 0);
            flow.begin(0);
            for step in round.steps(sample..sample + 1)? {
                flow.step(&step, &mut after).await?;
                if let Some(moment) = step.moment {
                    recorder.read(&mut flow, moment).await?;
                    after()?;
                }
            }
            recorded.push(std::mem::take(&mut recorder.sample));
        }
        Ok(recorded)
    }
}

/// Creates a recording without samples, which contains the numbers that the device was given.
fn new_recording(
    space: &SceneSpace,
    view: &View<'_>,
    settings: &RenderSettings,
    lighting: &LightingData,
) -> PathRecording {
    let (camera, uploaded) = requested_view(space, view.camera);
    let Tile { origin, size, .. } = middle_of(&view.film);
    PathRecording {
        camera,
        uploaded,
        film: view.film,
        origin,
        size,
        settings: settings.clone(),
        max_depth: match &settings.integrator {
            Integrator::Path(path) => path.max_depth,
            Integrator::Primary(_) | Integrator::Studio(_) => 0,
        },
        lighting: uploaded_lighting(&lighting.parameters),
        tables: lighting.tables.iter().map(|four| four.map(f32::to_bits)).collect(),
        emitters: lighting.emitters.iter().map(|four| four.map(f32::to_bits)).collect(),
        sky: uploaded_sky(settings),
        samples: Vec::new(),
    }
}

/// The rectangle in the middle of a film whose paths are recorded.
fn middle_of(film: &Film) -> Tile {
    let film = [film.width(), film.height()];
    let size = film.map(|side| side.min(LONGEST_SIDE));
    let origin = [0, 1].map(|axis| (film[axis] - size[axis]) / 2);
    Tile { origin, size, in_target: [0, 0] }
}

fn uploaded_lighting(lighting: &LightingParameters) -> UploadedLighting {
    let mut filter_table: Vec<f32> = lighting.filter_table.iter().flatten().copied().collect();
    // The table has rows of four numbers; the last row has a single one.
    filter_table.truncate(257);
    UploadedLighting {
        background: lighting.background,
        flags: lighting.flags,
        light_count: lighting.light_count,
        zenith: lighting.zenith,
        horizon: lighting.horizon,
        nadir: lighting.nadir,
        roulette_from: lighting.roulette_from,
        source_count: lighting.source_count,
        light_sampling: lighting.light_sampling,
        ground_normal: lighting.ground_normal,
        ground_point: lighting.ground_point,
        ground_color: lighting.ground_color,
        seed: lighting.seed,
        emitter_count: lighting.emitter_count,
        material_first: lighting.material_first,
        environment_size: lighting.environment_size,
        environment_rotation: lighting.environment_rotation,
        environment_strength: lighting.environment_strength,
        lamp_sources: lighting.lamp_sources,
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

#[cfg(test)]
#[path = "../../../tests/support/random_light.rs"]
#[allow(dead_code, reason = "tests of devices use all of it")]
mod random_light;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::{AccelChoice, AccelPlan};
    use crate::gpu::scene::scene_summary::SceneSummary;
    use crate::verify::Checker;

    /// The checker accepts the numbers that the host computes for a device from random scenes.
    #[test]
    fn uploaded_numbers_match_the_settings() {
        // The computation of energy tables takes most of the time.
        for seed in 1000..1016 {
            let random = random_light::view(seed);
            let view = View::new(random.camera.as_ref(), random.film);
            random.settings.check(&random.scene).unwrap();
            let checker = Checker::new(&random.scene).unwrap();
            let spheres = random.scene.spheres();
            let plan = AccelPlan::new(spheres, AccelChoice::List, 1 << 27);
            let (min, max) = plan.build(spheres).bounds();
            let space = SceneSpace { origin: random.scene.origin(), min, max };
            let summary = SceneSummary::of(&random.scene);
            let lighting = LightingData::new(&random.settings, &summary, view.camera);
            let mut recording = new_recording(&space, &view, &random.settings, &lighting);
            let certificate = checker.certify_paths(&recording);
            assert_eq!(certificate.upload, None, "seed {seed}: {}", random.name);
            // The checker rejects a roughness of more than 1, which shows that it can fail.
            if seed % 8 == 0 {
                let material = recording.lighting.material_first as usize;
                recording.tables[material][2] = 1.001_f32.to_bits();
                let certificate = checker.certify_paths(&recording);
                assert!(certificate.upload.is_some(), "seed {seed}: {}", random.name);
            }
        }
    }
}
