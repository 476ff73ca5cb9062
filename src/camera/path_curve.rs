//! Smooth curves through values at given times.

use std::ops::{Add, Mul};

use glam::DVec3;

/// A function of time through given values at given times. It is monotone where the values are, so it stays between
/// neighbours, and has a continuous derivative. Before the first and after the last time it is constant.
///
/// The slopes are those of F. N. Fritsch and J. Butland, A method for constructing local monotone piecewise cubic
/// interpolants, SIAM Journal on Scientific and Statistical Computing 5(2), 1984, for uneven times as in C. Moler,
/// Numerical Computing with MATLAB, section 3.4.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Track {
    times: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Track {
    /// The function through at least one `(time, value)`, with ascending times. If `ease` is set, it starts and ends at
    /// rest.
    pub(super) fn new(points: impl IntoIterator<Item = (f64, f64)>, ease: bool) -> Self {
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
    pub(super) fn at(&self, time: f64) -> f64 {
        between(time, &self.times, &self.values, &self.slopes)
    }
}

/// The slope at an end, from a parabola through three points. It must not lead away from the neighbouring value.
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

/// The weights of two values and two slopes in a cubic, at a position from 0 to 1.
fn hermite(s: f64) -> [f64; 4] {
    let rest = 1.0 - s;
    let end = s * s * (3.0 - 2.0 * s);
    [1.0 - end, end, s * rest * rest, -s * s * rest]
}

/// The cubic curve through `values` at `places`, of which there is at least one, with the given slopes. Before the
/// first and after the last place it is constant.
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
/// points, however uneven their distances are. A [`Track`] gives the position on the curve at each time. So the
/// velocity is continuous, and nothing moves between two equal points.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    /// The points. No two neighbouring points are equal.
    points: Vec<DVec3>,
    /// The parameter of each point.
    knots: Vec<f64>,
    /// The derivative at each point with respect to the parameter.
    tangents: Vec<DVec3>,
    parameter: Track,
}

impl Curve {
    /// The curve through at least one `(time, point)`, with ascending times.
    pub(super) fn new(all: &[(f64, DVec3)], ease: bool) -> Self {
        let (mut points, mut knots): (Vec<DVec3>, Vec<f64>) = (Vec::new(), Vec::new());
        let mut along = Vec::new();
        for &(time, point) in all {
            if points.last() != Some(&point) {
                let before = points.last().zip(knots.last());
                let next = before.map_or(0.0, |(before, knot)| knot + before.distance(point).sqrt());
                points.push(point);
                knots.push(next);
            }
            along.push((time, knots[knots.len() - 1]));
        }
        let chord = |i: usize| (points[i] - points[i - 1]) / (knots[i] - knots[i - 1]);
        let chords: Vec<DVec3> = (1..points.len()).map(chord).collect();
        // The derivative of a parabola through three points, in the middle and at the ends.
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
    pub(super) fn at(&self, time: f64) -> DVec3 {
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

    /// Checks that the left and right difference quotients agree at each time, up to the second derivative's effect.
    fn assert_smooth(at: impl Fn(f64) -> DVec3, times: &[f64]) {
        let step = 1e-6;
        for &time in times {
            let left = (at(time) - at(time - step)) / step;
            let right = (at(time + step) - at(time)) / step;
            assert!((left - right).length() < 1e-3 * (1.0 + left.length()), "{time} {left} {right}");
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
        let keys: Vec<_> = (0..=12).map(|i| f64::from(i) * 0.5).map(|t| (t, on_circle(t))).collect();
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
