//! The thin-lens camera: what is not in focus is blurred.

use glam::{DVec2, DVec3};

#[cfg(feature = "scene-file")]
use super::PinholeParameters;
use super::pose::checked_point;
use super::{Camera, CameraError, CameraKind, CameraVectors, PinholeCamera, checked_length};
#[cfg(feature = "scene-file")]
use crate::exact;
use crate::geometry::disk::concentric_disk;
use crate::geometry::math::MIN_LENGTH;
use crate::geometry::ray::Ray;
#[cfg(feature = "scene-file")]
use crate::geometry::subject::Subject;

/// A camera with a thin lens.
///
/// The rays of a relative location start on a disk around the eye, perpendicular to the view, and all intersect at one
/// point: where the pinhole camera's ray hits the plane of focus, which is `focus_distance` away along the view. The
/// lens does not bend the ray through its centre, so that ray is the pinhole camera's.
///
/// With the plane of focus at f, a point at the distance s from the lens is blurred to a disk that has the diameter
/// 2·radius·|s − f|/s in the plane of focus, the *circle of confusion* (M. Potmesil and I. Chakravarty, *Synthetic
/// image generation with a lens and aperture camera model*, ACM Transactions on Graphics 1, 1982).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLensCamera {
    /// The pinhole camera through the centre of the lens; its view plane is the plane of focus.
    pinhole: PinholeCamera,
    aperture_radius: f64,
}

impl ThinLensCamera {
    /// A pinhole camera with a lens in place of the hole. Lengths are in scene units; the distance is measured along
    /// the view.
    ///
    /// # Errors
    /// Returns an error if the distance is not a length greater than zero, or the radius is not a length up to the
    /// distance.
    pub fn new(
        pinhole: PinholeCamera,
        aperture_radius: f64,
        focus_distance: f64,
    ) -> Result<Self, CameraError> {
        let high = checked_length("`focus_distance`", focus_distance)?;
        if !(MIN_LENGTH..=high).contains(&aperture_radius) {
            let (parameter, value, low) = ("`aperture_radius`", aperture_radius, MIN_LENGTH);
            return Err(CameraError::Range { parameter, value, low, high });
        }
        Ok(Self { pinhole: pinhole.with_distance(focus_distance)?, aperture_radius })
    }

    /// The same as [`ThinLensCamera::new`], with the plane of focus through a point.
    ///
    /// # Errors
    /// Returns the same errors as [`ThinLensCamera::new`], and an error if the point does not lie in front of the
    /// camera.
    pub fn focused_on(
        pinhole: PinholeCamera,
        aperture_radius: f64,
        point: impl Into<DVec3>,
    ) -> Result<Self, CameraError> {
        let point = point.into();
        checked_point("`focus_on`", point)?;
        let pose = pinhole.pose();
        let depth = (pose.origin() - point).dot(pose.basis().w());
        let distance = checked_length("distance to `focus_on` along the view", depth)?;
        Self::new(pinhole, aperture_radius, distance)
    }

    /// The aperture radius of a lens: its f-number (ISO 517) is N = f/D, where f is the focal length in scene units and
    /// D the diameter. The focal length has no other effect: the field of view is the pinhole camera's.
    ///
    /// # Errors
    /// Returns an error if the focal length is not a length greater than zero, or the f-number not from 2⁻⁵⁶ to 2⁵⁶.
    pub fn aperture_radius(focal_length: f64, f_stop: f64) -> Result<f64, CameraError> {
        Ok(0.5 * checked_length("`focal_length`", focal_length)?
            / checked_length("`f_stop`", f_stop)?)
    }
}

impl Camera for ThinLensCamera {
    fn kind(&self) -> CameraKind {
        CameraKind::ThinLens
    }

    fn ray_in_world(&self, location: DVec2) -> Ray {
        self.pinhole.ray_in_world(location)
    }

    fn ray_through_lens(&self, location: DVec2, lens: DVec2) -> Ray {
        let CameraVectors { origin, right, up, forward, .. } = self.pinhole.vectors();
        let basis = self.pinhole.pose().basis();
        let on_lens = self.aperture_radius * concentric_disk(lens);
        let offset = on_lens.x * basis.u() + on_lens.y * basis.v();
        // The component along the view is the focus distance, so the vector is never zero.
        let toward = location.x * right + location.y * up + forward - offset;
        Ray { origin: origin + offset, direction: toward / toward.length() }
    }

    fn has_lens(&self) -> bool {
        true
    }

    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2> {
        self.pinhole.location_of(point_in_world)
    }

    /// The vectors of the pinhole camera whose view plane is the plane of focus. The first two numbers are the radius
    /// of the lens as a multiple of the lengths of `right` and of `up`.
    fn vectors(&self) -> CameraVectors {
        let [first, second] = (self.aperture_radius / self.pinhole.half_extent()).to_array();
        CameraVectors { numbers: [first, second, 0.0], ..self.pinhole.vectors() }
    }
}

