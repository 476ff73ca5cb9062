//! Cameras that move along a path given by keyframes.

use std::fmt;

use glam::{DQuat, DVec3};

use super::path_curve::{Curve, Track};
use super::{CameraError, Pose, Viewpoint, checked_fov, checked_range};

/// The unit in which the times of keyframes count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathClock {
    /// Pictures, or the frames of a trajectory, from 0.
    Frames,
    /// Seconds of the movie.
    Seconds,
}

/// The position and the view of a keyframe's camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeyPlace {
    /// At a point, in scene units.
    Point {
        /// Position of the camera.
        eye: DVec3,
        /// The point at which the camera looks.
        look_at: DVec3,
        /// The `up` direction in the picture, if it differs from that of the whole path.
        up: Option<DVec3>,
    },
    /// On a sphere around the subject.
    View {
        /// The side or the angles from which the camera looks.
        viewpoint: Viewpoint,
        /// The turn of the camera in degrees about the `up` direction, counter-clockwise seen from above. Full turns
        /// count: from 0 to 720, the camera goes around twice.
        turn: f64,
    },
}

/// The camera at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraKey {
    /// The frame or second, see [`PathClock`].
    pub time: f64,
    /// The position and the view of the camera.
    pub place: KeyPlace,
    /// Vertical field of view in radians. Keys without it do not affect it.
    pub fov_radians: Option<f64>,
    /// The enlargement of the picture about its middle. Keys without it do not affect it.
    pub zoom: Option<f64>,
}

/// The reason why keyframes do not make a path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
#[non_exhaustive]
pub struct CameraPathError {
    /// The wrong key, counted from 0. `None` if there are not enough keys.
    pub key: Option<usize>,
    /// The problem, and what to do.
    pub message: String,
}

impl CameraPathError {
    fn of(key: usize, message: impl fmt::Display) -> Self {
        Self { key: Some(key), message: format!("key {key}: {message}") }
    }
}

/// The checked keyframes of a camera. [`CameraPath::motion`] makes the motion through them.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    keys: Vec<CameraKey>,
    clock: PathClock,
    eases: bool,
}

impl CameraPath {
    /// The largest magnitude of a key's time or angle, and the largest zoom.
    const MOST: f64 = 1e9;

    /// Checks keyframes. With `eases`, the camera starts and ends at rest, so that its velocity is also continuous at
    /// the ends of the path.
    ///
    /// # Errors
    /// Returns an error if there are fewer than two keys, their times do not ascend, a number is not finite or out of
    /// range, a key's eye is at its target or its `up` parallel to its view, or some keys have an eye and others a view.
    pub fn new(keys: Vec<CameraKey>, clock: PathClock, eases: bool) -> Result<Self, CameraPathError> {
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
                    let mixed = "some keys have an eye and others a view; give all keys of a path the same";
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

    /// The unit in which the times of the keys count.
    #[must_use]
    pub fn clock(&self) -> PathClock {
        self.clock
    }

    /// Returns true if the camera starts and ends at rest.
    #[must_use]
    pub fn eases(&self) -> bool {
        self.eases
    }

    /// Time of the last key.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.keys.last().map_or(0.0, |key| key.time)
    }

    /// The motion through the keys. `up` is the `up` direction of keys that give none, and the axis about which views
    /// are turned. It need not be a unit vector. Without a direction, it is +y.
    ///
    /// # Errors
    /// Returns an error if the `up` directions of two neighbouring keys are opposite.
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
            let track = |i: usize| Track::new(angles.iter().map(|(time, angles)| (*time, angles[i])), self.eases);
            Places::Views { azimuth: track(0), elevation: track(1), up }
        } else {
            let points: Vec<(f64, [DVec3; 3])> = self.keys.iter().map(|key| (key.time, points(key, up))).collect();
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
                // A key without an `up` of its own gets another one in this case.
                Err(CameraError::UpParallelToView { .. }) if up.is_none() => {}
                made => made.map(drop).map_err(|error| CameraPathError::of(key, error))?,
            }
        }
    }
    now.fov_radians.map_or(Ok(()), checked_fov).map_err(|error| CameraPathError::of(key, error))
}

/// Azimuth and elevation of a key in radians, including its turns.
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

/// The eye, target and `up` unit vector of a key.
fn points(key: &CameraKey, of_path: DVec3) -> [DVec3; 3] {
    let KeyPlace::Point { eye, look_at, up } = key.place else { return [DVec3::ZERO; 3] };
    let up = up.and_then(DVec3::try_normalize).unwrap_or_else(|| {
        // In a view from straight above or below, the direction away from azimuth 0, as in `Viewpoint::axes`.
        let toward = (look_at - eye).normalize_or_zero();
        let is_vertical = toward.cross(of_path).length() < 1e-6;
        let front = DQuat::from_rotation_arc(DVec3::Y, of_path) * DVec3::Z;
        if is_vertical { front * toward.dot(of_path).signum() } else { of_path }
    });
    [eye, look_at, up]
}

/// The camera at one moment of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CameraOnPath {
    /// The position and the view of the camera.
    pub place: PlaceOnPath,
    /// Vertical field of view in radians, if a key gives it.
    pub fov_radians: Option<f64>,
    /// The enlargement of the picture about its middle, if a key gives it.
    pub zoom: Option<f64>,
}

/// The position and the view of the camera at one moment of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaceOnPath {
    /// At a point.
    Point {
        /// Position of the camera.
        eye: DVec3,
        /// The point at which the camera looks. Between two keys, it may coincide with the eye.
        look_at: DVec3,
        /// The `up` direction in the picture: a unit vector, perpendicular to the direction of view.
        up: DVec3,
    },
    /// On a sphere around the subject.
    View {
        /// The direction in which the camera looks: a unit vector.
        direction: DVec3,
        /// The `up` direction in the picture: a unit vector, perpendicular to `direction`.
        up: DVec3,
    },
}

/// The smooth motion of a camera through the keys of a path.
///
/// Position and target move on centripetal Catmull–Rom splines. The logarithms of field of view and zoom are
/// interpolated. These, and the angles of views, stay between the values of neighbouring keys. Velocities are
/// continuous between the first and the last key. Before and after them, the camera stands still.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraMotion {
    places: Places,
    log_fov: Option<Track>,
    log_zoom: Option<Track>,
}

#[derive(Clone, Debug, PartialEq)]
enum Places {
    /// The curves of the eye, the target and the `up` direction.
    Points(Box<[Curve; 3]>),
    Views {
        azimuth: Track,
        elevation: Track,
        up: DVec3,
    },
}

impl CameraMotion {
    /// The camera at a time, in the unit of [`CameraPath::clock`].
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
                PlaceOnPath::View { direction: -(cosine * front + sine * *up), up: cosine * *up - sine * front }
            }
        };
        let value = |track: &Option<Track>| track.as_ref().map(|track| track.at(time).exp());
        CameraOnPath { place, fov_radians: value(&self.log_fov), zoom: value(&self.log_zoom) }
    }
}

/// The component of `up` that is perpendicular to the view. At single moments between keys it may be zero. Then any
/// perpendicular direction.
fn upright(view: DVec3, up: DVec3) -> DVec3 {
    let Some(view) = view.try_normalize() else { return up.normalize_or(DVec3::Y) };
    let (beside, any) = (up - up.dot(view) * view, view.any_orthonormal_vector());
    if beside.length() > 1e-9 * up.length() { beside.normalize_or(any) } else { any }
}
