//! A cone relative to an exact ray, and bounds of its moves.
//!
//! All cones that are moved by at most `a` together fill the points whose signed distance from the solid between the discs
//! is at most a, and all of them share the points where it is at most −a. Along a ray, the signed distance from a convex
//! solid is a convex function, so that it has one least value, before which it falls and after which it rises. All moves
//! follow from it. They are never more than what is needed: what is legal is never refused.
//!
//! An end without a disc is open. A ray that enters there meets the wall from inside, where it leaves the solid. A cone with
//! round ends has open ends inside its spheres.

use glam::DVec3;

use super::moves::Moves;
use crate::geometry::cone::ConeInFrame;

/// A cone relative to a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct RelativeCone {
    origin: DVec3,
    direction: DVec3,
    ends: [DVec3; 2],
    axis: DVec3,
    length: f64,
    radii: [f64; 2],
    are_closed: [bool; 2],
    size: f64,
    /// The distance at which the solid is certainly behind.
    behind: f64,
    /// The distance at which the ray is nearest to the solid, or deepest in it, and the signed distance from the solid there
    /// and at the start.
    nearest: f64,
    least: f64,
    at_start: f64,
}

/// The part that is left by one step of a search by the golden ratio. All steps leave 3·10⁻¹², which is 5·10⁻⁵ of one k.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
const STEPS: usize = 55;

/// The number of times that an interval is halved, which leave less.
const HALVINGS: usize = 42;

/// The place of the least value of a convex function.
fn lowest(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let [mut first, mut second] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let [mut at_first, mut at_second] = [f(first), f(second)];
    for _ in 0..STEPS {
        if at_first <= at_second {
            (high, second, at_second) = (second, first, at_first);
            first = high - GOLDEN * (high - low);
            at_first = f(first);
        } else {
            (low, first, at_first) = (first, second, at_second);
            second = low + GOLDEN * (high - low);
            at_second = f(second);
        }
    }
    0.5 * (low + high)
}

/// The end of the part of an interval, at its start, in which something holds.
fn end_of(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    high
}

/// The distance of a point of a plane from a segment.
fn from_segment([h, rho]: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let ([along, up], [x, y]) = ([b[0] - a[0], b[1] - a[1]], [h - a[0], rho - a[1]]);
    let square = along * along + up * up;
    let s = if square > 0.0 { ((x * along + y * up) / square).clamp(0.0, 1.0) } else { 0.0 };
    (x - s * along).hypot(y - s * up)
}

impl RelativeCone {
    /// The cone relative to a ray. The direction must have unit length.
    pub(super) fn new(origin: DVec3, direction: DVec3, cone: &ConeInFrame) -> Self {
        let (ends, radii) = (cone.ends(), cone.radii());
        let [to_start, to_end] = ends.map(|end| end - origin);
        let half = 0.5 * (ends[1] - ends[0]).length();
        let (around, foot) = (half.hypot(radii[0].max(radii[1])), 0.5 * (to_start + to_end).dot(direction));
        let size = to_start.length().max(to_end.length()).max(radii[0]).max(radii[1]);
        let behind = (foot + around).max(0.0);
        let mut seen = Self {
            origin,
            direction,
            ends,
            axis: cone.axis(),
            length: 2.0 * half,
            radii,
            are_closed: cone.are_closed(),
            size,
            behind,
            nearest: 0.0,
            least: 0.0,
            at_start: 0.0,
        };
        if behind > 0.0 {
            seen.nearest = lowest((foot - around).max(0.0), behind, |t| seen.at(t));
        }
        seen.at_start = seen.at(0.0);
        seen.least = seen.at(seen.nearest);
        if seen.at_start <= seen.least {
            (seen.nearest, seen.least) = (0.0, seen.at_start);
        }
        seen
    }

    /// A point on the ray: its height above the start of the axis, and its distance from the axis.
    fn place(&self, t: f64) -> [f64; 2] {
        let from_start = self.origin - self.ends[0] + t * self.direction;
        let height = from_start.dot(self.axis);
        [height, (from_start - height * self.axis).length()]
    }

