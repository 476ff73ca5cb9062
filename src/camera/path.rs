//! Cameras that move along a path, which is given by keyframes.

use std::f64::consts::PI;
use std::fmt;
use std::ops::{Add, Mul};

use glam::{DQuat, DVec3};

use super::{CameraError, Pose, Viewpoint};

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
    /// What is wrong with it, and what to do.
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
    let within = |parameter, value: f64, [low, high]: [f64; 2]| {
        if (low..=high).contains(&value) {
            Ok(())
        } else {
            let error = CameraError::Range { parameter, value, low, high };
            Err(CameraPathError::of(key, error))
        }
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
    match now.fov_radians {
        Some(radians) if !(radians > 0.0 && radians < PI) => {
            Err(CameraPathError::of(key, CameraError::FieldOfView { radians }))
        }
        _ => Ok(()),
    }
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

/// A function of time that takes given values at given times. It is monotone wherever the values are, so it never goes
/// beyond two neighbours, and has a continuous derivative. Before the first and after the last time it is constant.
///
/// The slopes are those of F. N. Fritsch and J. Butland, A method for constructing local monotone piecewise cubic
/// interpolants, SIAM Journal on Scientific and Statistical Computing 5(2), 1984, for uneven times as in C. Moler,
/// Numerical Computing with MATLAB, section 3.4.
#[derive(Clone, Debug, PartialEq)]
struct Track {
    times: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Track {
    /// The function through `(time, value)`, of which there is at least one, with ascending times. With `ease`, it
    /// starts and ends at rest.
    fn new(points: impl IntoIterator<Item = (f64, f64)>, ease: bool) -> Self {
        let (times, values): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let rises = values.windows(2).zip(&steps).map(|(pair, step)| (pair[1] - pair[0]) / step);
        let rises: Vec<f64> = rises.collect();
        let inner = steps.windows(2).zip(rises.windows(2)).map(|(h, d)| {
            let (first, second) = (2.0 * h[1] + h[0], h[1] + 2.0 * h[0]);
            let is_turn = d[0] * d[1] <= 0.0;
            if is_turn { 0.0 } else { (first + second) / (first / d[0] + second / d[1]) }
        });
        let end = |at: [usize; 2]| match (rises.get(at[0]), rises.get(at[1])) {
            _ if ease => 0.0,
            (Some(near), Some(far)) => end_slope(at.map(|at| steps[at]), [*near, *far]),
            (Some(only), None) | (None, Some(only)) => *only,
            (None, None) => 0.0,
        };
        let count = rises.len();
        let last = end([count.wrapping_sub(1), count.wrapping_sub(2)]);
        let mut slopes: Vec<f64> = std::iter::once(end([0, 1])).chain(inner).collect();
        if count > 0 {
            slopes.push(last);
        }
        Self { times, values, slopes }
    }

    /// The value at a time.
    fn at(&self, time: f64) -> f64 {
        between(time, &self.times, &self.values, &self.slopes)
    }
}

/// The slope at an end, from a parabola through three points, which must not lead away from its neighbour.
fn end_slope(steps: [f64; 2], rises: [f64; 2]) -> f64 {
    let [near, far] = steps;
    let slope = ((2.0 * near + far) * rises[0] - near * rises[1]) / (near + far);
    if slope * rises[0] <= 0.0 {
        0.0
    } else if rises[0] * rises[1] <= 0.0 && slope.abs() > 3.0 * rises[0].abs() {
        3.0 * rises[0]
    } else {
        slope
    }
}

/// The weights of two values and of two slopes in a cubic, at a place from 0 to 1.
fn hermite(s: f64) -> [f64; 4] {
    let rest = 1.0 - s;
    let end = s * s * (3.0 - 2.0 * s);
    [1.0 - end, end, s * rest * rest, -s * s * rest]
}

/// The cubic curve through `values` at `places`, of which there is at least one, with these slopes. Before the first and
/// after the last place it is constant.
fn between<T>(place: f64, places: &[f64], values: &[T], slopes: &[T]) -> T
where
    T: Copy + Add<Output = T>,
    f64: Mul<T, Output = T>,
{
    let last = places.len() - 1;
    let next = places.partition_point(|at| *at <= place);
    match next {
        0 => values[0],
        _ if next > last => values[last],
        _ => {
            let index = next - 1;
            let step = places[next] - places[index];
            let [a, b, c, d] = hermite((place - places[index]) / step);
            a * values[index] + b * values[next] + step * (c * slopes[index] + d * slopes[next])
        }
    }
}

/// A curve in space that passes through given points at given times.
///
/// Its shape is a centripetal Catmull–Rom spline (C. Yuksel, S. Schaefer and J. Keyser, Parameterization and
/// applications of Catmull–Rom curves, Computer-Aided Design 43(7), 2011), which has no cusps and no loops between two
/// points however uneven their distances are. A [`Track`] says when which place of it is reached, so that the velocity
/// is continuous, and nothing moves between two equal points.
#[derive(Clone, Debug, PartialEq)]
struct Curve {
    /// The points, of which no two neighbours are equal.
    points: Vec<DVec3>,
    /// The parameter of each point.
    knots: Vec<f64>,
    /// The derivative by the parameter at each point.
    tangents: Vec<DVec3>,
    parameter: Track,
}

impl Curve {
    /// The curve through `(time, point)`, of which there is at least one, with ascending times.
    fn new(all: &[(f64, DVec3)], ease: bool) -> Self {
        let (mut points, mut knots): (Vec<DVec3>, Vec<f64>) = (Vec::new(), Vec::new());
        let mut along = Vec::new();
        for &(time, point) in all {
            if points.last() != Some(&point) {
                let before = points.last().zip(knots.last());
                let next =
                    before.map_or(0.0, |(before, knot)| knot + before.distance(point).sqrt());
                points.push(point);
                knots.push(next);
            }
            along.push((time, knots[knots.len() - 1]));
        }
        let chord = |i: usize| (points[i] - points[i - 1]) / (knots[i] - knots[i - 1]);
        let chords: Vec<DVec3> = (1..points.len()).map(chord).collect();
        // In the middle, the derivative of a parabola through three points; at the ends as well.
        let inner: Vec<DVec3> = (1..chords.len())
            .map(|i| {
                let whole = (points[i + 1] - points[i - 1]) / (knots[i + 1] - knots[i - 1]);
                chords[i - 1] + chords[i] - whole
            })
            .collect();
        let end = |chord: Option<&DVec3>, near: Option<&DVec3>| match (chord, near) {
            (Some(chord), Some(near)) => 2.0 * *chord - *near,
            (Some(chord), None) => *chord,
            (None, _) => DVec3::ZERO,
        };
        let (first, last) = (end(chords.first(), inner.first()), end(chords.last(), inner.last()));
        let tangents = [first].into_iter().chain(inner).chain([last]).collect();
        Self { points, knots, tangents, parameter: Track::new(along, ease) }
    }

    /// The point at a time.
    fn at(&self, time: f64) -> DVec3 {
        let knot = self.parameter.at(time);
        between(knot, &self.knots, &self.points, &self.tangents)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: [f64; 6] = [0.0, 1.0, 1.5, 4.0, 4.25, 7.0];

    fn points() -> Vec<(f64, DVec3)> {
        let points = [
            DVec3::ZERO,
            DVec3::new(1.0, 2.0, 0.0),
            DVec3::new(1.0, 2.0, 0.0),
            DVec3::new(30.0, -5.0, 4.0),
            DVec3::new(30.0, -5.1, 4.0),
            DVec3::new(-9.0, 0.0, 0.0),
        ];
        TIMES.into_iter().zip(points).collect()
    }

    /// The left and the right difference quotients at each time are the same, up to what the second derivative adds.
    fn assert_smooth(at: impl Fn(f64) -> DVec3, times: &[f64]) {
        let step = 1e-6;
        for &time in times {
            let left = (at(time) - at(time - step)) / step;
            let right = (at(time + step) - at(time)) / step;
            assert!(
                (left - right).length() < 1e-3 * (1.0 + left.length()),
                "{time} {left} {right}"
            );
        }
    }

    #[test]
    fn a_curve_passes_through_its_points_with_a_continuous_velocity() {
        for ease in [false, true] {
            let curve = Curve::new(&points(), ease);
            for (time, point) in points() {
                assert!((curve.at(time) - point).length() < 1e-12, "{time}");
            }
            let inside = &TIMES[1..5];
            assert_smooth(|time| curve.at(time), if ease { &TIMES } else { inside });
            assert_eq!(curve.at(-3.0), curve.at(0.0));
            assert_eq!(curve.at(70.0), curve.at(7.0));
        }
    }

    #[test]
    fn nothing_moves_between_equal_points_or_at_one() {
        let curve = Curve::new(&points(), true);
        for time in [1.0, 1.1, 1.3, 1.5] {
            assert_eq!(curve.at(time), DVec3::new(1.0, 2.0, 0.0));
        }
        let still = Curve::new(&[(0.0, DVec3::Y), (1.0, DVec3::Y)], false);
        assert_eq!([-1.0, 0.0, 0.3, 1.0, 2.0].map(|time| still.at(time)), [DVec3::Y; 5]);
        assert_eq!(Track::new([(3.0, 7.0)], false).at(1.0).to_bits(), 7_f64.to_bits());
        assert_eq!(Curve::new(&[(3.0, DVec3::X)], true).at(4.0), DVec3::X);
    }

    #[test]
    fn two_points_give_a_line_and_ease_rests_at_its_ends() {
        let ends = [(0.0, DVec3::ZERO), (2.0, DVec3::new(4.0, 0.0, 8.0))];
        let even = Curve::new(&ends, false);
        assert!((even.at(0.5) - DVec3::new(1.0, 0.0, 2.0)).length() < 1e-12);
        let eased = Curve::new(&ends, true);
        assert!((eased.at(1.0) - DVec3::new(2.0, 0.0, 4.0)).length() < 1e-12);
        assert!(eased.at(0.02).length() < 0.1 * even.at(0.02).length());
    }

    /// Points on a circle at equal times: the curve stays near the circle, and goes around it evenly.
    #[test]
    fn a_circle_stays_a_circle() {
        let on_circle = |time: f64| DVec3::new(time.cos(), time.sin(), 0.0);
        let keys: Vec<_> =
            (0..=12).map(|i| f64::from(i) * 0.5).map(|t| (t, on_circle(t))).collect();
        let curve = Curve::new(&keys, false);
        for step in 0..600 {
            let time = f64::from(step) * 0.01;
            assert!((curve.at(time) - on_circle(time)).length() < 0.02, "{time}");
        }
    }

    #[test]
    fn a_track_is_monotone_where_its_values_are() {
        let values = [0.0, 0.1, 5.0, 5.0, 4.9, -8.0];
        for ease in [false, true] {
            let track = Track::new(TIMES.into_iter().zip(values), ease);
            for (pair, ends) in TIMES.windows(2).zip(values.windows(2)) {
                let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                let mut before = ends[0];
                for step in 0..=100 {
                    let value = track.at(pair[0] + (pair[1] - pair[0]) * f64::from(step) * 0.01);
                    assert!((low - 1e-12..=high + 1e-12).contains(&value), "{value} {ends:?}");
                    assert!((value - before) * (ends[1] - ends[0]) >= -1e-12, "{ends:?}");
                    before = value;
                }
            }
            assert_smooth(|time| DVec3::splat(track.at(time)), &TIMES[1..5]);
        }
    }
}
