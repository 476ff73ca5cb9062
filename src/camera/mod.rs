//! Cameras: which ray belongs to a relative location?
//!
//! Each camera is one Rust file here, one WGSL part `shaders/camera_NAME.wgsl`, and one row of
//! `camera_table`. `ARCHITECTURE.md` says how to add one.

use glam::{DVec2, DVec3};

use crate::geometry::math::{MAX_LENGTH, MIN_LENGTH};
use crate::geometry::ray::Ray;

pub mod film;
pub mod filter;
mod fisheye;
mod framing;
mod orthographic;
mod panorama;
#[cfg(feature = "scene-file")]
mod parameters;
mod pinhole;
mod pose;
pub mod sampling;
#[cfg(feature = "scene-file")]
mod stereo;
mod thin_lens;
mod view;

pub use fisheye::FisheyeCamera;
#[cfg(feature = "scene-file")]
pub use fisheye::FisheyeParameters;
pub use orthographic::OrthographicCamera;
#[cfg(feature = "scene-file")]
pub use orthographic::OrthographicParameters;
pub use panorama::PanoramaCamera;
#[cfg(feature = "scene-file")]
pub use panorama::PanoramaParameters;
#[cfg(feature = "scene-file")]
pub use parameters::CameraParameters;
pub use pinhole::PinholeCamera;
#[cfg(feature = "scene-file")]
pub use pinhole::PinholeParameters;
pub use pose::{CameraError, Pose};
#[cfg(feature = "scene-file")]
pub use stereo::StereoParameters;
pub use thin_lens::ThinLensCamera;
#[cfg(feature = "scene-file")]
pub use thin_lens::ThinLensParameters;
pub use view::View;

/// A camera answers one question: which ray belongs to a relative location in [−1, 1]²?
///
/// The trait is sealed: a camera consists of its Rust type and its WGSL part, and only this crate can
/// join the two.
pub trait Camera: sealed::Sealed + std::fmt::Debug + Send + Sync {
    /// Which row of the camera table this is.
    fn kind(&self) -> CameraKind;

    /// The ray that belongs to `location`, in the world; its direction has unit length. Of a camera with a
    /// lens, that through the lens's centre.
    fn ray_in_world(&self, location: DVec2) -> Ray;

    /// The ray that belongs to `location` through a point of the lens: `lens` lies in the unit square
    /// [0, 1)², and (½, ½) is the lens's centre. Without a lens, the same ray for all points.
    fn ray_through_lens(&self, location: DVec2, lens: DVec2) -> Ray {
        let _ = lens;
        self.ray_in_world(location)
    }

    /// Whether [`Camera::ray_through_lens`] depends on the point of the lens.
    fn has_lens(&self) -> bool {
        false
    }

    /// Whether there is a ray at all. Where there is none, the pixel is a miss, and what
    /// [`Camera::ray_in_world`] says has no meaning.
    fn sees(&self, location: DVec2) -> bool {
        let _ = location;
        true
    }

    /// The relative location of a point in the world, perhaps outside [−1, 1]²: that of the ray that meets
    /// it. `None` if no ray does, or none can be told.
    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2>;

    /// What the WGSL part of this camera needs to answer the same question.
    fn vectors(&self) -> CameraVectors;
}

/// Vectors in the world and numbers, in f64, that say everything about a camera once its kind is known.
///
/// What `right`, `up`, `forward` and `numbers` mean is for the camera's own two files to agree on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CameraVectors {
    /// Where the camera is.
    pub origin: DVec3,
    /// From the middle of the view plane to its edge at x = +1.
    pub right: DVec3,
    /// From the middle of the view plane to its edge at y = +1.
    pub up: DVec3,
    /// Into the picture.
    pub forward: DVec3,
    /// What else there is to say; zeros if nothing.
    pub numbers: [f64; 3],
}

