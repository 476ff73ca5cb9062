//! The nearest hit of a ray: the set of answers that a conforming device may give. The checker has search trees of its own
//! (`tree.rs`).

use glam::{DVec3, Vec3};

use crate::geometry::cone::ConeInFrame;
use crate::geometry::math::wide;
use crate::scene::{Scene, SceneError, Shape};
use crate::verify::cone::LegalConeHits;
use crate::verify::rounding::{Interval, U};
use crate::verify::sphere::{Line, Slack, SphereTest};
use crate::verify::tree::{Body, Candidate, Tree, beside, entry, rounded};

/// Across the ray, |f|² and r² together are off by less than 13 u |f| |l| (`sphere.rs`). Along it, a search among twenty
/// million adversarial cases found 28 u.
impl Body for [f32; 4] {
    const BESIDE: f64 = 64.0 * U;

    fn corners(&self) -> [DVec3; 2] {
        let [x, y, z, radius] = *self;
        let center = wide([x, y, z]);
        [center - f64::from(radius), center + f64::from(radius)]
    }

    fn middle(&self) -> Vec3 {
        let [x, y, z, _] = *self;
        Vec3::new(x, y, z)
    }

    fn may_be_hit(&self, Line { origin, direction, .. }: &Line, beside: f64) -> bool {
        let [x, y, z, radius] = *self;
        let to_center = wide([x, y, z]) - origin;
        let foot = to_center - to_center.dot(*direction) * direction;
        foot.length_squared() <= (f64::from(radius) + beside).powi(2)
    }
}

/// How far outside of a cone a kernel may still find a hit, relative to the larger radius. The angle between the axis and a
/// ray that is hardly not parallel, 2⁻¹⁷ (`LEAST_SQUARE` in `cone.rs`), is known to within some 2⁻²³, and so is where around
/// the axis the ray passes.
const ASIDE: f64 = 1.0 / 16.0;

/// Distances across the axis and along it are off by some roundings of the longest vector. A search among 1.6 million hits of
/// devices that round in any way found 56, and as much of `ASIDE` (`tests/cpu/cone.rs`).
impl Body for ConeInFrame {
    const BESIDE: f64 = 256.0 * U;

    fn corners(&self) -> [DVec3; 2] {
        let aside = ASIDE * larger_radius(self);
        let [low, high] = self.corners();
        [low - aside, high + aside]
    }

    fn middle(&self) -> Vec3 {
        0.5 * Vec3::from(self.start) + 0.5 * Vec3::from(self.end)
    }

    fn may_be_hit(&self, line: &Line, beside: f64) -> bool {
        around(self, line, beside).is_some()
    }
}

fn larger_radius(cone: &ConeInFrame) -> f64 {
    let [first, second] = cone.radii();
    first.max(second)
}

/// The distances at which a ray is in the cylinder around a cone that is widened by `beside`; `None` if it passes by.
fn around(cone: &ConeInFrame, Line { origin, direction, .. }: &Line, beside: f64) -> Option<Interval> {
    let [start, end] = cone.ends();
    let (span, middle) = (end - start, 0.5 * (start + end));
    let (half, radius) = (0.5 * span.length() + beside, (1.0 + ASIDE) * larger_radius(cone) + beside);
    let axis = span / span.length();
    let foot = (middle - origin).dot(*direction);
    let from_middle = origin + foot * direction - middle;
    let [height, rise] = [from_middle, *direction].map(|v| v.dot(axis));
    let [away, aside] = [from_middle - height * axis, direction - rise * axis];
    // Numbers that are too small to divide by lead far away, as they should.
    let rise = rise.abs().max(LEAST).copysign(rise);
    let square = aside.length_squared().max(LEAST);
    let towards = -away.dot(aside);
    let root = (towards * towards - square * (away.length_squared() - radius * radius)).sqrt();
    let side = Interval { low: (towards - root) / square, high: (towards + root) / square };
    let slab = Interval::between((-half - height) / rise, (half - height) / rise, 0.0);
    let Interval { low, high } = side.intersection(slab);
    // This is also false for the root of a negative number, which is NaN.
    let is_crossed = !root.is_nan() && low <= high && foot + high > 0.0;
    is_crossed.then_some(Interval { low: foot + low, high: foot + high })
}

/// The least number that is divided by.
const LEAST: f64 = 1e-60;

/// The shapes of a scene, for searches.
#[derive(Debug)]
pub(super) struct Candidates {
    pub(super) spheres: Tree<[f32; 4]>,
    pub(super) cones: Tree<ConeInFrame>,
    /// Id of the first cone, if there are cones.
    pub(super) first_cone: Option<u32>,
    /// The corners of the box of all shapes.
    bounds: [Vec3; 2],
}

