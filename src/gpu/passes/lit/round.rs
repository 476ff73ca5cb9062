//! The dispatches of some samples of every pixel of a tile, in their order.

use std::ops::Range;

use wgpu::BindGroup;

use super::frame::Area;
use super::lighting::LightingData;
use super::pass::Pass;
use super::passes::{BySchedule, LitPasses, ShadePasses};
use super::records::{DispatchParameters, LIST_OF_LIGHT};
use crate::gpu::error::GpuError;
use crate::gpu::scene::scene_buffers::SceneBuffers;

/// How many lights are searched before they are added: each has a bit.
const BITS: usize = 32;

/// One dispatch.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct Step<'a> {
    pub(super) pass: &'a Pass,
    pub(super) dispatch: DispatchParameters,
    /// Group 1, if the pass works on a brick.
    pub(super) brick: Option<&'a BindGroup>,
    pub(super) work: Work,
    /// How many samples are in flight.
    pub(super) turns: u32,
    /// How many rays each path sends.
    rays: u32,
    /// Whether it searches, and so may take long.
    is_search: bool,
    /// What has happened once it is done, and it is the last of its kind.
    pub(in crate::gpu) moment: Option<Moment>,
}

impl Step<'_> {
    /// Whether it searches, and so may take long.
    pub(in crate::gpu) fn is_search(&self) -> bool {
        self.is_search
    }

    /// How many rays each of its invocations sends.
    pub(in crate::gpu) fn rays(&self) -> u32 {
        self.rays
    }

    /// How often it takes the workgroups that it has along the two sides of a tile.
    pub(in crate::gpu) fn layers(&self) -> u32 {
        match self.work {
            Work::Pixels(_) => self.turns,
            Work::List(_) | Work::Advance | Work::Sums => 1,
        }
    }
}

/// What a dispatch works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Work {
    /// One path for each pixel of an area and each sample.
    Pixels(Area),
    /// A list of paths; the area says by which box rays are moved.
    List(Area),
    /// One workgroup, which says how long a list is.
    Advance,
    /// The sums of all pixels.
    Sums,
}

/// After which passes of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gpu) enum Moment {
    Started,
    Extended,
    Scattered,
    Occluded,
    Accumulated,
}

/// What a round is made of.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct Round<'a> {
    pub(in crate::gpu) passes: &'a LitPasses,
    pub(in crate::gpu) lighting: &'a LightingData,
    pub(in crate::gpu) scene: &'a SceneBuffers,
    pub(in crate::gpu) occluders: &'a SceneBuffers,
    /// How many paths the buffers have room for.
    pub(in crate::gpu) room: u32,
    /// How many directions of ambient light one invocation searches: [`AT_ONCE`], or one where that takes it more steps
    /// than the device may loop for.
    pub(in crate::gpu) at_once: u32,
}

/// Most of what a path is read for does not depend on the direction.
pub(in crate::gpu) const AT_ONCE: u32 = 32;

impl<'a> Round<'a> {
    /// The dispatches of some samples, which are followed together.
    pub(in crate::gpu) fn steps(&self, samples: Range<u32>) -> Result<Vec<Step<'a>>, GpuError> {
        let count = samples.end.saturating_sub(samples.start);
        let dispatch = DispatchParameters {
            sample: samples.start,
            count,
            paths: self.room,
            ..bytemuck::Zeroable::zeroed()
        };
        let mut steps = Steps { round: *self, turns: count, steps: Vec::new() };
        let first = &self.scene.bricks()[0].surface_group;
        steps.push(&self.passes.start, dispatch, Some(first), Work::Pixels(Area::Whole));
        steps.mark(Moment::Started);
        match &self.passes.shade {
            ShadePasses::Studio { surface, shadow, illuminate, ambient, gather } => {
                let passes = StudioPasses { surface, shadow, illuminate, ambient, gather };
                steps.studio(dispatch, &passes)?;
            }
            ShadePasses::Path { scatter, occlude } => steps.path(dispatch, scatter, occlude)?,
        }
        steps.push(&self.passes.accumulate, dispatch, None, Work::Sums);
        steps.mark(Moment::Accumulated);
        Ok(steps.steps)
    }
}

struct StudioPasses<'a> {
    surface: &'a BySchedule,
    shadow: &'a Pass,
    illuminate: &'a Pass,
    ambient: &'a Pass,
    gather: &'a Pass,
}

struct Steps<'a> {
    round: Round<'a>,
    turns: u32,
    steps: Vec<Step<'a>>,
}

impl<'a> Steps<'a> {
    fn push(
        &mut self,
        pass: &'a Pass,
        dispatch: DispatchParameters,
        brick: Option<&'a BindGroup>,
        work: Work,
    ) {
        let (turns, is_search, moment) = (self.turns, false, None);
        self.steps.push(Step { pass, dispatch, brick, work, turns, rays: 1, is_search, moment });
    }

    fn push_search(
        &mut self,
        pass: &'a Pass,
        dispatch: DispatchParameters,
        brick: &'a BindGroup,
        work: Work,
    ) {
        let (turns, is_search, moment) = (self.turns, true, None);
        self.steps.push(Step {
            pass,
            dispatch,
            brick: Some(brick),
            work,
            turns,
            rays: 1,
            is_search,
            moment,
        });
    }

    /// The last dispatches, one for each brick of what casts shadows, send so many rays for each path.
    fn weigh(&mut self, rays: u32) {
        let count = self.round.occluders.bricks().len();
        self.steps.iter_mut().rev().take(count).for_each(|step| step.rays = rays);
    }

