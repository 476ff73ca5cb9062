//! The least change of a ray with which a pixel is legal.

use glam::DVec3;

use super::answers::{Answers, DepthKind, EPSILON, Finding, OF_COORDINATES, Rays, Reason};
use super::moves::Moves;
use super::relative::Seen;
use crate::image::NO_ID;
use crate::scene::{Scene, Shape};
use crate::verify::certificate::Outcome;
use crate::verify::hit::Candidates;
use crate::verify::sphere::Line;

/// The k (a move in units of ε) that moves a centre by its distance: every answer consistent with one sphere is legal.
const EVERYTHING: f64 = 1.0 / EPSILON;

/// A generous bound of the rounding errors of a search in f64, relative to the longest vector to a sphere.
const OF_SEARCH: f64 = 1.0 / (1_u64 << 40) as f64;

pub(super) struct PixelCheck<'a> {
    pub(super) scene: &'a Scene,
    pub(super) candidates: &'a Candidates,
    pub(super) answers: Answers<'a>,
    pub(super) rays: Rays<'a>,
    pub(super) axis: Option<DVec3>,
    pub(super) at_most: f64,
}

/// The exact ray of a pixel, in the scene's frame.
struct ExactRay {
    line: Line,
    /// The length that is added to the size of a sphere for its normals, which are made of coordinates in the world.
    world: f64,
    /// The length that is added to the size of every sphere if the renderer made the ray by itself.
    start: f64,
}

/// A sphere other than the one that the renderer found.
struct Other {
    id: u32,
    seen: Seen,
    /// The distance at which it may be hit.
    earliest: f64,
}

/// A renderer's claim about a pixel that it calls a hit.
struct Claim {
    shape: Shape,
    seen: Seen,
    /// The length of the move for k = 1.
    unit: f64,
    distance: Option<f64>,
    /// The least k for this sphere by itself, the move that it stands for, and the reason for it.
    alone: f64,
    moved: f64,
    reason: Reason,
    /// True if some normals would not be legal.
    tells_normals: bool,
}

impl ExactRay {
    fn seen(&self, shape: Shape) -> Seen {
        Seen::new(self.line.origin, self.line.direction, shape)
    }

    /// The length of the move of a sphere for k = 1.
    fn unit(&self, seen: &Seen) -> f64 {
        EPSILON * (seen.size() + self.start)
    }

    /// The largest k of some spheres, given the move of each.
    fn most(&self, others: &[Other], moved: impl Fn(&dyn Moves) -> f64) -> f64 {
        others.iter().map(|other| moved(&*other.seen) / self.unit(&other.seen)).fold(0.0, f64::max)
    }
}

