//! One ray against one sphere: everything that `intersect_sphere` in `shaders/scene/sphere.wgsl` may answer.
//!
//! The kernel's four lines that end in a fence are followed in f64, each with a bound of what its f32 value may
//! differ by. With the vector l to the centre, b = l·d and the foot vector f = l − b d, the rounding of l and of
//! f itself is an error δ of f, and that of b is one along d, which is nearly perpendicular to f: so of
//! |f|² it changes 2 Δb f·d = 2 Δb b (1 − d²), which is of second order, and a ray far from a small
//! sphere still knows whether it hits.

use glam::DVec3;

use super::line::Line;
use super::rounding::{DIVIDE, FLUSH, Interval, PAD, SQRT, U, gamma};
use crate::geometry::math::wide;

/// How far a ray may be from the one that is followed, because another kernel made it anew.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slack {
    /// Across.
    pub(super) across: f64,
    /// Along.
    pub(super) along: f64,
    /// Of its direction.
    pub(super) direction: f64,
}

/// The intermediates of a test, with their bounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphereTest {
    /// The distance to the foot point.
    b: f64,
    b_error: f64,
    /// From the foot point to the centre.
    pub(super) foot: DVec3,
    /// A bound of the error's length.
    pub(super) foot_error: f64,
    /// The square of half the chord.
    discriminant: f64,
    error: f64,
    /// Half the chord.
    pub(super) half: Interval,
    /// The product of the distances to both walls.
    c: f64,
    c_error: f64,
    bend: f64,
}

/// What the test may answer.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Roots {
    /// Distances to the near side.
    pub(super) near: Option<Interval>,
    /// Distances to the far side, from inside.
    pub(super) far: Option<Interval>,
    pub(super) may_miss: bool,
}

impl SphereTest {
    /// `None` for a ray that cannot hit.
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
        // The two roundings of f, from whatever l and b were before.
        let product = U * (b.abs() + b_error) * d;
        let difference = U * (1.0 + U) * (foot.abs() + l_error + (b_error + U * b.abs()) * d);
        let across = l_error + product + difference + 3.0 * FLUSH;
        let foot_errors = across + b_error * d;
        let beside = slack.across + slack.direction * b.abs();
        let square_error = 2.0 * foot.abs().dot(across)
            + 2.0 * b_error * b.abs() * line.bend
            + foot_errors.length_squared()
            + (2.0 * (foot2.sqrt() + foot_errors.length()) + beside) * beside;
        // An exact answer need not know that the kernel takes the direction's length to be one: the last term.
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
            foot_error: PAD * (foot_errors.length() + slack.across)
                + 2.0 * slack.direction * l.length(),
            discriminant,
            error,
            half,
            c,
            c_error,
            bend: line.bend,
        })
    }

    /// Whether the kernel may take the ray to start outside.
    pub(super) fn may_start_outside(&self) -> bool {
        self.c + self.c_error > 0.0
    }

    /// Whether the kernel may take the ray to start inside, or on the wall.
    pub(super) fn may_start_inside(&self) -> bool {
        self.c - self.c_error <= 0.0
    }

    /// Without what is granted beyond the kernel's own lines: that an answer may know better than to take the
    /// direction's length to be one.
    pub(super) fn as_the_kernel(self) -> Self {
        Self { bend: 0.0, ..self }
    }

    /// Half the chord, exactly.
    pub(super) fn exact_half(&self) -> f64 {
        self.discriminant.max(0.0).sqrt()
    }

    /// The distances that the last lines of the test may come to.
    pub(super) fn roots(&self) -> Roots {
        let mut roots =
            Roots { near: None, far: None, may_miss: self.discriminant - self.error < 0.0 };
        if self.may_start_outside() {
            roots.near = self.root(self.near(), &mut roots.may_miss);
        }
        if self.may_start_inside() {
            roots.far = self.root(self.far(), &mut roots.may_miss);
        }
        roots
    }

    /// b − h, or c/(b + h) where the two would cancel.
    fn near(&self) -> Option<Interval> {
        let (b, h) = (Interval::around(self.b, self.b_error), self.half);
        if b.high <= 0.0 {
            return None;
        }
        let b_low = b.low.max(0.0);
        // What lies behind is a difference of negative numbers, and so no hit.
        let c_low = if b.low > 0.0 { (self.c - self.c_error).max(0.0) } else { 0.0 };
        let quotient = Interval {
            low: c_low / (b.high + h.high) * (1.0 - DIVIDE - 2.0 * U),
            high: (self.c + self.c_error) / (b_low + h.low) * (1.0 + DIVIDE + 2.0 * U),
        };
        // The kernel asks whether −b h is negative; a product that becomes zero is not.
        let may_be_sum = b_low * h.low <= FLUSH;
        let sum = Interval { low: b_low * (1.0 - U), high: b.high * (1.0 + U) };
        Some(if may_be_sum { quotient.union(sum) } else { quotient })
    }

    /// b + h, or c/(b − h) where the two would cancel.
    fn far(&self) -> Option<Interval> {
        let (b, h) = (Interval::around(self.b, self.b_error), self.half);
        let sum = (b.high >= 0.0).then(|| Interval {
            low: (b.low.max(0.0) + h.low) * (1.0 - U),
            high: (b.high + h.high) * (1.0 + U),
        });
        let quotient = (b.low < 0.0).then(|| Interval {
            low: (-self.c - self.c_error).max(0.0) / (h.high - b.low) * (1.0 - DIVIDE - 2.0 * U),
            high: (self.c_error - self.c) / (h.low + (-b.high).max(0.0)) * (1.0 + DIVIDE + 2.0 * U),
        });
        // b h may become zero only where both, or one of them, are nothing.
        let nothing = (b.high < 0.0 && h.low * -b.high <= FLUSH)
            .then(|| Interval { low: 0.0, high: h.high.min(FLUSH.sqrt()) });
        [sum, quotient, nothing].into_iter().flatten().reduce(Interval::union)
    }

    /// Only what lies in front is a hit; and the exact answer, which need not know that the kernel takes the
    /// direction's length to be one, is among those that are legal.
    fn root(&self, root: Option<Interval>, may_miss: &mut bool) -> Option<Interval> {
        let Some(Interval { low, high }) = root else {
            *may_miss = true;
            return None;
        };
        let aside = 2.0 * self.bend;
        let low = low * (1.0 - aside) / PAD - FLUSH;
        let high = high * (1.0 + aside) * PAD + FLUSH;
        // A quotient of nothing by nothing is not a number.
        let high = if high.is_nan() { f64::INFINITY } else { high };
        if low <= FLUSH {
            *may_miss = true;
        }
        (high > 0.0).then_some(Interval { low: low.max(0.0), high })
    }
}
