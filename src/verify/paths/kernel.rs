//! The check of the shading kernel, number by number: from its input to its legal output. The WGSL twins are
//! `shaders/path/scatter.wgsl`, `bounce.wgsl` and the parts that they use.

use super::certificate::PathStage;
use super::expected::{Expected, Mismatch};
use super::recording::{PathRecording, PathState, UploadedLighting, flag, slot};
use super::vertex::Vertex;
use super::warp::Axes;
use crate::camera::sampling::{pair, pixel_seed};
use crate::image::NO_ID;
use crate::scene::Scene;
use crate::verify::choices::Choices;
use crate::verify::number::{Number, Vector};

/// The hit of a ray as the device recorded it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub(super) t: f32,
    pub(super) id: u32,
    pub(super) shape_index: u32,
    pub(super) distance: f32,
}

impl Hit {
    pub(super) fn new([t, id, shape_index, distance]: [u32; 4]) -> Self {
        Self { t: f32::from_bits(t), id, shape_index, distance: f32::from_bits(distance) }
    }
}

/// The address of a surface: pixel, sample, and index on the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Address {
    pub(super) pixel: [u32; 2],
    pub(super) sample: u32,
    pub(super) surface: u32,
}

/// One invocation of the kernel, for one combination of its open decisions.
pub(super) struct Kernel<'a> {
    pub(super) scene: &'a Scene,
    pub(super) recording: &'a PathRecording,
    /// Whether this is the kernel for scenes in which every material is matt or emissive.
    pub(super) is_matt: bool,
    pub(super) address: Address,
    pub(super) before: &'a PathState,
    pub(super) hit: Hit,
    pub(super) after: &'a PathState,
    pub(super) expected: Expected,
    pub(super) choices: &'a mut Choices,
}

/// A point of a surface that scatters light.
pub(super) struct Surface {
    pub(super) vertex: Vertex,
    pub(super) material: super::material::Material,
    pub(super) axes: Axes,
    /// The direction back along the arriving ray, in the tangent frame.
    pub(super) out: Vector,
}

