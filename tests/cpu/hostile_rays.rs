//! Rays and spheres for which rounding matters: tangents, walls, ties, sizes far apart.

use fastrand::Rng;
use pinhole::glam::{DVec3, Vec3};

/// A ray and a few spheres, exactly as a device has them.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    pub(crate) spheres: Vec<[f32; 4]>,
}

fn unit(random: &mut Rng) -> DVec3 {
    loop {
        let v = DVec3::from([0; 3].map(|_| random.f64() * 2.0 - 1.0));
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize_or(DVec3::X);
        }
    }
}

/// Ten to a power between two.
fn decades(random: &mut Rng, low: f64, high: f64) -> f64 {
    10_f64.powf(low + (high - low) * random.f64())
}

/// As normalized in f32, or a little off unit length.
fn narrow_direction(direction: DVec3, random: &mut Rng) -> [f32; 3] {
    let off = 1.0 + (random.f64() - 0.5) * 2e-6 * f64::from(random.u8(0..2));
    (direction * off).as_vec3().to_array()
}

fn sphere(center: DVec3, radius: f64) -> [f32; 4] {
    let center = center.as_vec3();
    [center.x, center.y, center.z, radius as f32]
}

/// A sphere that a ray passes at nearly the distance of its radius, ahead by `along`.
fn nearly_tangent(origin: DVec3, direction: DVec3, along: f64, random: &mut Rng) -> [f32; 4] {
    let radius = along * decades(random, -4.0, 0.5);
    let across = direction.cross(unit(random)).normalize_or(direction.any_orthonormal_vector());
    let off = 1.0 + (random.f64() - 0.5) * decades(random, -9.0, -2.0);
    sphere(origin + along * direction + radius * off * across, radius)
}

/// A sphere on whose wall a ray nearly starts.
fn nearly_on_wall(origin: DVec3, random: &mut Rng) -> [f32; 4] {
    let radius = decades(random, -3.0, 3.0);
    let off = 1.0 + (random.f64() - 0.5) * decades(random, -9.0, -3.0);
    sphere(origin + unit(random) * radius * off, radius)
}

pub(crate) fn case(random: &mut Rng) -> Case {
    let size = match random.u8(0..8) {
        0 => 2_f64.powi(50),
        1 => 2_f64.powi(-50),
        _ => 1.0,
    };
    let offset = match random.u8(0..8) {
        0 => unit(random) * decades(random, 0.0, 6.0),
        _ => DVec3::ZERO,
    };
    let near = |random: &mut Rng| offset + DVec3::from([0; 3].map(|_| random.f64() * 2.0 - 1.0));
    let origin = near(random) * if random.u8(0..4) == 0 { 100.0 } else { 1.0 };
    let target = near(random);
    let aimed = match random.u8(0..8) {
        0 => DVec3::AXES[random.usize(0..3)],
        _ => (target - origin).normalize_or(DVec3::X),
    };
    let direction = narrow_direction(aimed, random);
    let exact = Vec3::from(direction).as_dvec3();
    let origin = origin.as_vec3().as_dvec3();
    let distance = (target - origin).length();
    let mut spheres: Vec<[f32; 4]> = Vec::new();
    for _ in 0..random.usize(1..5) {
        let made = match random.u8(0..6) {
            0 => nearly_tangent(origin, exact, distance * (0.1 + random.f64()), random),
            1 => nearly_on_wall(origin, random),
            // A tie: as far along the ray as another, or the same again.
            2 if !spheres.is_empty() => {
                let [x, y, z, radius] = spheres[random.usize(0..spheres.len())];
                let center = DVec3::new(x.into(), y.into(), z.into());
                let grown = f64::from(radius) * decades(random, -1.0, 1.0);
                let off = (random.f64() - 0.5) * distance * decades(random, -9.0, -5.0);
                sphere(center + exact * (grown - f64::from(radius) + off), grown)
            }
            3 if !spheres.is_empty() => spheres[random.usize(0..spheres.len())],
            // Aimed at, and of any size.
            4 => sphere(origin + exact * distance, distance * decades(random, -5.0, 0.5)),
            _ => sphere(near(random), decades(random, -3.0, 0.0)),
        };
        spheres.push(made);
    }
    let scaled = |v: DVec3| (v * size).as_vec3().to_array();
    let spheres = spheres
        .into_iter()
        .map(|[x, y, z, radius]| {
            let [x, y, z] = scaled(DVec3::new(x.into(), y.into(), z.into()));
            [x, y, z, (f64::from(radius) * size) as f32]
        })
        .collect();
    Case { origin: scaled(origin), direction, spheres }
}
