//! The check of light from infinitely far away. The WGSL twins are `shaders/path/by_chance.wgsl`, `sky.wgsl` and
//! `environment.wgsl`.

use crate::camera::sampling::unit;
use crate::light::codes::lamp::DIRECTIONAL;
use crate::verify::lit::kernel::Kernel;
use crate::verify::lit::recording::{UploadedSky, flag, slot};
use crate::verify::lit::warp::pi;
use crate::verify::number::{Number, Vector, atan2_turns, sin_cos_turns};

impl Kernel<'_> {
    /// The radiance along a ray that hits no surface, times its weight.
    pub(super) fn light_of_miss(&mut self) -> Vector {
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
        let direction = Vector::recorded(self.before.vector(slot::DIRECTION));
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

    pub(super) fn sky_radiance(&mut self, direction: Vector) -> Vector {
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
        Vector::recorded(texel.unwrap_or_default())
            * Number::recorded(lighting.environment_strength)
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
    pub(super) fn sample_sky(&mut self, u: [u32; 2]) -> (Vector, Number) {
        if self.image().is_none() {
            return (Vector::ZERO, Number::ZERO);
        }
        let [width, height] = self.lighting().environment_size;
        let chance = u.map(unit);
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
        // Measured from the nearer pole by sin² of half the colatitude.
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
