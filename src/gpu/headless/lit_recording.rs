//! Recording lit pictures for the checker: the state of every path after every pass, and the sums of pixels before and
//! after a sample.

use std::cell::Cell;

use crate::camera::View;
use crate::camera::film::Film;
use crate::camera::sampling::pcg;
use crate::gpu::error::{GpuError, check_whole};
use crate::gpu::headless::Headless;
use crate::gpu::headless::lit_flow::{Flow, LitWork};
use crate::gpu::headless::lit_states::{Keeper, LONGEST_SIDE, Reader, States, longest_side};
use crate::gpu::headless::progress::{Progress, Watch, unless_ended};
use crate::gpu::headless::recording::requested_view;
use crate::gpu::passes::lit::{LightingData, LitPasses, LitScene, LitSizes, Moment, SampleStrategy};
use crate::gpu::passes::tiles::Tile;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::records::SceneSpace;
use crate::recording::lighting::uploaded_sky;
use crate::recording::lit::{LitInputs, LitRecording, RecordedFilm};
use crate::render::RenderSettings;

/// Callback with the recording of each sample.
pub type EachSample<'a> = dyn FnMut(&LitRecording) + 'a;

impl Headless {
    /// Takes some samples of a lit picture one by one and records the state of every path, or of every ray of a studio,
    /// after every pass, from which [`Checker::certify_lit`](crate::verify::Checker::certify_lit) judges the device.
    /// `each` is called with the recording of each sample. The sums of pixels continue from one sample to the next. If
    /// a side of the film has more than 256 pixels, only a rectangle in the middle of the film is recorded, and in a
    /// studio with many lights or directions of ambient light a smaller one. The passes take samples step by step.
    ///
    /// # Errors
    /// [`GpuError::NotLit`] if the integrator is `primary`; the same errors as for [`Headless::render_uploaded`];
    /// [`GpuError::Stopped`] if `watch` finishes or stops the recording.
    pub async fn record_lit(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        SampleRequest { part, samples }: SampleRequest<'_>,
        each: &mut EachSample<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), GpuError> {
        if settings.integrator.is_primary() {
            return Err(GpuError::NotLit);
        }
        check_whole(&view.film)?;
        let scenes = LitScene::new(scene, view, settings)?;
        let lighting = &scenes.lighting();
        let is_studio = lighting.mode.is_studio();
        let side = if is_studio { longest_side(lighting) } else { LONGEST_SIDE };
        let Some(tile) = part.tile(&view.film, side) else { return Ok(()) };
        let mut keeper = Keeper::new(inputs(&scenes, lighting, tile));
        // Recorded states exist only between passes, so the samples are taken step by step.
        let mut strategy = SampleStrategy::Steps;
        let key = strategy.key(scenes.key(lighting, &self.device.limits()));
        self.with_lit_passes(key, async |passes: &LitPasses| {
            let is_first = Cell::new(true);
            let mut each = |recording: &LitRecording| {
                is_first.set(false);
                each(recording);
            };
            loop {
                let work = LitWork { headless: self, passes, scenes, lighting, strategy };
                let done = work.record(tile, samples, &mut keeper, &mut each, watch).await;
                match (done, strategy.easier(lighting)) {
                    (Err(GpuError::Steps), Some(easier)) if is_first.get() => strategy = easier,
                    (done, _) => return done,
                }
            }
        })
        .await
    }
}

impl LitWork<'_> {
    async fn record(
        &self,
        tile: Tile,
        samples: &[u32],
        keeper: &mut Keeper,
        each: &mut EachSample<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), GpuError> {
        let Self { headless, passes, scenes, lighting, .. } = *self;
        let sizes = LitSizes::of_one_sample(tile.size, lighting.mode);
        let frame = &self.frame(sizes, std::iter::once(tile)).await?;
        let round = self.round(frame);
        let reader = Reader::new(&headless.device, frame, sizes.room(), lighting.mode);
        let total = samples.len() as u32;
        let mut flow = Flow::new(headless, frame, passes, scenes.all);
        frame.record_clear_film(flow.encoder(), 0);
        let mut before = reader.film(&mut flow).await?;
        for (done, &sample) in (0..).zip(samples) {
            let part = f64::from(done) / f64::from(total);
            let progress = Progress { samples: done, total, part, noise: None };
            let mut after = || unless_ended(watch(&progress));
            keeper.begin(sample);
            flow.begin(0);
            for step in round.steps(sample..sample.saturating_add(1))? {
                flow.step(&step, &mut after).await?;
                match step.moment {
                    Some(Moment::Accumulated) => {
                        let sums = reader.film(&mut flow).await?;
                        let before = std::mem::replace(&mut before, sums.clone());
                        keeper.end(RecordedFilm { before, after: sums });
                    }
                    Some(moment) if keeper.wants(moment) => {
                        let keep = |states: &States<'_>| keeper.keep(moment, states);
                        reader.states(&mut flow, moment, keep).await?;
                        after()?;
                    }
                    _ => {}
                }
            }
            each(keeper.recording());
        }
        Ok(())
    }
}

/// The part and the samples of a picture that [`Headless::record_lit`] records.
#[derive(Clone, Copy, Debug)]
pub struct SampleRequest<'a> {
    /// The part of the picture.
    pub part: LitPart,
    /// Indices of the samples, from 0.
    pub samples: &'a [u32],
}

impl<'a> SampleRequest<'a> {
    /// Samples of a rectangle in the middle.
    #[must_use]
    pub fn middle(samples: &'a [u32]) -> Self {
        Self { part: LitPart::Middle, samples }
    }
}

