//! The nearest hit of a ray: the set of answers that a conforming device may give.

use super::candidates::{Candidate, Candidates};
use super::line::Line;
use super::rounding::Interval;
use super::sphere::{Slack, SphereTest};

/// All answers to a ray that are legal: that a device which conforms to WGSL may give, however it rounds.
///
/// A hit is legal if its sphere is listed, and its distance is one of that sphere and at most `limit`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LegalHits {
    /// The spheres that may be the nearest, in no particular order.
    pub spheres: Vec<LegalHit>,
    /// An upper limit for the distance: a sphere is certainly hit at or before it. Infinity if no hit is certain.
    pub limit: f64,
    /// Whether a miss is legal.
    pub miss: bool,
}

/// A sphere that may be the nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegalHit {
    /// Index in input order.
    pub id: u32,
    /// Legal distances to the near side.
    pub near: Option<Interval>,
    /// Legal distances to the far side, if the ray may start inside.
    pub far: Option<Interval>,
    pub(super) sphere: [u32; 4],
}

impl LegalHit {
    fn crossings(&self) -> impl Iterator<Item = Interval> {
        [self.near, self.far].into_iter().flatten()
    }

    /// The interval that contains a distance.
    #[must_use]
    pub fn crossing_at(&self, t: f64) -> Option<Interval> {
        self.crossings().find(|crossing| crossing.contains(t))
    }

    pub(super) fn lowest(&self) -> f64 {
        self.crossings().map(|crossing| crossing.low).fold(f64::INFINITY, f64::min)
    }

    pub(super) fn highest(&self) -> f64 {
        self.crossings().map(|crossing| crossing.high).fold(0.0, f64::max)
    }
}

impl LegalHits {
    /// The number of legal answers, regardless of distances.
    #[must_use]
    pub fn count(&self) -> usize {
        self.spheres.len() + usize::from(self.miss)
    }

    /// The legal hit of the sphere with this index.
    #[must_use]
    pub fn of(&self, id: u32) -> Option<&LegalHit> {
        self.spheres.iter().find(|hit| hit.id == id)
    }

    /// Whether a hit of this sphere at this distance is legal.
    #[must_use]
    pub fn allows(&self, id: u32, t: f64) -> bool {
        t <= self.limit && self.of(id).is_some_and(|hit| hit.crossing_at(t).is_some())
    }

    /// Resets to a miss; keeps the allocated memory.
    pub(super) fn clear(&mut self) {
        self.spheres.clear();
        self.limit = f64::INFINITY;
        self.miss = true;
    }

    /// Computes the legal hits of a ray; keeps the allocated memory.
    pub(super) fn find(&mut self, candidates: &Candidates, line: &Line) {
        self.clear();
        self.find_nearer(candidates, line, Slack::default(), |_| false);
    }

    /// Adds the hits that may be nearer than those already known, except of spheres for which `is_left_out` is true.
    pub(super) fn find_nearer(
        &mut self,
        candidates: &Candidates,
        line: &Line,
        slack: Slack,
        is_left_out: impl Fn([f32; 4]) -> bool,
    ) {
        candidates.visit(line, slack.across + slack.along, self.limit, |candidate| {
            if is_left_out(candidate.sphere) {
                return self.limit;
            }
            if let Some((hit, may_miss)) = legal_hit(candidate, line, slack) {
                if hit.lowest() <= self.limit {
                    self.spheres.push(hit);
                }
                if !may_miss {
                    self.miss = false;
                    self.limit = self.limit.min(hit.highest());
                }
            }
            self.limit
        });
        self.spheres.retain(|hit| hit.lowest() <= self.limit);
        self.drop_copies();
    }

    /// Among spheres that are equal to the bit, keeps the one with the smallest id. Kernels find the same distance for
    /// equal spheres, to the bit, because they share one sphere test, and at equal distances the smaller id wins. This
    /// is a guarantee of this crate: WGSL does not guarantee that two kernels, such as those of two bricks, compile the
    /// test in the same way.
    fn drop_copies(&mut self) {
        if self.spheres.len() > 1 {
            self.spheres.sort_unstable_by_key(|hit| (hit.sphere, hit.id));
            self.spheres.dedup_by_key(|hit| hit.sphere);
        }
    }
}

