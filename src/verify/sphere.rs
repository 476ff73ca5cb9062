//! The check of the sphere test and of shading: every legal result of `intersect_sphere` in
//! `shaders/scene/sphere.wgsl`, and the layers that `shaders/primary/shade.wgsl` may write for a hit. The shader
//! computes the ray and the sphere test again, so both may differ slightly from the ray and the test of the trace.
//!
//! The four lines of the kernel that end in a fence are evaluated in f64, each with a bound of the error of its f32
//! value. Let l be the vector to the centre, b = l·d, and f = l − b d the foot vector. The rounding errors of l and of
//! f itself are an error δ of f. The error Δb of b is an error along d, which is nearly perpendicular to f: it changes
//! |f|² by 2 Δb f·d = 2 Δb b (1 − d²), which is of second order. So the result is reliable even for a ray that starts
//! far from a small sphere.

use glam::DVec3;

use crate::geometry::math::wide;
use crate::render::Shading;
use crate::verify::number::Number;
use crate::verify::rounding::{DIVIDE, FLUSH, Interval, PAD, SQRT, U, gamma, unit_error};

/// The smallest magnitude of a component. It replaces smaller ones, so that the distance to a plane is finite.
const SMALLEST_COMPONENT: f64 = 1e-60;

/// A ray with exactly the numbers that a kernel used.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// The deviation of the direction's squared length from one.
    pub(super) bend: f64,
}

impl Line {
    pub(super) fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        Self::exact(wide(origin), wide(direction))
    }

    pub(super) fn exact(origin: DVec3, direction: DVec3) -> Self {
        // The computed square is off by at most 2⁻⁵⁰ for directions of about unit length.
        let bend = (1.0 - direction.length_squared()).abs() + f64::EPSILON * 4.0;
        Self { origin, direction, bend }
    }

    /// Distance of the ray from the silhouette of a sphere, as a fraction of the sphere's radius.
    pub(super) fn beside_silhouette(&self, [x, y, z, radius]: [f32; 4]) -> f64 {
        let to_center = wide([x, y, z]) - self.origin;
        let foot = to_center.cross(self.direction).length() / self.direction.length();
        let radius = f64::from(radius.abs());
        (foot - radius).abs() / radius
    }

    /// The reciprocal of each component of the direction.
    pub(super) fn inverse(&self) -> DVec3 {
        let size = self.direction.abs().max(DVec3::splat(SMALLEST_COMPONENT));
        1.0 / size.copysign(self.direction)
    }
}

/// Maximum difference between a ray and the checked ray, because another kernel computed it again.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slack {
    pub(super) across: f64,
    pub(super) along: f64,
    pub(super) direction: f64,
}

/// The intermediate results of a sphere test, with error bounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphereTest {
    /// The distance to the foot point.
    b: f64,
    b_error: f64,
    /// The vector from the foot point to the centre.
    pub(super) foot: DVec3,
    /// A bound of the length of the foot vector's error.
    pub(super) foot_error: f64,
    /// The square of half the chord.
    discriminant: f64,
    error: f64,
    /// Half the chord.
    pub(super) half: Interval,
    /// The product of the distances to both sides.
    c: f64,
    c_error: f64,
    bend: f64,
}

/// The legal results of a sphere test.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Roots {
    /// Legal distances to the near side.
    pub(super) near: Option<Interval>,
    /// Legal distances to the far side, for a ray from inside.
    pub(super) far: Option<Interval>,
    pub(super) may_miss: bool,
}

impl SphereTest {
    /// Evaluates the test; `None` for a ray that cannot hit the sphere.
    pub(super) fn new(line: &Line, [x, y, z, radius]: [f32; 4], slack: Slack) -> Option<Self> {
        let d = line.direction.abs();
        let l = wide([x, y, z]) - line.origin;
        let r2 = f64::from(radius) * f64::from(radius);
        let b = l.dot(line.direction);
        let foot = l - b * line.direction;
        let foot2 = foot.length_squared();
        let discriminant = r2 - foot2;

        let l_error = U * l.abs() + 2.0 * FLUSH;
        let b_terms = l.abs().dot(d);
        let b_rounding = l_error.dot(d);
        let b_error = b_rounding + gamma(3) * (b_terms + b_rounding) + 8.0 * FLUSH;
        // The two roundings of f itself, after the roundings of l and b.
        let product = U * (b.abs() + b_error) * d;
        let difference = U * (1.0 + U) * (foot.abs() + l_error + (b_error + U * b.abs()) * d);
        let across = l_error + product + difference + 3.0 * FLUSH;
        let foot_errors = across + b_error * d;
        let beside = slack.across + slack.direction * b.abs();
        let square_error = 2.0 * foot.abs().dot(across)
            + 2.0 * b_error * b.abs() * line.bend
            + foot_errors.length_squared()
            + (2.0 * (foot2.sqrt() + foot_errors.length()) + beside) * beside;
        // The last term is for exact answers, which, unlike the kernel, need not assume a direction of unit length.
        let error = PAD
            * (square_error
                + gamma(4) * (r2 + foot2 + square_error)
                + b * b * line.bend * (line.bend + 2.0 * slack.direction)
                + 16.0 * FLUSH);
        if discriminant + error < 0.0 {
            return None;
        }

        let moved = slack.across + slack.along;
        let c = l.length_squared() - r2;
        let c_square_error = (2.0 * l.abs() + l_error).dot(l_error);
        let c_error = PAD
            * (c_square_error
                + gamma(4) * (l.length_squared() + c_square_error + r2)
                + (2.0 * l.length() + moved) * moved
                + 16.0 * FLUSH);
        let half = Interval {
            low: (discriminant - error).max(0.0).sqrt() * (1.0 - SQRT) / PAD,
            high: (discriminant + error).sqrt() * (1.0 + SQRT) * PAD,
        };
        Some(Self {
            b,
            b_error: PAD * (b_error + moved + slack.direction * l.length()),
            foot,
            foot_error: PAD * (foot_errors.length() + slack.across) + 2.0 * slack.direction * l.length(),
            discriminant,
            error,
            half,
            c,
            c_error,
            bend: line.bend,
        })
    }