/// The recorded part of a lit picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LitPart {
    /// A rectangle in the middle.
    Middle,
    /// A rectangle with half the sides, at a place that follows from this seed; nothing if [`LitPart::Middle`] is the
    /// whole picture. Every pixel has about the same chance, and pixels at edges a larger one.
    Random(u32),
    /// A rectangle: its first column and row, and its size of at most 256 pixels along each axis.
    Rectangle {
        /// First column and row.
        origin: [u32; 2],
        /// Width and height.
        size: [u32; 2],
    },
}

impl LitPart {
    /// The rectangle for a film, which is recorded whole if its sides are at most `longest_side`. For a larger film,
    /// both rectangles together have no more pixels than a square with that side.
    fn tile(self, film: &Film, longest_side: u32) -> Option<Tile> {
        let film = [film.width(), film.height()];
        let is_larger = film.iter().any(|side| *side > longest_side);
        let most = if is_larger { longest_side - longest_side / 8 } else { longest_side };
        let middle = film.map(|side| side.min(most));
        let (size, origin) = match self {
            Self::Rectangle { origin, size } => {
                let size = [0, 1].map(|axis| size[axis].min(most).min(film[axis].saturating_sub(origin[axis])));
                if size.contains(&0) {
                    return None;
                }
                (size, origin)
            }
            Self::Middle => (middle, [0, 1].map(|axis| (film[axis] - middle[axis]) / 2)),
            Self::Random(_) if middle == film => return None,
            Self::Random(seed) => {
                let size = middle.map(|side| side.div_ceil(2));
                let first = |axis: usize| {
                    // Moved inside if it sticks out, so that it covers edges as often as the middle.
                    let places = u64::from(film[axis]) + u64::from(size[axis]) - 1;
                    let random = u64::from(pcg(seed.wrapping_mul(2).wrapping_add(axis as u32)));
                    let end = (random * places) >> 32;
                    let first = (end + 1).saturating_sub(size[axis].into());
                    first.min((film[axis] - size[axis]).into()) as u32
                };
                (size, [first(0), first(1)])
            }
        };
        Some(Tile { origin, size, in_target: [0, 0] })
    }
}

/// Collects the numbers that the device is given for a tile.
pub(super) fn inputs(scenes: &LitScene<'_>, lighting: &LightingData, Tile { origin, size, .. }: Tile) -> LitInputs {
    let LitScene { all, occluders, view, settings } = *scenes;
    inputs_in([&all.space, &occluders.space], view, settings, lighting, [origin, size])
}

/// The inputs for the space of all spheres and the space of the spheres that cast shadows.
fn inputs_in(
    [space, occluders]: [&SceneSpace; 2],
    view: &View<'_>,
    settings: &RenderSettings,
    lighting: &LightingData,
    [origin, size]: [[u32; 2]; 2],
) -> LitInputs {
    let (camera, uploaded) = requested_view(space, view.camera);
    LitInputs {
        camera,
        uploaded,
        occluders: [occluders.min, occluders.max].map(|corner| corner.to_array()),
        film: view.film,
        origin,
        size,
        settings: settings.clone(),
        max_surfaces: lighting.max_surfaces,
        lighting: lighting.lighting.clone(),
        tables: lighting.tables.iter().map(|four| four.map(f32::to_bits)).collect(),
        emitters: lighting.emitters.iter().map(|four| four.map(f32::to_bits)).collect(),
        sky: uploaded_sky(settings),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_parts_lie_in_the_film_and_leave_no_pixel_out() {
        let film = Film::new(300, 7).unwrap();
        let mut seen = vec![0_u32; 300];
        for seed in 0..4000 {
            let Tile { origin, size, .. } = LitPart::Random(seed).tile(&film, 64).unwrap();
            assert_eq!((size, LitPart::Random(seed).tile(&film, 300)), ([28, 4], None));
            assert!(origin[0] + size[0] <= 300 && origin[1] + size[1] <= 7);
            (origin[0]..origin[0] + size[0]).for_each(|column| seen[column as usize] += 1);
        }
        // A column is expected in 28 of 327 rectangles.
        assert!(seen.iter().all(|count| *count > 260), "{seen:?}");
        assert_eq!(LitPart::Random(9).tile(&film, 64), LitPart::Random(9).tile(&film, 64));
        let Tile { origin, size, .. } = LitPart::Middle.tile(&film, 64).unwrap();
        assert_eq!((origin, size), ([122, 0], [56, 7]));
    }
}

#[cfg(test)]
#[path = "../../../tests/support/random_light.rs"]
#[allow(dead_code, reason = "tests of devices use all of it")]
mod random_light;

#[cfg(test)]
mod lit_inputs_tests {
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
            let (spheres, cones) = (random.scene.spheres(), random.scene.cones());
            let plan = AccelPlan::new(spheres, AccelChoice::List, 1 << 27).with_cones(cones, 1 << 27);
            let (min, max) = plan.bricks(spheres).with_cones(cones).bounds();
            let space = SceneSpace { origin: random.scene.origin(), min, max };
            let summary = SceneSummary::of(&random.scene);
            let lighting = LightingData::new(&random.settings, &summary, view.camera);
            let part = [[0; 2], [view.film.width(), view.film.height()]];
            let given = inputs_in([&space; 2], &view, &random.settings, &lighting, part);
            let mut recording = LitRecording { given, samples: Vec::new() };
            let certificate = checker.certify_lit(&recording);
            assert_eq!(certificate.upload, None, "seed {seed}: {}", random.name);
            // The checker rejects a roughness of more than 1, which shows that it can fail.
            if seed % 8 == 0 {
                let material = recording.given.lighting.material_first as usize;
                recording.given.tables[material][2] = 1.001_f32.to_bits();
                let certificate = checker.certify_lit(&recording);
                assert!(certificate.upload.is_some(), "seed {seed}: {}", random.name);
            }
        }
    }
}
