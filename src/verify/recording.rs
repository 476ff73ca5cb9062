//! Recordings: the inputs of a device and its results. Also checks whether these inputs
//! match the requested camera and scene.

use glam::{DVec3, Vec3};

use crate::camera::film::Film;
use crate::camera::{Camera, CameraKind, CameraVectors};
use crate::geometry::bounds::Bounds;
use crate::geometry::math::wide;
use crate::image::Image;
use crate::render::PrimarySettings;
use crate::scene::Scene;
use crate::verify::hit::Candidates;
use crate::verify::rounding::{Interval, U};

/// The expected margin of the box, relative to its diagonal. A device may have a larger or a smaller margin.
const BOX_MARGIN: f32 = 1.0 / (1 << 17) as f32;

/// A recording: a picture as a device rendered it, the rays and hits that led to it, and the inputs of the device. The
/// checker needs only this and the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// The requested camera.
    pub camera: RequestedCamera,
    /// The numbers of the view on the device.
    pub uploaded: UploadedView,
    /// The size of the picture.
    pub film: Film,
    /// The settings by which hits and misses become colours.
    pub primary: PrimarySettings,
    /// The ray and hit of every pixel, in the order of [`Image`].
    pub pixels: Vec<TracedPixel>,
    /// The picture with all layers.
    pub image: Image,
    /// The picture of the same view that the device renders without recording.
    pub rendered: PlainRender,
}

/// The picture of the same view from kernels that do not record rays, as
/// [`Headless::render`](crate::gpu::Headless::render) renders it. Rounding may differ in these kernels.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum PlainRender {
    /// There is no such picture.
    #[default]
    None,
    /// All layers equal the layers of the recording's picture.
    Same,
    /// Some value differs from the recording's picture. Holds all layers.
    Other(Box<Image>),
}

impl Recording {
    /// Compares with a picture of the same view from kernels that do not record rays, and keeps it if it differs.
    pub fn compare(&mut self, rendered: Image) {
        let is_same = rendered == self.image;
        self.rendered =
            if is_same { PlainRender::Same } else { PlainRender::Other(Box::new(rendered)) };
    }
}

/// A camera in f64 and in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequestedCamera {
    /// The kind of camera.
    pub kind: CameraKind,
    /// The vectors of the camera.
    pub vectors: CameraVectors,
}

impl RequestedCamera {
    /// The kind and the vectors of a camera.
    #[must_use]
    pub fn of(camera: &dyn Camera) -> Self {
        Self { kind: camera.kind(), vectors: camera.vectors() }
    }

    /// The factor of `forward` at which the nearest corner of a box lies, if the camera has a plane; 0 otherwise.
    fn nearest(&self, origin: DVec3, [low, high]: [DVec3; 2]) -> f64 {
        let CameraVectors { right, up, forward, .. } = self.vectors;
        let across = right.cross(up);
        let ahead = |corner: DVec3| (corner - origin).dot(across) / forward.dot(across);
        let corners = Bounds::between(low, high).corners().into_iter().map(ahead);
        if self.kind.is_linear() { corners.fold(f64::INFINITY, f64::min).max(0.0) } else { 0.0 }
    }
}

/// The numbers of a view on the device, in the scene's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UploadedView {
    /// The position of the camera, moved by `advance` times `forward`.
    pub origin: [f32; 3],
    /// The factor of `forward` in `origin`.
    pub advance: f32,
    /// See [`CameraVectors::right`].
    pub right: [f32; 3],
    /// See [`CameraVectors::up`].
    pub up: [f32; 3],
    /// See [`CameraVectors::forward`].
    pub forward: [f32; 3],
    /// See [`CameraVectors::numbers`].
    pub numbers: [f32; 3],
    /// The corner, with the smallest coordinates, of the box to which rays are moved.
    pub scene_min: [f32; 3],
    /// The corner of that box with the largest coordinates.
    pub scene_max: [f32; 3],
}

impl UploadedView {
    /// The inputs of a device for a camera, if the spheres lie between two corners. If the camera has a plane, rays
    /// start at the depth of the nearest corner of the scene's box.
    pub(super) fn expected(
        camera: &RequestedCamera,
        scene_origin: DVec3,
        (min, max): (Vec3, Vec3),
    ) -> Self {
        let narrow = |v: DVec3| v.as_vec3().to_array();
        let margin = Vec3::splat(BOX_MARGIN * (max - min).length());
        let (min, max) = (min - margin, max + margin);
        let CameraVectors { origin, right, up, forward, numbers } = camera.vectors;
        let origin = origin - scene_origin;
        let advance = camera.nearest(origin, [min, max].map(|v| v.as_dvec3())) as f32;
        Self {
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
}

/// The distance of a miss, because kernels have no infinity.
pub const NO_HIT: f32 = 1e30;

/// The ray that a device traced for a pixel, and its hit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TracedPixel {
    /// The ray; `None` if the device was told that no ray can hit the scene's box. The pixel is then a miss.
    pub ray: Option<TracedRay>,
    /// Distance along the ray to the nearest sphere, or [`NO_HIT`].
    pub t: f32,
    /// Index of the hit sphere in input order; [`NO_ID`](crate::image::NO_ID) for a miss.
    pub id: u32,
    /// The ray with which the hit was shaded, which another kernel made; `None` for a miss, or if it was not recorded.
    pub shading_ray: Option<TracedRay>,
}

/// A ray that a device traced, in the scene's frame, starting where it enters the scene's box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TracedRay {
    /// The start of the ray.
    pub origin: [f32; 3],
    /// The direction, which has unit length up to rounding.
    pub direction: [f32; 3],
    /// The distance of the start from the camera.
    pub distance: f32,
}

/// The smallest margin between the spheres and the box to which rays are moved, relative to the box's diagonal: twice
/// the largest rounding error of a ray's entry point.
pub(super) const LEAST_MARGIN: f64 = 16.0 * U;

/// Why the data on the device differ from the requested data.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
#[cfg_attr(feature = "run-file", derive(serde::Serialize))]
pub struct UploadError(pub(super) String);

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
    UploadError(format!(
        "the camera's vector {name} is {found:?} on the device; it should be {expected:?}"
    ))
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
    let nearest = camera.nearest(origin, [low, high]);
    // The rounding to f32, and rounding errors of f64 if the box is far from the camera.
    let far =
        f64::EPSILON * 64.0 * (origin.length() + high.length().max(low.length())) * across.length()
            / vectors.forward.dot(across).abs();
    if !Interval::around(nearest, U * nearest + far).contains(advance) {
        return Err(UploadError(format!(
            "rays start {advance} times the forward vector ahead of the camera; they should start at the scene's box, \
             {nearest:?} times ahead",
            advance = view.advance
        )));
    }
    if !scene.is_empty() {
        let (spheres_low, spheres_high) = candidates.bounds();
        let margin = LEAST_MARGIN * (high - low).length();
        let holds = (low + margin).cmple(spheres_low.as_dvec3()).all()
            && (high - margin).cmpge(spheres_high.as_dvec3()).all();
        if !holds {
            let found = [view.scene_min, view.scene_max];
            let spheres = [spheres_low.to_array(), spheres_high.to_array()];
            return Err(UploadError(format!(
                "the scene's box on the device, {found:?}, does not contain the box of the spheres, {spheres:?}"
            )));
        }
    }
    Ok(())
}
