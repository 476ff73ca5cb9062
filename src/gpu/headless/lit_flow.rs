//! Collecting the dispatches of lit pictures in submissions that are neither too short nor too long.

use wgpu::{CommandEncoder, SubmissionIndex};

use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::waiting::Instant;
use crate::gpu::passes::lit::{
    LightingData, LitFrame, LitPasses, LitScene, LitSizes, MAX_DISPATCHES, Moment, RecordedBy, Recorder, Round,
    SampleStrategy, Step,
};
use crate::gpu::passes::tiles::{Groups, Tile};
use crate::gpu::profile::NotedPass;
use crate::gpu::resources::Make;
use crate::gpu::scene::scene_buffers::SceneBuffers;

/// Callback after every submission. An error that it returns ends the work.
pub(crate) type After<'a> = dyn FnMut() -> Result<(), GpuError> + 'a;

/// The passes of a lit picture, and their inputs.
#[derive(Clone, Copy)]
pub(crate) struct LitWork<'a> {
    pub(crate) headless: &'a Headless,
    pub(crate) passes: &'a LitPasses,
    pub(crate) scenes: LitScene<'a>,
    pub(crate) lighting: &'a LightingData,
    pub(crate) strategy: SampleStrategy,
}

impl LitWork<'_> {
    /// Creates the buffers for some tiles.
    pub(crate) async fn frame(&self, sizes: LitSizes, tiles: impl Iterator<Item = Tile>) -> Result<LitFrame, GpuError> {
        let Self { headless: Headless { device, queue, .. }, passes, scenes, lighting, .. } = *self;
        let (make, by) = (Make { device, queue }, RecordedBy::Headless);
        let tiles = tiles.map(scenes.records(device));
        LitFrame::new(make, passes, sizes, lighting, by, tiles).await
    }

    /// The dispatches of samples in these buffers.
    pub(crate) fn round(&self, frame: &LitFrame) -> Round<'_> {
        let Self { passes, scenes: LitScene { all: scene, occluders, .. }, lighting, .. } = *self;
        let (room, strategy) = (frame.sizes.room(), self.strategy);
        Round { passes, lighting, scene, occluders, room, strategy }
    }
}

/// Records and submits the dispatches of a lit picture. While the device executes one submission, the next is recorded.
pub(crate) struct Flow<'a> {
    headless: &'a Headless,
    frame: &'a LitFrame,
    scene: &'a SceneBuffers,
    recorder: Recorder<'a>,
    encoder: Option<CommandEncoder>,
    /// Number of workgroups of searches in the encoder.
    gathered: u64,
    /// Tiles for which the encoder accumulates samples, each with its number of samples afterwards.
    accumulated: Vec<(usize, u32)>,
    /// The submission that the device is executing.
    submitted: Option<Submission>,
    /// The time at which the previous submission had finished.
    last_done: Instant,
    /// Number of samples that each tile has accumulated, counting all submitted work.
    pub(crate) samples: Vec<u32>,
}

struct Submission {
    index: SubmissionIndex,
    at: Instant,
    groups: u64,
    noted: NotedPass,
}

impl<'a> Flow<'a> {
    pub(crate) fn new(
        headless: &'a Headless,
        frame: &'a LitFrame,
        passes: &'a LitPasses,
        scene: &'a SceneBuffers,
    ) -> Self {
        let recorder = Recorder::new(frame, &passes.advance, headless.options.indirect, 0);
        Self {
            headless,
            frame,
            scene,
            recorder,
            encoder: None,
            gathered: 0,
            accumulated: Vec::new(),
            submitted: None,
            last_done: Instant::now(),
            samples: vec![0; frame.tiles.len()],
        }
    }

    /// The encoder of the next submission, for commands other than dispatches.
    pub(crate) fn encoder(&mut self) -> &mut CommandEncoder {
        let headless = self.headless;
        self.encoder.get_or_insert_with(|| headless.encoder())
    }

    /// Starts new paths in a tile.
    pub(crate) fn begin(&mut self, tile: usize) {
        self.recorder.tile = tile;
        let frame = self.frame;
        frame.record_clear_lists(self.encoder());
    }

    /// Records a dispatch, divided into slices if it takes long.
    pub(crate) async fn step(&mut self, step: &Step<'a>, after: &mut After<'_>) -> Result<(), GpuError> {
        // A slice of a list needs one more dispatch.
        if self.recorder.dispatches() + 2 > MAX_DISPATCHES {
            self.send(after).await?;
        }
        let whole = self.recorder.groups(step);
        let weight = step.rays_in_layers();
        let submission_size = self.scene.submission_size().groups();
        if whole.count() * weight <= submission_size {
            self.record(step, None);
            self.gathered += whole.count() * weight;
            self.note_samples(step);
            let is_enough = self.gathered >= submission_size || self.headless.submits_one_by_one();
            return match is_enough {
                true => self.send(after).await,
                false => Ok(()),
            };
        }
        self.send(after).await?;
        let mut left = vec![whole];
        while let Some(slice) = Groups::take(&mut left, (self.scene.submission_size().groups() / weight).max(1)) {
            self.record(step, Some(slice));
            self.gathered = slice.count() * weight;
            if left.is_empty() {
                self.note_samples(step);
            } else if step.moment == Some(Moment::Accumulated) {
                // All pixels of a tile must have the same number of samples when the caller may end the work.
                self.send(&mut || Ok(())).await?;
                continue;
            }
            self.send(after).await?;
        }
        Ok(())
    }

