//! Cameras, each of which gives the ray that belongs to a relative location in the picture.
//!
//! Each camera is one Rust file here, one WGSL part `shaders/camera/NAME.wgsl`, and one row of `camera_table`.
//! `docs/dev/how-to-add/camera.md` explains how to add one.

use glam::{DVec2, DVec3};

use crate::camera::film::Film;
use crate::geometry::math::{MAX_LENGTH, MIN_LENGTH};
use crate::geometry::ray::Ray;

pub mod film;
pub mod filter;
mod fisheye;
mod framing;
mod host;
mod orthographic;
mod panorama;
mod parameters;
mod path;
mod path_curve;
mod pinhole;
mod placement;
mod pose;
pub mod sampling;
mod thin_lens;
mod viewpoint;

pub use framing::DEFAULT_MARGIN;

pub use fisheye::FisheyeCamera;
pub use host::{DepthOrder, HostCamera, HostCameraError, HostMatrix};
pub use orthographic::OrthographicCamera;
pub use panorama::PanoramaCamera;
pub use parameters::CameraParameters;
pub use path::{CameraKey, CameraMotion, CameraOnPath, CameraPath, CameraPathError, KeyPlace, PathClock, PlaceOnPath};
pub use pinhole::PinholeCamera;
use pose::checked_range;
pub use pose::{CameraError, CameraVectors, Pose};
pub use thin_lens::ThinLensCamera;
pub use viewpoint::{Viewpoint, ViewpointError, turned};

/// A camera, which gives the ray that belongs to a relative location in [−1, 1]².
///
/// The trait is sealed. A camera consists of its Rust type and its WGSL part, and only this crate can join the two.
pub trait Camera: sealed::Sealed + std::fmt::Debug + Send + Sync {
    /// The kind of the camera, which is its row of the camera table.
    fn kind(&self) -> CameraKind;

    /// The ray that belongs to `location`, in world space. Its direction has unit length. For a camera with a lens,
    /// this is the ray through the centre of the lens.
    fn ray_in_world(&self, location: DVec2) -> Ray;

    /// The ray that belongs to `location` through a point of the lens. `lens` lies in the unit square [0, 1)², and (½,
    /// ½) is the centre of the lens. A camera without a lens returns the same ray for all points.
    fn ray_through_lens(&self, location: DVec2, lens: DVec2) -> Ray {
        let _ = lens;
        self.ray_in_world(location)
    }

    /// Returns true if [`Camera::ray_through_lens`] depends on the point of the lens.
    fn has_lens(&self) -> bool {
        false
    }

    /// Returns true if the camera has a ray at `location`. If not, the pixel is a miss, and the result of
    /// [`Camera::ray_in_world`] has no meaning.
    fn sees(&self, location: DVec2) -> bool {
        let _ = location;
        true
    }

    /// The relative location of the ray that hits a point in world space. It may lie outside [−1, 1]². `None` if no ray
    /// hits the point, or if the camera cannot tell.
    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2>;

    /// The data from which the WGSL part of this camera computes the same rays.
    fn vectors(&self) -> CameraVectors;
}

/// A camera and a film, which together define a picture's rays and pixels.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The camera, which gives the ray of each location in the picture.
    pub camera: &'a dyn Camera,
    /// The size of the picture.
    pub film: Film,
}

impl<'a> View<'a> {
    /// The picture that `camera` takes on `film`.
    #[must_use]
    pub fn new(camera: &'a dyn Camera, film: Film) -> Self {
        Self { camera, film }
    }

    /// The ray through the centre of a pixel, given as column and row. `None` if the camera has no ray there.
    #[must_use]
    pub fn ray_through_center(&self, [column, row]: [u32; 2]) -> Option<Ray> {
        let location = self.film.relative_location(f64::from(column) + 0.5, f64::from(row) + 0.5);
        self.camera.sees(location).then(|| self.camera.ray_in_world(location))
    }
}

/// The single list of cameras. A row holds the variant, the type, the name (in scene files and of the WGSL part), and
/// the type that reads the camera's table in a scene file.
macro_rules! camera_table {
    ($apply:ident) => {
        $apply! {
            /// Every ray starts at the eye. Objects shrink with distance.
            Pinhole, PinholeCamera, "pinhole", PinholeParameters;
            /// Every ray has the same direction. Objects keep their size.
            Orthographic, OrthographicCamera, "orthographic", OrthographicParameters;
            /// Rays start anywhere on a lens. Objects out of focus are blurred.
            ThinLens, ThinLensCamera, "thin-lens", ThinLensParameters;
            /// Rays go in all directions. Longitude runs across the picture and latitude up it.
            Panorama, PanoramaCamera, "panorama", PanoramaParameters;
            /// Rays fill a cone, which may be wider than a half space. The picture is a disk.
            Fisheye, FisheyeCamera, "fisheye", FisheyeParameters;
        }
    };
}
pub(crate) use camera_table;

macro_rules! define_kind {
    ($($(#[$doc:meta])* $variant:ident, $camera:ident, $name:literal, $parameters:ident;)+) => {
        mod sealed {
            pub trait Sealed {}
            $(impl Sealed for super::$camera {})+
        }

        /// The kinds of camera.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum CameraKind {
            $($(#[$doc])* $variant,)+
        }

        impl CameraKind {
            /// All kinds of camera.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The name of the camera in scene files.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }
        }
    };
}
camera_table!(define_kind);

impl CameraKind {
    /// Returns true if straight lines stay straight in the picture, so that a box lies between the images of its
    /// corners. The rays of such a camera may start on any plane along `forward` instead of at the camera; see `Camera`
    /// in `shaders/scene/records.wgsl`.
    #[must_use]
    pub const fn is_linear(self) -> bool {
        matches!(self, Self::Pinhole | Self::Orthographic | Self::ThinLens)
    }
}

/// Returns an error for a length whose square is not a normal f32.
fn checked_length(parameter: &'static str, value: f64) -> Result<f64, CameraError> {
    if (MIN_LENGTH..=MAX_LENGTH).contains(&value) { Ok(value) } else { Err(CameraError::Length { parameter, value }) }
}

fn checked_half_extent(half_extent: impl Into<DVec2>) -> Result<DVec2, CameraError> {
    let half_extent = half_extent.into();
    checked_length("half extent in x", half_extent.x)?;
    checked_length("half extent in y", half_extent.y)?;
    Ok(half_extent)
}

/// Returns an error for a vertical field of view that is not an angle between 0 and π.
fn checked_fov(radians: f64) -> Result<(), CameraError> {
    if radians > 0.0 && radians < std::f64::consts::PI {
        return Ok(());
    }
    let degrees = radians.to_degrees();
    Err(CameraError::Invalid(format!("the vertical field of view is {degrees} degrees; it must lie between 0 and 180")))
}

/// Returns an error for a margin that leaves too little of the picture.
fn checked_margin(value: f64) -> Result<f64, CameraError> {
    checked_range("`margin`", value, [0.0, framing::MOST_MARGIN])
}

fn checked_aspect(aspect: f64) -> Result<f64, CameraError> {
    checked_length("aspect ratio", aspect)
}

/// Checks the separation of two eyes, and the distance at which they converge, which may be infinite.
fn stereo_lengths(separation: f64, convergence: f64) -> Result<(f64, f64), CameraError> {
    checked_length("`separation` of the eyes", separation)?;
    if convergence != f64::INFINITY {
        checked_length("`convergence` of the eyes", convergence)?;
    }
    Ok((separation, convergence))
}
