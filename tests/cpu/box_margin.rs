//! Tests that the margin of boxes suffices for any legal rounding. If the sphere test hits, the ray enters the sphere's
//! box before. `src/accel/slab.rs` has the proof, and the part of the margin that each error needs.

#![allow(clippy::print_stdout, reason = "the margin that is needed is a figure")]

use fastrand::Rng;
use pinhole::accel::SceneStatistics;
use pinhole::glam::DVec3;
use pinhole::internals::NO_HIT;
use pinhole::verify::TracedRay;

use crate::support::effort::tries;
use crate::support::legal_device::{Habit, LegalDevice};

/// The error of the length of a direction, in units of 2⁻²³. It is half of three roundings of the square, plus a root,
/// a reciprocal and a product.
const LENGTH_ERROR: f64 = 11.0;

/// A random direction.
fn unit(random: &mut Rng) -> DVec3 {
    let along = DVec3::from([0; 3].map(|_| random.f64() - 0.5));
    along / along.length().max(1e-30)
}

/// A ray in a scene whose box has the diagonal [`DIAGONAL`], and a sphere that the ray hits or nearly hits.
fn ray_and_sphere(random: &mut Rng) -> (TracedRay, [f32; 4]) {
    // Along diagonals and along axes, where all of the box's diagonal is between origin and sphere.
    let corner = |random: &mut Rng| match random.u32(0..4) {
        0 => DVec3::splat(0.57),
        1 => DVec3::new(0.99, 1e-3 * random.f64(), 1e-3 * random.f64()),
        2 => DVec3::new(0.99, 0.05, 0.02),
        _ => DVec3::from([0; 3].map(|_| random.f64() * 0.57)),
    };
    let radius = match random.u32(0..3) {
        0 => 0.5 * random.f64(),
        1 => 10_f64.powf(-6.0 * random.f64() - 0.5),
        _ => 0.3 + 0.2 * random.f64(),
    };
    let far = corner(random);
    let [origin, center] = match random.u32(0..3) {
        // From one end of the box to a sphere at the other.
        0 => [DVec3::ZERO, far * (1.0 - radius)],
        // From within the sphere, or from near its surface.
        1 => {
            let along = unit(random);
            let depth = match random.u32(0..3) {
                0 => radius * random.f64(),
                1 => radius * (1.0 - 10_f64.powf(-7.0 * random.f64())),
                _ => radius * (1.0 + 10_f64.powf(-7.0 * random.f64())),
            };
            [DVec3::splat(0.5) + depth * along, DVec3::splat(0.5)]
        }
        _ => [corner(random) * random.f64(), corner(random) * random.f64()],
    };
    // Aims at the points where the sphere touches its box, at the near side, or anywhere.
    let mut pole = DVec3::ZERO;
    pole[random.usize(0..3)] = -1.0;
    let (aim, off) = match random.u32(0..6) {
        0..3 => (pole + 10_f64.powf(-6.0 * random.f64()) * unit(random), 1.0),
        3 => (unit(random), 0.0),
        4 => (unit(random), random.f64()),
        // Near the silhouette.
        _ => (unit(random), 1.0 - 10_f64.powf(-7.0 * random.f64())),
    };
    let toward = center + off * radius * aim - origin;
    let sign = if random.u32(0..8) == 0 { -1.0 } else { 1.0 };
    let length = 1.0 + [-1.0, 0.0, 1.0][random.usize(0..3)] * LENGTH_ERROR / 8_388_608.0;
    let direction = sign * toward / toward.length().max(1e-30) * length;
    // Moves around the middle of the scene's frame, so that differences are rounded.
    let moved = DVec3::from([0; 3].map(|_| -random.f64()));
    let narrow = |v: DVec3| (DIAGONAL * v).as_vec3().to_array();
    let [x, y, z] = narrow(center + moved);
    let ray = TracedRay { origin: narrow(origin + moved), direction: direction.as_vec3().to_array(), distance: 0.0 };
    (ray, [x, y, z, (DIAGONAL * radius) as f32])
}

