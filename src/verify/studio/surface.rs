//! The check of the parts of a surface's look that need no search for light. The WGSL twin is
//! `shaders/studio/surface.wgsl`.

use crate::image::NO_ID;
use crate::light::codes::material::{EMISSIVE, LAMBERT};
use crate::recording::lit::{flag, slot};
use crate::verify::lit::certificate::LitStage;
use crate::verify::lit::judge::{Mismatch, Name};
use crate::verify::lit::kernel::{Kernel, Vertex};
use crate::verify::lit::sampling::Material;
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::Interval;

const FLAGS: Name = (LitStage::Surface, "the ray's flags");
const ORIGIN: Name = (LitStage::Surface, "the origin of a ray that has ended");
const DEPARTURE: Name = (LitStage::Surface, "the shape that the ray passes");
const EXIT_DISTANCE: Name = (LitStage::Surface, "the distance to the far side of the shape");
const REST: Name = (LitStage::Surface, "the weight that remains behind the surface");
const WEIGHT: Name = (LitStage::Surface, "the weight of the surface");
const RADIANCE: Name = (LitStage::Surface, "the radiance so far");
const ALPHA: Name = (LitStage::Surface, "the opacity so far");
const FIRST: Name = (LitStage::Surface, "the first surface's color");
const LENGTH: Name = (LitStage::Surface, "the distance from the camera");
const NORMAL: Name = (LitStage::Surface, "the normal");
const ALBEDO: Name = (LitStage::Surface, "the color times its weight");
const LOBE: Name = (LitStage::Surface, "the specular lobe");
const KEPT: Name = (LitStage::Surface, "an unchanged part of the ray's state");

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HitKind {
    Nothing,
    /// A surface that emits light and is not lit.
    Emitter,
    /// A surface to which lights add light.
    Surface,
}

