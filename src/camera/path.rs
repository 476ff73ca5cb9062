//! Cameras that move along a path, which is given by keyframes.

use std::fmt;

use glam::{DQuat, DVec3};

use super::path_curve::{Curve, Track};
use super::{CameraError, Pose, Viewpoint, checked_fov, checked_range};

/// What the times of keyframes count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathClock {
    /// Pictures, or the frames of a trajectory, from 0.
    Frames,
    /// Seconds of the movie.
    Seconds,
}

/// Where the camera of a keyframe is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeyPlace {
    /// At a point, in scene units.
    Point {
        /// Position of the camera.
        eye: DVec3,
        /// The point at which the camera looks.
        look_at: DVec3,
        /// The direction that is up in the picture, if it is not that of the whole path.
        up: Option<DVec3>,
    },
    /// On a sphere around the subject.
    View {
        /// From where the camera looks.
        viewpoint: Viewpoint,
        /// By how many degrees the camera is turned about the direction that is up, counter-clockwise seen from above.
        /// Full turns count: from 0 to 720 the camera goes around twice.
        turn: f64,
    },
}

/// The camera of one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraKey {
    /// The frame or second, see [`PathClock`].
    pub time: f64,
    /// Where the camera is.
    pub place: KeyPlace,
    /// Vertical field of view in radians; keys without it do not decide it.
    pub fov_radians: Option<f64>,
    /// How much the picture is enlarged about its middle; keys without it do not decide it.
    pub zoom: Option<f64>,
}

/// Why keyframes do not make a path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
#[non_exhaustive]
pub struct CameraPathError {
    /// The key that is wrong, counted from 0; `None` if there are not enough keys.
    pub key: Option<usize>,
    /// The problem, and what to do.
    pub message: String,
}

impl CameraPathError {
    fn of(key: usize, message: impl fmt::Display) -> Self {
        Self { key: Some(key), message: format!("key {key}: {message}") }
    }
}

/// Keyframes of a camera, checked. [`CameraPath::motion`] makes the motion through them.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    keys: Vec<CameraKey>,
    clock: PathClock,
    eases: bool,
}

impl CameraPath {
    /// The largest time, angle and zoom of a key, and the smallest with a minus.
    const MOST: f64 = 1e9;

    /// Checks keyframes. With `eases`, the camera starts and ends at rest, so that its velocity is continuous also
    /// where the path begins and ends.
    ///
    /// # Errors
    /// Returns an error if there are fewer than two keys, their times do not ascend, a number is not finite or out of
    /// range, a key's eye is at its target or its `up` parallel to its view, or some keys have an eye and others a view.
    pub fn new(
        keys: Vec<CameraKey>,
        clock: PathClock,
        eases: bool,
    ) -> Result<Self, CameraPathError> {
        if keys.len() < 2 {
            let few = if keys.is_empty() { "is none" } else { "is only one" };
            let message = format!("a camera path needs at least two keys, but there {few}");
            return Err(CameraPathError { key: None, message });
        }
        let mut before: Option<CameraKey> = None;
        for (key, now) in keys.iter().enumerate() {
            check(key, now)?;
            if let Some(before) = before {
                if now.time <= before.time {
                    let message = format!(
                        "key {key} is at {:?}, which is not later than key {} at {:?}; keys stand in the order of time",
                        now.time,
                        key - 1,
                        before.time
                    );
                    return Err(CameraPathError { key: Some(key), message });
                }
                if is_view(&before) != is_view(now) {
                    let mixed =
                        "some keys have an eye and others a view; give all keys of a path the same";
                    return Err(CameraPathError::of(key, mixed));
                }
            }
            before = Some(*now);
        }
        Ok(Self { keys, clock, eases })
    }

    /// The keyframes.
    #[must_use]
    pub fn keys(&self) -> &[CameraKey] {
        &self.keys
    }

    /// What the times of the keys count.
    #[must_use]
    pub fn clock(&self) -> PathClock {
        self.clock
    }

    /// Whether the camera starts and ends at rest.
    #[must_use]
    pub fn eases(&self) -> bool {
        self.eases
    }