pub(super) fn legal_hit(
    Candidate { sphere, id }: &Candidate,
    line: &Line,
    slack: Slack,
) -> Option<(LegalHit, bool)> {
    let test = SphereTest::new(line, *sphere, slack)?;
    let roots = test.roots();
    let hit =
        LegalHit { id: *id, near: roots.near, far: roots.far, sphere: sphere.map(f32::to_bits) };
    roots.near.or(roots.far).map(|_| (hit, roots.may_miss))
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;
    use glam::Vec3;

    use super::*;

    /// The reference, which tests every sphere.
    fn without_search(spheres: &[[f32; 4]], line: &Line) -> LegalHits {
        let mut legal = LegalHits::default();
        legal.clear();
        for (sphere, id) in spheres.iter().zip(0..) {
            if let Some((hit, may_miss)) =
                legal_hit(&Candidate { sphere: *sphere, id }, line, Slack::default())
            {
                legal.spheres.push(hit);
                if !may_miss {
                    legal.miss = false;
                    legal.limit = legal.limit.min(hit.highest());
                }
            }
        }
        legal.spheres.retain(|hit| hit.lowest() <= legal.limit);
        legal.drop_copies();
        legal
    }

    fn in_order(mut legal: LegalHits) -> LegalHits {
        legal.spheres.sort_unstable_by_key(|hit| hit.id);
        legal
    }

    fn point(random: &mut Rng) -> Vec3 {
        Vec3::from([0; 3].map(|_| random.f32() * 2.0 - 1.0))
    }

    /// Spheres of various sizes, some of them twice.
    fn spheres(random: &mut Rng, scale: f32, count: usize) -> Vec<[f32; 4]> {
        let decades = random.f32() * 6.0;
        let mut spheres: Vec<[f32; 4]> = (0..count)
            .map(|_| {
                let [x, y, z] = point(random).to_array();
                let radius = 10_f32.powf(-decades * random.f32()) * 0.5;
                [x, y, z, radius].map(|number| number * scale)
            })
            .collect();
        for _ in 0..count / 4 {
            spheres.push(spheres[random.usize(0..spheres.len())]);
        }
        spheres
    }

    #[test]
    fn the_search_loses_no_sphere() {
        let mut random = Rng::with_seed(9);
        let mut undecided = 0;
        for round in 0..60 {
            let scale = 2_f32.powi(random.i32(-50..51));
            let spheres = spheres(&mut random, scale, 1 << (round % 10));
            let candidates = Candidates::new(&spheres).unwrap();
            for _ in 0..300 {
                // Rays near a silhouette; half of them at the end of a box, along its side.
                let [x, y, z, r] = spheres[random.usize(0..spheres.len())];
                let mut outward = point(&mut random).normalize_or(Vec3::X);
                if random.bool() {
                    outward = Vec3::AXES[random.usize(0..3)] * f32::from(random.i8(0..2) * 2 - 1);
                }
                let off = 1.0 + 10_f32.powf(-3.0 - 5.0 * random.f32()) * (random.f32() - 0.5);
                let target = Vec3::new(x, y, z) + outward * r * off;
                let along = outward.cross(point(&mut random)).normalize_or(Vec3::Y);
                let origin = target - along * 2_f32.powi(random.i32(-3..5)) * scale;
                let direction = (target - origin).normalize_or(Vec3::Y);
                let line = Line::new(origin.to_array(), direction.to_array());
                let mut found = LegalHits::default();
                found.find(&candidates, &line);
                assert_eq!(in_order(found.clone()), in_order(without_search(&spheres, &line)));
                undecided += u32::from(found.count() > 1);
            }
        }
        assert!(undecided > 1000, "{undecided}");
    }
}
