//! The rest of a lit picture that is left to record, in pieces that fit into a budget of rays.

use std::ops::Range;

use wgpu::CommandEncoder;

use crate::gpu::error::GpuError;
use crate::gpu::passes::lit::{MAX_DISPATCHES, Moment, Recorder, Round, Step};
use crate::gpu::passes::tiles::{Groups, WORKGROUP_SIDE};

/// Number of rays of a workgroup if each of its invocations traces one.
pub(super) const RAYS_PER_GROUP: u64 = (WORKGROUP_SIDE * WORKGROUP_SIDE) as u64;

/// Maximum number of rays that a recording may trace, and the number that it traces so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    pub(super) rays: u64,
    max: u64,
}

impl Budget {
    pub(super) fn new(max: u64) -> Self {
        Self { rays: 0, max }
    }

    /// Number of workgroups that are left, if each of their invocations traces `rays` rays.
    pub(super) fn groups(&self, rays: u64) -> u64 {
        (self.max - self.rays) / (RAYS_PER_GROUP * rays)
    }

    pub(super) fn take(&mut self, groups: u64, rays: u64) {
        self.rays += groups * rays * RAYS_PER_GROUP;
    }

    /// The error of a budget that is too small for a workgroup with `rays` rays in each invocation.
    pub(super) fn too_small(&self, rays: u64) -> GpuError {
        GpuError::Budget { needed: RAYS_PER_GROUP * rays, given: self.max }
    }
}

/// The place that the recording of samples has reached.
#[derive(Clone, Debug, Default)]
pub(super) struct Cursor {
    /// Number of samples that all pixels have.
    pub(super) samples: u32,
    /// The samples that are being taken, the current tile, and the current step of its round.
    batch: Range<u32>,
    tile: usize,
    step: usize,
    /// The remaining workgroups of the step, if some have been recorded.
    left: Option<Vec<Groups>>,
}

impl Cursor {
    /// Records samples until the budget is exhausted, or `total` samples are complete. `completed` is called whenever the
    /// tile of the recorder has more samples, with their number.
    pub(super) fn record<'a>(
        &mut self,
        encoder: &mut CommandEncoder,
        round: &Round<'a>,
        recorder: &mut Recorder<'a>,
        budget: &mut Budget,
        total: u32,
        mut completed: impl FnMut(&mut CommandEncoder, &mut Recorder<'a>, u32),
    ) -> Result<(), GpuError> {
        let frame = recorder.frame;
        while self.samples < total {
            if self.batch.is_empty() {
                // The first samples are taken one by one, so that there is a picture soon.
                let count = self.samples.clamp(1, frame.sizes.in_flight).min(total - self.samples);
                self.batch = self.samples..self.samples + count;
            }
            let steps = round.steps(self.batch.clone())?;
            recorder.tile = self.tile;
            while let Some(step) = steps.get(self.step) {
                if !self.record_step(encoder, recorder, budget, step)? {
                    return Ok(());
                }
                if step.moment == Some(Moment::Accumulated) {
                    completed(encoder, recorder, step.samples_after());
                }
            }
            self.step = 0;
            self.tile += 1;
            if self.tile == frame.tiles.len() {
                self.tile = 0;
                self.samples = self.batch.end;
                self.batch = 0..0;
            }
        }
        Ok(())
    }

    /// Records the rest of a step. Returns whether all of it fitted into the budget.
    fn record_step<'a>(
        &mut self,
        encoder: &mut CommandEncoder,
        recorder: &mut Recorder<'a>,
        budget: &mut Budget,
        step: &Step<'a>,
    ) -> Result<bool, GpuError> {
        let whole = recorder.groups(step);
        let rays = step.rays_in_layers();
        if self.step == 0 && self.left.is_none() {
            // The first step of a round finds empty lists.
            recorder.frame.record_clear_lists(encoder);
        }
        let mut left = self.left.take().unwrap_or_else(|| vec![whole]);
        // A slice of a list takes two dispatches, and the caller may add one to the dispatches of a step.
        while recorder.dispatches() + 3 <= MAX_DISPATCHES {
            let room = if rays == 0 { u64::MAX } else { budget.groups(rays) };
            if room == 0 {
                break;
            }
            let Some(slice) = Groups::take(&mut left, room) else {
                self.step += 1;
                return Ok(true);
            };
            recorder.record(encoder, step, (slice != whole).then_some(slice));
            budget.take(slice.count(), rays);
        }
        if left.iter().all(|groups| groups.count() == 0) {
            self.step += 1;
            return Ok(true);
        }
        self.left = Some(left);
        if budget.rays == 0 && recorder.dispatches() == 0 {
            return Err(budget.too_small(rays));
        }
        Ok(false)
    }
}
