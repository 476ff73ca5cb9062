//! A sphere relative to an exact ray, and the least move of its centre for each answer that a renderer may give.
//!
//! In the plane through the ray and the centre, the ray is the axis from 0 on. The centre is at `b` along it and at `f`
//! beside it. A renderer's answer holds for a sphere whose centre is moved by at most `a`. All such spheres together
//! fill the ball of radius r + a around the centre, and the ball of radius r − a is inside all of them. So the bounds
//! are distances of points from circles, in closed form.

use glam::DVec3;

use super::moves::Moves;
use crate::geometry::math::wide;

/// A sphere relative to a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct RelativeSphere {
    /// Distance of the foot point of the centre along the ray; negative behind the start.
    b: f64,
    /// Distance of the centre from the line of the ray.
    f: f64,
    /// Distance of the centre from the start.
    l: f64,
    r: f64,
    /// The vector from the foot point to the centre.
    foot: DVec3,
}

impl RelativeSphere {
    /// The sphere relative to a ray. The direction must have unit length.
    pub(super) fn new(origin: DVec3, direction: DVec3, [x, y, z, radius]: [f32; 4]) -> Self {
        let to_center = wide([x, y, z]) - origin;
        let b = to_center.dot(direction);
        let foot = to_center - b * direction;
        Self { b, f: foot.length(), l: to_center.length(), r: radius.into(), foot }
    }

    fn starts_inside(&self) -> bool {
        self.l <= self.r
    }

    /// The distance of a point on the ray from the centre.
    fn distance_of(&self, t: f64) -> f64 {
        (t - self.b).hypot(self.f)
    }
}

impl Moves for RelativeSphere {
    fn size(&self) -> f64 {
        self.l.max(self.r)
    }

    fn radius(&self) -> f64 {
        self.r
    }

    fn move_to_hit(&self) -> f64 {
        let outside = if self.b > 0.0 { self.f } else { self.l };
        if self.starts_inside() { 0.0 } else { (outside - self.r).max(0.0) }
    }

    fn move_to_miss(&self) -> f64 {
        let least = match (self.starts_inside(), self.b > 0.0) {
            (true, false) => self.r - self.l,
            (false, false) => 0.0,
            // A line beside the sphere. There is no nearer way out.
            (_, true) => self.r - self.f,
        };
        least.max(0.0)
    }

    fn move_to_hit_at(&self, t: f64) -> f64 {
        let to_surface = (self.distance_of(t) - self.r).abs();
        // If a line only touches the moved sphere, its centre is beside the point.
        let to_touching = (t - self.b).hypot(self.f - self.r);
        let [entering, leaving] = if t <= self.b { [to_surface, to_touching] } else { [to_touching, to_surface] };
        // A ray meets the far side first only if it starts inside.
        entering.min(leaving.max(self.l - self.r))
    }

    fn move_to_pass(&self, t: f64) -> f64 {
        let missed = self.move_to_miss();
        let beyond_far_side = self.distance_of(t) - self.r;
        if self.starts_inside() {
            return missed.min(beyond_far_side).max(0.0);
        }
        let before_near_side = if t <= self.b { -beyond_far_side } else { missed };
        // If the ray may also start inside, it meets the far side.
        let inside = (self.l - self.r).max(beyond_far_side);
        missed.min(before_near_side).min(inside).max(0.0)
    }

    fn move_to_normal(&self, direction: DVec3, normal: DVec3) -> f64 {
        let along = normal.dot(direction);
        // The moved centre is on the line that lies beside the ray by the normal times the radius.
        let beside = (self.foot + self.r * (normal - along * direction)).length();
        // A normal that faces the wrong way is turned at least to where it is perpendicular to the ray.
        let entering = beside.max(self.r * along);
        let leaving = beside.max(-self.r * along).max(self.l - self.r);
        entering.min(leaving)
    }

    fn earliest(&self, a: f64) -> f64 {
        if self.l - self.r <= -a {
            // All moved spheres contain the start.
            let inner = self.r - a;
            return self.b + (inner * inner - self.f * self.f).max(0.0).sqrt();
        }
        let outer = self.r + a;
        if self.l <= outer {
            return 0.0;
        }
        self.b - (outer * outer - self.f * self.f).max(0.0).sqrt()
    }

