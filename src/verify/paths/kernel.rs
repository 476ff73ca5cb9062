//! The check of the shading kernel, number by number, from its input to its legal output. The WGSL twins are
//! `shaders/path/scatter.wgsl`, `bounce.wgsl` and the parts that they use.

use crate::image::NO_ID;
use crate::light::codes::material::{DIELECTRIC, EMISSIVE};
use crate::recording::lit::{flag, slot};
use crate::verify::lit::certificate::{Address, LitStage};
use crate::verify::lit::judge::{Mismatch, Name};
use crate::verify::lit::kernel::{Kernel, Output, RayState, Vertex, unit};
use crate::verify::lit::sampling::{Axes, Material, axes_around};
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::{FLUSH, U};

/// A point of a surface that scatters light.
pub(crate) struct Surface {
    pub(crate) vertex: Vertex,
    pub(crate) material: Material,
    pub(crate) axes: Axes,
    /// The direction back along the arriving ray, in the tangent frame.
    pub(crate) out: Vector,
}

const ORIGIN: Name = (LitStage::Vertex, "the origin of the next ray");
const DIRECTION: Name = (LitStage::Scatter, "the direction of the next ray");
const DENSITY: Name = (LitStage::Scatter, "the density of the next direction");
const FLAGS: Name = (LitStage::Scatter, "the path's flags");
const DEPARTURE: Name = (LitStage::Vertex, "the shape that the path leaves");
const EXIT_DISTANCE: Name = (LitStage::Scatter, "the exit distance of the shape that the path leaves");
const THROUGHPUT: Name = (LitStage::Scatter, "the path's throughput");
const RADIANCE: Name = (LitStage::Radiance, "the path's radiance");
const ALPHA: Name = (LitStage::Radiance, "the path's opacity");
const PENDING: Name = (LitStage::Light, "the pending light");
const LIGHT: Name = (LitStage::Light, "the sampled light");
const MEDIUM: Name = (LitStage::Scatter, "the absorption along the next ray");
const FIRST: Name = (LitStage::Vertex, "the first surface's color");
pub(crate) const KEPT: Name = (LitStage::Scatter, "an unchanged part of the path's state");