impl Candidates {
    pub(super) fn new(spheres: &[[f32; 4]], cones: &[ConeInFrame]) -> Result<Self, SceneError> {
        let join = |[low, high]: [Vec3; 2], [other_low, other_high]: [DVec3; 2]| {
            [low.min(rounded(other_low, f32::next_down)), high.max(rounded(other_high, f32::next_up))]
        };
        let tree = Tree::new(spheres, 0)?;
        Ok(Self {
            bounds: cones.iter().map(ConeInFrame::corners).fold(tree.bounds(), join),
            spheres: tree,
            cones: Tree::new(cones, spheres.len())?,
            first_cone: (!cones.is_empty()).then_some(spheres.len() as u32),
        })
    }

    /// The corners of the box of all shapes.
    pub(super) fn bounds(&self) -> (Vec3, Vec3) {
        let [low, high] = self.bounds;
        (low, high)
    }
}

/// All legal answers to a ray. Every answer that a device that conforms to WGSL may give, however it rounds, is one.
///
/// A hit is legal if its shape is listed, and its distance is legal for this shape and at most `limit`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LegalHits {
    /// The spheres and cones that may be the nearest, in no particular order.
    pub spheres: Vec<LegalHit>,
    /// An upper limit for the distance: a shape is certainly hit at or before it. Infinity if no hit is certain.
    pub limit: f64,
    /// Whether a miss is legal.
    pub miss: bool,
    /// Id of the first cone, if the scene has cones.
    pub(super) first_cone: Option<u32>,
}

/// A shape that may be the nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegalHit {
    /// Index in input order.
    pub id: u32,
    /// Legal distances to the near side.
    pub near: Option<Interval>,
    /// Legal distances to the far side, if the ray may start inside.
    pub far: Option<Interval>,
    /// The numbers of the shape, which are the same for equal ones.
    pub(super) key: [u32; 8],
}

/// The shape with an id. `None` without such a shape, as for the ground and for the camera.
pub(super) fn shape_of(scene: &Scene, id: u32) -> Option<Shape> {
    ((id as usize) < scene.shape_count()).then(|| scene.shared_shapes().shape(id))
}

/// The key of a shape. That of a sphere is none of a cone, whose numbers are finite.
pub(super) fn key_of(shape: Shape) -> [u32; 8] {
    match shape {
        Shape::Sphere(sphere) => {
            let [x, y, z, radius] = sphere.map(f32::to_bits);
            [x, y, z, radius, u32::MAX, u32::MAX, u32::MAX, u32::MAX]
        }
        Shape::Cone(cone) => bytemuck::cast(cone),
    }
}