#[cfg(feature = "run-file")]
impl CameraVectors {
    /// Vectors as [`Camera::vectors`] gives them, in the order of the fields, checked as far as every camera
    /// keeps to it.
    pub(crate) fn checked(rows: [DVec3; 5]) -> Result<Self, CameraError> {
        let [origin, right, up, forward, numbers] = rows;
        pose::checked_point("the origin", origin)?;
        for (parameter, value) in
            [("length of right", right), ("length of up", up), ("length of forward", forward)]
        {
            // They are products of a length in range and a vector of unit length up to rounding.
            let length = value.length();
            if !(0.5 * MIN_LENGTH..=2.0 * MAX_LENGTH).contains(&length) {
                return Err(CameraError::Length { parameter, value: length });
            }
        }
        // They are lengths, or quotients of two.
        const LARGEST: f64 = 2.0 * MAX_LENGTH * MAX_LENGTH;
        let numbers = numbers.to_array();
        match numbers.into_iter().find(|number| !(-LARGEST..=LARGEST).contains(number)) {
            None => Ok(Self { origin, right, up, forward, numbers }),
            Some(value) => {
                let (parameter, low, high) = ("camera's number", -LARGEST, LARGEST);
                Err(CameraError::Range { parameter, value, low, high })
            }
        }
    }
}

/// The one list of cameras. A row is: variant, type, name in files and of the WGSL part, and the
/// type that reads the camera's table in a scene file.
macro_rules! camera_table {
    ($apply:ident) => {
        $apply! {
            /// Every ray starts at the eye; things shrink with distance.
            Pinhole, PinholeCamera, "pinhole", PinholeParameters;
            /// Every ray has the same direction; things keep their size.
            Orthographic, OrthographicCamera, "orthographic", OrthographicParameters;
            /// Rays start anywhere on a lens; what is not in focus is blurred.
            ThinLens, ThinLensCamera, "thin-lens", ThinLensParameters;
            /// Rays go in all directions; longitude and latitude are the picture's two sides.
            Panorama, PanoramaCamera, "panorama", PanoramaParameters;
            /// Rays fill a cone, perhaps more than half of all directions; the picture is a disk.
            Fisheye, FisheyeCamera, "fisheye", FisheyeParameters;
        }
    };
}
#[cfg(any(feature = "gpu", feature = "scene-file"))]
pub(crate) use camera_table;

macro_rules! define_kind {
    ($($(#[$doc:meta])* $variant:ident, $camera:ident, $name:literal, $parameters:ident;)+) => {
        mod sealed {
            pub trait Sealed {}
            $(impl Sealed for super::$camera {})+
        }

        /// The cameras that exist.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum CameraKind {
            $($(#[$doc])* $variant,)+
        }

        impl CameraKind {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The name in scene files.
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
    /// Whether straight lines are straight in the picture, so that all of a box lies between its corners. The
    /// rays may then be taken up at any plane along `forward` instead of at the camera; see `Camera` in
    /// `shaders/scene/records.wgsl`.
    pub(crate) const fn is_linear(self) -> bool {
        matches!(self, Self::Pinhole | Self::Orthographic | Self::ThinLens)
    }
}

/// Refuses a length that kernels could not square.
fn checked_length(parameter: &'static str, value: f64) -> Result<f64, CameraError> {
    if (MIN_LENGTH..=MAX_LENGTH).contains(&value) {
        Ok(value)
    } else {
        Err(CameraError::Length { parameter, value })
    }
}

fn checked_half_extent(half_extent: impl Into<DVec2>) -> Result<DVec2, CameraError> {
    let half_extent = half_extent.into();
    checked_length("half extent in x", half_extent.x)?;
    checked_length("half extent in y", half_extent.y)?;
    Ok(half_extent)
}

fn checked_aspect(aspect: f64) -> Result<f64, CameraError> {
    checked_length("aspect ratio", aspect)
}

/// The separation of two eyes, and the distance at which they converge, which may be infinite.
fn stereo_lengths(separation: f64, convergence: f64) -> Result<(f64, f64), CameraError> {
    checked_length("eyes' `separation`", separation)?;
    if convergence != f64::INFINITY {
        checked_length("eyes' `convergence`", convergence)?;
    }
    Ok((separation, convergence))
}
