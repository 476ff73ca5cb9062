//! The conversion of spheres from world space to f32 offsets in the frame of a scene, and the data of a whole scene
//! that rays and a camera need if only some spheres are in memory.

use glam::{DVec3, Vec3};

use super::cone::Cone;
#[cfg(feature = "run-file")]
use super::cone::check_in_frame;
use super::error::SceneError;
use super::shared::SharedShapes;
use crate::geometry::bounds::Bounds;
use crate::geometry::cone::ConeInFrame;
use crate::parallel;
use crate::scene::sphere::{self, Sphere};

/// Factor that shrinks offsets before they are checked, so that rounding alone does not push them out of range.
const FRAME_SLACK: f64 = 1.0 - 1.0 / (1 << 20) as f64;

pub(super) fn f64_parts(sphere: &Sphere) -> [f64; 4] {
    let [x, y, z] = sphere.center;
    [x, y, z, sphere.radius]
}

/// Returns an error for more shapes than there are ids.
pub(super) fn check_count(count: usize) -> Result<(), SceneError> {
    let most = u32::MAX;
    match count < most as usize {
        true => Ok(()),
        false => Err(SceneError::Invalid(format!("{count} spheres are too many; ids are u32 and {most} means a miss"))),
    }
}

/// Checks cones, and returns the bounding box of all.
pub(super) fn bounds_of_cones(cones: &[Cone]) -> Result<Option<Bounds>, SceneError> {
    let wrong = |(index, cone): (usize, &Cone)| Some(SceneError::Cone { index, error: cone.check().err()? });
    match cones.iter().enumerate().find_map(wrong) {
        Some(error) => Err(error),
        None => Ok(cones.iter().map(Cone::bounds).reduce(Bounds::union)),
    }
}

/// Converts checked cones to f32 in the frame at `origin`.
pub(super) fn cones_in_frame(cones: &[Cone], origin: DVec3) -> Result<Vec<ConeInFrame>, SceneError> {
    let in_frame =
        |(index, cone): (usize, &Cone)| cone.in_frame(origin).map_err(|error| SceneError::Cone { index, error });
    cones.iter().enumerate().map(in_frame).collect()
}

/// Checks cones that are in a frame.
#[cfg(feature = "run-file")]
pub(super) fn check_cones_in_frame(cones: &[ConeInFrame]) -> Result<(), SceneError> {
    let check = |(index, cone)| check_in_frame(cone).map_err(|error| SceneError::Cone { index, error });
    cones.iter().enumerate().try_for_each(check)
}

/// Checks the number of spheres and each sphere, and returns the bounding box of all.
pub(super) fn bounds_of_checked<T: Sync>(
    spheres: &[T],
    parts: impl Fn(&T) -> [f64; 4] + Sync,
) -> Result<Option<Bounds>, SceneError> {
    check_count(spheres.len())?;
    let of_chunk = |first: usize, chunk: &[T]| {
        let mut bounds: Option<Bounds> = None;
        for (offset, item) in chunk.iter().enumerate() {
            let sphere @ [x, y, z, radius] = parts(item);
            sphere::check(sphere).map_err(|error| SceneError::Sphere { index: first + offset, error })?;
            let of_sphere = Bounds::of_sphere(DVec3::new(x, y, z), radius);
            bounds = Some(bounds.map_or(of_sphere, |bounds| bounds.union(of_sphere)));
        }
        Ok(bounds)
    };
    // The results of the chunks are in input order, so that the error names the first invalid sphere.
    let chunks: Result<Vec<_>, _> = parallel::map_chunks(spheres, of_chunk).into_iter().collect();
    Ok(chunks?.into_iter().flatten().reduce(Bounds::union))
}

/// The origin of a frame, the spheres in it, and their bounding box in world space.
type InFrame = (DVec3, Vec<[f32; 4]>, Option<Bounds>);

/// Checks spheres, and converts them to f32 in the frame of the box that `of_all` makes of theirs.
pub(super) fn in_own_frame<T: Sync>(
    spheres: &[T],
    parts: impl Fn(&T) -> [f64; 4] + Sync,
    of_all: impl FnOnce(Option<Bounds>) -> Option<Bounds>,
) -> Result<InFrame, SceneError> {
    let bounds = of_all(bounds_of_checked(spheres, &parts)?);
    let origin = bounds.map_or(DVec3::ZERO, frame_origin);
    let narrow = parallel::try_map(spheres.len(), |i| moved(parts(&spheres[i]), origin));
    Ok((origin, narrow.map_err(|_| SceneError::Memory { count: spheres.len() })?, bounds))
}

/// Converts one sphere to f32 in the frame at `origin`.
pub(super) fn moved([x, y, z, radius]: [f64; 4], origin: DVec3) -> [f32; 4] {
    let offset = (DVec3::new(x, y, z) - origin).as_vec3();
    [offset.x, offset.y, offset.z, radius as f32]
}

