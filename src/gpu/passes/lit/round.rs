//! The sequence of dispatches for some samples of every pixel of a tile.

use std::ops::Range;

use wgpu::BindGroup;

use crate::accel::Primitive;
use crate::gpu::error::GpuError;
use crate::gpu::passes::lit::frame::Area;
use crate::gpu::passes::lit::kernels::{LitKey, Mode, PassName, Schedule};
use crate::gpu::passes::lit::lighting::LightingData;
use crate::gpu::passes::lit::passes::{LitPasses, Pass};
use crate::gpu::passes::lit::records::{BITS, DispatchParameters, LIST_OF_LIGHT};
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::BrickPass;

/// A dispatch of a round.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step<'a> {
    pub(super) pass: &'a Pass,
    pub(super) dispatch: DispatchParameters,
    /// Bind group 1, if the pass uses a brick.
    pub(super) brick: Option<&'a BindGroup>,
    /// Bind group 3, if the pass needs the appearance of the shapes beside their structure.
    pub(super) appearance: Option<&'a BindGroup>,
    pub(super) work: Work,
    /// Number of samples in flight.
    pub(super) in_flight: u32,
    /// Number of rays that each invocation traces.
    rays: u32,
    /// Whether the dispatch traces rays, and so may take long.
    is_search: bool,
    /// The stage of the sample that this dispatch completes, if it is the last one of the stage.
    pub(crate) moment: Option<Moment>,
}

impl Step<'_> {
    /// Number of rays of the invocations at one place, over all layers; 0 if the dispatch traces
    /// none, so that it never takes long.
    pub(crate) fn rays_in_layers(&self) -> u64 {
        if self.is_search { u64::from(self.layers()) * u64::from(self.rays) } else { 0 }
    }

    /// Number of samples that every pixel has after the dispatch, if it completes samples.
    pub(crate) fn samples_after(&self) -> u32 {
        self.dispatch.sample + self.dispatch.count
    }

    /// Number of layers of workgroups, each of which covers the area of a tile.
    pub(crate) fn layers(&self) -> u32 {
        match self.work {
            Work::Pixels(_) => self.in_flight,
            Work::List(_) | Work::Advance | Work::Sums | Work::Samples => 1,
        }
    }
}

/// The items that a dispatch processes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Work {
    /// One path for each pixel of an area and each sample in flight.
    Pixels(Area),
    /// A list of paths. The area determines the box to which the origins of rays are moved.
    List(Area),
    /// One workgroup, which computes the size of the next dispatches from the length of a list.
    Advance,
    /// The sums of all pixels.
    Sums,
    /// Whole samples of all pixels.
    Samples,
}

impl Work {
    fn schedule(self) -> Schedule {
        if matches!(self, Self::List(_)) { Schedule::Queue } else { Schedule::Pixels }
    }
}

/// Stages of a sample after which its state can be recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Moment {
    Started,
    Extended,
    /// The hits of all rays are shaded.
    Shaded,
    /// Along paths, the sampled lights are searched for.
    Occluded,
    /// In a studio, some lights are searched for.
    Shadowed,
    /// In a studio, some lights are added.
    Illuminated,
    /// In a studio, some directions of ambient light are searched.
    Searched,
    /// In a studio, some directions of ambient light are added.
    Gathered,
    Accumulated,
}

/// The ways in which samples are taken, the quickest first. Each later one needs fewer iterations of an invocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SampleStrategy {
    /// One pass takes whole samples, where there is such a pass.
    OnePass,
    /// A ray for each invocation, except rays towards ambient light.
    Steps,
    /// A ray for each invocation.
    OneByOne,
}

impl SampleStrategy {
    /// The next way, if some invocations needed too many iterations.
    pub(crate) fn easier(self, lighting: &LightingData) -> Option<Self> {
        match self {
            Self::OnePass => Some(Self::Steps),
            Self::Steps if lighting.parameters.occlusion_samples > 1 => Some(Self::OneByOne),
            Self::Steps | Self::OneByOne => None,
        }
    }

    /// The key of the passes that take samples in this way.
    pub(crate) fn key(self, key: LitKey) -> LitKey {
        LitKey { one_pass: key.one_pass.filter(|_| self == Self::OnePass), ..key }
    }

    /// Number of directions of ambient light that an invocation searches. Searching many saves time, because most of
    /// the state that the invocation reads does not depend on the direction.
    pub(crate) fn at_once(self) -> u32 {
        if self == Self::OneByOne { 1 } else { 32 }
    }
}

/// The inputs of a round, which traces some samples of every pixel of a tile together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Round<'a> {
    pub(crate) passes: &'a LitPasses,
    pub(crate) lighting: &'a LightingData,
    pub(crate) scene: &'a SceneBuffers,
    pub(crate) occluders: &'a SceneBuffers,
    /// Number of paths that the buffers have room for.
    pub(crate) room: u32,
    pub(crate) strategy: SampleStrategy,
}

/// Maximum number of samples that an invocation takes in the pass over whole samples.
const SAMPLES_AT_ONCE: u32 = 8;

