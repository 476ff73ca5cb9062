//! Rays that a structure may lose a sphere along, and the answer of trying every sphere.

use fastrand::Rng;
use pinhole::glam::Vec3;
use pinhole::internals::{NO_HIT, Nearest, RayF32, intersect_sphere};

use crate::support::spheres::Spheres;

/// What a host does: low and high corner of the scene's box.
pub(crate) fn corners(spheres: &Spheres) -> (Vec3, Vec3) {
    let corner = |sign: f32| {
        move |&[x, y, z, radius]: &[f32; 4]| Vec3::new(x, y, z) + Vec3::splat(sign * radius)
    };
    let low = spheres.iter().map(corner(-1.0)).reduce(Vec3::min).unwrap_or(Vec3::ZERO);
    let high = spheres.iter().map(corner(1.0)).reduce(Vec3::max).unwrap_or(Vec3::ONE);
    (low, high)
}

pub(crate) fn brute(spheres: &Spheres, ray: &RayF32) -> Nearest {
    let mut nearest = Nearest::NONE;
    for (id, sphere) in spheres.iter().enumerate() {
        let t = intersect_sphere(ray, *sphere);
        if t < NO_HIT {
            nearest.offer(t, id as u32);
        }
    }
    nearest
}

fn unit(rng: &mut Rng) -> Vec3 {
    loop {
        let v = Vec3::from_array([(); 3].map(|()| rng.f32() * 2.0 - 1.0));
        if (0.01..1.0).contains(&v.length_squared()) {
            return v / v.length();
        }
    }
}

/// A point of the box, often on its surface.
fn point(rng: &mut Rng, (low, high): (Vec3, Vec3)) -> Vec3 {
    let share = |rng: &mut Rng| match rng.u32(0..4) {
        0 => 0.0,
        1 => 1.0,
        _ => rng.f32(),
    };
    low + (high - low) * Vec3::new(share(rng), share(rng), share(rng))
}

pub(crate) fn rays(rng: &mut Rng, spheres: &Spheres, count: usize) -> Vec<RayF32> {
    let bounds = corners(spheres);
    let axis = |rng: &mut Rng| {
        let mut direction = Vec3::ZERO;
        direction[rng.usize(0..3)] = if rng.bool() { 1.0 } else { -1.0 };
        direction
    };
    let some_sphere = |rng: &mut Rng| match spheres.len() {
        0 => [0.5, 0.5, 0.5, 0.1],
        n => spheres[rng.usize(0..n)],
    };
    (0..count)
        .map(|i| {
            let [x, y, z, radius] = some_sphere(rng);
            let center = Vec3::new(x, y, z);
            let (origin, direction) = match i % 8 {
                0 => (point(rng, bounds), unit(rng)),
                // Along an axis, often along a face of the box: exact zeros, of both signs.
                1 => (point(rng, bounds), axis(rng) * 1.0),
                2 => (point(rng, bounds), -axis(rng)),
                // In a plane of two axes.
                3 => {
                    let mut direction = unit(rng);
                    direction[rng.usize(0..3)] = 0.0;
                    (point(rng, bounds), direction.normalize_or(Vec3::X))
                }
                // From within a sphere, and from its wall.
                4 => (center + unit(rng) * (radius * rng.f32()), unit(rng)),
                5 => (center + unit(rng) * radius, unit(rng)),
                // At a sphere, and past its rim as near as f32 says.
                6 => {
                    let origin = point(rng, bounds);
                    (origin, (center - origin).normalize_or(Vec3::Y))
                }
                _ => {
                    let origin = point(rng, bounds);
                    let rim = center + unit(rng).any_orthonormal_vector() * radius;
                    (origin, (rim - origin).normalize_or(Vec3::Z))
                }
            };
            RayF32 { origin, direction }
        })
        .collect()
}

pub(crate) fn assert_same(found: Nearest, expected: Nearest, name: &str, ray: &RayF32) {
    assert_eq!(
        (found.id, found.t.to_bits()),
        (expected.id, expected.t.to_bits()),
        "{name}: {found:?}, not {expected:?}, along {ray:?}"
    );
}
