//! The conversion of spheres from world space to f32 offsets in the frame of a scene.

use glam::DVec3;

use super::SceneError;
use crate::geometry::bounds::Bounds;
use crate::parallel;
use crate::scene::sphere::{self, Sphere};

/// Factor that shrinks offsets before they are checked, so that rounding alone does not push them out of range.
const FRAME_SLACK: f64 = 1.0 - 1.0 / (1 << 20) as f64;

pub(super) fn f64_parts(sphere: &Sphere) -> [f64; 4] {
    let [x, y, z] = sphere.center;
    [x, y, z, sphere.radius]
}

/// Checks the number of spheres and each sphere, and returns the bounding box of all.
pub(super) fn bounds_of_checked<T: Sync>(
    spheres: &[T],
    parts: impl Fn(&T) -> [f64; 4] + Sync,
) -> Result<Option<Bounds>, SceneError> {
    if spheres.len() >= u32::MAX as usize {
        return Err(SceneError::TooMany { count: spheres.len() });
    }
    let of_chunk = |first: usize, chunk: &[T]| {
        let mut bounds: Option<Bounds> = None;
        for (offset, item) in chunk.iter().enumerate() {
            let sphere @ [x, y, z, radius] = parts(item);
            sphere::check(sphere)
                .map_err(|error| SceneError::Sphere { index: first + offset, error })?;
            let of_sphere = Bounds::of_sphere(DVec3::new(x, y, z), radius);
            bounds = Some(bounds.map_or(of_sphere, |bounds| bounds.union(of_sphere)));
        }
        Ok(bounds)
    };
    // The results of the chunks are in input order, so that the error names the first invalid sphere.
    let chunks: Result<Vec<_>, _> = parallel::map_chunks(spheres, of_chunk).into_iter().collect();
    Ok(chunks?.into_iter().flatten().reduce(Bounds::union))
}

/// Converts spheres to f32 in the frame at `origin`.
pub(super) fn narrowed<T: Sync>(
    spheres: &[T],
    parts: impl Fn(&T) -> [f64; 4] + Sync,
    origin: DVec3,
) -> Result<Vec<[f32; 4]>, SceneError> {
    parallel::try_map(spheres.len(), |i| moved(parts(&spheres[i]), origin))
        .map_err(|_| SceneError::Memory { count: spheres.len() })
}

/// Converts one sphere to f32 in the frame at `origin`.
pub(super) fn moved([x, y, z, radius]: [f64; 4], origin: DVec3) -> [f32; 4] {
    let offset = (DVec3::new(x, y, z) - origin).as_vec3();
    [offset.x, offset.y, offset.z, radius as f32]
}

/// The origin of a scene's frame. Along each axis it is zero if the centre of the data is no farther from the world's
/// origin than the longest side of its bounding box; otherwise it is the centre of the data.
///
/// The centre is rounded to f32. Coordinates that are exact in f32 then stay exact after the move, because neither of
/// the two f32 numbers is more than twice the other (Sterbenz).
pub(super) fn frame_origin(bounds: Bounds) -> DVec3 {
    let width = bounds.size().max_element();
    let along = |center: f64| if center.abs() <= width { 0.0 } else { f64::from(center as f32) };
    DVec3::from(bounds.center().to_array().map(along))
}

/// A sphere of a frame for checking, with its offset shrunk by [`FRAME_SLACK`] so that rounding does not invalidate a
/// sphere at the very limit.
pub(super) fn slackened(sphere: &[f32; 4]) -> [f64; 4] {
    let [x, y, z, radius] = sphere.map(f64::from);
    [x * FRAME_SLACK, y * FRAME_SLACK, z * FRAME_SLACK, radius]
}

/// The bounding box, in world space, of spheres in a frame.
pub(super) fn bounds_in_frame(origin: DVec3, spheres: &[[f32; 4]]) -> Option<Bounds> {
    let of_sphere = |s: &[f32; 4]| {
        let [x, y, z, radius] = s.map(f64::from);
        Bounds::of_sphere(origin + DVec3::new(x, y, z), radius)
    };
    let of_chunk = |_: usize, chunk: &[[f32; 4]]| chunk.iter().map(of_sphere).reduce(Bounds::union);
    parallel::map_chunks(spheres, of_chunk).into_iter().flatten().reduce(Bounds::union)
}