    /// Time of the last key.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.keys.last().map_or(0.0, |key| key.time)
    }

    /// The motion through the keys, where `up` is the direction that is up for keys that give none, and about which
    /// views are turned. It need not be a unit vector; without a direction, +y is taken.
    ///
    /// # Errors
    /// Returns an error if the directions that are up in two neighbouring keys are opposite.
    pub fn motion(&self, up: DVec3) -> Result<CameraMotion, CameraPathError> {
        let up = up.try_normalize().unwrap_or(DVec3::Y);
        let track = |value: &dyn Fn(&CameraKey) -> Option<f64>| {
            let given = self.keys.iter().filter_map(|key| Some((key.time, value(key)?)));
            let given = given.collect::<Vec<_>>();
            (!given.is_empty()).then(|| Track::new(given, self.eases))
        };
        let places = if self.keys.iter().any(is_view) {
            let angles = self.keys.iter().map(|key| (key.time, angles(key, up)));
            let angles: Vec<(f64, [f64; 2])> = angles.collect();
            let track = |i: usize| {
                Track::new(angles.iter().map(|(time, angles)| (*time, angles[i])), self.eases)
            };
            Places::Views { azimuth: track(0), elevation: track(1), up }
        } else {
            let points: Vec<(f64, [DVec3; 3])> =
                self.keys.iter().map(|key| (key.time, points(key, up))).collect();
            for (key, pair) in points.windows(2).enumerate() {
                if pair[0].1[2].dot(pair[1].1[2]) < -0.999_999 {
                    let message = format!(
                        "its direction that is up is opposite to that of key {key}; add a key between them that says to \
                         which side the camera rolls"
                    );
                    return Err(CameraPathError::of(key + 1, message));
                }
            }
            let curve = |i: usize| {
                let of_one: Vec<_> = points.iter().map(|(time, all)| (*time, all[i])).collect();
                Curve::new(&of_one, self.eases)
            };
            Places::Points(Box::new([0, 1, 2].map(curve)))
        };
        Ok(CameraMotion {
            places,
            log_fov: track(&|key| key.fov_radians.map(f64::ln)),
            log_zoom: track(&|key| key.zoom.map(f64::ln)),
        })
    }
}

fn is_view(key: &CameraKey) -> bool {
    matches!(key.place, KeyPlace::View { .. })
}

/// Checks one key by itself.
fn check(key: usize, now: &CameraKey) -> Result<(), CameraPathError> {
    let most = CameraPath::MOST;
    let within = |parameter, value, range| {
        checked_range(parameter, value, range).map_err(|error| CameraPathError::of(key, error))
    };
    within("time", now.time, [-most, most])?;
    if let Some(zoom) = now.zoom {
        within("zoom", zoom, [1.0 / most, most])?;
    }
    match now.place {
        KeyPlace::View { viewpoint, turn } => {
            within("turn", turn, [-most, most])?;
            if let Viewpoint::Angles { azimuth, elevation } = viewpoint {
                within("azimuth", azimuth, [-most, most])?;
                within("elevation", elevation, [-90.0, 90.0])?;
            }
        }
        KeyPlace::Point { eye, look_at, up } => {
            match Pose::looking_at(eye, look_at, up.unwrap_or(DVec3::Y)) {
                // Without an `up` of its own, such a key gets another one.
                Err(CameraError::UpParallelToView { .. }) if up.is_none() => {}
                made => made.map(drop).map_err(|error| CameraPathError::of(key, error))?,
            }
        }
    }
    now.fov_radians.map_or(Ok(()), checked_fov).map_err(|error| CameraPathError::of(key, error))
}

/// Azimuth and elevation of a key, in radians, with the turns.
fn angles(key: &CameraKey, up: DVec3) -> [f64; 2] {
    let KeyPlace::View { viewpoint, turn } = key.place else { return [0.0; 2] };
    let from_y = DQuat::from_rotation_arc(DVec3::Y, up);
    let [azimuth, elevation] = match viewpoint {
        Viewpoint::Angles { azimuth, elevation } => [azimuth, elevation].map(f64::to_radians),
        Viewpoint::Axis { .. } => {
            let [direction, _] = viewpoint.axes(up, 0.0);
            let place = from_y.inverse() * -direction;
            let beside = place.x.hypot(place.z);
            let azimuth = if beside < 1e-9 { 0.0 } else { place.x.atan2(place.z) };
            [azimuth, place.y.atan2(beside)]
        }
    };
    [azimuth + turn.to_radians(), elevation]
}

