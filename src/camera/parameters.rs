//! The parameters of a camera of any kind, as given by scene files or command-line flags.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::placement::{Placement, PoseParameters, refused};
use super::{
    Camera, CameraError, CameraKind, DEFAULT_MARGIN, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera,
    Pose, ThinLensCamera, Viewpoint, camera_table, checked_length, framing,
};
use crate::exact::{List, Table};
use crate::geometry::subject::Subject;

/// The parameters of a camera of any kind, deserialized from the table `[camera.NAME]` of a scene file. The default is
/// a pinhole camera that frames the scene.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(transparent)]
pub struct CameraParameters(ByKind);

macro_rules! define_camera_parameters {
    ($($(#[$doc:meta])* $variant:ident, $camera:ident, $name:literal, $parameters:ident;)+) => {
        /// The parameters of each kind of camera.
        #[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
        enum ByKind {
            $(#[serde(rename = $name)] $variant(Table<$parameters>),)+
        }

        impl CameraParameters {
            /// The camera for a film of the given aspect ratio. For two eyes, the camera halfway between them. It
            /// frames the subject if the parameters give no position.
            ///
            /// # Errors
            /// Returns an error if a parameter is out of range, or if parameters exclude each other.
            pub fn camera(
                &self,
                aspect: f64,
                subject: &Subject<'_>,
            ) -> Result<Box<dyn Camera>, CameraError> {
                let site = Site::new(&self.place()?, aspect, subject);
                match &self.0 {
                    $(ByKind::$variant(Table(table)) => {
                        Ok(Box::new(table.camera(&site)?))
                    })+
                }
            }

            fn place(&self) -> Result<Placement, CameraError> {
                match self.0 {
                    $(ByKind::$variant(Table(table)) => table.pose().standing(None, DVec3::Y)?.placed(),)+
                }
            }

            /// Says where the camera stands, if nothing says it: outside the scene at the `automatic` viewpoint, if there
            /// is one. `up` is the direction that is up in a view if no parameter says what is.
            ///
            /// # Errors
            /// Returns an error if parameters exclude each other.
            pub fn standing(
                mut self,
                automatic: Option<Viewpoint>,
                up: DVec3,
            ) -> Result<Self, CameraError> {
                match &mut self.0 {
                    $(ByKind::$variant(Table(table)) => {
                        let automatic = automatic.filter(|_| CameraKind::$variant.is_linear());
                        let pose = table.pose().standing(automatic, up)?;
                        (table.direction, table.up) = (pose.direction, pose.up);
                        (table.view, table.turn) = (None, None);
                    })+
                }
                Ok(self)
            }

            fn set_place(&mut self, eye: DVec3, Placement { direction, up, .. }: Placement) {
                let eye = list(eye);
                match &mut self.0 {
                    $(ByKind::$variant(Table(table)) => {
                        (table.eye, table.direction, table.up) = (eye, direction, up);
                        (table.view, table.turn) = (None, None);
                    })+
                }
            }
        }
    };
}
camera_table!(define_camera_parameters);

macro_rules! define_pose {
    ($($(#[$doc:meta])* $variant:ident, $camera:ident, $name:literal, $parameters:ident;)+) => {
        $(impl $parameters {
            fn pose(&self) -> PoseParameters {
                let Self { eye, look_at, direction, up, view, turn, .. } = *self;
                PoseParameters { eye, look_at, direction, up, view, turn }
            }
        })+
    };
}
camera_table!(define_pose);

impl CameraParameters {
    /// Returns this camera with its position, direction and `up` direction filled in, so that it no longer depends on
    /// the subject.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range, or parameters exclude each other.
    pub fn placed(&self, aspect: f64, subject: &Subject<'_>) -> Result<Self, CameraError> {
        let (mut placed, place) = (*self, self.place()?);
        match &mut placed.0 {
            ByKind::Pinhole(Table(table)) => table.margin = None,
            ByKind::Orthographic(Table(table)) => {
                let site = Site::new(&place, aspect, subject);
                let (_, half_extent) = table.wide(&site)?;
                table.half_extent = Some(List(half_extent.to_array()));
                table.margin = None;
            }
            ByKind::ThinLens(Table(table)) => {
                if place.is_framed && table.focus_distance.is_none() && table.focus_on.is_none() {
                    table.focus_on = list(subject.bounds().center());
                }
                table.margin = None;
            }
            ByKind::Panorama(_) | ByKind::Fisheye(_) => {}
        }
        placed.set_place(self.camera(aspect, subject)?.vectors().origin, place);
        Ok(placed)
    }

    /// The cameras of the left and of the right eye. `None` unless the parameters ask for two eyes.
    ///
    /// # Errors
    /// Returns the same errors as [`CameraParameters::camera`].
    pub fn stereo_pair(&self, aspect: f64, subject: &Subject<'_>) -> Result<Option<[Box<dyn Camera>; 2]>, CameraError> {
        fn boxed<C: Camera + 'static>(pair: [C; 2]) -> [Box<dyn Camera>; 2] {
            pair.map(|camera| Box::new(camera) as Box<dyn Camera>)
        }
        let site = Site::new(&self.place()?, aspect, subject);
        Ok(match &self.0 {
            ByKind::Pinhole(Table(table @ PinholeParameters { stereo: Some(eyes), .. })) => {
                Some(boxed(table.camera(&site)?.stereo_pair(eyes.separation, eyes.convergence)?))
            }
            ByKind::Panorama(Table(table @ PanoramaParameters { stereo: Some(eyes), .. })) => {
                Some(boxed(table.camera(&site)?.stereo_pair(eyes.separation, eyes.convergence)?))
            }
            _ => None,
        })
    }
}

impl Default for CameraParameters {
    fn default() -> Self {
        Self(ByKind::Pinhole(Table::default()))
    }
}

/// The table `stereo` of a camera, which asks for one picture per eye.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct StereoParameters {
    /// Distance between the eyes, in scene units.
    separation: f64,
    /// Distance, in scene units, at which objects seem to lie in the screen. Infinite by default.
    #[serde(default = "infinitely_far")]
    convergence: f64,
}

fn infinitely_far() -> f64 {
    f64::INFINITY
}

/// The pose and the aspect ratio for a new camera, and its subject.
struct Site<'a> {
    pose: Pose,
    /// See [`Placement::is_framed`].
    is_framed: bool,
    aspect: f64,
    subject: Subject<'a>,
}

impl<'a> Site<'a> {
    fn new(place: &Placement, aspect: f64, subject: &Subject<'a>) -> Self {
        Self { pose: place.pose, is_framed: place.is_framed, aspect, subject: *subject }
    }
}

/// The margin of a framed picture. A camera with an eye has no margin.
fn margin_of(margin: Option<f64>, is_framed: bool) -> Result<f64, CameraError> {
    if margin.is_some() && !is_framed {
        return refused("`margin` applies only to a camera that frames the scene; remove `margin` or `eye`");
    }
    Ok(margin.unwrap_or(DEFAULT_MARGIN))
}

fn list(point: DVec3) -> Option<List<3>> {
    Some(List(point.to_array()))
}

/// The table `[camera.pinhole]` of a scene file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
struct PinholeParameters {
    eye: Option<List<3>>,
    look_at: Option<List<3>>,
    direction: Option<List<3>>,
    up: Option<List<3>>,
    view: Option<Viewpoint>,
    turn: Option<f64>,
    /// Distance of the view plane from the eye.
    distance: Option<f64>,
    /// Half width and half height of the view plane.
    half_extent: Option<List<2>>,
    /// Vertical field of view in degrees, instead of `distance` and `half_extent`.
    vertical_fov: Option<f64>,
    /// The fraction of the picture that a camera without an eye leaves free beside the scene, from 0 to 0.45.
    margin: Option<f64>,
    /// The enlargement of the picture about its middle, by a narrower field of view.
    zoom: Option<f64>,
    /// The settings of two eyes.
    stereo: Option<StereoParameters>,
}

impl PinholeParameters {
    fn camera(&self, site: &Site<'_>) -> Result<PinholeCamera, CameraError> {
        let Site { pose, is_framed, aspect, subject } = *site;
        let fov = self.vertical_fov.map_or(PinholeCamera::DEFAULT_FOV_RADIANS, f64::to_radians);
        match (self.half_extent, self.distance) {
            (Some(_), _) if self.vertical_fov.is_some() => {
                return refused("`vertical_fov` and `half_extent` exclude each other; keep one");
            }
            (None, Some(_)) => {
                return refused("`distance` needs a `half_extent`; a field of view needs neither");
            }
            (Some(_), _) if is_framed => {
                return refused("`half_extent` needs an `eye`; to frame the whole scene give `vertical_fov`");
            }
            _ => {}
        }
        let margin = margin_of(self.margin, is_framed)?;
        let wide = match self.half_extent {
            _ if is_framed => PinholeCamera::framing(subject, pose, fov, aspect, margin),
            Some(List(half_extent)) => PinholeCamera::new(pose, self.distance.unwrap_or(1.0), half_extent),
            None => PinholeCamera::with_vertical_fov(pose, fov, aspect),
        };
        wide?.zoomed(self.zoom)
    }
}

/// The table `[camera.orthographic]` of a scene file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
struct OrthographicParameters {
    /// The middle of the view plane.
    eye: Option<List<3>>,
    look_at: Option<List<3>>,
    direction: Option<List<3>>,
    up: Option<List<3>>,
    view: Option<Viewpoint>,
    turn: Option<f64>,
    /// Half width and half height of the view plane.
    half_extent: Option<List<2>>,
    /// The fraction of the picture that a camera without an eye leaves free beside the scene, from 0 to 0.45.
    margin: Option<f64>,
    /// The enlargement of the picture about its middle.
    zoom: Option<f64>,
}

impl OrthographicParameters {
    /// The pose, and the half extent of the view plane before the picture is enlarged.
    fn wide(&self, site: &Site<'_>) -> Result<(Pose, DVec2), CameraError> {
        let Site { pose, is_framed, aspect, subject } = *site;
        let margin = margin_of(self.margin, is_framed)?;
        match self.half_extent {
            Some(_) if is_framed => refused("`half_extent` needs an `eye`; to frame the whole scene leave both out"),
            None if !is_framed => refused("an `eye` needs a `half_extent`"),
            Some(List(half_extent)) => Ok((pose, half_extent.into())),
            None => {
                let framed = OrthographicCamera::framing(subject, pose, aspect, margin)?;
                Ok((framed.pose, framed.half_extent))
            }
        }
    }

    fn camera(&self, site: &Site<'_>) -> Result<OrthographicCamera, CameraError> {
        let (pose, half_extent) = self.wide(site)?;
        let zoom = self.zoom.map_or(Ok(1.0), |zoom| checked_length("`zoom`", zoom))?;
        OrthographicCamera::new(pose, half_extent / zoom)
    }
}

/// The table `[camera.thin-lens]` of a scene file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
struct ThinLensParameters {
    /// The middle of the lens.
    eye: Option<List<3>>,
    look_at: Option<List<3>>,
    direction: Option<List<3>>,
    up: Option<List<3>>,
    view: Option<Viewpoint>,
    turn: Option<f64>,
    distance: Option<f64>,
    half_extent: Option<List<2>>,
    vertical_fov: Option<f64>,
    margin: Option<f64>,
    zoom: Option<f64>,
    /// Radius of the lens in scene units.
    aperture_radius: Option<f64>,
    /// F-number (focal length over diameter), given together with `focal_length` instead of `aperture_radius`.
    f_stop: Option<f64>,
    /// Focal length in scene units. It only turns `f_stop` into a length.
    focal_length: Option<f64>,
    /// Distance along the view at which objects are sharp. By default, that of `look_at` or of the scene's middle.
    focus_distance: Option<f64>,
    /// A point that is in focus, instead of `focus_distance`.
    focus_on: Option<List<3>>,
}

impl ThinLensParameters {
    /// The pinhole camera through the centre of the lens, without its position.
    fn pinhole(&self) -> PinholeParameters {
        let Self { distance, half_extent, vertical_fov, margin, zoom, .. } = *self;
        let default = PinholeParameters::default();
        PinholeParameters { distance, half_extent, vertical_fov, margin, zoom, ..default }
    }

    fn camera(&self, site: &Site<'_>) -> Result<ThinLensCamera, CameraError> {
        let pinhole = self.pinhole().camera(site)?;
        let radius = match (self.aperture_radius, self.f_stop, self.focal_length) {
            (Some(radius), None, None) => radius,
            (None, Some(f_stop), Some(length)) => ThinLensCamera::aperture_radius(length, f_stop)?,
            (Some(_), _, _) => {
                return refused("`aperture_radius` excludes `f_stop` and `focal_length`; keep one");
            }
            (None, None, None) => {
                return refused("a lens needs an `aperture_radius`, or an `f_stop` with a `focal_length`");
            }
            (None, Some(_), None) | (None, None, Some(_)) => {
                return refused("`f_stop` and `focal_length` need each other: together they give the aperture radius");
            }
        };
        let point = match (self.focus_distance, self.focus_on.or(self.look_at), self.eye) {
            (Some(_), _, _) if self.focus_on.is_some() => {
                return refused("`focus_distance` and `focus_on` exclude each other; keep one");
            }
            (Some(distance), _, _) => return ThinLensCamera::new(pinhole, radius, distance),
            (None, Some(List(point)), _) => point.into(),
            (None, None, None) => site.subject.bounds().center(),
            (None, None, Some(_)) => {
                return refused(
                    "a `direction` does not say at which distance objects are sharp; give a `focus_distance` or `focus_on`",
                );
            }
        };
        ThinLensCamera::focused_on(pinhole, radius, point)
    }
}

/// The table `[camera.panorama]` of a scene file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
struct PanoramaParameters {
    /// Position of the camera. By default, the middle of the scene.
    eye: Option<List<3>>,
    /// The point in the middle of the picture.
    look_at: Option<List<3>>,
    direction: Option<List<3>>,
    up: Option<List<3>>,
    view: Option<Viewpoint>,
    turn: Option<f64>,
    /// The settings of two eyes.
    stereo: Option<StereoParameters>,
}

impl PanoramaParameters {
    fn camera(&self, site: &Site<'_>) -> Result<PanoramaCamera, CameraError> {
        let Site { pose, is_framed, subject, .. } = *site;
        Ok(PanoramaCamera::new(match is_framed {
            true => pose.framing(&subject.bounds(), DVec3::ZERO)?,
            false => pose,
        }))
    }
}

/// The table `[camera.fisheye]` of a scene file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
struct FisheyeParameters {
    eye: Option<List<3>>,
    look_at: Option<List<3>>,
    direction: Option<List<3>>,
    up: Option<List<3>>,
    view: Option<Viewpoint>,
    turn: Option<f64>,
    /// The angle across the whole disk, in degrees.
    angle: Option<f64>,
}

impl FisheyeParameters {
    fn camera(&self, site: &Site<'_>) -> Result<FisheyeCamera, CameraError> {
        let Site { pose, is_framed, aspect, subject } = *site;
        let angle = self.angle.map_or(FisheyeCamera::DEFAULT_ANGLE_RADIANS, f64::to_radians);
        let camera = FisheyeCamera::new(pose, angle, aspect)?;
        if !is_framed {
            return Ok(camera);
        }
        let bounds = subject.bounds();
        let back = framing::round_distance(&bounds, 0.5 * angle) * pose.basis().w();
        FisheyeCamera::new(pose.framing(&bounds, back)?, angle, aspect)
    }
}