    fn mark(&mut self, moment: Moment) {
        if let Some(last) = self.steps.last_mut() {
            last.moment = Some(moment);
        }
    }

    /// What the rays meet at a surface: the camera's by pixels, others by lists.
    fn extend(&mut self, dispatch: DispatchParameters) -> Result<(), GpuError> {
        let (first, later) = &self.round.passes.extend;
        for (turn, brick) in self.round.scene.bricks().iter().enumerate() {
            let by = match (turn, later) {
                (0, _) => first,
                (_, Some(later)) => later,
                (_, None) => return Err(GpuError::OtherRenderer),
            };
            let (pass, work) = by_surface(by, dispatch, Area::Visible);
            self.push_search(pass, dispatch, &brick.trace_group, work);
        }
        Ok(())
    }

    /// A dispatch for every brick: each shades what it holds.
    fn shade(&mut self, by: &'a BySchedule, dispatch: DispatchParameters) {
        for brick in self.round.scene.bricks() {
            // What the camera sees beside the scene is background.
            let (pass, work) = by_surface(by, dispatch, Area::Whole);
            self.push(pass, dispatch, Some(&brick.surface_group), work);
        }
    }

    /// The parameters of the passes over a surface; from the second on, the list of paths that go on is counted first.
    fn surface(
        &mut self,
        dispatch: DispatchParameters,
        surface: u32,
        is_last: bool,
    ) -> DispatchParameters {
        let list = surface.wrapping_sub(1) & 1;
        let dispatch = DispatchParameters { surface, is_last: is_last.into(), list, ..dispatch };
        if surface > 0 {
            self.advance(DispatchParameters { is_new: 1, ..dispatch });
        }
        dispatch
    }

    fn advance(&mut self, dispatch: DispatchParameters) {
        let dispatch = DispatchParameters { count: 0, first: [0, 0], ..dispatch };
        self.push(&self.round.passes.advance, dispatch, None, Work::Advance);
    }

    /// Searches what casts shadows for all that look for light.
    fn search_occluders(&mut self, pass: &'a Pass, dispatch: DispatchParameters, area: Area) {
        for brick in self.round.occluders.bricks() {
            self.push_search(pass, dispatch, &brick.trace_group, Work::List(area));
        }
    }

    fn path(
        &mut self,
        dispatch: DispatchParameters,
        scatter: &'a BySchedule,
        occlude: &'a Pass,
    ) -> Result<(), GpuError> {
        let lighting = self.round.lighting;
        for surface in 0..=lighting.most_surfaces {
            let dispatch = self.surface(dispatch, surface, surface == lighting.most_surfaces);
            self.extend(dispatch)?;
            self.mark(Moment::Extended);
            self.shade(scatter, dispatch);
            self.mark(Moment::Scattered);
            if lighting.parameters.source_count > 0 && surface < lighting.most_surfaces {
                let dispatch = DispatchParameters { list: LIST_OF_LIGHT, ..dispatch };
                self.advance(dispatch);
                self.search_occluders(occlude, dispatch, Area::Visible);
                self.mark(Moment::Occluded);
            }
        }
        Ok(())
    }

    fn studio(
        &mut self,
        dispatch: DispatchParameters,
        passes: &StudioPasses<'a>,
    ) -> Result<(), GpuError> {
        let lighting = self.round.lighting;
        let first = &self.round.scene.bricks()[0].surface_group;
        let lights = lighting.casts_shadow.len() as u32;
        let directions = lighting.parameters.occlusion_samples;
        let at_once = self.round.occluders.rays_at_once(self.round.at_once);
        for surface in 0..lighting.most_surfaces {
            let dispatch = self.surface(dispatch, surface, surface + 1 == lighting.most_surfaces);
            self.extend(dispatch)?;
            self.shade(passes.surface, dispatch);
            if lights == 0 && directions == 0 {
                continue;
            }
            let dispatch = DispatchParameters { list: LIST_OF_LIGHT, ..dispatch };
            self.advance(dispatch);
            for light in (0..lights).step_by(BITS) {
                let count = (lights - light).min(BITS as u32);
                let casts =
                    |light: &u32| lighting.has_shadows && lighting.casts_shadow[*light as usize];
                for light in (light..light + count).filter(casts) {
                    self.search_occluders(
                        passes.shadow,
                        DispatchParameters { light, ..dispatch },
                        Area::Occluders,
                    );
                }
                let dispatch = DispatchParameters { light, count, ..dispatch };
                self.push(passes.illuminate, dispatch, Some(first), Work::List(Area::Whole));
            }
            for light in (0..directions).step_by(BITS) {
                let count = (directions - light).min(BITS as u32);
                for first in (light..light + count).step_by(at_once as usize) {
                    let count = (light + count - first).min(at_once);
                    let dispatch = DispatchParameters { light: first, count, ..dispatch };
                    self.search_occluders(passes.ambient, dispatch, Area::Occluders);
                    self.weigh(count);
                }
                let dispatch = DispatchParameters { light, count, ..dispatch };
                self.push(passes.gather, dispatch, Some(first), Work::List(Area::Whole));
            }
        }
        Ok(())
    }
}

/// The camera's rays are taken by pixels, those that surfaces send by lists.
fn by_surface(by: &BySchedule, dispatch: DispatchParameters, area: Area) -> (&Pass, Work) {
    if dispatch.surface == 0 {
        (&by.pixels, Work::Pixels(area))
    } else {
        (&by.queue, Work::List(Area::Visible))
    }
}