    fn latest(&self, a: f64) -> f64 {
        if self.l - self.r > a {
            let inner = self.r - a;
            return self.b - (inner * inner - self.f * self.f).max(0.0).sqrt();
        }
        let outer = self.r + a;
        self.b + (outer * outer - self.f * self.f).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;

    use super::*;

    /// The distance at which a ray along x first meets a sphere of radius 1, computed directly.
    fn first(center: DVec3) -> Option<f64> {
        let beside = center.y.hypot(center.z);
        let half = (1.0 - beside * beside).max(0.0).sqrt();
        let is_inside = center.length() <= 1.0;
        let t = if is_inside { center.x + half } else { center.x - half };
        (beside <= 1.0 && (is_inside || t > 0.0)).then_some(t)
    }

    /// Spheres with moved centres stay within the bounds of the closed forms, and some come close to the bounds.
    #[test]
    fn bounds_hold_and_are_reached() {
        let mut random = Rng::with_seed(4);
        let (mut hits, mut certain) = (0, 0);
        for _ in 0..400 {
            let center = DVec3::new(3.0 * random.f64() - 0.7, 1.4 * random.f64(), 0.0);
            let seen = RelativeSphere::new(-center, DVec3::X, [0.0, 0.0, 0.0, 1.0]);
            let a = 0.4 * random.f64();
            let moved: Vec<_> = (0..4000)
                .map(|i| {
                    let angle = f64::from(i) * 2.4;
                    let length = a * (f64::from(i + 1) / 4000.0).sqrt();
                    first(center + length * DVec3::new(angle.cos(), angle.sin(), 0.0))
                })
                .collect();
            let found: Vec<f64> = moved.iter().copied().flatten().collect();
            let slack = 0.12;
            if seen.move_to_hit() <= a && found.is_empty() {
                assert!(seen.move_to_hit() > 0.9 * a - 0.01, "{center} {a}");
            }
            if !found.is_empty() {
                hits += 1;
                assert!(seen.move_to_hit() <= a);
                let least = found.iter().copied().fold(f64::INFINITY, f64::min);
                let earliest = seen.earliest(a);
                assert!(earliest <= least + 1e-12, "{center} {a}: {earliest} {least}");
                assert!(least - earliest < slack + 0.2 * a, "{center} {a}: {earliest} {least}");
            }
            for t in found.iter().step_by(97) {
                assert!(seen.move_to_hit_at(*t) <= a + 1e-12, "{center} {a} {t}");
            }
            let is_certain = seen.move_to_miss() > a;
            assert!(!is_certain || found.len() == moved.len(), "{center} {a}");
            if is_certain {
                certain += 1;
                let most = found.iter().copied().fold(0.0, f64::max);
                assert!(seen.latest(a) >= most - 1e-12, "{center} {a}");
                for t in [0.3, 0.9, 1.3, 2.0, most - 1e-9] {
                    // A point before the latest hit is not certainly hidden.
                    assert!(t > most || seen.move_to_pass(t) <= a + 1e-9, "{center} {a} {t}");
                }
                let beyond = seen.latest(a) + 1e-9;
                assert!(seen.move_to_pass(beyond) >= a - 1e-9, "{center} {a}");
            }
        }
        assert!(hits > 300 && certain > 100, "{hits} {certain}");
    }

    #[test]
    fn a_normal_is_reached_by_the_move_that_makes_it() {
        let mut random = Rng::with_seed(5);
        let any = |random: &mut Rng| DVec3::from([0; 3].map(|_| random.f64() - 0.5));
        for _ in 0..2000 {
            let center = DVec3::X * 3.0 + any(&mut random);
            let moved = center + 0.2 * any(&mut random);
            let Some(t) = first(moved) else { continue };
            let normal = t * DVec3::X - moved;
            let seen = RelativeSphere::new(-center, DVec3::X, [0.0, 0.0, 0.0, 1.0]);
            let least = seen.move_to_normal(DVec3::X, normal.normalize_or_zero());
            assert!(least <= (moved - center).length() + 1e-12);
            let back = seen.move_to_normal(DVec3::X, -normal.normalize_or_zero());
            assert!(back > 0.3 || normal.x > -0.6, "{back} {normal}");
        }
    }
}
