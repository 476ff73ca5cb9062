//! Recordings: the data that a device was given, and its results.

use glam::{DVec3, Vec3};

use crate::camera::film::Film;
use crate::camera::{Camera, CameraKind, CameraVectors};
use crate::geometry::bounds::Bounds;
use crate::image::Image;
use crate::render::PrimarySettings;

/// The margin of the box that is expected, relative to its diagonal; a device may have a larger or a smaller one.
const BOX_MARGIN: f32 = 1.0 / (1 << 17) as f32;

/// A recording: a picture as a device rendered it, the rays and hits that led to it, and the numbers that the device
/// was given. The checker needs only this and the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// The requested camera.
    pub camera: RequestedCamera,
    /// The numbers of the view on the device.
    pub uploaded: UploadedView,
    /// The size of the picture.
    pub film: Film,
    /// How hits and misses become colours.
    pub primary: PrimarySettings,
    /// The ray and hit of every pixel, in the order of [`Image`].
    pub pixels: Vec<TracedPixel>,
    /// The picture with all layers.
    pub image: Image,
    /// The picture of the same view that the device renders without recording.
    pub rendered: Rendered,
}

/// The picture of the same view from kernels that do not record rays, as
/// [`Headless::render`](crate::gpu::Headless::render) renders it. These are different kernels, so rounding may differ.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Rendered {
    /// There is no such picture.
    #[default]
    None,
    /// All layers equal those of the recording's picture.
    Same,
    /// Some value differs from the recording's picture. Holds all layers.
    Other(Box<Image>),
}

impl Recording {
    /// Compares with a picture of the same view from kernels that do not record rays, and keeps it if it differs.
    pub fn compare(&mut self, rendered: Image) {
        let is_same = rendered == self.image;
        self.rendered = if is_same { Rendered::Same } else { Rendered::Other(Box::new(rendered)) };
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
}

/// The numbers of a view with which kernels compute, in the scene's frame.
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
    /// The numbers that a device is given for a camera, if the spheres lie between two corners: rays start where the
    /// nearest corner of the scene's box lies, if the camera has a plane.
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
        let across = right.cross(up);
        let ahead = |corner: DVec3| (corner - origin).dot(across) / forward.dot(across);
        let corners = Bounds::between(min.as_dvec3(), max.as_dvec3()).corners();
        let nearest = corners.into_iter().map(ahead).fold(f64::INFINITY, f64::min);
        let advance = if camera.kind.is_linear() { nearest.max(0.0) as f32 } else { 0.0 };
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
    /// Index of that sphere in input order; [`NO_ID`](crate::image::NO_ID) for a miss.
    pub id: u32,
    /// The ray with which the hit was shaded, which another kernel made; `None` for a miss, and where it was not recorded.
    pub shading_ray: Option<TracedRay>,
}

/// A ray that a device traced, in the scene's frame, starting where it enters the scene's box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TracedRay {
    /// The start of the ray.
    pub origin: [f32; 3],
    /// The direction; unit length, up to rounding.
    pub direction: [f32; 3],
    /// The distance of the start from the camera.
    pub distance: f32,
}
