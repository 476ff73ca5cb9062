//! The check of light sampling at a surface. The WGSL twins are `shaders/path/direct.wgsl` and
//! `scene/emitters.wgsl`.

use super::kernel::Surface;
use crate::light::codes::lamp::HEAD;
use crate::light::codes::sampling::{CHANCE, MULTIPLE};
use crate::verify::lit::expected::Mismatch;
use crate::verify::lit::kernel::{Kernel, unit};
use crate::verify::lit::lamp::Lamp;
use crate::verify::lit::recording::{NO_EMITTER, flag, slot};
use crate::verify::lit::stage::LitStage;
use crate::verify::lit::warp::{axes_around, cone_direction, cone_of_sphere, pi};
use crate::verify::number::{Number, Vector};
use crate::verify::recording::NO_HIT;

/// A sample of a light source, seen from a surface.
struct LightSample {
    direction: Vector,
    distance: Number,
    /// Density of the direction, for a light that scattered rays can hit as well; 0 for others.
    density: Number,
    /// Radiance divided by the density.
    radiance: Vector,
    /// Index of the emitter, or [`NO_EMITTER`].
    emitter: u32,
}

/// An emissive sphere in the tables of the device.
struct Emitter {
    sphere: [f32; 4],
    probability: Number,
    radiance: Vector,
}

const DIRECTION: (LitStage, &str) = (LitStage::Light, "the direction towards the light");
const DISTANCE: (LitStage, &str) = (LitStage::Light, "the distance to the light");
const EMITTER: (LitStage, &str) = (LitStage::Light, "the sampled emitter");

