//! Recording lit pictures for the checker: the state of every path after every pass, and the sums of pixels before and
//! after a sample.

use std::cell::Cell;

use crate::camera::View;
use crate::camera::film::Film;
use crate::gpu::error::{GpuError, check_whole};
use crate::gpu::headless::Headless;
use crate::gpu::headless::lit_flow::Flow;
use crate::gpu::headless::lit_inputs::inputs;
use crate::gpu::headless::lit_states::{Keep, LONGEST_SIDE, Reader};
use crate::gpu::headless::path_recording::PathKeeper;
use crate::gpu::headless::progress::{Decision, Progress, Watch};
use crate::gpu::headless::studio_recording::{StudioKeeper, longest_side};
use crate::gpu::passes::frame::iteration_limit;
use crate::gpu::passes::lit::{
    AT_ONCE, LightingData, LitFrame, LitKey, LitPasses, LitScene, LitSizes, Moment, RecordedBy,
    Round,
};
use crate::gpu::passes::tiles::Tile;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::render::RenderSettings;
use crate::verify::{LitRecording, RecordedFilm};

/// Callback with the recording of each sample.
pub type EachSample<'a> = dyn FnMut(LitRecording<'_>) + 'a;

/// The inputs of a recording.
struct Work<'a> {
    headless: &'a Headless,
    passes: &'a LitPasses,
    scenes: LitScene<'a>,
    view: &'a View<'a>,
    settings: &'a RenderSettings,
    lighting: &'a LightingData,
    tile: Tile,
}

impl Headless {
    /// Records lit pictures like [`Headless::record_lit`], without blocking the thread.
    ///
    /// # Errors
    /// The same as for [`Headless::record_lit`].
    pub async fn record_lit_async(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        samples: &[u32],
        callbacks: (&mut EachSample<'_>, &mut Watch<'_>),
    ) -> Result<(), GpuError> {
        let part = LitPart::Middle;
        self.record_lit_part_async(scene, view, settings, (part, samples), callbacks).await
    }

    /// Records a part of a lit picture like [`Headless::record_lit_part`], without blocking the thread.
    ///
    /// # Errors
    /// The same as for [`Headless::record_lit`].
    pub async fn record_lit_part_async(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        (part, samples): (LitPart, &[u32]),
        (each, watch): (&mut EachSample<'_>, &mut Watch<'_>),
    ) -> Result<(), GpuError> {
        if settings.integrator.is_primary() {
            return Err(GpuError::NotLit);
        }
        check_whole(&view.film)?;
        settings.check_with(scene.appearance())?;
        let lighting = LightingData::new(settings, scene.summary(), view.camera);
        let scenes = LitScene { all: scene, occluders: scene.occluders(settings)? };
        let side = if lighting.mode.is_studio() { longest_side(&lighting) } else { LONGEST_SIDE };
        let Some(tile) = part.tile(&view.film, side) else { return Ok(()) };
        let spaces = [scenes.all, scenes.occluders].map(SceneBuffers::space);
        let given = inputs(spaces, view, settings, &lighting, tile);
        let mut keep: Box<dyn Keep> = if lighting.mode.is_studio() {
            Box::new(StudioKeeper::new(given))
        } else {
            Box::new(PathKeeper::new(given))
        };
        // What is recorded lies between the passes.
        let key = LitKey { one_pass: None, ..scenes.key(view, &lighting, &self.device().limits()) };
        self.with_lit_passes(key, async |passes: &LitPasses| {
            let (headless, lighting) = (self, &lighting);
            let work = Work { headless, passes, scenes, view, settings, lighting, tile };
            let is_first = Cell::new(true);
            let each = &mut |recording: LitRecording<'_>| {
                is_first.set(false);
                each(recording);
            };
            match work.record(samples, AT_ONCE, &mut *keep, each, watch).await {
                // Several directions of ambient light in one invocation need more steps than one direction.
                Err(GpuError::Steps)
                    if is_first.get() && lighting.parameters.occlusion_samples > 1 =>
                {
                    work.record(samples, 1, &mut *keep, each, watch).await
                }
                done => done,
            }
        })
        .await
    }
}

impl Work<'_> {
    async fn record(
        &self,
        samples: &[u32],
        at_once: u32,
        keep: &mut dyn Keep,
        each: &mut EachSample<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), GpuError> {
        let Self { headless, passes, scenes, view, settings, lighting, tile } = *self;
        let device = headless.device();
        let (region, limit) = (scenes.visible_region(view, settings), iteration_limit(device));
        let tiles = std::iter::once((tile, scenes.frames(view, region, tile, limit)));
        let sizes = LitSizes::of_one_sample(tile.size, lighting.mode);
        let (devices, by) = ((device, headless.queue()), RecordedBy::Headless);
        let frame = &LitFrame::new(devices, passes, sizes, lighting, by, tiles).await?;
        let LitScene { all, occluders } = scenes;
        let room = sizes.room();
        let round = Round { passes, lighting, scene: all, occluders, room, at_once };
        let reader = Reader::new(device, frame, room, lighting.mode);
        let total = samples.len() as u32;
        let mut flow = Flow::new(headless, frame, passes, all);
        frame.record_clear_film(flow.encoder(), 0);
        let mut before = reader.film(&mut flow).await?;
        for (done, &sample) in (0..).zip(samples) {
            let part = f64::from(done) / f64::from(total);
            let progress = Progress { samples: done, total, part, noise: None };
            let mut after = || match watch(&progress) {
                Decision::GoOn | Decision::MeasureNoise => Ok(()),
                Decision::Finish | Decision::Stop => Err(GpuError::Stopped),
            };
            keep.begin(sample);
            flow.begin(0);
            for step in round.steps(sample..sample.saturating_add(1))? {
                flow.step(&step, &mut after).await?;
                match step.moment {
                    Some(Moment::Accumulated) => {
                        let sums = reader.film(&mut flow).await?;
                        let before = std::mem::replace(&mut before, sums.clone());
                        keep.end(RecordedFilm { before, after: sums });
                    }
                    Some(moment) => {
                        if let Some(wanted) = keep.wants(moment) {
                            reader
                                .states(&mut flow, wanted, |states| keep.keep(moment, states))
                                .await?;
                            after()?;
                        }
                    }
                    None => {}
                }
            }
            each(keep.recording());
        }
        Ok(())
    }
}

/// The part of a lit picture of which samples are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LitPart {
    /// A rectangle in the middle.
    Middle,
    /// A rectangle with half the sides, at a place that follows from this seed; nothing if [`LitPart::Middle`] is the whole
    /// picture. Every pixel has about the same chance, those at the edges a larger one.
    Random(u32),
}

impl LitPart {
    /// The rectangle of a film of which one with sides of at most `longest_side` is recorded whole. Of a larger film, both
    /// rectangles together have no more pixels than a square with that side.
    fn tile(self, film: &Film, longest_side: u32) -> Option<Tile> {
        let film = [film.width(), film.height()];
        let is_larger = film.iter().any(|side| *side > longest_side);
        let most = if is_larger { longest_side - longest_side / 8 } else { longest_side };
        let middle = film.map(|side| side.min(most));
        let (size, origin) = match self {
            Self::Middle => (middle, [0, 1].map(|axis| (film[axis] - middle[axis]) / 2)),
            Self::Random(_) if middle == film => return None,
            Self::Random(seed) => {
                let size = middle.map(|side| side.div_ceil(2));
                let first = |axis: usize| {
                    // As if the rectangle could stick out, so that it covers edges as often as the middle.
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

/// The hash function PCG of one round (M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020).
fn pcg(input: u32) -> u32 {
    let state = input.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
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