    /// Notes the number of samples that the tile has after a dispatch, if the dispatch completes some.
    fn note_samples(&mut self, step: &Step<'a>) {
        if step.moment == Some(Moment::Accumulated) {
            self.accumulated.push((self.recorder.tile, step.samples_after()));
        }
    }

    fn record(&mut self, step: &Step<'a>, slice: Option<Groups>) {
        let headless = self.headless;
        let encoder = self.encoder.get_or_insert_with(|| headless.encoder());
        self.recorder.record(encoder, step, slice);
    }

    /// Submits the recorded commands, and waits until the previous submission has finished. If the host's clock
    /// measures passes, waits for this submission too, so that the time of a pass never includes that of the next.
    async fn send(&mut self, after: &mut After<'_>) -> Result<(), GpuError> {
        self.hand_over(after).await?;
        if !self.headless.submits_one_by_one() {
            return Ok(());
        }
        let last = self.submitted.take();
        self.wait_for(last).await
    }

    /// Submits the recorded commands, and waits until the previous submission has finished.
    async fn hand_over(&mut self, after: &mut After<'_>) -> Result<(), GpuError> {
        let Some(encoder) = self.encoder.take() else {
            return Ok(());
        };
        let queue = self.headless.queue();
        self.frame.queue_parameters(queue, 0, &self.recorder.take_parameters());
        let noted = self.recorder.take_noted();
        let at = Instant::now();
        let index = self.headless.start(encoder);
        for (tile, samples) in self.accumulated.drain(..) {
            self.samples[tile] = samples;
        }
        let groups = std::mem::take(&mut self.gathered);
        let before = self.submitted.replace(Submission { index, at, groups, noted });
        self.wait_for(before).await?;
        after()
    }

    /// Submits the recorded commands, and waits until all work has finished and the buffers are mapped.
    pub(crate) async fn finish(&mut self, mapped: &[&wgpu::Buffer]) -> Result<(), GpuError> {
        self.hand_over(&mut || Ok(())).await?;
        let last = self.submitted.take();
        if let Some(Submission { index, .. }) = &last {
            self.headless.wait(mapped, index.clone()).await?;
        }
        self.wait_for(last).await
    }

    /// Discards the recorded commands, and waits until all submitted work has finished.
    pub(crate) async fn abandon(&mut self) -> Result<(), GpuError> {
        self.encoder = None;
        self.accumulated.clear();
        self.recorder.take_parameters();
        self.recorder.take_noted();
        let last = self.submitted.take();
        self.wait_for(last).await
    }

    /// Waits for all submitted work, and returns an error if the searches of some rays were abandoned.
    pub(crate) async fn check_spent(&mut self) -> Result<(), GpuError> {
        let frame = self.frame;
        frame.record_copy_spent(self.encoder());
        self.finish(&[&frame.spent_back.buffer]).await?;
        frame.read_spent()
    }

    async fn wait_for(&mut self, submitted: Option<Submission>) -> Result<(), GpuError> {
        let Some(Submission { index, at, groups, noted }) = submitted else {
            return Ok(());
        };
        self.headless.wait(&[], index).await?;
        // The device began this work when it was submitted, or when the previous submission had finished.
        let began = at.max(self.last_done);
        let elapsed = began.elapsed();
        self.headless.note_pass(noted, began);
        self.last_done = Instant::now();
        let size = [u32::try_from(groups).unwrap_or(u32::MAX), 1];
        self.scene.adapt_submission_size(Groups { first: [0, 0], size }, elapsed);
        Ok(())
    }

    /// Computes the sums, over all pixels, of the variances of their means and of their luminances. All pixels must
    /// have the same number of samples.
    pub(crate) async fn variations(&mut self, passes: &LitPasses) -> Result<[f64; 2], GpuError> {
        let mut sums = [0.0; 2];
        for (tile, samples) in self.samples.clone().into_iter().enumerate() {
            self.recorder.tile = tile;
            let (headless, frame) = (self.headless, self.frame);
            let encoder = self.encoder.get_or_insert_with(|| headless.encoder());
            let written = self.recorder.record_noise(encoder, &passes.noise, samples);
            frame.record_copy_variations(encoder);
            self.finish(&[&frame.variations_back.buffer]).await?;
            let _phase = headless.phase("read back");
            frame.variations_back.read(|found: &[[f32; 2]]| {
                for [variance, light] in &found[..written] {
                    sums[0] += f64::from(*variance);
                    sums[1] += f64::from(*light);
                }
            })?;
        }
        Ok(sums)
    }
}
