//! What the arithmetic and a camera need of all spheres of a scene of which only some are in memory.

use glam::{DVec3, Vec3};

use super::frame::{frame_origin, moved};
use crate::geometry::bounds::Bounds;

/// All spheres of a scene of which only a part is in memory. Every part shares the frame and the box of the whole, which
/// decide the arithmetic of rays, so that each sphere is hit at the same distance, to the bit, as in the whole scene.
///
/// It is made in two passes over the spheres: [`Whole::new`] needs the box of all of them, and [`Whole::add`] then needs
/// each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whole {
    /// The bounding box of all spheres as given, in world space.
    pub bounds: Bounds,
    /// The number of spheres.
    pub count: u64,
    /// The corner with the smallest coordinates of the box of all spheres as kernels see them, in the scene's frame.
    pub min: Vec3,
    /// The corner with the largest coordinates.
    pub max: Vec3,
    /// The corner with the smallest coordinates of the box of all centres, in the scene's frame.
    pub center_min: Vec3,
    /// The corner with the largest coordinates.
    pub center_max: Vec3,
    /// The smallest radius; `f32::MAX` without spheres.
    pub radius_min: f32,
    /// The largest radius.
    pub radius_max: f32,
    /// The sum of all radii.
    pub radius_sum: f64,
}

impl Whole {
    /// The whole of no spheres yet, in the frame of spheres with this bounding box.
    #[must_use]
    pub fn new(bounds: Bounds) -> Self {
        Self {
            bounds,
            count: 0,
            min: Vec3::MAX,
            max: Vec3::MIN,
            center_min: Vec3::MAX,
            center_max: Vec3::MIN,
            radius_min: f32::MAX,
            radius_max: 0.0,
            radius_sum: 0.0,
        }
    }

    /// The origin of the frame, in world space: that of [`Scene::from_parts`](super::Scene::from_parts) for all spheres.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        frame_origin(self.bounds)
    }

    /// A sphere (x, y, z, radius) in the frame, to the bit as a scene of all spheres has it.
    #[must_use]
    pub fn in_frame(&self, sphere: [f64; 4]) -> [f32; 4] {
        moved(sphere, self.origin())
    }

    /// Adds a sphere, which is in the frame.
    pub fn add(&mut self, [x, y, z, radius]: [f32; 4]) {
        let center = Vec3::new(x, y, z);
        self.count += 1;
        self.min = self.min.min(center - radius);
        self.max = self.max.max(center + radius);
        self.center_min = self.center_min.min(center);
        self.center_max = self.center_max.max(center);
        self.radius_min = self.radius_min.min(radius);
        self.radius_max = self.radius_max.max(radius);
        self.radius_sum += f64::from(radius);
    }

    /// Whether a sphere of the frame is inside the box.
    pub(super) fn contains(&self, [x, y, z, radius]: [f32; 4]) -> bool {
        let center = Vec3::new(x, y, z);
        (center - radius).cmpge(self.min).all() && (center + radius).cmple(self.max).all()
    }

    /// The mean radius; 0 without spheres.
    #[must_use]
    pub fn mean_radius(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.radius_sum / self.count as f64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::color::LinearRgb;
    use crate::scene::Scene;
    use crate::scene::sphere_array::SphereArray;

    fn spheres() -> Vec<[f64; 4]> {
        let mut rng = fastrand::Rng::with_seed(5);
        (0..1000)
            .map(|_| [1e6 + rng.f64(), rng.f64() - 0.5, 70.0 * rng.f64(), 0.01 + rng.f64()])
            .collect()
    }

    fn whole_of(spheres: &[[f64; 4]]) -> Whole {
        let bounds = spheres
            .iter()
            .map(|[x, y, z, radius]| Bounds::of_sphere(DVec3::new(*x, *y, *z), *radius))
            .reduce(Bounds::union)
            .unwrap();
        let mut whole = Whole::new(bounds);
        spheres.iter().for_each(|sphere| whole.add(whole.in_frame(*sphere)));
        whole
    }

    #[test]
    fn a_whole_has_the_frame_and_the_boxes_of_the_scene() {
        let spheres = spheres();
        let scene = Scene::from_f64(&spheres, LinearRgb::WHITE).unwrap();
        let whole = whole_of(&spheres);
        assert_eq!((whole.origin(), Some(whole.bounds)), (scene.origin(), scene.bounds()));
        assert!(whole.origin().x != 0.0);
        for (sphere, expected) in spheres.iter().zip(scene.spheres()) {
            assert_eq!(whole.in_frame(*sphere).map(f32::to_bits), expected.map(f32::to_bits));
        }
        let statistics = crate::accel::SceneStatistics::of(scene.spheres());
        assert_eq!((whole.min, whole.max), (statistics.min, statistics.max));
        let bits = |radii: [f32; 2]| radii.map(f32::to_bits);
        let expected = [statistics.radius_min, statistics.radius_max];
        assert_eq!(bits([whole.radius_min, whole.radius_max]), bits(expected));
        assert!((whole.mean_radius() - f64::from(statistics.radius_mean)).abs() < 1e-6);
    }

    /// A camera frames a part as it does the whole, if the part has the spheres that reach farthest.
    #[test]
    fn parts_know_the_box_the_plane_and_the_mean_radius_of_the_whole() {
        let flat: Vec<[f64; 4]> =
            (0..50).map(|i| [f64::from(i), f64::from(i * i), 2.0, 0.5]).collect();
        let whole = whole_of(&flat);
        let all = Scene::from_f64(&flat, LinearRgb::WHITE).unwrap();
        let some = vec![whole.in_frame(flat[0]), whole.in_frame(flat[49])];
        let part = Scene::part(whole, some, LinearRgb::WHITE.into()).unwrap();
        assert_eq!((part.origin(), part.bounds()), (all.origin(), all.bounds()));
        assert_eq!(part.subject().flat_axis(), Some(2));
        assert_eq!(part.subject().mean_radius(), Some(0.5));
        let directions = [DVec3::X, DVec3::NEG_ONE, DVec3::new(-0.3, 0.1, 2.0)];
        let supports = |scene: &Scene| scene.subject().supports(directions).map(f64::to_bits);
        assert_eq!(supports(&part), supports(&all));
        let beyond = vec![[0.0, 0.0, 1e9, 0.5]];
        assert!(Scene::part(whole, beyond, LinearRgb::WHITE.into()).is_err());
        assert!(Scene::part(whole, vec![[0.0, 0.0, 2.0, -0.5]], LinearRgb::WHITE.into()).is_err());
        let array = SphereArray::F32(Vec::new());
        assert_eq!(array.scene(LinearRgb::WHITE).unwrap().whole(), None);
    }
}
