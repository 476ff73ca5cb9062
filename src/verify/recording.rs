//! What a device was given, and what it made of it.

use crate::camera::film::Film;
use crate::camera::{Camera, CameraKind, CameraVectors};
use crate::image::Image;
use crate::render::PrimarySettings;

/// The picture of a scene as a device rendered it, the rays and hits that it got there by, and the numbers
/// that it was given. Beside the scene, this is all that the checker needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// The camera that was asked for.
    pub camera: RequestedCamera,
    /// What was made of it for the device.
    pub uploaded: UploadedView,
    /// The picture's size.
    pub film: Film,
    /// How hits and misses become colours.
    pub primary: PrimarySettings,
    /// Of every pixel, as in [`Image`].
    pub pixels: Vec<TracedPixel>,
    /// All layers.
    pub image: Image,
    /// The picture that the device makes of the same view when nothing is recorded.
    pub rendered: Rendered,
}

/// A picture of the same view by the kernels that keep no rays, as [`Headless::render`](crate::gpu::Headless::render)
/// makes it. The kernels are others, and so may round otherwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Rendered {
    /// There is none.
    #[default]
    None,
    /// It has the values of the recording's picture, in all layers.
    Same,
    /// It has others somewhere. All layers.
    Other(Box<Image>),
}

impl Recording {
    /// Takes a picture of the same view by kernels that keep no rays, and keeps it if it is another.
    pub fn compare(&mut self, rendered: Image) {
        let is_same = rendered == self.image;
        self.rendered = if is_same { Rendered::Same } else { Rendered::Other(Box::new(rendered)) };
    }
}

/// A camera, in f64 and in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequestedCamera {
    /// Which one.
    pub kind: CameraKind,
    /// Its vectors.
    pub vectors: CameraVectors,
}

impl RequestedCamera {
    /// What a camera says of itself.
    #[must_use]
    pub fn of(camera: &dyn Camera) -> Self {
        Self { kind: camera.kind(), vectors: camera.vectors() }
    }
}

/// The numbers of a view that kernels compute with, in the scene's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UploadedView {
    /// The camera, moved by `advance` times `forward`.
    pub origin: [f32; 3],
    /// See `origin`.
    pub advance: f32,
    /// See [`CameraVectors::right`].
    pub right: [f32; 3],
    /// See [`CameraVectors::up`].
    pub up: [f32; 3],
    /// See [`CameraVectors::forward`].
    pub forward: [f32; 3],
    /// See [`CameraVectors::numbers`].
    pub numbers: [f32; 3],
    /// The corner of the box that rays are moved to, with the smallest coordinates.
    pub scene_min: [f32; 3],
    /// The opposite corner.
    pub scene_max: [f32; 3],
}

/// The distance of a miss: kernels have no infinity.
pub const NO_HIT: f32 = 1e30;

/// The ray that a device traced for a pixel, and its answer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TracedPixel {
    /// The ray; `None` where the device was told that no ray can meet the scene's box. Then there is no hit.
    pub ray: Option<TracedRay>,
    /// Distance along the ray to the nearest sphere, or [`NO_HIT`].
    pub t: f32,
    /// Index of that sphere in input order; [`NO_ID`](crate::image::NO_ID) for a miss.
    pub id: u32,
}

/// A ray that a device traced, in the scene's frame, from where it enters the scene's box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TracedRay {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Of unit length, up to rounding.
    pub direction: [f32; 3],
    /// How far the origin is from the camera.
    pub distance: f32,
}