/// Eye, target and the unit vector that is up of a key.
fn points(key: &CameraKey, of_path: DVec3) -> [DVec3; 3] {
    let KeyPlace::Point { eye, look_at, up } = key.place else { return [DVec3::ZERO; 3] };
    let up = up.and_then(DVec3::try_normalize).unwrap_or_else(|| {
        // Seen from straight above or below, the direction away from azimuth 0, as `Viewpoint::axes` has it.
        let toward = (look_at - eye).normalize_or_zero();
        let is_vertical = toward.cross(of_path).length() < 1e-6;
        let front = DQuat::from_rotation_arc(DVec3::Y, of_path) * DVec3::Z;
        if is_vertical { front * toward.dot(of_path).signum() } else { of_path }
    });
    [eye, look_at, up]
}

/// The camera of one moment of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CameraOnPath {
    /// Where the camera is.
    pub place: PlaceOnPath,
    /// Vertical field of view in radians, if a key says it.
    pub fov_radians: Option<f64>,
    /// How much the picture is enlarged about its middle, if a key says it.
    pub zoom: Option<f64>,
}

/// Where the camera is at one moment of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaceOnPath {
    /// At a point.
    Point {
        /// Position of the camera.
        eye: DVec3,
        /// The point at which the camera looks. Between two keys, it may be that of the eye.
        look_at: DVec3,
        /// The direction that is up in the picture: a unit vector, perpendicular to the direction of view.
        up: DVec3,
    },
    /// On a sphere around the subject.
    View {
        /// The direction in which the camera looks: a unit vector.
        direction: DVec3,
        /// The direction that is up in the picture: a unit vector, perpendicular to `direction`.
        up: DVec3,
    },
}

/// The smooth motion of a camera through the keys of a path.
///
/// Position and target move on centripetal Catmull–Rom splines. Field of view and zoom are interpolated in logarithms,
/// and they and the angles of views stay between those of neighbouring keys. Velocities are continuous between the first
/// and the last key; before and after them the camera stands still.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraMotion {
    places: Places,
    log_fov: Option<Track>,
    log_zoom: Option<Track>,
}

#[derive(Clone, Debug, PartialEq)]
enum Places {
    /// Eye, target and up.
    Points(Box<[Curve; 3]>),
    Views {
        azimuth: Track,
        elevation: Track,
        up: DVec3,
    },
}

impl CameraMotion {
    /// The camera at a time, which is counted as [`CameraPath::clock`] says.
    #[must_use]
    pub fn at(&self, time: f64) -> CameraOnPath {
        let place = match &self.places {
            Places::Points(curves) => {
                let [eye, look_at, up] = curves.each_ref().map(|curve| curve.at(time));
                PlaceOnPath::Point { eye, look_at, up: upright(look_at - eye, up) }
            }
            Places::Views { azimuth, elevation, up } => {
                let from_y = DQuat::from_rotation_arc(DVec3::Y, *up);
                let (sine, cosine) = azimuth.at(time).sin_cos();
                let front = from_y * DVec3::new(sine, 0.0, cosine);
                let (sine, cosine) = elevation.at(time).sin_cos();
                PlaceOnPath::View {
                    direction: -(cosine * front + sine * *up),
                    up: cosine * *up - sine * front,
                }
            }
        };
        let value = |track: &Option<Track>| track.as_ref().map(|track| track.at(time).exp());
        CameraOnPath { place, fov_radians: value(&self.log_fov), zoom: value(&self.log_zoom) }
    }
}

/// The part of `up` that is perpendicular to the view. Where there is none, which happens at single moments between
/// keys, any perpendicular direction.
fn upright(view: DVec3, up: DVec3) -> DVec3 {
    let Some(view) = view.try_normalize() else { return up.normalize_or(DVec3::Y) };
    let (beside, any) = (up - up.dot(view) * view, view.any_orthonormal_vector());
    if beside.length() > 1e-9 * up.length() { beside.normalize_or(any) } else { any }
}