impl LegalHit {
    pub(super) fn crossings(&self) -> impl Iterator<Item = Interval> {
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

    /// Returns true if a hit of this sphere at this distance is legal.
    #[must_use]
    pub fn allows(&self, id: u32, t: f64) -> bool {
        t <= self.limit && self.of(id).is_some_and(|hit| hit.crossing_at(t).is_some())
    }

    /// Resets to a miss, and keeps the allocated memory.
    pub(super) fn clear(&mut self) {
        self.spheres.clear();
        self.limit = f64::INFINITY;
        self.miss = true;
    }

    /// Computes the legal hits of a ray, and keeps the allocated memory.
    pub(super) fn find(&mut self, candidates: &Candidates, line: &Line) {
        self.clear();
        self.find_nearer(candidates, line, Slack::default(), |_| false);
    }

    /// Adds the hits that may be nearer than known hits, except of shapes for which `is_left_out` is true.
    pub(super) fn find_nearer(
        &mut self,
        candidates: &Candidates,
        line: &Line,
        slack: Slack,
        is_left_out: impl Fn(Shape) -> bool,
    ) {
        let moved = slack.across + slack.along;
        candidates.spheres.visit(line, moved, self.limit, |candidate| {
            if !is_left_out(Shape::Sphere(candidate.shape)) {
                self.add(legal_hit(candidate, line, slack));
            }
            self.limit
        });
        candidates.cones.visit(line, moved, self.limit, |candidate| {
            if !is_left_out(Shape::Cone(candidate.shape)) {
                self.add(legal_cone_hit(candidate, line, slack));
            }
            self.limit
        });
        self.first_cone = candidates.first_cone;
        self.drop_hidden();
    }

    /// Adds a hit that may be nearer than known hits, and whether a miss is legal too.
    fn add(&mut self, found: Option<(LegalHit, bool)>) {
        if let Some((hit, may_miss)) = found {
            if hit.lowest() <= self.limit {
                self.spheres.push(hit);
            }
            if !may_miss {
                self.miss = false;
                self.limit = self.limit.min(hit.highest());
            }
        }
    }

    /// Drops shapes that others certainly hide. Among shapes that are equal to the bit, keeps the one with the
    /// smallest id. Kernels find the same distance for equal shapes, to the bit, because they share one test,
    /// and at equal distances the smaller id wins. This is an assumption: WGSL does not guarantee that two kernels,
    /// such as the kernels of two bricks, compile the test in the same way.
    fn drop_hidden(&mut self) {
        self.spheres.retain(|hit| hit.lowest() <= self.limit);
        if self.spheres.len() > 1 {
            self.spheres.sort_unstable_by_key(|hit| (hit.key, hit.id));
            self.spheres.dedup_by_key(|hit| hit.key);
        }
    }
}

/// The legal hits of a sphere, and whether a miss is legal.
pub(super) fn legal_hit(
    Candidate { shape: sphere, id }: &Candidate<[f32; 4]>,
    line: &Line,
    slack: Slack,
) -> Option<(LegalHit, bool)> {
    let test = SphereTest::new(line, *sphere, slack)?;
    let roots = test.roots();
    let hit = LegalHit { id: *id, near: roots.near, far: roots.far, key: key_of(Shape::Sphere(*sphere)) };
    roots.near.or(roots.far).map(|_| (hit, roots.may_miss))
}

/// The legal hits of a cone, and whether a miss is legal.
pub(super) fn legal_cone_hit(
    Candidate { shape: cone, id }: &Candidate<ConeInFrame>,
    line: &Line,
    slack: Slack,
) -> Option<(LegalHit, bool)> {
    let corners = Body::corners(cone);
    let beside = beside::<ConeInFrame>(line, corners, slack.across + slack.along);
    let mut within = around(cone, line, beside)?;
    within.low = within.low.max(entry(line, corners, beside));
    let legal = LegalConeHits::of(line, slack, cone);
    let side = |is_near| legal.distances(is_near).map(|side| side.intersection(within));
    let [near, far] = [true, false].map(|is_near| side(is_near).filter(|side| side.low <= side.high));
    let hit = LegalHit { id: *id, near, far, key: key_of(Shape::Cone(*cone)) };
    near.or(far).map(|_| (hit, legal.may_miss))
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;

    use super::*;
    use crate::recording::cone_rays::{RayAndCone, rays_and_cones};

    /// The legal hits without a search tree: every shape is tested.
    fn without_search(spheres: &[[f32; 4]], cones: &[ConeInFrame], line: &Line) -> LegalHits {
        let mut legal = LegalHits::default();
        legal.clear();
        for (shape, id) in spheres.iter().zip(0..) {
            legal.add(legal_hit(&Candidate { shape: *shape, id }, line, Slack::default()));
        }
        for (shape, id) in cones.iter().zip(spheres.len() as u32..) {
            legal.add(legal_cone_hit(&Candidate { shape: *shape, id }, line, Slack::default()));
        }
        legal.first_cone = (!cones.is_empty()).then_some(spheres.len() as u32);
        legal.drop_hidden();
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
            let candidates = Candidates::new(&spheres, &[]).unwrap();
            for _ in 0..300 {
                // Rays near a silhouette. Half of them are at the end of a box, along its side.
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
                assert_eq!(in_order(found.clone()), in_order(without_search(&spheres, &[], &line)));
                undecided += u32::from(found.count() > 1);
            }
        }
        assert!(undecided > 1000, "{undecided}");
    }

    #[test]
    fn the_search_loses_no_cone() {
        let mut random = Rng::with_seed(3);
        let (mut undecided, mut of_cones) = (0, 0);
        let inputs = rays_and_cones(16_000);
        for (round, inputs) in inputs.chunks(400).enumerate() {
            // The cones of some inputs only, so that all others are met by rays that go elsewhere.
            let cones: Vec<ConeInFrame> = inputs[..1 << (round % 9)].iter().map(|input| input.cone).collect();
            let spheres = spheres(&mut random, 1.0, 1 + round % 30);
            let candidates = Candidates::new(&spheres, &cones).unwrap();
            for RayAndCone { origin, direction, .. } in inputs {
                let line = Line::new(*origin, *direction);
                let mut found = LegalHits::default();
                found.find(&candidates, &line);
                assert_eq!(in_order(found.clone()), in_order(without_search(&spheres, &cones, &line)));
                undecided += u32::from(found.count() > 1);
                of_cones += u32::from(found.spheres.iter().any(|hit| Some(hit.id) >= found.first_cone));
            }
        }
        assert!(undecided > 200 && of_cones > 8000, "{undecided} {of_cones}");
    }
}