/// The distances at which a device finds that a ray enters a box and leaves it.
fn crossing(device: &mut LegalDevice, ray: &TracedRay, [low, high]: [[f32; 3]; 2]) -> [f32; 2] {
    let (mut entry, mut exit) = (0.0_f32, NO_HIT);
    for k in 0..3 {
        let size = ray.direction[k].abs().max(2_f32.powi(-40));
        let component = if ray.direction[k] >= 0.0 { size } else { -size };
        let inverse = device.divide(1.0, component);
        let mut distance = |plane: f32| {
            let away = device.add(plane, -ray.origin[k]);
            device.mul(away, inverse)
        };
        let (a, b) = (distance(low[k]), distance(high[k]));
        entry = entry.max(a.min(b));
        exit = exit.min(a.max(b));
    }
    [entry, exit]
}

/// The box of a sphere and a margin, rounded outwards.
fn around([x, y, z, radius]: [f32; 4], margin: f64) -> [[f32; 3]; 2] {
    let reach = f64::from(radius) + margin;
    let low = [x, y, z].map(|x| ((f64::from(x) - reach) as f32).next_down());
    let high = [x, y, z].map(|x| ((f64::from(x) + reach) as f32).next_up());
    [low, high]
}

/// The diagonal of the scene's box. It is just above a power of two, where an ULP is the largest fraction of a number.
const DIAGONAL: f64 = 1.02;

const UNIT: f64 = DIAGONAL / (1 << 24) as f64;

/// A ray, a sphere that it hits, and the rounding of the device that finds the hit.
struct Case {
    ray: TracedRay,
    sphere: [f32; 4],
    habit: Habit,
}

impl Case {
    /// The distance by which the ray enters the box of the sphere and a margin too late for the hit, or leaves it too
    /// early. `None` if the ray misses the sphere.
    fn late(&self, units: f64) -> Option<f32> {
        let mut device = LegalDevice { habit: self.habit, random: Rng::with_seed(1) };
        let t = device.intersect(&self.ray, self.sphere);
        let [entry, exit] = crossing(&mut device, &self.ray, around(self.sphere, units * UNIT));
        (t < NO_HIT).then(|| entry - exit.min(t))
    }

    /// Rounds each operation the other way, one after the other, where that makes the entry later.
    fn worsened(mut self) -> Self {
        let mut worst = self.late(0.0);
        for bit in 0..48 {
            let Habit::Chosen(bits) = self.habit else { return self };
            self.habit = Habit::Chosen(bits ^ 1 << bit);
            match self.late(0.0) {
                late if late > worst => worst = late,
                _ => self.habit = Habit::Chosen(bits),
            }
        }
        self
    }
}

#[test]
fn no_hit_of_a_device_that_rounds_as_it_likes_is_outside_of_its_box() {
    let margin = f64::from(SceneStatistics::of(&[[0.0, 0.0, 0.0, 0.5 * DIAGONAL as f32 / 3_f32.sqrt()]]).margin());
    assert!((margin / UNIT - 128.0).abs() < 0.01, "{}", margin / UNIT);
    let mut random = Rng::with_seed(11);
    // The number of hits, and the largest needed margin, in units.
    let (mut hits, mut needed) = (0, 0.0);
    let cases = tries(120_000);
    for _ in 0..cases {
        let (ray, sphere) = ray_and_sphere(&mut random);
        let habits = [Habit::Up, Habit::Down, Habit::Random, Habit::Chosen(random.u64(..))];
        for habit in habits {
            let case = Case { ray, sphere, habit }.worsened();
            let Some(late) = case.late(128.0) else { continue };
            assert!(late <= 0.0, "{ray:?}, {sphere:?}, {habit:?}: {late}");
            hits += 1;
            while case.late(needed).is_some_and(|late| late > 0.0) {
                needed += 1.0;
            }
        }
    }
    println!("{hits} hits; the largest margin that one of them needs is {needed} u of 128");
    assert!(hits > cases * 5 / 3, "{hits}");
    // The search works: errors are large, but below the sum of all errors in the proof.
    assert!((16.0..=68.0).contains(&needed), "{needed}");
}