/// The origin of a scene's frame. Along each axis it is zero if the centre of the data is no farther from the world's
/// origin than the longest side of its bounding box. Otherwise it is the centre of the data.
///
/// The centre is rounded to f32. Coordinates that are exact in f32 then stay exact after the move, because neither of
/// the two f32 numbers is more than twice the other (Sterbenz).
pub(super) fn frame_origin(bounds: Bounds) -> DVec3 {
    let width = bounds.size().max_element();
    let along = |center: f64| if center.abs() <= width { 0.0 } else { f64::from(center as f32) };
    DVec3::from(bounds.center().to_array().map(along))
}

/// A sphere of a frame for checking. [`FRAME_SLACK`] shrinks its offset, so that rounding does not invalidate a sphere
/// at the very limit.
pub(super) fn slackened(sphere: &[f32; 4]) -> [f64; 4] {
    let [x, y, z, radius] = sphere.map(f64::from);
    [x * FRAME_SLACK, y * FRAME_SLACK, z * FRAME_SLACK, radius]
}

/// The bounding box, in world space, of spheres in a frame.
pub(crate) fn bounds_in_frame(origin: DVec3, spheres: &[[f32; 4]]) -> Option<Bounds> {
    let of_sphere = |s: &[f32; 4]| {
        let [x, y, z, radius] = s.map(f64::from);
        Bounds::of_sphere(origin + DVec3::new(x, y, z), radius)
    };
    let of_chunk = |_: usize, chunk: &[[f32; 4]]| chunk.iter().map(of_sphere).reduce(Bounds::union);
    parallel::map_chunks(spheres, of_chunk).into_iter().flatten().reduce(Bounds::union)
}

impl SharedShapes {
    /// The bounding box, in world space, of the shapes in a frame at `origin`.
    pub(crate) fn bounds(&self, origin: DVec3) -> Option<Bounds> {
        let of_cone = |cone: &ConeInFrame| {
            let [low, high] = cone.corners();
            Bounds::between(origin + low, origin + high)
        };
        let of_spheres = bounds_in_frame(origin, &self.spheres);
        of_spheres.into_iter().chain(self.cones.iter().map(of_cone)).reduce(Bounds::union)
    }
}

/// Bounds and frame of a scene whose parts are loaded separately. All parts share them. They determine the arithmetic
/// of rays, so each sphere is hit at the same distance, to the bit, as in the whole scene.
///
/// It is made in two passes over the spheres. [`SceneExtent::new`] needs the box of all of them, and [`SceneExtent::add`] then
/// needs each one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneExtent {
    /// The bounding box of all spheres as given, in world space.
    pub bounds: Bounds,
    /// The number of spheres.
    pub count: u64,
    /// The corner with the smallest coordinates of the box of all spheres in f32, in the scene's frame.
    pub min: Vec3,
    /// The corner of that box with the largest coordinates.
    pub max: Vec3,
    /// The corner with the smallest coordinates of the box of all centres, in the scene's frame.
    pub center_min: Vec3,
    /// The corner of that box with the largest coordinates.
    pub center_max: Vec3,
    /// The smallest radius. `f32::MAX` without spheres.
    pub radius_min: f32,
    /// The largest radius.
    pub radius_max: f32,
    /// The sum of all radii.
    pub radius_sum: f64,
}

impl SceneExtent {
    /// A whole without spheres yet, in the frame of spheres with the given bounding box.
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

    /// The origin of the frame, in world space, as in [`Scene::from_parts`](super::Scene::from_parts) for all spheres.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        frame_origin(self.bounds)
    }

    /// Converts a sphere (x, y, z, radius) to the frame, to the bit as in a scene of all spheres.
    #[must_use]
    pub fn in_frame(&self, sphere: [f64; 4]) -> [f32; 4] {
        moved(sphere, self.origin())
    }

    /// Adds a sphere, given in the frame.
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

    /// The mean radius. 0 without spheres.
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
        (0..1000).map(|_| [1e6 + rng.f64(), rng.f64() - 0.5, 70.0 * rng.f64(), 0.01 + rng.f64()]).collect()
    }

    fn whole_of(spheres: &[[f64; 4]]) -> SceneExtent {
        let bounds = spheres
            .iter()
            .map(|[x, y, z, radius]| Bounds::of_sphere(DVec3::new(*x, *y, *z), *radius))
            .reduce(Bounds::union)
            .unwrap();
        let mut whole = SceneExtent::new(bounds);
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

    /// A camera frames a part like the whole, if the part has the spheres that reach farthest.
    #[test]
    fn parts_know_the_box_the_plane_and_the_mean_radius_of_the_whole() {
        let flat: Vec<[f64; 4]> = (0..50).map(|i| [f64::from(i), f64::from(i * i), 2.0, 0.5]).collect();
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