    fn side(&self) -> [[f64; 2]; 2] {
        [[0.0, self.radii[0]], [self.length, self.radii[1]]]
    }

    fn disc(&self, end: usize) -> [[f64; 2]; 2] {
        let height = [0.0, self.length][end];
        [[height, 0.0], [height, self.radii[end]]]
    }

    /// The distance of a point on the ray from the surface of the solid, with a minus sign inside.
    fn at(&self, t: f64) -> f64 {
        let place @ [height, aside] = self.place(t);
        let surface = [self.side(), self.disc(0), self.disc(1)].map(|wall| from_segment(place, wall));
        let distance = surface.into_iter().fold(f64::INFINITY, f64::min);
        let is_inside = height >= 0.0 && height <= self.length && aside <= self.radius_at(height);
        if is_inside { -distance } else { distance }
    }

    /// The distance of a point on the ray from the side and the closed ends.
    fn walls_at(&self, t: f64) -> f64 {
        let place = self.place(t);
        let closed = (0..2).filter(|end| self.are_closed[*end]).map(|end| from_segment(place, self.disc(end)));
        closed.fold(from_segment(place, self.side()), f64::min)
    }

    /// The least distance of a part of the ray from a disc.
    fn disc_beside(&self, end: usize, [first, last]: [f64; 2]) -> f64 {
        let distance = |t| from_segment(self.place(t), self.disc(end));
        distance(lowest(first, last.min(self.behind), distance))
    }

    /// The least distance of a part of the ray from an open end; infinity if both are closed.
    fn open_beside(&self, part: [f64; 2]) -> f64 {
        let open = (0..2).filter(|end| !self.are_closed[*end]);
        open.map(|end| self.disc_beside(end, part)).fold(f64::INFINITY, f64::min)
    }

    /// The least move for which the ray may enter through an open end.
    fn move_to_enter_open(&self, t: f64) -> f64 {
        if self.starts_inside() { 0.0 } else { self.open_beside([0.0, t.min(self.nearest)]) }
    }

    fn starts_inside(&self) -> bool {
        self.at_start <= 0.0
    }

    /// The least move for which the ray meets a wall from inside, up to `t`.
    fn move_to_leave(&self, t: f64) -> f64 {
        self.at_start.min(self.open_beside([0.0, t])).max(0.0)
    }

    /// The distance up to which the signed distance is above `level`, before the ray is nearest.
    fn falls_to(&self, level: f64) -> f64 {
        end_of(0.0, self.nearest, |t| self.at(t) > level)
    }

    /// The distance from which on the signed distance is above `level`.
    fn rises_to(&self, level: f64) -> f64 {
        end_of(self.nearest, self.behind + level.abs(), |t| self.at(t) <= level)
    }

    /// The radius at a height above the start of the axis.
    fn radius_at(&self, height: f64) -> f64 {
        self.radii[0] + (self.radii[1] - self.radii[0]) * height / self.length
    }

    /// The least move for which the hit has this normal, on a wall at the given distance from the line of the ray, where a
    /// change of the normal by 1 moves by `turned`.
    fn with_normal(&self, normal: DVec3, right: DVec3, [distance, turned]: [f64; 2]) -> f64 {
        let along = turned * right.dot(self.direction);
        let least = distance.max(turned * (normal - right).length());
        let entering = least.max(along);
        let leaving = least.max(-along).max(self.move_to_leave(self.behind));
        entering.min(leaving)
    }
}

impl Moves for RelativeCone {
    fn size(&self) -> f64 {
        self.size
    }

    fn radius(&self) -> f64 {
        self.radii[0].max(self.radii[1])
    }

    fn move_to_hit(&self) -> f64 {
        self.least.max(0.0)
    }

    fn move_to_miss(&self) -> f64 {
        // As long as the deepest point is inside, the ray enters before it and leaves after it.
        let leaves_open = self.open_beside([self.nearest, self.behind]);
        (-self.least).min(self.move_to_enter_open(self.nearest).max(leaves_open)).max(0.0)
    }

