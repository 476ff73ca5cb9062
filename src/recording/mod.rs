//! Recordings: the data that a device was given, and its results. Renderers write them, and the checker reads them.

pub(crate) mod cone_rays;
pub(crate) mod lighting;
pub(crate) mod lit;

use crate::camera::film::Film;
use crate::camera::{Camera, CameraKind, CameraVectors};
use crate::image::Image;
use crate::render::PrimarySettings;

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
    /// Compares with a picture of the same view from kernels that do not record rays, and keeps it if it differs, unless
    /// another one differs already.
    pub fn compare(&mut self, rendered: Image) {
        self.rendered = match std::mem::take(&mut self.rendered) {
            PlainRender::None | PlainRender::Same if rendered == self.image => PlainRender::Same,
            PlainRender::None | PlainRender::Same => PlainRender::Other(Box::new(rendered)),
            other => other,
        };
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

/// Why the data on the device differ from the requested data.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
#[cfg_attr(feature = "run-file", derive(serde::Serialize))]
pub struct UploadError(pub(crate) String);

/// Column and row of a pixel by its index, row by row from the top.
pub(crate) fn pixel_at(index: usize, width: u32) -> [u32; 2] {
    let width = width.max(1) as usize;
    // The sides of a picture are u32.
    [(index % width) as u32, (index / width) as u32]
}