/// The table `[camera.thin-lens]` of a scene file.
#[cfg(feature = "scene-file")]
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct ThinLensParameters {
    /// The middle of the lens; without it, the camera frames the scene.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// The point at which the camera looks.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub look_at: Option<[f64; 3]>,
    /// The direction in which the camera looks, instead of `look_at`.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// The direction that is up in the picture; without it +y, or in a view along y another axis.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub up: Option<[f64; 3]>,
    /// Distance of the view plane from the eye.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// Half width and half height of the view plane.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub half_extent: Option<[f64; 2]>,
    /// Vertical field of view in degrees, instead of `distance` and `half_extent`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertical_fov: Option<f64>,
    /// The part of the picture that a camera without an eye leaves free beside the scene, from 0 to 0.45.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// How much the picture is enlarged about its middle, by a narrower field of view.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zoom: Option<f64>,
    /// Radius of the lens in scene units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aperture_radius: Option<f64>,
    /// F-number (focal length over diameter), given together with `focal_length` instead of `aperture_radius`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub f_stop: Option<f64>,
    /// Focal length in scene units; it only turns `f_stop` into a length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focal_length: Option<f64>,
    /// Distance along the view at which objects are sharp; without it, that of `look_at` or of the scene's middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focus_distance: Option<f64>,
    /// A point that is in focus, instead of `focus_distance`.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub focus_on: Option<[f64; 3]>,
}

#[cfg(feature = "scene-file")]
impl ThinLensParameters {
    /// The pinhole camera through the centre of the lens.
    fn pinhole(&self) -> PinholeParameters {
        let &Self { eye, look_at, direction, up, distance, half_extent, .. } = self;
        let &Self { vertical_fov, margin, zoom, .. } = self;
        PinholeParameters {
            eye,
            look_at,
            direction,
            up,
            distance,
            half_extent,
            vertical_fov,
            margin,
            zoom,
            stereo: None,
        }
    }

    /// The same camera with a position, a direction, the direction that is up, and a point or distance of focus.
    /// Without an `eye` it is placed so that it sees the whole of the subject.
    ///
    /// # Errors
    /// Returns the same errors as [`ThinLensParameters::camera`].
    pub fn placed(&self, aspect: f64, subject: &Subject<'_>) -> Result<Self, CameraError> {
        let PinholeParameters { eye, direction, up, margin, .. } =
            self.pinhole().placed(aspect, subject)?;
        let has_focus = self.focus_distance.is_some() || self.focus_on.is_some();
        let middle =
            (self.eye.is_none() && !has_focus).then(|| subject.bounds().center().to_array());
        Ok(Self { eye, direction, up, margin, focus_on: self.focus_on.or(middle), ..*self })
    }

    /// The camera for a film of the given aspect ratio. Without an `eye` it is placed so that it sees the whole of the
    /// subject.
    ///
    /// # Errors
    /// Returns an error if a value is out of range, or values exclude each other.
    pub fn camera(
        &self,
        aspect: f64,
        subject: &Subject<'_>,
    ) -> Result<ThinLensCamera, CameraError> {
        let (eye, look_at) = (self.eye, self.look_at);
        let pinhole = self.pinhole().camera(aspect, subject)?;
        let radius = match (self.aperture_radius, self.f_stop, self.focal_length) {
            (Some(radius), None, None) => radius,
            (None, Some(f_stop), Some(length)) => ThinLensCamera::aperture_radius(length, f_stop)?,
            (Some(_), _, _) => {
                let message = "`aperture_radius` excludes `f_stop` and `focal_length`; keep one";
                return Err(CameraError::Parameters { message });
            }
            (None, None, None) => {
                let message =
                    "a lens needs an `aperture_radius`, or an `f_stop` with a `focal_length`";
                return Err(CameraError::Parameters { message });
            }
            (None, Some(_), None) | (None, None, Some(_)) => {
                let message = "`f_stop` and `focal_length` need each other: together they give the aperture radius";
                return Err(CameraError::Parameters { message });
            }
        };
        match (self.focus_distance, self.focus_on, look_at, eye) {
            (Some(_), Some(_), _, _) => Err(CameraError::Parameters {
                message: "`focus_distance` and `focus_on` exclude each other; keep one",
            }),
            (Some(distance), None, _, _) => ThinLensCamera::new(pinhole, radius, distance),
            (None, Some(point), _, _) | (None, None, Some(point), _) => {
                ThinLensCamera::focused_on(pinhole, radius, point)
            }
            (None, None, None, None) => {
                ThinLensCamera::focused_on(pinhole, radius, subject.bounds().center())
            }
            (None, None, None, Some(_)) => Err(CameraError::Parameters {
                message: "a `direction` does not say at which distance objects are sharp; give a `focus_distance` or `focus_on`",
            }),
        }
    }
}
