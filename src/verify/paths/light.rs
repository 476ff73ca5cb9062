//! The check of light sampling at a surface, and of light from infinitely far away. The WGSL twins are
//! `shaders/path/direct.wgsl`, `by_chance.wgsl`, `sky.wgsl`, `environment.wgsl` and `scene/emitters.wgsl`.

use crate::camera::sampling;
use crate::light::codes::lamp::{DIRECTIONAL, HEAD};
use crate::light::codes::material::DIELECTRIC;
use crate::light::codes::sampling::{CHANCE, MULTIPLE};
use crate::recording::NO_HIT;
use crate::recording::lit::{NO_EMITTER, UploadedSky, flag, slot};
use crate::verify::lit::certificate::LitStage;
use crate::verify::lit::judge::{Mismatch, Name};
use crate::verify::lit::kernel::{Kernel, unit};
use crate::verify::lit::sampling::{Lamp, axes_around, cone_direction, cone_of_sphere, pi};
use crate::verify::number::{Number, Vector, atan2_turns, sin_cos_turns};
use crate::verify::paths::kernel::{KEPT, Surface};

/// A sample of a light source, seen from a surface.
struct LightSample {
    direction: Vector,
    distance: Number,
    /// Density of the direction, if scattered rays can hit the light as well; 0 for other lights.
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

const DIRECTION: Name = (LitStage::Light, "the direction towards the light");
const DISTANCE: Name = (LitStage::Light, "the distance to the light");
const EMITTER: Name = (LitStage::Light, "the sampled emitter");

impl Kernel<'_> {
    /// The light of lamps at the eye, which reaches only surfaces that the camera sees.
    pub(crate) fn head_light(&mut self, at: &Surface, is_seen: bool) -> Vector {
        if !is_seen || at.material.kind == DIELECTRIC {
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

    pub(crate) fn sample_light(&mut self, at: &Surface, through: Vector) -> Result<(), Mismatch> {
        let lighting = self.lighting();
        if lighting.source_count == 0 {
            self.write_bits(EMITTER, [slot::DEPARTURE, 3], NO_EMITTER)?;
            return self.same(KEPT, &[slot::SHADOW, slot::PENDING]);
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
        self.write(DIRECTION, slot::SHADOW, found.direction, 0.0)?;
        self.write_bits(EMITTER, [slot::DEPARTURE, 3], found.emitter)?;

        let color = Vector::recorded(at.vertex.color);
        let toward = at.axes.to_local(found.direction);
        let r = self.reflect_toward(&at.material, color, at.out, toward);
        let mut light = through.times(r.value).times(found.radiance);
        if lighting.light_sampling == MULTIPLE && self.choices.decide(found.density.is_above_zero()) {
            let all = (found.density + r.density).max(Number::constant(1e-30));
            light = light * (found.density / all);
        }
        let is_open = self.is_open(at, &found, light);
        let (light, open, distance) =
            if is_open { (light, Number::ONE, found.distance) } else { (Vector::ZERO, Number::ZERO, Number::ZERO) };
        self.write_number(DISTANCE, [slot::SHADOW, 3], distance, 0.0)?;
        self.write_light(light, open)
    }

    /// Whether light may arrive, so that occlusion must be tested.
    fn is_open(&mut self, at: &Surface, found: &LightSample, light: Vector) -> bool {
        let vertex = &at.vertex;
        if !self.choices.decide(light.largest().is_above_zero()) {
            return false;
        }
        if vertex.is_back {
            let exit = vertex.exit_distance(found.direction, self.choices);
            if self.choices.decide(exit.is_less(found.distance)) {
                return false;
            }
        }
        if vertex.is_shape() {
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
        let recorded = self.recorded(slot::SHADOW);
        let Lamp { direction, distance, strength, sun } = self.lamp(light, position, u, recorded);
        let sources = self.sources();
        let density = if sun.is_zero() { Number::ZERO } else { Number::ONE / (Number::TWO * pi() * sun * sources) };
        let radiance = strength * (pi() * sources);
        LightSample { direction, distance, density, radiance, emitter: NO_EMITTER }
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

    /// The density with which a point samples directions towards a chosen emitter; 0 inside the emitter.
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
    pub(crate) fn density_of_hit_emitter(&mut self, id: u32, position: Vector) -> Number {
        if self.lighting().emitter_count == 0 {
            return Number::ZERO;
        }
        let found = self.emitter(self.find_emitter(0, id));
        self.emitter_density(&found, position) / self.sources()
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
        // Narrowed to the fenced direction in the recorded state, if it is legal.
        let recorded = self.recorded(slot::SHADOW).unwrap_or(direction);
        let direction = direction.zip(recorded, Number::narrowed);
        let middle = toward.dot(direction);
        let foot = toward - direction * middle;
        let chord = (radius.squared() - foot.squared()).max(Number::ZERO).sqrt();
        let distance = (middle - chord).max(Number::ZERO);
        let radiance = per_density(density, || found.radiance);
        LightSample { direction, distance, density, radiance, emitter }
    }

    fn sample_sky_light(&mut self, u: [u32; 2]) -> LightSample {
        let (direction, density) = self.sample_sky(u);
        let density = density / self.sources();
        let radiance = per_density(density, || self.sky_radiance(direction));
        let distance = Number::known(NO_HIT.into());
        LightSample { direction, distance, density, radiance, emitter: NO_EMITTER }
    }

    /// The weight of light that a scattered ray hit, if light sampling would have chosen it with a density.
    pub(crate) fn weight_of_hit_light(&mut self, light_density: Number) -> Number {
        let sampling = self.lighting().light_sampling;
        let is_sampled = !light_density.is_zero() && self.choices.decide(light_density.is_above_zero());
        if self.before.has(flag::FULL) || sampling == CHANCE || !is_sampled {
            return Number::ONE;
        }
        if sampling != MULTIPLE {
            return Number::ZERO;
        }
        let scattered = self.before.number(slot::DIRECTION);
        scattered / (scattered + light_density).max(Number::constant(1e-30))
    }
}

/// Radiance divided by the density of its direction.
fn per_density(density: Number, radiance: impl FnOnce() -> Vector) -> Vector {
    if density.is_zero() {
        return Vector::ZERO;
    }
    let divisor = density.max(Number::constant(1e-30));
    radiance().map(|c| c / divisor)
}

impl Kernel<'_> {
    /// The radiance along a ray that hits no surface, times its weight.
    pub(crate) fn light_of_miss(&mut self) -> Vector {
        let lighting = self.lighting();
        let is_seen = !self.before.has(flag::SCATTERED);
        let is_transparent = lighting.flags & flag::TRANSPARENT != 0;
        if is_seen && is_transparent {
            return Vector::ZERO;
        }
        if is_seen && lighting.flags & flag::SKY_SEEN == 0 {
            return Vector::recorded(lighting.background);
        }
        let sources = Number::known(lighting.source_count.max(1).into());
        let direction = self.before.vector(slot::DIRECTION);
        let density = self.sky_density(direction) / sources;
        let weight = self.weight_of_hit_light(density);
        let mut sum = self.sky_radiance(direction) * weight;
        for light in 0..lighting.light_count {
            let [x, y, z, _] = self.table_numbers(3 * light);
            let [r, g, b, k] = self.table_numbers(3 * light + 1);
            if self.table(3 * light)[3] != DIRECTIONAL || k <= 0.0 {
                continue;
            }
            let k = Number::recorded(k);
            let aside = (direction - Vector::recorded([x, y, z])).squared();
            if !self.choices.decide(aside.is_less(Number::TWO * k)) {
                continue;
            }
            let weight = self.weight_of_hit_light(Number::ONE / (Number::TWO * pi() * k * sources));
            let size = k * (Number::TWO - k);
            sum = sum + Vector::recorded([r, g, b]).map(|c| c / size) * weight;
        }
        sum
    }

    /// The image of the sky, if there is one.
    fn image(&self) -> Option<&UploadedSky> {
        self.inputs.sky.as_ref()
    }

    pub(crate) fn sky_radiance(&mut self, direction: Vector) -> Vector {
        let lighting = self.lighting();
        if self.image().is_none() {
            let height = direction.0[1];
            let is_down = self.choices.decide(height.is_less(Number::ZERO));
            let end = Vector::recorded(if is_down { lighting.nadir } else { lighting.zenith });
            let along = height.abs();
            return Vector::recorded(lighting.horizon) * (Number::ONE - along) + end * along;
        }
        let [column, row] = self.texel(direction);
        let at = row as usize * lighting.environment_size[0] as usize + column as usize;
        let texel = self.image().and_then(|image| image.texels.get(at)).copied();
        Vector::recorded(texel.unwrap_or_default()) * Number::recorded(lighting.environment_strength)
    }

    fn sky_density(&mut self, direction: Vector) -> Number {
        if self.image().is_none() {
            return Number::ZERO;
        }
        let texel = self.texel(direction);
        self.density_of(texel)
    }

    /// x and z after a rotation about +y.
    fn turned(&self, [x, z]: [Number; 2], sign: f64) -> [Number; 2] {
        let [cosine, sine] = self.lighting().environment_rotation.map(Number::recorded);
        let sine = Number::known(sign) * sine;
        [cosine * x + sine * z, cosine * z - sine * x]
    }

    /// Column and row of the texel in a direction.
    fn texel(&mut self, direction: Vector) -> [u32; 2] {
        let Vector([x, y, z]) = direction;
        let [x, z] = self.turned([x, z], -1.0);
        let across = atan2_turns(x, -z, self.choices) + Number::HALF;
        let level = (x.squared() + z.squared()).sqrt();
        let down = Number::TWO * atan2_turns(level, y, self.choices);
        let [width, height] = self.lighting().environment_size;
        [(across, width), (down, height)].map(|(part, count)| {
            // Negative numbers become zero.
            let all = (part * Number::known(count.into())).max(Number::ZERO);
            let texel = self.choices.pick(all.floor());
            (texel as u32).min(count.max(1) - 1)
        })
    }

    fn share(&self, at: usize) -> f64 {
        let share = self.image().and_then(|image| image.shares.get(at));
        share.copied().unwrap_or_default().into()
    }

    /// Index of the first entry of the cumulative table of a row's columns.
    fn columns(&self, row: u32) -> usize {
        let [width, height] = self.lighting().environment_size.map(|side| side as usize);
        height + 1 + row as usize * (width + 1)
    }

    fn density_of(&mut self, [column, row]: [u32; 2]) -> Number {
        let [width, height] = self.lighting().environment_size.map(f64::from);
        let entry = self.columns(row) + column as usize;
        // The shares are multiples of 2^-24 below 1, so the difference is exact.
        let share = |at: usize| Number::known(self.share(at + 1) - self.share(at));
        let (x, y) = (share(entry), share(row as usize));
        let height = Number::known(height);
        let middle = Number::known(f64::from(2 * row + 1)) / (Number::known(4.0) * height);
        let [first, _] = sin_cos_turns(middle, self.choices);
        let [second, _] = sin_cos_turns(Number::known(0.25) / height, self.choices);
        let all = Number::constant(12.566_371) / Number::known(width) * (first * second);
        x * (y / all)
    }

    /// The last entry of a cumulative table, except its end, that is at most `chance`.
    fn chosen(&self, first: usize, count: u32, chance: f64) -> u32 {
        let (mut low, mut high) = (0, count);
        for _ in 0..12 {
            let middle = (low + high) >> 1;
            if self.share(first + middle as usize) <= chance { low = middle } else { high = middle }
        }
        low
    }

    /// A sampled direction, and its density.
    pub(crate) fn sample_sky(&mut self, u: [u32; 2]) -> (Vector, Number) {
        if self.image().is_none() {
            return (Vector::ZERO, Number::ZERO);
        }
        let [width, height] = self.lighting().environment_size;
        let chance = u.map(sampling::unit);
        let row = self.chosen(0, height, chance[1]);
        let columns = self.columns(row);
        let column = self.chosen(columns, width, chance[0]);
        let ends = |at: usize| [self.share(at), self.share(at + 1)];
        let [left, right] = ends(columns + column as usize);
        let [top, bottom] = ends(row as usize);
        let share = |low: f64, high: f64| Number::known((high - low).max(0.5_f64.powi(24)));
        let rest = u.map(|bits| Number::known((f64::from(bits & 0xff) + 0.5) * 0.5_f64.powi(32)));
        let along = (Number::known(chance[0]) - Number::known(left) + rest[0]) / share(left, right);
        let along = along.min(Number::ONE);
        let across = (Number::known(column.into()) + along) / Number::known(width.into());
        let [sine, cosine] = sin_cos_turns(across - Number::HALF, self.choices);
        // The angle is measured from the nearer pole, as sin² of half the colatitude.
        let is_upper = 2 * row < height;
        let from_pole = if is_upper { row } else { height - 1 - row };
        let into = if is_upper {
            Number::known(chance[1]) - Number::known(top) + rest[1]
        } else {
            Number::known(bottom) - Number::known(chance[1]) - rest[1]
        };
        let down = (into / share(top, bottom)).clamp(0.0, 1.0);
        let mut edge = |row: u32| {
            let turns = Number::known(row.into()) / Number::known(f64::from(4 * height));
            let [sine, _] = sin_cos_turns(turns, self.choices);
            sine.squared()
        };
        let [low, high] = [edge(from_pole), edge(from_pole + 1)];
        let square = low + down * (high - low);
        let radius = Number::TWO * (square * (Number::ONE - square)).max(Number::ZERO).sqrt();
        let y = Number::ONE - Number::TWO * square;
        let y = if is_upper { y } else { -y };
        let [x, z] = self.turned([radius * sine, -(radius * cosine)], 1.0);
        (Vector([x, y, z]), self.density_of([column, row]))
    }
}