impl Kernel<'_> {
    /// The light of lights at the eye, which reaches only surfaces that the camera sees.
    pub(super) fn head_light(&mut self, at: &Surface, is_seen: bool) -> Vector {
        if !is_seen || at.material.is_dielectric() {
            return Vector::ZERO;
        }
        let sum = (0..self.lighting().light_count)
            .filter(|light| self.table(3 * light)[3] == HEAD)
            .map(|light| {
                let [r, g, b, _] = self.table_numbers(3 * light + 1);
                Vector::recorded([r, g, b])
            })
            .fold(Vector::ZERO, |sum, light| sum + light);
        if sum.0.iter().all(Number::is_zero) {
            return Vector::ZERO;
        }
        let color = Vector::recorded(at.vertex.color);
        let r = self.reflect_toward(&at.material, color, at.out, at.out);
        (sum * pi()).times(r.value)
    }

    pub(super) fn sample_light(&mut self, at: &Surface, through: Vector) -> Result<(), Mismatch> {
        let (lighting, after) = (self.lighting(), self.after);
        if lighting.source_count == 0 {
            self.expected.bits(EMITTER, after.departure().emitter, NO_EMITTER)?;
            return self.same(&[slot::SHADOW, slot::PENDING]);
        }
        let (u, [which, choice]) = (self.pair(4), self.pair(5));
        let scaled = unit(which) * Number::known(lighting.source_count.into());
        let source = self.choices.pick(scaled.floor()) as u32;
        let source = source.min(lighting.source_count - 1);
        let position = at.vertex.position;
        let is_emitter = source == lighting.lamp_sources && lighting.emitter_count > 0;
        let found = if source < lighting.lamp_sources {
            self.sample_lamp(source, position, u)
        } else if is_emitter {
            self.sample_emitter(position, u, choice)
        } else {
            self.sample_sky_light(u)
        };
        self.expected.vector(DIRECTION, after.vector(slot::SHADOW), found.direction)?;
        self.expected.bits(EMITTER, after.departure().emitter, found.emitter)?;

        let color = Vector::recorded(at.vertex.color);
        let toward = at.axes.to_local(found.direction);
        let r = self.reflect_toward(&at.material, color, at.out, toward);
        let mut light = through.times(r.value).times(found.radiance);
        if lighting.light_sampling == MULTIPLE && self.choices.decide(found.density.is_above_zero())
        {
            let all = (found.density + r.density).max(Number::constant(1e-30));
            light = light * (found.density / all);
        }
        let is_open = self.is_open(at, &found, light);
        let (light, open, distance) = if is_open {
            (light, Number::ONE, found.distance)
        } else {
            (Vector::ZERO, Number::ZERO, Number::ZERO)
        };
        self.expected.number(DISTANCE, after.number(slot::SHADOW), distance)?;
        self.compare_light(light, open)
    }

    /// Whether light may arrive, so that occlusion must be tested.
    fn is_open(&mut self, at: &Surface, found: &LightSample, light: Vector) -> bool {
        let vertex = &at.vertex;
        if !self.choices.decide(light.largest().is_above_zero()) {
            return false;
        }
        if vertex.is_back {
            let exit = vertex.exit_distance(found.direction);
            if self.choices.decide(exit.is_less(found.distance)) {
                return false;
            }
        }
        if vertex.is_sphere() {
            let ground = self.ground_distance(vertex.position, found.direction, Number::ZERO);
            if ground.is_some_and(|t| self.choices.decide(t.is_less(found.distance))) {
                return false;
            }
        }
        true
    }

    fn sources(&self) -> Number {
        Number::known(self.lighting().source_count.max(1).into())
    }

    fn sample_lamp(&mut self, source: u32, position: Vector, u: [u32; 2]) -> LightSample {
        let light = self.table(3 * source + 2)[0];
        let recorded = Some(Vector::recorded(self.after.vector(slot::SHADOW)));
        let Lamp { direction, distance, strength, sun } = self.lamp(light, position, u, recorded);
        let sources = self.sources();
        let density = if sun.is_zero() {
            Number::ZERO
        } else {
            Number::ONE / (Number::TWO * pi() * sun * sources)
        };
        let radiance = strength * (pi() * sources);
        LightSample { direction, distance, density, radiance, emitter: NO_EMITTER }
    }

    /// The direction towards a light, narrowed to the fenced direction in the recorded state if that is legal.
    fn narrowed_direction(&self, direction: Vector) -> Vector {
        let recorded = Vector::recorded(self.after.vector(slot::SHADOW));
        direction.zip(recorded, Number::narrowed)
    }

    fn emitter(&self, index: u32) -> Emitter {
        let at = index.saturating_mul(3);
        let numbers = |at: u32| self.emitter_words(at).map(f32::from_bits);
        let [_, _, probability, _] = numbers(at.saturating_add(1));
        let [r, g, b, _] = numbers(at.saturating_add(2));
        Emitter {
            sphere: numbers(at),
            probability: Number::recorded(probability),
            radiance: Vector::recorded([r, g, b]),
        }
    }

    /// The index of the first emitter whose word is at least `value`.
    fn find_emitter(&self, word: usize, value: u32) -> u32 {
        let count = self.lighting().emitter_count;
        let words = |index: u32| self.emitter_words(index.saturating_mul(3).saturating_add(1));
        let is_before = |index: u32| words(index)[word] < value;
        let (mut low, mut high) = (0, count);
        while low < high {
            let middle = low + (high - low) / 2;
            if is_before(middle) { low = middle + 1 } else { high = middle }
        }
        low.min(count.max(1) - 1)
    }

    /// The density with which a point samples directions towards a chosen emitter; 0 from inside.
    fn emitter_density(&mut self, emitter: &Emitter, position: Vector) -> Number {
        let [x, y, z, radius] = emitter.sphere;
        let radius = Number::recorded(radius);
        let distance = (Vector::recorded([x, y, z]) - position).fence().squared().sqrt();
        if !self.choices.decide(radius.is_less(distance)) {
            return Number::ZERO;
        }
        let k = cone_of_sphere(radius, distance.max(radius));
        emitter.probability / (Number::TWO * pi() * k)
    }

    /// The density with which light sampling would have chosen the emissive sphere that was hit.
    pub(super) fn density_of_hit_emitter(&mut self, id: u32, position: [f32; 3]) -> Number {
        if self.lighting().emitter_count == 0 {
            return Number::ZERO;
        }
        let found = self.emitter(self.find_emitter(0, id));
        self.emitter_density(&found, Vector::recorded(position)) / self.sources()
    }

    fn sample_emitter(&mut self, position: Vector, u: [u32; 2], choice: u32) -> LightSample {
        let emitter = self.find_emitter(1, choice);
        let found = self.emitter(emitter);
        let density = self.emitter_density(&found, position) / self.sources();
        let [x, y, z, radius] = found.sphere;
        let radius = Number::recorded(radius);
        let toward = Vector::recorded([x, y, z]) - position;
        let length = toward.fence().squared().max(Number::constant(1e-30)).sqrt();
        let k = cone_of_sphere(radius, length.max(radius));
        let axis = toward.fence().map(|c| c / length);
        let direction = axes_around(axis, self.choices).to_world(cone_direction(u, k));
        let direction = self.narrowed_direction(direction);
        let middle = toward.dot(direction);
        let foot = toward - direction * middle;
        let chord = (radius.squared() - foot.squared()).max(Number::ZERO).sqrt();
        let distance = (middle - chord).max(Number::ZERO);
        let radiance = if density.is_zero() {
            Vector::ZERO
        } else {
            let divisor = density.max(Number::constant(1e-30));
            found.radiance.map(|c| c / divisor)
        };
        LightSample { direction, distance, density, radiance, emitter }
    }

    fn sample_sky_light(&mut self, u: [u32; 2]) -> LightSample {
        let (direction, density) = self.sample_sky(u);
        let density = density / self.sources();
        let divisor = density.max(Number::constant(1e-30));
        let radiance = if density.is_zero() {
            Vector::ZERO
        } else {
            self.sky_radiance(direction).map(|c| c / divisor)
        };
        let distance = Number::known(NO_HIT.into());
        LightSample { direction, distance, density, radiance, emitter: NO_EMITTER }
    }

    /// The weight of light that a scattered ray hit, if light sampling would have chosen it with a density.
    pub(super) fn weight_of_hit_light(&mut self, light_density: Number) -> Number {
        let sampling = self.lighting().light_sampling;
        let is_sampled =
            !light_density.is_zero() && self.choices.decide(light_density.is_above_zero());
        if self.before.has(flag::FULL) || sampling == CHANCE || !is_sampled {
            return Number::ONE;
        }
        if sampling != MULTIPLE {
            return Number::ZERO;
        }
        let scattered = Number::recorded(self.before.number(slot::DIRECTION));
        scattered / (scattered + light_density).max(Number::constant(1e-30))
    }
}
