//! Recording dispatches into an encoder, and collecting their parameters.

use wgpu::CommandEncoder;

use crate::gpu::passes::lit::frame::{Area, LitFrame, LitTile};
use crate::gpu::passes::lit::passes::{Bound, Extent, Pass};
use crate::gpu::passes::lit::records::{DispatchParameters, GROUPS_OF_ONE, PIXELS_PER_VARIATION};
use crate::gpu::passes::lit::round::{Step, Work};
use crate::gpu::passes::tiles::{Groups, WORKGROUP_SIDE};
use crate::gpu::profile::NotedPass;

/// Number of paths that a workgroup processes.
const WORKGROUP_SIZE: u64 = (WORKGROUP_SIDE * WORKGROUP_SIDE) as u64;

/// Records the dispatches of a submission. The parameters from [`Recorder::take_parameters`] must be queued before the
/// encoder is submitted.
#[derive(Debug)]
pub(crate) struct Recorder<'a> {
    pub(crate) frame: &'a LitFrame,
    /// Index of the tile for which dispatches are recorded.
    pub(crate) tile: usize,
    /// Index of the recording among the recordings under way.
    place: usize,
    advance: &'a Pass,
    /// Whether indirect dispatches are used.
    is_indirect: bool,
    parameters: Vec<DispatchParameters>,
    noted: NotedPass,
}

impl<'a> Recorder<'a> {
    /// A recorder for the recording with the index `place` among the recordings under way.
    pub(crate) fn new(frame: &'a LitFrame, advance: &'a Pass, is_indirect: bool, place: usize) -> Self {
        let (parameters, noted) = (Vec::new(), NotedPass::default());
        Self { frame, tile: 0, place, advance, is_indirect, parameters, noted }
    }

    /// Number of dispatches since the last call of [`Recorder::take_parameters`].
    pub(crate) fn dispatches(&self) -> usize {
        self.parameters.len()
    }

    /// Returns the parameters of the dispatches, in order, and starts a new submission.
    pub(crate) fn take_parameters(&mut self) -> Vec<DispatchParameters> {
        std::mem::take(&mut self.parameters)
    }

    /// Returns the name of the recorded pass, and starts a new submission.
    pub(crate) fn take_noted(&mut self) -> NotedPass {
        std::mem::take(&mut self.noted)
    }

    /// The maximum number of workgroups of a dispatch, in each of its [`Step::layers`].
    pub(crate) fn groups(&self, step: &Step<'_>) -> Groups {
        let tile = &self.frame.tiles[self.tile];
        match step.work {
            Work::Pixels(area) => Groups { first: [0, 0], size: tile.frames[area as usize].traced_size },
            Work::List(_) => {
                // Only paths in the visible region hit something and continue.
                let [x, y] = tile.frames[Area::Visible as usize].traced_size;
                Groups { first: [0, 0], size: [x * y * step.in_flight, 1] }
            }
            Work::Advance => Groups { first: [0, 0], size: [1, 1] },
            Work::Sums | Work::Samples => Groups { first: [0, 0], size: tile.frames[Area::Whole as usize].traced_size },
        }
    }

    /// Records a dispatch, or a slice of its workgroups.
    pub(crate) fn record(&mut self, encoder: &mut CommandEncoder, step: &Step<'a>, slice: Option<Groups>) {
        let groups = slice.unwrap_or_else(|| self.groups(step));
        if groups.count() == 0 {
            return;
        }
        let tile = &self.frame.tiles[self.tile];
        let visible = &tile.frames[Area::Visible as usize];
        let dispatch = DispatchParameters {
            first: groups.first,
            visible_first: visible.traced_first,
            visible_size: visible.traced_size,
            ..step.dispatch
        };
        let [x, y] = groups.size;
        let (group, extent) = match step.work {
            Work::Pixels(area) => (&tile.groups[area as usize], Extent::Groups([x, y, step.layers()])),
            Work::List(area) => {
                let group = &tile.groups[area as usize];
                let needed = &self.frame.groups_needed;
                match (self.is_indirect, slice) {
                    (false, _) => (group, Extent::Groups([x, y, 1])),
                    (true, None) => (group, Extent::Indirect(needed, 0)),
                    (true, Some(_)) => {
                        let slice = DispatchParameters { count: x, is_new: 0, ..dispatch };
                        let extent = Extent::Groups([1, 1, 1]);
                        self.dispatch(encoder, self.advance, slice, &tile.advance, [None; 2], extent);
                        (group, Extent::Indirect(needed, GROUPS_OF_ONE))
                    }
                }
            }
            Work::Advance if !self.is_indirect && dispatch.is_new == 0 => return,
            Work::Advance => (&tile.advance, Extent::Groups([1, 1, 1])),
            Work::Sums => (&tile.sums, Extent::Groups([x, y, 1])),
            Work::Samples => (&tile.samples, Extent::Groups([x, y, 1])),
        };
        let last = step.appearance.or(self.frame.lit.sky.as_ref());
        self.dispatch(encoder, step.pass, dispatch, group, [step.brick, last], extent);
    }

    /// Records the pass that sums variances and luminances of a tile whose pixels have `samples` samples each. Returns
    /// the number of sums.
    pub(crate) fn record_noise(&mut self, encoder: &mut CommandEncoder, noise: &Pass, samples: u32) -> usize {
        let tile = &self.frame.tiles[self.tile];
        let groups = pixels(tile).div_ceil(WORKGROUP_SIZE * PIXELS_PER_VARIATION);
        let dispatch = DispatchParameters { sample: samples, ..bytemuck::Zeroable::zeroed() };
        // There are fewer groups than pixels, so their number fits into u32.
        let extent = Extent::Groups([groups as u32, 1, 1]);
        self.dispatch(encoder, noise, dispatch, &tile.sums, [None; 2], extent);
        (groups * WORKGROUP_SIZE) as usize
    }

    /// Records the pass that writes the means of a tile whose pixels have `samples` samples each to the host's textures.
    pub(crate) fn record_resolve(
        &mut self,
        encoder: &mut CommandEncoder,
        resolve: &wgpu::ComputePipeline,
        targets: &wgpu::BindGroup,
        samples: u32,
    ) {
        let tile = &self.frame.tiles[self.tile];
        let offset = self.frame.parameter_offset(self.place, self.parameters.len());
        let dispatch = DispatchParameters { sample: samples, ..bytemuck::Zeroable::zeroed() };
        self.parameters.push(dispatch);
        let [width, height] = Groups::of_size(tile.tile.size).size;
        let descriptor = wgpu::ComputePassDescriptor { label: Some("pinhole resolve"), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        pass.set_pipeline(resolve);
        pass.set_bind_group(0, &tile.sums, &[offset]);
        pass.set_bind_group(2, targets, &[]);
        pass.dispatch_workgroups(width, height, 1);
    }

    fn dispatch(
        &mut self,
        encoder: &mut CommandEncoder,
        pass: &Pass,
        dispatch: DispatchParameters,
        group: &wgpu::BindGroup,
        [brick, last]: [Option<&wgpu::BindGroup>; 2],
        extent: Extent<'_>,
    ) {
        let offset = self.frame.parameter_offset(self.place, self.parameters.len());
        self.parameters.push(dispatch);
        let lighting = &self.frame.lit.group;
        let bound = Bound { frame: group, dispatch: offset, brick, lighting, last };
        pass.record(encoder, bound, extent, &mut self.noted);
    }
}

fn pixels(tile: &LitTile) -> u64 {
    u64::from(tile.tile.size[0]) * u64::from(tile.tile.size[1])
}