    /// Whether the kernel may decide that the ray starts outside.
    pub(super) fn may_start_outside(&self) -> bool {
        self.c + self.c_error > 0.0
    }

    /// Whether the kernel may decide that the ray starts inside, or on the surface.
    pub(super) fn may_start_inside(&self) -> bool {
        self.c - self.c_error <= 0.0
    }

    /// Returns the test without the additional slack for exact answers, which do not assume
    /// that the direction has unit length.
    pub(super) fn as_the_kernel(self) -> Self {
        Self { bend: 0.0, ..self }
    }

    /// Half the chord of the exact test.
    pub(super) fn exact_half(&self) -> f64 {
        self.discriminant.max(0.0).sqrt()
    }

    /// The legal results of the last lines of the test.
    pub(super) fn roots(&self) -> Roots {
        let mut roots = Roots { near: None, far: None, may_miss: self.discriminant - self.error < 0.0 };
        if self.may_start_outside() {
            roots.near = self.root(self.near(), &mut roots.may_miss);
        }
        if self.may_start_inside() {
            roots.far = self.root(self.far(), &mut roots.may_miss);
        }
        roots
    }

    /// The near distance: b − h, or c/(b + h) if the two would cancel.
    fn near(&self) -> Option<Interval> {
        let (b, h) = (Interval::around(self.b, self.b_error), self.half);
        if b.high <= 0.0 {
            return None;
        }
        let b_low = b.low.max(0.0);
        // A sphere behind the origin gives a difference of negative numbers, which is not a hit.
        let c_low = if b.low > 0.0 { (self.c - self.c_error).max(0.0) } else { 0.0 };
        let quotient = Interval {
            low: c_low / (b.high + h.high) * (1.0 - DIVIDE - 2.0 * U),
            high: (self.c + self.c_error) / (b_low + h.low) * (1.0 + DIVIDE + 2.0 * U),
        };
        // The kernel tests whether −b h is negative. A product that is flushed to zero is not negative.
        let may_be_sum = b_low * h.low <= FLUSH;
        let sum = Interval { low: b_low * (1.0 - U), high: b.high * (1.0 + U) };
        Some(if may_be_sum { quotient.union(sum) } else { quotient })
    }

    /// The far distance: b + h, or c/(b − h) if the two would cancel.
    fn far(&self) -> Option<Interval> {
        let (b, h) = (Interval::around(self.b, self.b_error), self.half);
        let sum = (b.high >= 0.0)
            .then(|| Interval { low: (b.low.max(0.0) + h.low) * (1.0 - U), high: (b.high + h.high) * (1.0 + U) });
        let quotient = (b.low < 0.0).then(|| Interval {
            low: (-self.c - self.c_error).max(0.0) / (h.high - b.low) * (1.0 - DIVIDE - 2.0 * U),
            high: (self.c_error - self.c) / (h.low + (-b.high).max(0.0)) * (1.0 + DIVIDE + 2.0 * U),
        });
        // The product b h can be flushed to zero only if one or both of them are tiny.
        let flushed =
            (b.high < 0.0 && h.low * -b.high <= FLUSH).then(|| Interval { low: 0.0, high: h.high.min(FLUSH.sqrt()) });
        [sum, quotient, flushed].into_iter().flatten().reduce(Interval::union)
    }

    /// Widens a distance so that exact answers are legal too, which do not assume that the direction has unit length.
    /// Only positive distances are hits.
    fn root(&self, root: Option<Interval>, may_miss: &mut bool) -> Option<Interval> {
        let Some(Interval { low, high }) = root else {
            *may_miss = true;
            return None;
        };
        let aside = 2.0 * self.bend;
        let low = low * (1.0 - aside) / PAD - FLUSH;
        let high = high * (1.0 + aside) * PAD + FLUSH;
        // Zero divided by zero is NaN.
        let high = if high.is_nan() { f64::INFINITY } else { high };
        if low <= FLUSH {
            *may_miss = true;
        }
        (high > 0.0).then_some(Interval { low: low.max(0.0), high })
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
pub(super) fn normal_at(test: &SphereTest, line: &Line, chord: Chord, radius: f32, slack: Slack) -> (DVec3, f64) {
    // The normal is the hypotenuse of a triangle, approximately as long as the radius.
    let Chord { half, exact, is_behind } = chord;
    let from_foot = if is_behind { exact } else { -exact };
    let half_error = (half.high - exact).max(exact - half.low);
    let outward = from_foot * line.direction - test.foot;
    let length = outward.length();
    let error =
        half_error + test.foot_error + half.high * slack.direction + gamma(2) * (half.high + length) + 4.0 * FLUSH;
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

/// The legal colours for a normal that is at most `off` from this one.
pub(super) fn legal_color(
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
    Number::recorded(value).interval()
}
