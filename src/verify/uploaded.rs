//! Checks that the numbers on a device are those of the requested camera and scene.

use glam::{DVec3, Vec3};

use crate::camera::CameraVectors;
use crate::geometry::bounds::Bounds;
use crate::geometry::math::wide;
use crate::recording::{PlainRender, Recording, RequestedCamera, UploadError, UploadedView};
use crate::scene::Scene;
use crate::verify::hit::Candidates;
use crate::verify::rounding::{Interval, U};

/// The expected margin of the box, relative to its diagonal. A device may have a larger or a smaller margin.
const BOX_MARGIN: f32 = 1.0 / (1 << 17) as f32;

/// The box of a device around shapes that lie between two corners.
pub(super) fn expected_box(min: Vec3, max: Vec3) -> [Vec3; 2] {
    let margin = Vec3::splat(BOX_MARGIN * (max - min).length());
    [min - margin, max + margin]
}

/// The inputs of a device for a camera, if the shapes lie between two corners. If the camera has a plane, rays
/// start at the depth of the nearest corner of the scene's box.
pub(super) fn expected_view(camera: &RequestedCamera, scene_origin: DVec3, (min, max): (Vec3, Vec3)) -> UploadedView {
    let narrow = |v: DVec3| v.as_vec3().to_array();
    let [min, max] = expected_box(min, max);
    let CameraVectors { origin, right, up, forward, numbers } = camera.vectors;
    let origin = origin - scene_origin;
    let advance = nearest(camera, origin, [min, max].map(|v| v.as_dvec3())) as f32;
    UploadedView {
        origin: narrow(origin + f64::from(advance) * forward),
        advance,
        right: narrow(right),
        up: narrow(up),
        forward: narrow(forward),
        numbers: numbers.map(|number| number as f32),
        scene_min: min.to_array(),
        scene_max: max.to_array(),
    }
}

/// The factor of `forward` at which the nearest corner of a box lies, if the camera has a plane; 0 otherwise.
fn nearest(camera: &RequestedCamera, origin: DVec3, [low, high]: [DVec3; 2]) -> f64 {
    let CameraVectors { right, up, forward, .. } = camera.vectors;
    let across = right.cross(up);
    let ahead = |corner: DVec3| (corner - origin).dot(across) / forward.dot(across);
    let corners = Bounds::between(low, high).corners().into_iter().map(ahead);
    if camera.kind.is_linear() { corners.fold(f64::INFINITY, f64::min).max(0.0) } else { 0.0 }
}

/// The smallest margin between the shapes and the box to which rays are moved, relative to the box's diagonal: twice
/// the largest rounding error of a ray's entry point.
pub(super) const LEAST_MARGIN: f64 = 16.0 * U;

/// Compares the recording with the scene, in f64.
pub(super) fn check_recording(
    scene: &Scene,
    candidates: &Candidates,
    recording: &Recording,
) -> Result<(), UploadError> {
    check_view(scene, candidates, &recording.camera, &recording.uploaded)?;
    let Recording { film, pixels, image, rendered, .. } = recording;
    let film = [film.width(), film.height()];
    let rendered = if let PlainRender::Other(image) = rendered { Some(&**image) } else { None };
    for image in [image].into_iter().chain(rendered) {
        let (count, size) = (pixels.len() as u64, [image.width(), image.height()]);
        if size != film || count != recording.film.pixel_count() {
            return Err(UploadError(format!(
                "the recording has {count} pixels and a picture of {}x{}, but the film is {}x{}",
                size[0], size[1], film[0], film[1]
            )));
        }
        if image.depth().is_none() || image.normal().is_none() || image.id().is_none() {
            let message = "the picture lacks one of its layers color, depth, normal and id";
            return Err(UploadError(message.to_owned()));
        }
    }
    Ok(())
}

fn wrong_vector(name: &str, found: [f32; 3], expected: [f32; 3]) -> UploadError {
    UploadError(format!("the camera's vector {name} is {found:?} on the device; it should be {expected:?}"))
}

/// Compares the camera and the scene's box with the camera and the box on the device.
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
        // The origin has the rounding error of f64 if large numbers cancel.
        let slack = match name {
            "origin" => f64::EPSILON * 4.0 * (origin.abs() + (advance * vectors.forward).abs()),
            _ => DVec3::ZERO,
        };
        let legal = (asked - slack).as_vec3()..=(asked + slack).as_vec3();
        let vector = Vec3::from(found);
        if !(vector.cmpge(*legal.start()) & vector.cmple(*legal.end())).all() {
            return Err(wrong_vector(name, found, asked.as_vec3().to_array()));
        }
    }
    let asked = vectors.numbers.map(|number| number as f32);
    // Compared by value, because the sign of a zero does not matter.
    if Vec3::from(view.numbers) != Vec3::from(asked) {
        return Err(wrong_vector("of numbers", view.numbers, asked));
    }
    let (low, high) = (wide(view.scene_min), wide(view.scene_max));
    let across = vectors.right.cross(vectors.up);
    let nearest = nearest(camera, origin, [low, high]);
    // The rounding to f32, and rounding errors of f64 if the box is far from the camera.
    let far = f64::EPSILON * 64.0 * (origin.length() + high.length().max(low.length())) * across.length()
        / vectors.forward.dot(across).abs();
    if !Interval::around(nearest, U * nearest + far).contains(advance) {
        return Err(UploadError(format!(
            "rays start {advance} times the forward vector ahead of the camera; they should start at the scene's box, \
             {nearest:?} times ahead",
            advance = view.advance
        )));
    }
    if !scene.is_empty() {
        let (shapes_low, shapes_high) = candidates.bounds();
        let margin = LEAST_MARGIN * (high - low).length();
        let holds =
            (low + margin).cmple(shapes_low.as_dvec3()).all() && (high - margin).cmpge(shapes_high.as_dvec3()).all();
        if !holds {
            let found = [view.scene_min, view.scene_max];
            let shapes = [shapes_low.to_array(), shapes_high.to_array()];
            return Err(UploadError(format!(
                "the scene's box on the device, {found:?}, does not contain the box of its shapes, {shapes:?}"
            )));
        }
    }
    Ok(())
}