/// Maximum number of loop iterations of such an invocation apart from searching. It leaves the larger part of the limit
/// of software devices to searching.
pub(super) const MOST_LOOPS: u32 = 2500;

impl<'a> Round<'a> {
    /// The dispatches of some samples, which are traced together.
    pub(crate) fn steps(&self, samples: Range<u32>) -> Result<Vec<Step<'a>>, GpuError> {
        let count = samples.end.saturating_sub(samples.start);
        let dispatch =
            DispatchParameters { sample: samples.start, count, paths: self.room, ..bytemuck::Zeroable::zeroed() };
        let LitPasses { key, .. } = self.passes;
        if key.one_pass.is_some() {
            let pass = self.passes.named(key.passes()[0])?;
            return Ok(self.one_pass(pass, dispatch));
        }
        let mut steps = Steps { round: *self, in_flight: count, steps: Vec::new() };
        steps.push_first("start", dispatch, Work::Pixels(Area::Whole))?;
        steps.mark(Moment::Started);
        match key.mode {
            Mode::Studio => steps.studio(dispatch)?,
            Mode::Path(..) => steps.path(dispatch)?,
        }
        steps.push("accumulate", dispatch, (key.first(), None), Work::Sums)?;
        steps.mark(Moment::Accumulated);
        Ok(steps.steps)
    }

    /// The dispatches of the pass that takes whole samples. Each takes a few, so that no invocation reaches the
    /// iteration limit.
    fn one_pass(&self, pass: &'a Pass, dispatch: DispatchParameters) -> Vec<Step<'a>> {
        let brick = &self.scene.bricks[0];
        let rays = self.lighting.rays_of_sample();
        // Studios have no such loops.
        let by_loops = MOST_LOOPS / self.lighting.loops_of_path().max(1);
        let most = SAMPLES_AT_ONCE.min(by_loops).max(1);
        let at_once = (self.scene.rays_at_once(most * rays) / rays).max(1);
        let starts = (0..dispatch.count).step_by(at_once as usize);
        starts
            .map(|start| {
                let count = at_once.min(dispatch.count - start);
                Step {
                    pass,
                    dispatch: DispatchParameters {
                        sample: dispatch.sample + start,
                        count,
                        surface: self.lighting.max_surfaces,
                        ..dispatch
                    },
                    brick: Some(&brick.trace_group),
                    appearance: Some(&brick.appearance_group),
                    work: Work::Samples,
                    in_flight: 1,
                    rays: count * rays,
                    is_search: true,
                    moment: Some(Moment::Accumulated),
                }
            })
            .collect()
    }
}

struct Steps<'a> {
    round: Round<'a>,
    in_flight: u32,
    steps: Vec<Step<'a>>,
}

