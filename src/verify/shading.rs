//! The check of shading: the layers that `shaders/primary/shade.wgsl` may write for a hit. The shader computes the ray and the
//! sphere test again, so both may differ slightly from those of the trace.

use glam::DVec3;

use super::line::Line;
use super::rounding::{FLUSH, Interval, PAD, U, gamma, unit_error};
use super::sphere::{Slack, SphereTest};
use crate::render::Shading;

/// The unit normals that a device may write: those within a distance of one of these.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LegalNormals {
    sides: [Option<(DVec3, f64)>; 2],
}

impl LegalNormals {
    /// The legal normals of a sphere for a ray, or for a ray within `slack` of it.
    pub(super) fn new(line: &Line, sphere: [f32; 4], slack: Slack) -> Self {
        let Some(test) = SphereTest::new(line, sphere, slack) else {
            return Self::default();
        };
        let side = |is_behind: bool| {
            let chord = Chord { half: test.half, exact: test.exact_half(), is_behind };
            normal_at(&test, line, chord, sphere[3], slack)
        };
        Self {
            sides: [
                test.may_start_outside().then(|| side(false)),
                test.may_start_inside().then(|| side(true)),
            ],
        }
    }

    /// The distance of a normal from the nearest exact one, relative to its bound; above 1 it is not legal.
    pub(super) fn fraction(&self, normal: DVec3) -> f64 {
        let fractions =
            self.sides.iter().flatten().map(|(exact, error)| (normal - exact).length() / error);
        // `f64::min` would ignore NaN.
        fractions.reduce(|a, b| if a < b { a } else { b }).unwrap_or(f64::INFINITY)
    }

    /// The exact normal and the bound of its error, if there is only one.
    pub(super) fn only(&self) -> Option<(DVec3, f64)> {
        let mut all = self.crossings();
        all.next().filter(|_| all.next().is_none())
    }

    /// The exact normals, and the bounds of their errors.
    pub(super) fn crossings(&self) -> impl Iterator<Item = (DVec3, f64)> {
        self.sides.into_iter().flatten()
    }
}

/// Half of the chord that a sphere cuts out of a ray, and whether the hit is at the far end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    pub(super) half: Interval,
    pub(super) exact: f64,
    pub(super) is_behind: bool,
}

/// The exact normal at one end of a chord, and the bound of a device's error.
pub(super) fn normal_at(
    test: &SphereTest,
    line: &Line,
    chord: Chord,
    radius: f32,
    slack: Slack,
) -> (DVec3, f64) {
    // The normal is the hypotenuse of a triangle, approximately as long as the radius.
    let Chord { half, exact, is_behind } = chord;
    let from_foot = if is_behind { exact } else { -exact };
    let half_error = (half.high - exact).max(exact - half.low);
    let outward = from_foot * line.direction - test.foot;
    let length = outward.length();
    let error = half_error
        + test.foot_error
        + half.high * slack.direction
        + gamma(2) * (half.high + length)
        + 4.0 * FLUSH;
    // Dunkl and Williams, "A simple norm inequality" (1964): 2 |x − y| / (|x| + |y|), with |y| no less
    // than |x| − |x − y|.
    let turned = 2.0 * error / (2.0 * length - error).max(error);
    let normal = if length > 0.0 { outward / length } else { DVec3::ZERO };
    let unit = unit_error(radius.into());
    (normal, (PAD * turned + 2.0 * unit).min(2.0 + unit))
}

/// The legal depths of a hit at `t` of a ray that starts at `distance` from the camera: the sum of both.
pub(super) fn legal_depth(distance: f32, t: f32) -> Interval {
    let sum = f64::from(distance) + f64::from(t);
    Interval::around(sum, PAD * U * sum.abs() + 2.0 * FLUSH)
}

/// The legal colours for the normal that the device wrote.
pub(super) fn legal_color(
    shading: Shading,
    color: [f32; 3],
    normal: DVec3,
    direction: [Interval; 3],
) -> [Interval; 3] {
    legal_color_near(shading, color, (normal, 0.0), direction)
}

/// The legal colours for a normal that is at most `off` from this one.
pub(super) fn legal_color_near(
    shading: Shading,
    color: [f32; 3],
    (normal, off): (DVec3, f64),
    direction: [Interval; 3],
) -> [Interval; 3] {
    let Shading::Headlight = shading else {
        return color.map(exactly);
    };
    let middle = DVec3::from(direction.map(|axis| 0.5 * (axis.low + axis.high)));
    let half = DVec3::from(direction.map(|axis| 0.5 * (axis.high - axis.low)));
    let terms = normal.abs().dot(middle.abs() + half);
    let cosine = normal.dot(middle).abs();
    let turned = off * (middle.length() + half.length());
    let error = PAD * (normal.abs().dot(half) + gamma(3) * (terms + turned) + turned) + 4.0 * FLUSH;
    color.map(|c| {
        let c = f64::from(c);
        Interval {
            low: c * (cosine - error).max(0.0) * (1.0 - U) / PAD - FLUSH,
            high: c * (cosine + error) * (1.0 + U) * PAD + FLUSH,
        }
    })
}

/// A number that is passed on unchanged, or zero if it is subnormal.
pub(super) fn exactly(value: f32) -> Interval {
    let value = f64::from(value);
    let low = if value.abs() < FLUSH { value.min(0.0) } else { value };
    Interval { low, high: if value.abs() < FLUSH { value.max(0.0) } else { value } }
}
