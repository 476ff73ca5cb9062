//! The check of uploaded data: whether the numbers on the device are those of the requested camera and scene.

use glam::{DVec3, Vec3};

use super::candidates::Candidates;
use super::recording::{Recording, Rendered, RequestedCamera, UploadedView};
use super::rounding::{Interval, U};
use crate::geometry::bounds::Bounds;
use crate::geometry::math::wide;
use crate::scene::Scene;

/// The smallest margin between the spheres and the box to which rays are moved, relative to the box's diagonal: twice
/// the largest rounding error of a ray's entry point.
pub(super) const LEAST_MARGIN: f64 = 16.0 * U;

/// Why the data on the device are not those that were requested.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UploadError {
    /// A vector of the camera is wrong.
    #[error("the camera's vector {name} is {found:?} on the device; it should be {expected:?}")]
    Vector {
        /// Name of the vector.
        name: &'static str,
        /// The vector on the device.
        found: [f32; 3],
        /// The vector that was requested.
        expected: [f32; 3],
    },
    /// Rays do not start at the scene's box, or start inside it.
    #[error(
        "rays start {advance} times the forward vector ahead of the camera; they should start at the scene's box, {nearest:?} times ahead"
    )]
    Advance {
        /// The factor on the device.
        advance: f32,
        /// The factor that was expected.
        nearest: f64,
    },
    /// The box to which rays are moved does not contain the spheres.
    #[error(
        "the scene's box on the device, {found:?}, does not contain the box of the spheres, {spheres:?}"
    )]
    Box {
        /// Both corners of the box on the device.
        found: [[f32; 3]; 2],
        /// Both corners of the spheres' bounding box.
        spheres: [[f32; 3]; 2],
    },
    /// The size of the recording differs from that of its film.
    #[error("the recording has {pixels} pixels and a picture of {}x{}, but the film is {}x{}", image[0], image[1], film[0], film[1])]
    Size {
        /// The number of pixels that were traced.
        pixels: u64,
        /// Width and height of the picture.
        image: [u32; 2],
        /// Width and height of the film.
        film: [u32; 2],
    },
    /// A layer of the picture is missing.
    #[error("the picture lacks one of its layers color, depth, normal and id")]
    Layers,
}

/// Compares the recording with the scene, in f64.
pub(super) fn check(
    scene: &Scene,
    candidates: &Candidates,
    recording: &Recording,
) -> Result<(), UploadError> {
    check_view(scene, candidates, &recording.camera, &recording.uploaded)?;
    let Recording { film, pixels, image, rendered, .. } = recording;
    let film = [film.width(), film.height()];
    let rendered = if let Rendered::Other(image) = rendered { Some(&**image) } else { None };
    for image in [image].into_iter().chain(rendered) {
        let (count, size) = (pixels.len() as u64, [image.width(), image.height()]);
        if size != film || count != recording.film.pixel_count() {
            return Err(UploadError::Size { pixels: count, image: size, film });
        }
        if image.depth().is_none() || image.normal().is_none() || image.id().is_none() {
            return Err(UploadError::Layers);
        }
    }
    Ok(())
}

/// Compares the camera and the scene's box with those on the device.
pub(super) fn check_view(
    scene: &Scene,
    candidates: &Candidates,
    camera: &RequestedCamera,
    view: &UploadedView,
) -> Result<(), UploadError> {
    let vectors = &camera.vectors;
    let advance = f64::from(view.advance);
    let origin = vectors.origin - scene.origin();
    let moved = origin + advance * vectors.forward;
    for (name, found, asked) in [
        ("right", view.right, vectors.right),
        ("up", view.up, vectors.up),
        ("forward", view.forward, vectors.forward),
        ("origin", view.origin, moved),
    ] {
        // For the origin, the rounding error of f64 if large numbers cancel.
        let slack = match name {
            "origin" => f64::EPSILON * 4.0 * (origin.abs() + (advance * vectors.forward).abs()),
            _ => DVec3::ZERO,
        };
        let legal = (asked - slack).as_vec3()..=(asked + slack).as_vec3();
        let vector = Vec3::from(found);
        if !(vector.cmpge(*legal.start()) & vector.cmple(*legal.end())).all() {
            let expected = asked.as_vec3().to_array();
            return Err(UploadError::Vector { name, found, expected });
        }
    }
    let asked = vectors.numbers.map(|number| number as f32);
    // Compared by value, because the sign of a zero does not matter.
    if Vec3::from(view.numbers) != Vec3::from(asked) {
        let (name, found, expected) = ("of numbers", view.numbers, asked);
        return Err(UploadError::Vector { name, found, expected });
    }
    let (low, high) = (wide(view.scene_min), wide(view.scene_max));
    let across = vectors.right.cross(vectors.up);
    let nearest = Bounds::between(low, high)
        .corners()
        .map(|corner| (corner - origin).dot(across) / vectors.forward.dot(across))
        .into_iter()
        .fold(f64::INFINITY, f64::min)
        .max(0.0);
    let nearest = if camera.kind.is_linear() { nearest } else { 0.0 };
    // The rounding to f32, and rounding errors of f64 if the box is far from the camera.
    let far =
        f64::EPSILON * 64.0 * (origin.length() + high.length().max(low.length())) * across.length()
            / vectors.forward.dot(across).abs();
    if !Interval::around(nearest, U * nearest + far).contains(advance) {
        return Err(UploadError::Advance { advance: view.advance, nearest });
    }
    if !scene.is_empty() {
        let (spheres_low, spheres_high) = candidates.bounds();
        let margin = LEAST_MARGIN * (high - low).length();
        let holds = (low + margin).cmple(spheres_low.as_dvec3()).all()
            && (high - margin).cmpge(spheres_high.as_dvec3()).all();
        if !holds {
            return Err(UploadError::Box {
                found: [view.scene_min, view.scene_max],
                spheres: [spheres_low.to_array(), spheres_high.to_array()],
            });
        }
    }
    Ok(())
}