impl PixelCheck<'_> {
    fn ray(&self, index: usize) -> Option<ExactRay> {
        let (ray, is_made) = match self.rays {
            Rays::View(view) => (view.ray_through_center(self.answers.pixel(index))?, true),
            Rays::Given(rays) => (rays[index], false),
        };
        let origin = ray.origin - self.scene.origin();
        let line = Line::exact(origin, ray.direction / ray.direction.length());
        let [in_frame, in_world] = [origin, ray.origin].map(|start| OF_COORDINATES * start.length());
        Some(ExactRay { line, world: in_world.max(in_frame), start: if is_made { in_frame } else { 0.0 } })
    }

    /// Judges a pixel: its outcome and its least k.
    pub(super) fn judge(&self, index: usize) -> (Outcome, f32) {
        let id = self.answers.ids[index];
        let Some(ray) = self.ray(index) else {
            // If the camera has no ray, only a miss is legal.
            return if id == NO_ID { (Outcome::Proved, 0.0) } else { (Outcome::Violated, f32::INFINITY) };
        };
        let (least, is_only) = match self.claim(index, id, &ray) {
            None => {
                let (mut others, _) = self.find(&ray, None);
                let mut least = ray.most(&others, |seen| seen.move_to_miss());
                if least > self.at_most {
                    others = self.find_crossed(&ray, None, f64::INFINITY);
                    least = ray.most(&others, |seen| seen.move_to_miss());
                }
                (least, others.is_empty())
            }
            Some(claim) => {
                let (mut others, is_certain) = self.find(&ray, Some(&claim));
                let mut least = Self::to_be_nearest(&ray, &claim, &others);
                if least > self.at_most {
                    let t = claim.distance.unwrap_or_else(|| claim.earliest(claim.alone));
                    others = self.find_crossed(&ray, Some(&claim), t);
                    least = Self::to_be_nearest(&ray, &claim, &others);
                }
                (least, is_certain && others.is_empty() && claim.tells_normals)
            }
        };
        let outcome = match (least <= self.at_most, is_only) {
            (false, _) => Outcome::Violated,
            (true, false) => Outcome::Undecided,
            (true, true) => Outcome::Proved,
        };
        (outcome, least as f32)
    }

    /// Explains why a pixel needs its k.
    pub(super) fn explain(&self, index: usize, outcome: Outcome, least: f64) -> Finding {
        let id = self.answers.ids[index];
        let mut finding = Finding {
            pixel: self.answers.pixel(index),
            id,
            depth: self.answers.depths.map(|depths| depths[index]),
            outcome,
            least,
            margin: f64::INFINITY,
            reason: Reason::NoRay,
            exact: None,
            spheres: self.scene.len() as u32,
        };
        let Some(ray) = self.ray(index) else { return finding };
        let crossed = self.find_crossed(&ray, None, f64::INFINITY);
        let nearest = crossed.iter().min_by(|a, b| a.earliest.total_cmp(&b.earliest).then(a.id.cmp(&b.id)));
        finding.exact = nearest.map(|other| (other.id, other.earliest));
        match self.claim(index, id, &ray) {
            Some(claim) if claim.alone as f32 >= least as f32 => {
                (finding.margin, finding.reason) = (claim.moved, claim.reason);
            }
            claim => {
                // The sphere that hides the claimed one the most.
                let needed = |other: &Other| {
                    let unit = ray.unit(&other.seen);
                    let t = claim.as_ref().map(|claim| claim.distance.unwrap_or_else(|| claim.earliest(least)));
                    let moved = t.map_or_else(|| other.seen.move_to_miss(), |t| other.seen.move_to_pass(t));
                    (moved / unit, moved)
                };
                let others = crossed
                    .iter()
                    .filter(|other| claim.as_ref().is_none_or(|claim| !is_same(self.shape(other.id), claim.shape)));
                let worst = others.max_by(|a, b| needed(a).0.total_cmp(&needed(b).0));
                if let Some(worst) = worst {
                    (finding.margin, finding.reason) = (needed(worst).1, Reason::Hidden(worst.id));
                }
            }
        }
        finding
    }

    fn shape(&self, id: u32) -> Shape {
        let (spheres, id) = (self.scene.spheres(), id as usize);
        match spheres.get(id) {
            Some(sphere) => Shape::Sphere(*sphere),
            None => Shape::Cone(self.scene.cones()[id - spheres.len()]),
        }
    }

    /// Calls `offer` for every shape that comes near a ray before `limit`: within a length that depends on that of the
    /// longest vector to a shape. The return value of `offer` is the new limit.
    fn visit(
        &self,
        line: &Line,
        beside: impl Fn(f64) -> f64,
        mut limit: f64,
        mut offer: impl FnMut(u32, Shape) -> f64,
    ) {
        let Candidates { spheres, cones, .. } = self.candidates;
        if !self.scene.spheres().is_empty() {
            let beside = beside(spheres.longest_from(line.origin));
            spheres.visit_beside(line, beside, limit, |candidate| {
                limit = offer(candidate.id, Shape::Sphere(candidate.shape));
                limit
            });
        }
        if !self.scene.cones().is_empty() {
            let beside = beside(cones.longest_from(line.origin));
            cones.visit_beside(line, beside, limit, |candidate| offer(candidate.id, Shape::Cone(candidate.shape)));
        }
    }

    /// The renderer's claim about a hit; `None` for a miss.
    fn claim(&self, index: usize, id: u32, ray: &ExactRay) -> Option<Claim> {
        if id == NO_ID {
            return None;
        }
        let shape = self.shape(id);
        let (seen, direction) = (ray.seen(shape), ray.line.direction);
        let unit = ray.unit(&seen);
        let distance = self.answers.depths.map(|depths| match (self.answers.depth_kind, self.axis) {
            (DepthKind::AlongAxis, Some(axis)) => depths[index] / direction.dot(axis),
            _ => depths[index],
        });
        let (mut moved, mut reason) = match distance {
            Some(t) => (seen.move_to_hit_at(t), Reason::Depth),
            None => (seen.move_to_hit(), Reason::Missed),
        };
        if seen.move_to_hit() >= moved {
            reason = Reason::Missed;
        }
        let (mut alone, mut tells_normals) = (moved / unit, true);
        if let Some(normals) = self.answers.normals {
            let (normal, radius) = (DVec3::from(normals[index]), seen.radius());
            let of_normal =
                seen.move_to_normal(direction, normal.normalize_or_zero()).max((normal.length() - 1.0).abs() * radius);
            // The coordinates of the hit point are rounded, whether the ray was given or not.
            let unit = EPSILON * (seen.size() + ray.world);
            tells_normals = self.at_most * unit < radius;
            if of_normal / unit > alone {
                (alone, moved, reason) = (of_normal / unit, of_normal, Reason::Normal);
            }
        }
        // The value is NaN if a ray is perpendicular to the axis of depth.
        let alone = if alone.is_nan() { f64::INFINITY } else { alone };
        Some(Claim { shape, seen, unit, distance, alone, moved, reason, tells_normals })
    }

    /// The other spheres that may be the nearest, for k of at most the limit, and whether the claimed sphere is certainly
    /// hit.
    fn find(&self, ray: &ExactRay, claim: Option<&Claim>) -> (Vec<Other>, bool) {
        let (mut others, k) = (Vec::<Other>::new(), self.at_most);
        let beside = |longest: f64| k * EPSILON * (longest + ray.start) + OF_SEARCH * longest;
        let claimed = claim.map(|claim| (claim, k * claim.unit));
        let certain = claimed.filter(|(claim, a)| claim.seen.move_to_miss() > *a);
        let mut limit = certain.map_or(f64::INFINITY, |(claim, a)| claim.seen.latest(a));
        self.visit(&ray.line, beside, limit, |id, shape| {
            let seen = ray.seen(shape);
            let a = k * ray.unit(&seen);
            if seen.move_to_hit() > a || claim.is_some_and(|claim| is_same(claim.shape, shape)) {
                return limit;
            }
            let earliest = seen.earliest(a);
            if earliest <= limit {
                others.push(Other { id, seen, earliest });
                if seen.move_to_miss() > a {
                    limit = limit.min(seen.latest(a));
                }
            }
            limit
        });
        others.retain(|other| other.earliest <= limit);
        (others, certain.is_some())
    }

    /// The spheres other than the claimed one that the exact ray meets before `t`.
    fn find_crossed(&self, ray: &ExactRay, claim: Option<&Claim>, t: f64) -> Vec<Other> {
        let mut others = Vec::new();
        self.visit(
            &ray.line,
            |longest| OF_SEARCH * longest,
            t,
            |id, shape| {
                let seen = ray.seen(shape);
                let is_other = claim.is_none_or(|claim| !is_same(claim.shape, shape));
                if is_other && seen.move_to_miss() > 0.0 {
                    others.push(Other { id, seen, earliest: seen.earliest(0.0) });
                }
                t
            },
        );
        others
    }

    /// The least k for which a claim is right by itself, and no other sphere certainly hides it.
    fn to_be_nearest(ray: &ExactRay, claim: &Claim, others: &[Other]) -> f64 {
        let hidden = |t: f64| ray.most(others, |seen| seen.move_to_pass(t));
        let alone = claim.alone;
        if let Some(t) = claim.distance {
            return alone.max(hidden(t));
        }
        // Without a depth, k determines how near the sphere may be, so it is found by bisection.
        let is_enough = |k: f64| hidden(claim.earliest(k)) <= k;
        if is_enough(alone) {
            return alone;
        }
        let (mut low, mut high) = (alone, alone.max(1.0 / 16.0));
        while !is_enough(high) && high < EVERYTHING {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if is_enough(middle) { high = middle } else { low = middle }
        }
        high
    }
}

impl Claim {
    fn earliest(&self, k: f64) -> f64 {
        self.seen.earliest(k * self.unit)
    }
}

/// Returns true if shapes are equal to the bit, so that no renderer can tell them apart.
fn is_same(a: Shape, b: Shape) -> bool {
    match (a, b) {
        (Shape::Sphere(a), Shape::Sphere(b)) => a.map(f32::to_bits) == b.map(f32::to_bits),
        (Shape::Cone(a), Shape::Cone(b)) => bytemuck::bytes_of(&a) == bytemuck::bytes_of(&b),
        _ => false,
    }
}