    fn move_to_hit_at(&self, t: f64) -> f64 {
        let wall = self.walls_at(t);
        // A line that meets a wall from the other side has passed where it was nearest, or not yet.
        let turned = wall.max(-self.least);
        let [entering, leaving] = if t <= self.nearest { [wall, turned] } else { [turned, wall] };
        entering.min(leaving.max(self.move_to_leave(t)))
    }

    fn move_to_pass(&self, t: f64) -> f64 {
        let there = self.at(t);
        let by_far_side =
            if t > self.nearest { there.min(-self.least).min(self.open_beside([self.nearest, t])) } else { 0.0 };
        if self.starts_inside() {
            return by_far_side.max(0.0);
        }
        // If the ray may also start inside, it meets the far side.
        let by_near_side =
            (-self.at(t.min(self.nearest))).min(self.at_start.max(there)).min(self.move_to_enter_open(t));
        by_near_side.max(by_far_side).max(0.0)
    }

    fn move_to_normal(&self, direction: DVec3, normal: DVec3) -> f64 {
        let across = (normal - normal.dot(self.axis) * self.axis).normalize_or_zero();
        let slope = (self.radii[1] - self.radii[0]) / self.length;
        // The line on the side where the normal has this direction around the axis, seen along the ray.
        let [first, second] = [0, 1].map(|end| self.ends[end] + self.radii[end] * across - self.origin);
        let [first, way] = [first, second - first].map(|v| v - v.dot(direction) * direction);
        let s = (-first.dot(way) / way.length_squared()).clamp(0.0, 1.0);
        // If the ray is parallel to that line, it may be hit anywhere.
        let radius = if s.is_nan() {
            self.radii[0].min(self.radii[1])
        } else {
            self.radii[0] + (self.radii[1] - self.radii[0]) * s
        };
        let distance = (first + way * if s.is_nan() { 0.0 } else { s }).length();
        let of_side = |across: DVec3| (across - slope * self.axis).normalize_or_zero();
        let on_side = if across == DVec3::ZERO {
            f64::INFINITY
        } else {
            self.with_normal(normal, of_side(across), [distance, radius])
        };
        // The same by where the line of the ray meets the side: on flat cones, rounding a normal turns it around the axis.
        let met = [self.falls_to(0.0), self.rises_to(0.0)].map(|t| {
            let from_start = self.origin - self.ends[0] + t * direction;
            let height = from_start.dot(self.axis);
            let across = (from_start - height * self.axis).normalize_or_zero();
            let radius = self.radius_at(height.clamp(0.0, self.length));
            self.with_normal(normal, of_side(across), [from_segment(self.place(t), self.side()), radius])
        });
        let closed = (0..2).filter(|end| self.are_closed[*end]);
        let on_discs = closed.map(|end| {
            let outward = [-self.axis, self.axis][end];
            let size = self.length.max(self.radii[end]);
            self.with_normal(normal, outward, [self.disc_beside(end, [0.0, self.behind]), size])
        });
        on_discs.chain(met).fold(on_side, f64::min)
    }

    fn earliest(&self, a: f64) -> f64 {
        match self.at_start {
            // All moved cones contain the start.
            inside if inside <= -a => self.rises_to(-a),
            near if near <= a => 0.0,
            _ => self.falls_to(a),
        }
    }

    fn latest(&self, a: f64) -> f64 {
        let enters = self.at_start > a && self.move_to_enter_open(self.nearest) > a;
        if enters { self.falls_to(-a) } else { self.rises_to(a) }
    }
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;

    use super::*;
    use crate::geometry::cone_crossing::intersect;
    use crate::geometry::ray::Ray;

    fn any(random: &mut Rng) -> DVec3 {
        DVec3::from([0; 3].map(|_| 2.0 * random.f64() - 1.0))
    }

