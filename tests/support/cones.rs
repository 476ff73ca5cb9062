//! Scenes with cones and cylinders.

use fastrand::Rng;

use pinhole::scene::cone::{Caps, Cone};
use pinhole::{LinearRgb, Scene, SphereArray};

/// Cones, cylinders and some spheres in a cube of side 2, with all kinds of ends.
pub(crate) fn mixed(spheres: usize, cones: usize, size: f64, seed: u64) -> Scene {
    let (balls, cones) = mixed_shapes(spheres, cones, size, seed);
    Scene::from_shapes(SphereArray::F64(balls), &cones, LinearRgb::new([0.6, 0.5, 0.4]).unwrap().into()).unwrap()
}

/// The shapes of such a scene.
pub(crate) fn mixed_shapes(spheres: usize, cones: usize, size: f64, seed: u64) -> (Vec<[f64; 4]>, Vec<Cone>) {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut place = |reach: f64| [0; 3].map(|_| reach * (2.0 * random.f64() - 1.0));
    let balls: Vec<[f64; 4]> = (0..spheres)
        .map(|_| {
            let [x, y, z] = place(1.0);
            [x, y, z, 0.3 * size]
        })
        .collect();
    let cones: Vec<Cone> = (0..cones)
        .map(|number| {
            let (start, along) = (place(1.0), place(2.0 * size));
            let end = [0, 1, 2].map(|axis| start[axis] + along[axis]);
            let radius = 0.2 * size;
            let cone = match number % 4 {
                0 => Cone::new(start, end, [radius, 0.0]),
                1 => Cone::new(start, end, [0.5 * radius, radius]),
                _ => Cone::cylinder(start, end, 0.5 * radius),
            };
            cone.with_caps([Caps::Both, Caps::Both, Caps::None, Caps::First, Caps::Second][number % 5])
        })
        .collect();
    (balls, cones)
}

/// Short cones crowded in a few places, needles across the whole scene and one large open cylinder around all.
pub(crate) fn crowded(seed: u64) -> Scene {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut cones = vec![Cone::cylinder([0.0, -1.5, 0.0], [0.0, 1.5, 0.0], 1.4).with_caps(Caps::None)];
    let mut place = |reach: f64| [0; 3].map(|_| reach * (2.0 * random.f64() - 1.0));
    for _ in 0..6 {
        let middle = place(0.9);
        for _ in 0..500 {
            let (start, along) = (place(0.04), place(0.01));
            let start = [0, 1, 2].map(|axis| middle[axis] + start[axis]);
            cones.push(Cone::new(start, [0, 1, 2].map(|axis| start[axis] + along[axis]), [0.002, 0.001]));
        }
    }
    cones.extend((0..100).map(|_| Cone::cylinder(place(1.0), place(1.0), 0.002)));
    let color = LinearRgb::new([0.6, 0.5, 0.4]).unwrap();
    Scene::from_shapes(SphereArray::F64(Vec::new()), &cones, color.into()).unwrap()
}

/// A scene of any size at any place, with what is hard: cones and cylinders that are parallel to an axis, needles and
/// discs, some in one place or with common ends, tangent ones on a grid, tips, radii that hardly differ, and spheres.
/// Returns also the middle and the size.
pub(crate) fn hostile(random: &mut Rng) -> (Scene, [f64; 3], f64) {
    let size = 10.0_f64.powi(random.i32(-3..4));
    let far = if random.u32(..4) == 0 { 100.0 * size } else { 0.0 };
    let middle = [0; 3].map(|_| far * (random.f64() - 0.5));
    let on_grid = random.bool();
    let place = |random: &mut Rng| {
        middle.map(|middle| {
            let at = 8.0 * random.f64() - 4.0;
            middle + size * if on_grid { 0.5 * (2.0 * at).round() } else { at }
        })
    };
    let count = random.usize(1..40);
    let places: Vec<[f64; 3]> = (0..=count).map(|_| place(random)).collect();
    let (mut balls, mut cones) = (Vec::new(), Vec::new());
    for index in 0..count {
        let mut start = places[index];
        if random.u32(..5) == 0 {
            let [x, y, z] = start;
            balls.push([x, y, z, size * [0.25, 0.5, 0.01 + random.f64()][random.usize(..3)]]);
            continue;
        }
        let mut end = places[index + 1];
        match random.u32(..5) {
            0 => {
                end = start;
                end[random.usize(..3)] += size * [-1.0, 0.5, 1.0, 2.0][random.usize(..4)];
            }
            1 => (start, end) = (places[0], places[1]),
            _ => {}
        }
        let length = [0, 1, 2].map(|axis| end[axis] - start[axis]).iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
        if length == 0.0 {
            continue;
        }
        let aspect = if random.u32(..3) == 0 { 8.0 * random.f64() - 4.0 } else { 1.3 * random.f64() };
        let radius = match random.u32(..4) {
            0 if on_grid => 0.25 * size,
            _ => (length * 0.99 / 10.0_f64.powf(aspect)).min(3.0 * size),
        };
        let other = [radius, 0.0, radius * random.f64(), radius * (1.0 + 1e-6)][random.usize(..4)];
        let mut radii = [radius, other];
        random.shuffle(&mut radii);
        let cone = Cone::new(start, end, radii);
        let caps = [Caps::Both, Caps::None, Caps::First, Caps::Second][random.usize(..4)];
        cones.extend(cone.check().is_ok().then(|| cone.with_caps(caps)));
    }
    let color = LinearRgb::new([0.6, 0.5, 0.4]).unwrap();
    (Scene::from_shapes(SphereArray::F64(balls), &cones, color.into()).unwrap(), middle, size)
}