/// The stage and the name of a number, for reports.
type Name = (PathStage, &'static str);

const ORIGIN: Name = (PathStage::Vertex, "the origin of the next ray");
const DIRECTION: Name = (PathStage::Scatter, "the direction of the next ray");
const DENSITY: Name = (PathStage::Scatter, "the density of the next direction");
const FLAGS: Name = (PathStage::Scatter, "the path's flags");
const DEPARTURE: Name = (PathStage::Vertex, "the sphere that the path leaves");
const EXIT_DISTANCE: Name =
    (PathStage::Scatter, "the exit distance of the sphere that the path leaves");
const THROUGHPUT: Name = (PathStage::Scatter, "the path's throughput");
const RADIANCE: Name = (PathStage::Radiance, "the path's radiance");
const ALPHA: Name = (PathStage::Radiance, "the path's opacity");
const PENDING: Name = (PathStage::Light, "the pending light");
const LIGHT: Name = (PathStage::Light, "the sampled light");
const MEDIUM: Name = (PathStage::Scatter, "the absorption along the next ray");
const FIRST: Name = (PathStage::Vertex, "the first surface's color");

impl<'a> Kernel<'a> {
    pub(super) fn lighting(&self) -> &'a UploadedLighting {
        &self.recording.lighting
    }

    /// An entry of the tables; zeros beyond their end.
    pub(super) fn table(&self, at: u32) -> [u32; 4] {
        self.recording.tables.get(at as usize).copied().unwrap_or_default()
    }

    pub(super) fn emitter_words(&self, at: u32) -> [u32; 4] {
        self.recording.emitters.get(at as usize).copied().unwrap_or_default()
    }

    pub(super) fn table_numbers(&self, at: u32) -> [f32; 4] {
        self.table(at).map(f32::from_bits)
    }

    pub(super) fn pair(&self, number: u32) -> [u32; 2] {
        let Address { pixel, sample, surface } = self.address;
        pair(pixel_seed(pixel, self.lighting().seed), sample, number + 8 * surface)
    }

    pub(super) fn is_last(&self) -> bool {
        self.address.surface >= self.recording.max_depth
    }

    /// Follows the kernel, and compares its output.
    pub(super) fn follow(&mut self) -> Result<(), Mismatch> {
        let (before, after) = (self.before, self.after);
        let radiance_so_far = self.radiance_so_far();
        let alpha = before.number(slot::RADIANCE);
        let through = Vector::recorded(before.vector(slot::THROUGHPUT));
        let Some(vertex) = self.vertex()? else {
            let light = self.light_of_miss();
            return self.end(radiance_so_far + through.times(light), alpha);
        };
        let medium = Vector::recorded(before.vector(slot::MEDIUM));
        let arriving = if self.is_matt {
            through
        } else {
            through.times(medium.map(|m| (-m * vertex.distance).exp()))
        };
        self.compare_departure(&vertex)?;
        if vertex.is_passed {
            return self.pass(&vertex, radiance_so_far, arriving);
        }
        let is_seen = !before.has(flag::SCATTERED);
        if is_seen && before.number(slot::FIRST) >= 0.0 {
            let first = Vector::recorded(vertex.color).map(|c| c.min(Number::ONE));
            self.expected.vector(FIRST, after.vector(slot::FIRST), first)?;
            self.expected.bits(FIRST, after.bits(slot::FIRST), (-1.0_f32).to_bits())?;
        } else {
            self.expected.same(FIRST, [before, after], slot::FIRST)?;
        }
        let material = self.material_of(&vertex);
        if material.is_emissive() {
            let density = self.density_of_hit_emitter(self.hit.id, before.vector(slot::ORIGIN));
            let weight = self.weight_of_hit_light(density);
            let light = Vector::recorded(vertex.color) * material.parameter * weight;
            self.compare_radiance(radiance_so_far + arriving.times(light), Number::ONE)?;
            return self.stop();
        }
        let axes = self.axes_around(vertex.normal);
        let out = axes.to_local(-Vector::recorded(before.vector(slot::DIRECTION)));
        let at = Surface { vertex, material, axes, out };
        let light = self.head_light(&at, is_seen);
        self.compare_radiance(radiance_so_far + arriving.times(light), Number::ONE)?;
        if self.is_last() {
            return self.stop();
        }
        self.sample_light(&at, arriving)?;
        self.bounce(&at, arriving)
    }

    /// Compares the sphere that the path leaves, and its exit distance along the next ray.
    fn compare_departure(&mut self, at: &Vertex) -> Result<(), Mismatch> {
        let (after, departure) = (self.after, self.after.departure());
        let (id, shape_index) =
            if at.is_sphere() { (self.hit.id, self.hit.shape_index) } else { (NO_ID, 0) };
        self.expected.bits(DEPARTURE, departure.id, id)?;
        self.expected.bits(DEPARTURE, departure.shape_index, shape_index)?;
        let exit_distance = if after.has(flag::INSIDE) {
            at.exit_distance(Vector::recorded(after.vector(slot::DIRECTION)))
        } else {
            Number::ZERO
        };
        self.expected.number(EXIT_DISTANCE, departure.exit_distance, exit_distance)
    }

    /// The radiance of the path so far, including the pending light if it is not occluded.
    fn radiance_so_far(&self) -> Vector {
        radiance_so_far(self.before)
    }

    pub(super) fn same(&mut self, slots: &[usize]) -> Result<(), Mismatch> {
        const KEPT: Name = (PathStage::Scatter, "an unchanged part of the path's state");
        let states = [self.before, self.after];
        slots.iter().try_for_each(|slot| self.expected.same(KEPT, states, *slot))
    }

    fn compare_radiance(&mut self, radiance: Vector, alpha: Number) -> Result<(), Mismatch> {
        let after = self.after;
        self.expected.vector(RADIANCE, after.vector(slot::RADIANCE), radiance)?;
        self.expected.number(ALPHA, after.number(slot::RADIANCE), alpha)
    }

    /// Compares the pending light, and whether it must be tested for occlusion: 1 or 0.
    pub(super) fn compare_light(&mut self, light: Vector, open: Number) -> Result<(), Mismatch> {
        let after = self.after;
        self.expected.vector(PENDING, after.vector(slot::PENDING), light)?;
        self.expected.number(LIGHT, after.number(slot::PENDING), open)
    }

    /// Compares the state if no light was sampled; the direction of the light does not matter then.
    fn compare_no_light(&mut self) -> Result<(), Mismatch> {
        let after = self.after;
        self.expected.number(LIGHT, after.number(slot::SHADOW), Number::ZERO)?;
        self.compare_light(Vector::ZERO, Number::ZERO)
    }

    /// The path ends because its ray hits nothing.
    fn end(&mut self, radiance: Vector, alpha: f32) -> Result<(), Mismatch> {
        let after = self.after;
        self.compare_radiance(radiance, Number::recorded(alpha))?;
        self.expected.vector(ORIGIN, after.vector(slot::ORIGIN), Vector::ZERO)?;
        self.expected.bits(FLAGS, after.flags(), 0)?;
        self.compare_no_light()?;
        self.same(&[slot::DIRECTION, slot::DEPARTURE, slot::THROUGHPUT, slot::FIRST])?;
        self.same(&[slot::MEDIUM])
    }

    /// The path ends on a surface. The next ray does not matter then.
    fn stop(&mut self) -> Result<(), Mismatch> {
        self.expected.bits(FLAGS, self.after.flags() & flag::ALIVE, 0)?;
        self.compare_no_light()
    }

    /// The path passes through a surface as if it were not there.
    fn pass(
        &mut self,
        at: &Vertex,
        radiance_so_far: Vector,
        arriving: Vector,
    ) -> Result<(), Mismatch> {
        let (before, after) = (self.before, self.after);
        self.compare_radiance(radiance_so_far, Number::recorded(before.number(slot::RADIANCE)))?;
        self.same(&[slot::FIRST])?;
        // Glass ends at its far side, even if the path passes through that side.
        if at.is_back && self.material_of(at).is_dielectric() {
            self.expected.vector(MEDIUM, after.vector(slot::MEDIUM), Vector::ZERO)?;
        } else {
            self.same(&[slot::MEDIUM])?;
        }
        self.compare_no_light()?;
        let direction = Vector::recorded(before.vector(slot::DIRECTION));
        self.expected.vector(DIRECTION, after.vector(slot::DIRECTION), direction)?;
        self.expected.number(DENSITY, after.number(slot::DIRECTION), Number::ZERO)?;
        self.expected.vector(THROUGHPUT, after.vector(slot::THROUGHPUT), arriving)?;
        let alive = if self.is_last() { 0 } else { flag::ALIVE };
        let scattered = before.flags() & flag::SCATTERED;
        self.compare_flags(at, true, flag::FULL | scattered | alive)
    }

    /// Compares the flags, including on which side of a surface the path continues.
    fn compare_flags(&mut self, at: &Vertex, is_behind: bool, flags: u32) -> Result<(), Mismatch> {
        let is_inside = at.is_sphere() && is_behind != at.is_back;
        let side = if is_inside { flag::INSIDE } else { 0 };
        let ground = if at.is_sphere() { 0 } else { flag::ON_GROUND };
        self.expected.bits(FLAGS, self.after.flags(), side | ground | flags)
    }

    /// A surface scatters the path.
    fn bounce(&mut self, at: &Surface, through: Vector) -> Result<(), Mismatch> {
        let (after, surface) = (self.after, self.address.surface);
        let lobe = unit(self.pair(3)[0]);
        let next = self.scatter_light(at, lobe, self.pair(2));
        let is_behind = self.choices.decide(next.direction.0[2].is_less(Number::ZERO));
        let direction = at.axes.to_world(next.direction);
        self.expected.vector(DIRECTION, after.vector(slot::DIRECTION), direction)?;
        self.expected.number(DENSITY, after.number(slot::DIRECTION), next.density)?;

        let carried = through.times(next.weight).fence();
        let most = carried.largest();
        let survival = if surface >= self.lighting().roulette_from {
            most.min(Number::constant(0.95))
        } else {
            Number::ONE
        };
        let divisor = survival.max(Number::constant(1e-30));
        let carried = carried.map(|c| c / divisor);
        self.expected.vector(THROUGHPUT, after.vector(slot::THROUGHPUT), carried)?;

        let is_glass = at.material.is_dielectric();
        let medium = if is_glass && is_behind {
            if at.vertex.is_back { Vector::ZERO } else { at.material.absorption }
        } else {
            Vector::recorded(self.before.vector(slot::MEDIUM))
        };
        self.expected.vector(MEDIUM, after.vector(slot::MEDIUM), medium)?;

        let draw = unit(self.pair(6)[0]);
        let is_dead = !self.choices.decide(most.is_above_zero())
            || !self.choices.decide(draw.is_less(survival));
        let full = if is_glass { flag::FULL } else { 0 };
        let alive = if is_dead { 0 } else { flag::ALIVE };
        self.compare_flags(&at.vertex, is_behind, flag::SCATTERED | full | alive)
    }
}

/// The number in [0, 1) that the upper 24 bits stand for, exactly.
pub(super) fn unit(bits: u32) -> Number {
    Number::known(crate::camera::sampling::unit(bits))
}

/// The radiance of a path, including the pending light if it is not occluded.
pub(super) fn radiance_so_far(state: &PathState) -> Vector {
    let open = Number::recorded(state.number(slot::PENDING));
    Vector::recorded(state.vector(slot::RADIANCE))
        + Vector::recorded(state.vector(slot::PENDING)) * open
}