impl<'a> Steps<'a> {
    /// Adds a dispatch of the pass with an entry point over a brick of these shapes.
    fn push(
        &mut self,
        entry_point: &'static str,
        dispatch: DispatchParameters,
        (primitive, brick): (Primitive, Option<&'a BindGroup>),
        work: Work,
    ) -> Result<(), GpuError> {
        let name = PassName { entry_point, schedule: work.schedule(), brick_pass: BrickPass::First, primitive };
        self.push_pass(self.round.passes.named(name)?, dispatch, brick, work);
        Ok(())
    }

    /// Adds a dispatch of a pass that needs the palette alone, with the surfaces of the first brick.
    fn push_first(
        &mut self,
        entry_point: &'static str,
        dispatch: DispatchParameters,
        work: Work,
    ) -> Result<(), GpuError> {
        let first = &self.round.scene.bricks[0];
        self.push(entry_point, dispatch, (first.kind.primitive, Some(&first.surface_group)), work)
    }

    fn push_pass(&mut self, pass: &'a Pass, dispatch: DispatchParameters, brick: Option<&'a BindGroup>, work: Work) {
        self.steps.push(Step {
            pass,
            dispatch,
            brick,
            appearance: None,
            work,
            in_flight: self.in_flight,
            rays: 1,
            is_search: false,
            moment: None,
        });
    }

    /// Sets the number of rays of the last dispatches, one for each brick of the occluders.
    fn set_rays(&mut self, rays: u32) {
        let count = self.round.occluders.bricks.len();
        self.steps.iter_mut().rev().take(count).for_each(|step| step.rays = rays);
    }

    fn mark(&mut self, moment: Moment) {
        if let Some(last) = self.steps.last_mut() {
            last.moment = Some(moment);
        }
    }

    /// Adds the search for the hits of all rays: over pixels for camera rays, over lists for others.
    fn extend(&mut self, dispatch: DispatchParameters) -> Result<(), GpuError> {
        let work = work_of(dispatch, Area::Visible);
        for (index, brick) in self.round.scene.bricks.iter().enumerate() {
            let brick_pass = if index == 0 { BrickPass::First } else { BrickPass::Later };
            let primitive = brick.kind.primitive;
            let name = PassName { entry_point: "extend", schedule: work.schedule(), brick_pass, primitive };
            let pass = self.round.passes.named(name)?;
            self.push_pass(pass, dispatch, Some(&brick.trace_group), work);
            self.mark_search();
        }
        Ok(())
    }

    /// Notes that the last dispatch traces rays.
    fn mark_search(&mut self) {
        if let Some(last) = self.steps.last_mut() {
            last.is_search = true;
        }
    }

    /// Adds a dispatch for every brick, which shades the hits in the brick.
    fn shade(&mut self, entry_point: &'static str, dispatch: DispatchParameters) -> Result<(), GpuError> {
        // Pixels outside the visible region show the background.
        let work = work_of(dispatch, Area::Whole);
        let mut bricks = self.round.scene.bricks.iter();
        bricks.try_for_each(|b| self.push(entry_point, dispatch, (b.kind.primitive, Some(&b.surface_group)), work))
    }

    /// The parameters of the passes over a surface. From the second surface on, the list of paths is counted first.
    fn surface(&mut self, dispatch: DispatchParameters, surface: u32, is_last: bool) -> DispatchParameters {
        let list = surface.wrapping_sub(1) & 1;
        let dispatch = DispatchParameters { surface, is_last: is_last.into(), list, ..dispatch };
        if surface > 0 {
            self.advance(DispatchParameters { is_new: 1, ..dispatch });
        }
        dispatch
    }

    fn advance(&mut self, dispatch: DispatchParameters) {
        let dispatch = DispatchParameters { count: 0, first: [0, 0], ..dispatch };
        self.push_pass(&self.round.passes.advance, dispatch, None, Work::Advance);
    }

    /// Adds the search for occluders for all paths in the list of light.
    fn search_occluders(
        &mut self,
        entry_point: &'static str,
        dispatch: DispatchParameters,
        area: Area,
    ) -> Result<(), GpuError> {
        for brick in &self.round.occluders.bricks {
            let of_brick = (brick.kind.primitive, Some(&brick.trace_group));
            self.push(entry_point, dispatch, of_brick, Work::List(area))?;
            self.mark_search();
        }
        Ok(())
    }

    fn path(&mut self, dispatch: DispatchParameters) -> Result<(), GpuError> {
        let lighting = self.round.lighting;
        for surface in 0..=lighting.max_surfaces {
            let dispatch = self.surface(dispatch, surface, surface == lighting.max_surfaces);
            self.extend(dispatch)?;
            self.mark(Moment::Extended);
            self.shade("scatter", dispatch)?;
            self.mark(Moment::Shaded);
            if lighting.parameters.source_count > 0 && surface < lighting.max_surfaces {
                let dispatch = DispatchParameters { list: LIST_OF_LIGHT, ..dispatch };
                self.advance(dispatch);
                self.search_occluders("occlude", dispatch, Area::Visible)?;
                self.mark(Moment::Occluded);
            }
        }
        Ok(())
    }

    fn studio(&mut self, dispatch: DispatchParameters) -> Result<(), GpuError> {
        let lighting = self.round.lighting;
        let lights = lighting.casts_shadow.len() as u32;
        let directions = lighting.parameters.occlusion_samples;
        let at_once = self.round.occluders.rays_at_once(self.round.strategy.at_once());
        for surface in 0..lighting.max_surfaces {
            let dispatch = self.surface(dispatch, surface, surface + 1 == lighting.max_surfaces);
            self.extend(dispatch)?;
            self.mark(Moment::Extended);
            self.shade("surface", dispatch)?;
            self.mark(Moment::Shaded);
            if lights == 0 && directions == 0 {
                continue;
            }
            let dispatch = DispatchParameters { list: LIST_OF_LIGHT, ..dispatch };
            self.advance(dispatch);
            for light in (0..lights).step_by(BITS) {
                let count = (lights - light).min(BITS as u32);
                let casts = |light: &u32| lighting.shadows && lighting.casts_shadow[*light as usize];
                let casting: Vec<u32> = (light..light + count).filter(casts).collect();
                for &light in &casting {
                    let dispatch = DispatchParameters { light, ..dispatch };
                    self.search_occluders("shadow", dispatch, Area::Occluders)?;
                }
                if !casting.is_empty() {
                    self.mark(Moment::Shadowed);
                }
                let dispatch = DispatchParameters { light, count, ..dispatch };
                self.push_first("illuminate", dispatch, Work::List(Area::Whole))?;
                self.mark(Moment::Illuminated);
            }
            for light in (0..directions).step_by(BITS) {
                let count = (directions - light).min(BITS as u32);
                for first in (light..light + count).step_by(at_once as usize) {
                    let count = (light + count - first).min(at_once);
                    let dispatch = DispatchParameters { light: first, count, ..dispatch };
                    self.search_occluders("ambient", dispatch, Area::Occluders)?;
                    self.set_rays(count);
                }
                self.mark(Moment::Searched);
                let dispatch = DispatchParameters { light, count, ..dispatch };
                self.push_first("gather", dispatch, Work::List(Area::Whole))?;
                self.mark(Moment::Gathered);
            }
        }
        Ok(())
    }
}

/// The work for a surface: camera rays are processed by pixels, and all others by lists.
fn work_of(dispatch: DispatchParameters, area: Area) -> Work {
    if dispatch.surface == 0 { Work::Pixels(area) } else { Work::List(Area::Visible) }
}
