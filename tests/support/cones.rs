//! Scenes with cones and cylinders.

use pinhole::scene::cone::{Caps, Cone};
use pinhole::{LinearRgb, Scene, SphereArray};

/// Cones, cylinders and some spheres in a cube of side 2, with all kinds of ends.
pub(crate) fn mixed(spheres: usize, cones: usize, size: f64, seed: u64) -> Scene {
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
    Scene::from_shapes(SphereArray::F64(balls), &cones, LinearRgb::new([0.6, 0.5, 0.4]).unwrap().into()).unwrap()
}
