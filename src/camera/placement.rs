//! The placement of a camera in a scene file.

use glam::DVec3;

use super::{CameraError, Pose, Viewpoint, turned};
use crate::exact::List;

/// The eye, target and `up`, which the tables of all cameras have. Without an eye, the camera is placed so that it sees
/// the whole scene.
pub(super) struct PoseParameters {
    /// Position of the camera.
    pub(super) eye: Option<List<3>>,
    /// The point at which the camera looks.
    pub(super) look_at: Option<List<3>>,
    /// The direction in which the camera looks, instead of `look_at`.
    pub(super) direction: Option<List<3>>,
    /// The `up` direction in the picture. By default it is +y, or another axis in a view along y.
    pub(super) up: Option<List<3>>,
    /// Where a camera without an eye stands, instead of `direction`.
    pub(super) view: Option<Viewpoint>,
    /// The angle in degrees by which a camera without an eye is turned about `up`, counter-clockwise seen from above.
    pub(super) turn: Option<f64>,
}

/// The pose that [`PoseParameters`] give, and how it was found.
pub(super) struct Placement {
    pub(super) pose: Pose,
    /// Whether the position follows from what the camera must see. If so, the pose has only the orientation.
    pub(super) is_framed: bool,
    pub(super) direction: Option<List<3>>,
    pub(super) up: Option<List<3>>,
}

impl PoseParameters {
    /// Turns `view` and `turn` into a direction. A camera that has neither an eye nor a direction stands at the
    /// `automatic` viewpoint. A view has `default_up` up if `up` is not given.
    pub(super) fn standing(mut self, automatic: Option<Viewpoint>, default_up: DVec3) -> Result<Self, CameraError> {
        let is_placed = self.eye.is_some() || self.look_at.is_some() || self.direction.is_some();
        if self.view.is_some() && is_placed {
            return refused("`view` excludes `eye`, `look_at` and `direction`; keep one");
        }
        if self.turn.is_some() && self.eye.is_some() {
            return refused("`turn` applies only to a camera that frames the scene; remove `turn` or `eye`");
        }
        let turn = self.turn.take().unwrap_or(0.0);
        if !turn.is_finite() {
            return refused("`turn` must be a finite angle");
        }
        let up = self.up.map_or(default_up, |List(up)| up.into());
        if let Some(view) = self.view.take().or(automatic.filter(|_| !is_placed)) {
            let axes = view.axes(up, turn).map(|axis| Some(List(axis.to_array())));
            [self.direction, self.up] = axes;
        } else if turn != 0.0 {
            let direction = self.direction.map_or(DVec3::NEG_Z, |List(direction)| direction.into());
            self.direction = Some(List(turned(direction, up, turn).to_array()));
        }
        Ok(self)
    }

    pub(super) fn placed(&self) -> Result<Placement, CameraError> {
        let Self { eye, look_at, direction, .. } = *self;
        let (eye, toward) = match (eye, look_at, direction) {
            (Some(List(eye)), Some(List(look_at)), None) => {
                let toward = DVec3::from(look_at) - DVec3::from(eye);
                let at = |up: [f64; 3]| Pose::looking_at(eye, look_at, up);
                return self.upright(toward, at, direction, false);
            }
            (Some(List(eye)), None, Some(List(direction))) => (Some(eye), direction),
            (Some(_), None, None) => {
                return refused("an `eye` needs a `look_at` point or a `direction`");
            }
            (_, Some(_), Some(_)) => {
                return refused("`look_at` and `direction` exclude each other; keep one");
            }
            (None, Some(_), None) => {
                return refused("`look_at` needs an `eye`; to frame the whole scene give a `direction`");
            }
            (None, None, direction) => (None, direction.map_or(Pose::DEFAULT_DIRECTION, |direction| direction.0)),
        };
        let along = |up: [f64; 3]| Pose::looking_along(eye.unwrap_or_default(), toward, up);
        self.upright(toward.into(), along, Some(List(toward)), eye.is_none())
    }

    /// Makes a pose with the `up` direction. If none was given, it is +y, or for a view straight down or up the
    /// horizontal direction that [`Viewpoint::axes`](super::Viewpoint::axes) chooses.
    fn upright(
        &self,
        toward: DVec3,
        pose: impl Fn([f64; 3]) -> Result<Pose, CameraError>,
        direction: Option<List<3>>,
        is_framed: bool,
    ) -> Result<Placement, CameraError> {
        let up = self.up.map_or([0.0, 1.0, 0.0], |up| up.0);
        let (pose, up) = match pose(up) {
            Err(CameraError::UpParallelToView { .. }) if self.up.is_none() => {
                let up = [0.0, 0.0, if toward.y < 0.0 { -1.0 } else { 1.0 }];
                (pose(up)?, up)
            }
            pose => (pose?, up),
        };
        Ok(Placement { pose, is_framed, direction, up: Some(List(up)) })
    }
}

pub(super) fn refused<T>(message: &str) -> Result<T, CameraError> {
    Err(CameraError::Invalid(message.to_owned()))
}