    /// No move of a cone is smaller than what the bounds say that it needs. The cone is moved by moving the ray.
    #[test]
    fn bounds_hold() {
        let mut random = Rng::with_seed(6);
        let (mut hits, mut certain, mut inner) = (0, 0, 0);
        for number in 0..600 {
            let [start, end] = [any(&mut random), any(&mut random)].map(|end| end.as_vec3().to_array());
            let [first_radius, second_radius] = [0; 2].map(|_| {
                let radius = [0.6 * random.f32(), 0.0][usize::from(random.u32(..5) == 0)] + 1e-3;
                if random.bool() { radius } else { -radius }
            });
            let cone = ConeInFrame { start, first_radius, end, second_radius };
            let origin =
                if number % 4 == 0 { 0.7 * any(&mut random) } else { 3.0 * any(&mut random).normalize_or_zero() };
            let direction = (0.6 * any(&mut random) - origin).normalize_or(DVec3::X);
            let seen = RelativeCone::new(origin, direction, &cone);
            let a = 0.2 * random.f64().powi(3);
            let is_certain = seen.move_to_miss() > a;
            certain += usize::from(is_certain);
            for _ in 0..200 {
                let moved = a * random.f64().cbrt() * any(&mut random).normalize_or_zero();
                let found = intersect(&Ray { origin: origin - moved, direction }, &cone);
                let Some((t, normal)) = found else {
                    assert!(!is_certain, "{number}");
                    continue;
                };
                hits += 1;
                inner += usize::from(normal.dot(direction) > 0.0);
                let length = moved.length() + 1e-9;
                assert!(seen.move_to_hit() <= length, "{number}");
                assert!(seen.move_to_hit_at(t) <= length, "{number}: {t} {} {length}", seen.move_to_hit_at(t));
                assert!(seen.move_to_pass(t - 1e-9) <= length, "{number}: {t} {} {length}", seen.move_to_pass(t));
                let turned = seen.move_to_normal(direction, normal);
                assert!(turned <= length, "{number}: {t} {normal} {turned} {length}");
                assert!(seen.earliest(a) <= t + 1e-9, "{number}: {} {t}", seen.earliest(a));
                assert!(!is_certain || seen.latest(a) >= t - 1e-9, "{number}: {} {t}", seen.latest(a));
            }
        }
        assert!(hits > 20_000 && certain > 100 && inner > 1000, "{hits} {certain} {inner}");
    }

    /// Along the axis of a cylinder everything is known.
    #[test]
    fn bounds_are_reached() {
        let cone = ConeInFrame { start: [0.0; 3], first_radius: 1.0, end: [0.0, 0.0, 4.0], second_radius: 1.0 };
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} {b}");
        let seen = RelativeCone::new(DVec3::new(0.5, 0.0, -3.0), DVec3::Z, &cone);
        near(seen.size(), 7.0_f64.hypot(0.5));
        near(seen.move_to_hit(), 0.0);
        near(seen.move_to_miss(), 0.5);
        near(seen.move_to_hit_at(3.1), 0.1);
        near(seen.move_to_pass(3.2), 0.2);
        near(seen.earliest(0.1), 2.9);
        near(seen.latest(0.1), 3.1);
        near(seen.move_to_normal(DVec3::Z, -DVec3::Z), 0.0);
        near(seen.move_to_normal(DVec3::Z, DVec3::X), 0.5);
        let beside = RelativeCone::new(DVec3::new(1.3, 0.0, -3.0), DVec3::Z, &cone);
        near(beside.move_to_hit(), 0.3);
        near(beside.move_to_miss(), 0.0);
        let open = ConeInFrame { first_radius: -1.0, ..cone };
        let through = RelativeCone::new(DVec3::new(0.5, 0.0, -3.0), DVec3::Z, &open);
        near(through.move_to_hit_at(7.0), 0.0);
        near(through.move_to_hit_at(3.0), 0.5);
        near(through.move_to_miss(), 0.5);
        near(through.latest(0.1), 7.1);
    }
}