impl Kernel<'_> {
    pub(crate) fn pair(&self, number: u32) -> [u32; 2] {
        let Address { sample, surface, .. } = self.address;
        self.numbers(sample, number + 8 * surface)
    }

    pub(crate) fn is_last(&self) -> bool {
        self.address.surface >= self.inputs.max_surfaces
    }

    pub(crate) fn follow(&mut self) -> Result<(), Mismatch> {
        let before = self.before;
        let radiance_so_far = radiance_so_far(before);
        let alpha = before.number(slot::RADIANCE);
        let through = before.vector(slot::THROUGHPUT);
        let Some(vertex) = self.vertex()? else {
            let light = self.light_of_miss();
            return self.end(radiance_so_far + through.times(light), alpha);
        };
        let medium = before.vector(slot::MEDIUM);
        let arriving = if self.is_matt { through } else { through.times(medium.map(|m| (-m * vertex.distance).exp())) };
        self.write_departure(&vertex)?;
        if self.is_passed(&vertex) {
            return self.pass(&vertex, radiance_so_far, arriving);
        }
        let is_seen = !before.has(flag::SCATTERED);
        // A distance is not negative, but its bound may be.
        if is_seen && before.number(slot::FIRST).interval().high >= 0.0 {
            let first = Vector::recorded(vertex.color).map(|c| c.min(Number::ONE));
            self.write(FIRST, slot::FIRST, first, 0.0)?;
            self.write_number(FIRST, [slot::FIRST, 3], Number::known(-1.0), 0.0)?;
        } else {
            self.same(KEPT, &[slot::FIRST])?;
        }
        let material = self.material_of(&vertex);
        if material.kind == EMISSIVE {
            let density = self.density_of_hit_emitter(self.hit.id, before.vector(slot::ORIGIN));
            let weight = self.weight_of_hit_light(density);
            let light = Vector::recorded(vertex.color) * material.parameter * weight;
            self.write_radiance(radiance_so_far + arriving.times(light), Number::ONE)?;
            return self.stop(&vertex);
        }
        let axes = axes_around(vertex.normal, self.choices);
        let out = axes.to_local(-before.vector(slot::DIRECTION));
        let at = Surface { vertex, material, axes, out };
        let light = self.head_light(&at, is_seen);
        self.write_radiance(radiance_so_far + arriving.times(light), Number::ONE)?;
        if self.is_last() {
            return self.stop(&at.vertex);
        }
        self.sample_light(&at, arriving)?;
        self.bounce(&at, arriving)
    }

    /// Whether the path passes through the surface as if it were not there.
    fn is_passed(&mut self, at: &Vertex) -> bool {
        let [_, pass] = self.pair(3).map(crate::camera::sampling::unit);
        let [material, alpha] = at.opacities.map(f64::from);
        // The product in f64 is exact, because both numbers have 24 bits.
        let opacity = material * alpha;
        let is_exact = f64::from(opacity as f32).to_bits() == opacity.to_bits();
        let error = if is_exact { 0.0 } else { U * opacity + FLUSH };
        let is_open = (pass - opacity).abs() <= error && !is_exact;
        self.choices.decide((!is_open).then_some(pass >= opacity))
    }

    /// Writes the shape that the path leaves.
    fn write_departure(&mut self, at: &Vertex) -> Result<(), Mismatch> {
        let (id, shape_index) = if at.is_shape() { (self.hit.id, self.hit.shape_index) } else { (NO_ID, 0) };
        self.write_bits(DEPARTURE, [slot::DEPARTURE, 0], id)?;
        self.write_bits(DEPARTURE, [slot::DEPARTURE, 1], shape_index)
    }

    /// Writes the exit distance of the shape that the path leaves, along the next ray.
    fn write_exit_distance(&mut self, at: &Vertex) -> Result<(), Mismatch> {
        let (flags, direction) = match &self.after {
            Output::Recorded(after) => (after.flags(), Vector::recorded(after.vector(slot::DIRECTION))),
            Output::Legal(after) => (after.raw.flags(), after.vector(slot::DIRECTION)),
        };
        let is_inside = flags & flag::INSIDE != 0;
        let exit_distance = if is_inside { at.exit_distance(direction, self.choices) } else { Number::ZERO };
        // Near an edge of a cone, the distance may be far shorter than its errors, which are those of the cone's size.
        let size = at.cone.map_or(0.0, |cone| cone.ball()[3].into());
        self.write_number(EXIT_DISTANCE, [slot::DEPARTURE, 2], exit_distance, size)
    }

    fn write_radiance(&mut self, radiance: Vector, alpha: Number) -> Result<(), Mismatch> {
        self.write(RADIANCE, slot::RADIANCE, radiance, 0.0)?;
        self.write_number(ALPHA, [slot::RADIANCE, 3], alpha, 0.0)
    }

    /// Writes the pending light, and whether it must be tested for occlusion: 1 or 0.
    pub(crate) fn write_light(&mut self, light: Vector, open: Number) -> Result<(), Mismatch> {
        self.write(PENDING, slot::PENDING, light, 0.0)?;
        self.write_number(LIGHT, [slot::PENDING, 3], open, 0.0)
    }

    /// Writes the state if no light was sampled. The direction of the light does not matter then.
    fn write_no_light(&mut self) -> Result<(), Mismatch> {
        self.write_number(LIGHT, [slot::SHADOW, 3], Number::ZERO, 0.0)?;
        self.write_light(Vector::ZERO, Number::ZERO)
    }

    /// Judges a path that ends because its ray hits nothing.
    fn end(&mut self, radiance: Vector, alpha: Number) -> Result<(), Mismatch> {
        self.write_radiance(radiance, alpha)?;
        self.write(ORIGIN, slot::ORIGIN, Vector::ZERO, 0.0)?;
        self.write_bits(FLAGS, [slot::ORIGIN, 3], 0)?;
        self.write_no_light()?;
        self.same(KEPT, &[slot::DIRECTION, slot::DEPARTURE, slot::THROUGHPUT, slot::FIRST, slot::MEDIUM])
    }

    /// Judges a path that ends on a surface. The next ray does not matter then.
    fn stop(&mut self, at: &Vertex) -> Result<(), Mismatch> {
        match &mut self.after {
            Output::Recorded(after) => self.judge.bits(FLAGS, after.flags() & flag::ALIVE, 0)?,
            Output::Legal(after) => after.raw.slots[slot::ORIGIN][3] &= !flag::ALIVE,
        }
        self.write_exit_distance(at)?;
        self.write_no_light()
    }

    /// Judges a path that passes through a surface as if it were not there.
    fn pass(&mut self, at: &Vertex, radiance_so_far: Vector, arriving: Vector) -> Result<(), Mismatch> {
        let before = self.before;
        self.write_radiance(radiance_so_far, before.number(slot::RADIANCE))?;
        self.same(KEPT, &[slot::FIRST])?;
        // Glass ends at its far side, even if the path passes through that side.
        if at.is_back && self.material_of(at).kind == DIELECTRIC {
            self.write(MEDIUM, slot::MEDIUM, Vector::ZERO, 0.0)?;
        } else {
            self.same(KEPT, &[slot::MEDIUM])?;
        }
        self.write_no_light()?;
        self.write(DIRECTION, slot::DIRECTION, before.vector(slot::DIRECTION), 0.0)?;
        self.write_number(DENSITY, [slot::DIRECTION, 3], Number::ZERO, 0.0)?;
        self.write(THROUGHPUT, slot::THROUGHPUT, arriving, 0.0)?;
        let alive = if self.is_last() { 0 } else { flag::ALIVE };
        let scattered = before.raw.flags() & flag::SCATTERED;
        self.write_flags(at, true, flag::FULL | scattered | alive)
    }

    /// Writes the flags, including the side of a surface on which the path continues.
    fn write_flags(&mut self, at: &Vertex, is_behind: bool, flags: u32) -> Result<(), Mismatch> {
        let is_inside = at.is_shape() && is_behind != at.is_back;
        let side = if is_inside { flag::INSIDE } else { 0 };
        let ground = if at.is_shape() { 0 } else { flag::ON_GROUND };
        self.write_bits(FLAGS, [slot::ORIGIN, 3], side | ground | flags)?;
        self.write_exit_distance(at)
    }

    /// Judges a path that a surface scatters.
    fn bounce(&mut self, at: &Surface, through: Vector) -> Result<(), Mismatch> {
        let surface = self.address.surface;
        let lobe = unit(self.pair(3)[0]);
        let next = self.scatter_light(at, lobe, self.pair(2));
        let is_behind = self.choices.decide(next.direction.0[2].is_less(Number::ZERO));
        let direction = at.axes.to_world(next.direction);
        self.write(DIRECTION, slot::DIRECTION, direction, 0.0)?;
        self.write_number(DENSITY, [slot::DIRECTION, 3], next.density, 0.0)?;

        let carried = through.times(next.weight).fence();
        let most = carried.largest();
        let survival =
            if surface >= self.lighting().roulette_from { most.min(Number::constant(0.95)) } else { Number::ONE };
        let divisor = survival.max(Number::constant(1e-30));
        let carried = carried.map(|c| c / divisor);
        self.write(THROUGHPUT, slot::THROUGHPUT, carried, 0.0)?;

        let is_glass = at.material.kind == DIELECTRIC;
        let medium = if is_glass && is_behind {
            if at.vertex.is_back { Vector::ZERO } else { at.material.absorption }
        } else {
            self.before.vector(slot::MEDIUM)
        };
        self.write(MEDIUM, slot::MEDIUM, medium, 0.0)?;

        let draw = unit(self.pair(6)[0]);
        let is_dead = !self.choices.decide(most.is_above_zero()) || !self.choices.decide(draw.is_less(survival));
        let full = if is_glass { flag::FULL } else { 0 };
        let alive = if is_dead { 0 } else { flag::ALIVE };
        self.write_flags(&at.vertex, is_behind, flag::SCATTERED | full | alive)
    }
}

/// The radiance of a path, including the pending light if it is not occluded.
pub(crate) fn radiance_so_far(state: &RayState) -> Vector {
    state.vector(slot::RADIANCE) + state.vector(slot::PENDING) * state.number(slot::PENDING)
}