impl Kernel<'_> {
    pub(crate) fn follow_surface(&mut self, is_last: bool) -> Result<HitKind, Mismatch> {
        let (before, lighting) = (self.before, self.lighting());
        let is_transparent = lighting.flags & flag::TRANSPARENT != 0;
        let shown = Vector::recorded(if is_transparent { [0.0; 3] } else { lighting.background });
        let left_over = before.vector(slot::THROUGHPUT).0[0];
        self.same(KEPT, &[slot::DIRECTION])?;
        let Some(vertex) = self.vertex()? else {
            self.added(shown * left_over, Number::ZERO)?;
            self.write(ORIGIN, slot::ORIGIN, Vector::ZERO, 0.0)?;
            self.write_bits(FLAGS, [slot::ORIGIN, 3], 0)?;
            self.same(KEPT, &[slot::DEPARTURE, slot::THROUGHPUT, slot::FIRST])?;
            self.same(KEPT, &[slot::NORMAL, slot::ALBEDO, slot::LOBE])?;
            return Ok(HitKind::Nothing);
        };
        let material = self.material_of(&vertex);
        let is_caught = !vertex.is_shape() && lighting.flags & flag::CATCHER != 0;
        let is_emitter = material.kind == EMISSIVE;

        let far = before.number(slot::FIRST) + vertex.distance;
        let fade = self.faded(far);
        let [of_material, alpha] = vertex.opacities.map(Number::recorded);
        let opacity = alpha * of_material;
        let weight = left_over * opacity;
        // Nothing remains behind an opaque surface: a number minus itself is zero.
        let is_opaque = vertex.opacities.iter().all(|opacity| opacity.to_bits() == 1.0_f32.to_bits());
        let rest = if is_opaque { Number::ZERO } else { left_over - weight };
        let Interval { low, .. } = fade.interval();
        // The fraction is at most one, and one minus one is exactly zero.
        let clear = if low >= 1.0 { Number::ZERO } else { Number::ONE - fade };
        let lit = weight * clear;
        let color = Vector::recorded(vertex.color);
        let has_occlusion = lighting.occlusion_samples > 0;
        let own = match (is_emitter, has_occlusion) {
            (true, _) => Vector([material.parameter; 3]),
            (false, true) => Vector::ZERO,
            (false, false) => Vector::recorded(lighting.ambient),
        };
        let through = if is_last { shown * rest } else { Vector::ZERO };
        if is_caught {
            self.added(shown * left_over, Number::ZERO)?;
        } else {
            let faded = Vector::recorded(lighting.cue_color) * (weight * fade);
            self.added(faded + (color * lit).times(own) + through, weight)?;
        }

        let is_first = self.address.surface == 0 && !is_caught;
        let first = if is_first { color.map(|c| c.min(Number::ONE)) } else { before.vector(slot::FIRST) };
        self.write(FIRST, slot::FIRST, first, 0.0)?;
        self.write_number(LENGTH, [slot::FIRST, 3], far, 0.0)?;
        self.write_passed(&vertex)?;
        let size = left_over.interval().high;
        self.write_number(REST, [slot::THROUGHPUT, 0], rest, size)?;
        self.write_number(WEIGHT, [slot::THROUGHPUT, 1], lit, size)?;
        for nothing in [2, 3] {
            self.write_number(WEIGHT, [slot::THROUGHPUT, nothing], Number::ZERO, 0.0)?;
        }
        self.write(NORMAL, slot::NORMAL, vertex.normal, 0.0)?;
        self.write_bits(NORMAL, [slot::NORMAL, 3], 0)?;
        self.write(ALBEDO, slot::ALBEDO, color * lit, size)?;
        let caught = if is_caught { left_over } else { Number::ZERO };
        self.write_number(ALBEDO, [slot::ALBEDO, 3], caught, 0.0)?;
        self.write_lobe(&material)?;

        let ends = is_last || is_caught || !self.choices.decide(rest.is_more(Number::ZERO));
        let is_closed = vertex.is_back && !self.choices.decide(opacity.is_less(Number::ONE));
        let flags = [
            (!ends, flag::ALIVE),
            (vertex.is_shape() && !vertex.is_back, flag::INSIDE),
            (is_closed, flag::BACK),
            (!vertex.is_shape(), flag::ON_GROUND),
        ];
        let flags = flags.into_iter().filter(|(is_set, _)| *is_set).map(|(_, flag)| flag).sum();
        self.write_bits(FLAGS, [slot::ORIGIN, 3], flags)?;
        Ok(if is_emitter { HitKind::Emitter } else { HitKind::Surface })
    }

    /// The fraction of the colour that depth cueing replaces at a distance: `shaders/studio/faded.wgsl`.
    fn faded(&self, distance: Number) -> Number {
        let lighting = self.lighting();
        let beyond = distance - Number::recorded(lighting.cue_near);
        (beyond * Number::recorded(lighting.cue_scale)).clamp(0.0, 1.0)
    }

    /// Writes radiance and opacity: the sums of their previous values and the additions.
    fn added(&mut self, radiance: Vector, opacity: Number) -> Result<(), Mismatch> {
        let before = self.before;
        self.write(RADIANCE, slot::RADIANCE, before.vector(slot::RADIANCE) + radiance, 0.0)?;
        self.write_number(ALPHA, [slot::RADIANCE, 3], before.number(slot::RADIANCE) + opacity, 0.0)
    }

    /// Writes the shape that the ray passes, its radius, and the distance to its far side.
    fn write_passed(&mut self, vertex: &Vertex) -> Result<(), Mismatch> {
        let is_shape = vertex.is_shape();
        let (id, index) = if is_shape { (self.hit.id, self.hit.shape_index) } else { (NO_ID, 0) };
        self.write_bits(DEPARTURE, [slot::DEPARTURE, 0], id)?;
        self.write_bits(DEPARTURE, [slot::DEPARTURE, 1], index)?;
        let radius = Number::recorded(vertex.sphere[3]);
        self.write_number(DEPARTURE, [slot::DEPARTURE, 3], radius, 0.0)?;
        let exit = vertex.exit_distance(self.before.vector(slot::DIRECTION), self.choices);
        let size = vertex.cone.map_or(f64::from(vertex.sphere[3]), |cone| cone.ball()[3].into());
        self.write_number(EXIT_DISTANCE, [slot::DEPARTURE, 2], exit, size)
    }

    /// Writes the share of the lobe, the square of its roughness, and the index of its energies.
    fn write_lobe(&mut self, material: &Material) -> Result<(), Mismatch> {
        let expected = if material.kind == LAMBERT { material.parameter } else { Number::ZERO };
        self.write_number(LOBE, [slot::LOBE, 0], expected, 0.0)?;
        self.write_number(LOBE, [slot::LOBE, 1], material.alpha, 0.0)?;
        self.write_bits(LOBE, [slot::LOBE, 2], material.energies)?;
        self.write_bits(LOBE, [slot::LOBE, 3], 0)
    }
}
