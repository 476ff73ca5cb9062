//! The nearest hit of a ray: the set of answers that a conforming device may give. The checker has a separate search
//! tree, which is in f64 and as simple as possible, because it judges results that other structures found.

use glam::{DVec3, Vec3};

use crate::geometry::math::wide;
use crate::parallel::{both, try_map};
use crate::scene::SceneError;
use crate::verify::rounding::{Interval, U};
use crate::verify::sphere::{Line, Slack, SphereTest};

const LEAF: usize = 6;

/// Subtrees of up to this number of levels are built by one thread.
const SMALL: u32 = 10;

/// The distance from a box, relative to the longest vector to a sphere, at which a kernel may still find that the
/// sphere in it is hit. Across the ray, |f|² and r² together are off by less than 13 u |f| |l| (`sphere.rs`). Along it,
/// a search among twenty million adversarial cases found 28 u.
const BESIDE: f64 = 64.0 * U;

/// A sphere in the scene's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) sphere: [f32; 4],
    pub(super) id: u32,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
}

/// A tree of boxes in which each node halves its spheres. The left child of a node comes right after it, and the right
/// child after the whole left subtree, so that only boxes are stored.
#[derive(Debug)]
pub(super) struct Candidates {
    items: Vec<Candidate>,
    nodes: Vec<Node>,
    levels: u32,
}

/// A node during the traversal, and the range of spheres below it.
#[derive(Clone, Copy, Debug)]
struct Visit {
    node: usize,
    level: u32,
    start: usize,
    end: usize,
    entry: f64,
}

impl Candidates {
    pub(super) fn new(spheres: &[[f32; 4]]) -> Result<Self, SceneError> {
        let memory = |_| SceneError::Memory { count: spheres.len() };
        let item = |i: usize| Candidate { sphere: spheres[i], id: i as u32 };
        let mut items = try_map(spheres.len(), item).map_err(memory)?;
        let levels = items.len().div_ceil(LEAF).next_power_of_two().trailing_zeros();
        let empty = Node { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };
        let mut nodes = try_map((2 << levels) - 1, |_| empty).map_err(memory)?;
        build(&mut items, &mut nodes, levels);
        Ok(Self { items, nodes, levels })
    }

    pub(super) fn bounds(&self) -> (Vec3, Vec3) {
        (self.nodes[0].low, self.nodes[0].high)
    }

    /// The length of the longest vector from a point to a sphere's centre.
    pub(super) fn longest_from(&self, point: DVec3) -> f64 {
        let Node { low, high } = self.nodes[0];
        let low = (low.as_dvec3() - point).abs();
        low.max((high.as_dvec3() - point).abs()).length()
    }

    /// Calls `offer` for every sphere that a ray, displaced by up to `moved`, may hit before `nearest`. The return
    /// value of `offer` is the new `nearest`.
    pub(super) fn visit(&self, line: &Line, moved: f64, nearest: f64, offer: impl FnMut(&Candidate) -> f64) {
        let longest = self.longest_from(line.origin) + moved;
        self.visit_beside(line, (BESIDE + 2.0 * line.bend) * longest + moved, nearest, offer);
    }

    /// Calls `offer` for every sphere that comes within `beside` of a ray before `nearest`, as [`Candidates::visit`] does.
    pub(super) fn visit_beside(
        &self,
        line: &Line,
        beside: f64,
        nearest: f64,
        mut offer: impl FnMut(&Candidate) -> f64,
    ) {
        let slab = Slab { line, inverse: line.inverse(), beside };
        let entry = slab.entry(&self.nodes[0]);
        let root = Visit { node: 0, level: self.levels, start: 0, end: self.items.len(), entry };
        // The entry of a box that is not hit is infinite, which is farther than any limit.
        self.visit_node(&slab, root, &mut nearest.min(f64::MAX), &mut offer);
    }

    /// Visits a node. Calls are nested at most 32 deep, because a tree has no more levels than an id has bits.
    fn visit_node(&self, slab: &Slab<'_>, visit: Visit, nearest: &mut f64, offer: &mut impl FnMut(&Candidate) -> f64) {
        let Visit { level, start, end, entry, .. } = visit;
        if entry > *nearest || start == end {
            // Nothing nearer can be found there.
        } else if level == 0 {
            for item in self.items[start..end].iter().filter(|item| slab.may_hit(item)) {
                *nearest = offer(item).min(f64::MAX);
            }
        } else {
            for child in self.children(slab, visit) {
                self.visit_node(slab, child, nearest, offer);
            }
        }
    }

    /// Both children, the nearer one first.
    fn children(&self, slab: &Slab<'_>, Visit { node, level, start, end, .. }: Visit) -> [Visit; 2] {
        let (middle, level) = (start + (end - start) / 2, level - 1);
        let (left, right) = (node + 1, node + (2 << level));
        let left_entry = slab.entry(&self.nodes[left]);
        let right_entry = slab.entry(&self.nodes[right]);
        let left = Visit { node: left, level, start, end: middle, entry: left_entry };
        let right = Visit { node: right, level, start: middle, end, entry: right_entry };
        if right_entry < left_entry { [right, left] } else { [left, right] }
    }
}

/// Orders the spheres, and computes the boxes of a subtree whose root is the first node.
fn build(items: &mut [Candidate], nodes: &mut [Node], level: u32) {
    if level == 0 {
        for Candidate { sphere: [x, y, z, radius], .. } in items {
            let center = wide([*x, *y, *z]);
            let radius = f64::from(*radius);
            nodes[0].low = nodes[0].low.min(rounded(center - radius, f32::next_down));
            nodes[0].high = nodes[0].high.max(rounded(center + radius, f32::next_up));
        }
        return;
    }
    let axis = longest_axis(items);
    let middle = items.len() / 2;
    if middle > 0 {
        items.select_nth_unstable_by(middle, |a, b| a.sphere[axis].total_cmp(&b.sphere[axis]));
    }
    let (left_items, right_items) = items.split_at_mut(middle);
    let (root, below) = nodes.split_at_mut(1);
    let (left, right) = below.split_at_mut((2 << (level - 1)) - 1);
    both(level > SMALL, || build(left_items, left, level - 1), || build(right_items, right, level - 1));
    root[0] = Node { low: left[0].low.min(right[0].low), high: left[0].high.max(right[0].high) };
}

/// Converts to f32 and moves each component one step outwards.
fn rounded(v: DVec3, beyond: fn(f32) -> f32) -> Vec3 {
    Vec3::from(v.as_vec3().to_array().map(beyond))
}

/// The axis along which the centres are farthest apart.
fn longest_axis(items: &[Candidate]) -> usize {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for Candidate { sphere: [x, y, z, _], .. } in items {
        let center = Vec3::new(*x, *y, *z);
        (low, high) = (low.min(center), high.max(center));
    }
    (high - low).max_position()
}

struct Slab<'a> {
    line: &'a Line,
    inverse: DVec3,
    beside: f64,
}

impl Slab<'_> {
    /// Whether the ray comes close enough to the sphere that a kernel may find a hit.
    fn may_hit(&self, Candidate { sphere: [x, y, z, radius], .. }: &Candidate) -> bool {
        let Line { origin, direction, .. } = *self.line;
        let to_center = wide([*x, *y, *z]) - origin;
        let foot = to_center - to_center.dot(direction) * direction;
        foot.length_squared() <= (f64::from(*radius) + self.beside).powi(2)
    }

    /// The distance at which the ray enters the box, widened by `beside` on all sides; infinity if it misses.
    fn entry(&self, node: &Node) -> f64 {
        let low = (node.low.as_dvec3() - self.beside - self.line.origin) * self.inverse;
        let high = (node.high.as_dvec3() + self.beside - self.line.origin) * self.inverse;
        let entry = low.min(high).max_element().max(0.0);
        let exit = low.max(high).min_element();
        if entry <= exit { entry } else { f64::INFINITY }
    }
}

/// All legal answers to a ray. Every answer that a device that conforms to WGSL may give, however it rounds, is one.
///
/// A hit is legal if its sphere is listed, and its distance is legal for this sphere and at most `limit`.
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

    /// Adds the hits that may be nearer than known hits, except of spheres for which `is_left_out` is true.
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
            self.add(candidate, line, slack);
            self.limit
        });
        self.drop_hidden();
    }

    /// Adds the hit of a sphere, if there is one that may be nearer than known hits.
    fn add(&mut self, candidate: &Candidate, line: &Line, slack: Slack) {
        if let Some((hit, may_miss)) = legal_hit(candidate, line, slack) {
            if hit.lowest() <= self.limit {
                self.spheres.push(hit);
            }
            if !may_miss {
                self.miss = false;
                self.limit = self.limit.min(hit.highest());
            }
        }
    }

    /// Drops spheres that others certainly hide. Among spheres that are equal to the bit, keeps the one with the
    /// smallest id. Kernels find the same distance for equal spheres, to the bit, because they share one sphere test,
    /// and at equal distances the smaller id wins. This is an assumption: WGSL does not guarantee that two kernels,
    /// such as the kernels of two bricks, compile the test in the same way.
    fn drop_hidden(&mut self) {
        self.spheres.retain(|hit| hit.lowest() <= self.limit);
        if self.spheres.len() > 1 {
            self.spheres.sort_unstable_by_key(|hit| (hit.sphere, hit.id));
            self.spheres.dedup_by_key(|hit| hit.sphere);
        }
    }
}

pub(super) fn legal_hit(Candidate { sphere, id }: &Candidate, line: &Line, slack: Slack) -> Option<(LegalHit, bool)> {
    let test = SphereTest::new(line, *sphere, slack)?;
    let roots = test.roots();
    let hit = LegalHit { id: *id, near: roots.near, far: roots.far, sphere: sphere.map(f32::to_bits) };
    roots.near.or(roots.far).map(|_| (hit, roots.may_miss))
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;

    use super::*;

    /// The legal hits without a search tree: every sphere is tested.
    fn without_search(spheres: &[[f32; 4]], line: &Line) -> LegalHits {
        let mut legal = LegalHits::default();
        legal.clear();
        for (sphere, id) in spheres.iter().zip(0..) {
            legal.add(&Candidate { sphere: *sphere, id }, line, Slack::default());
        }
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
            let candidates = Candidates::new(&spheres).unwrap();
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
                assert_eq!(in_order(found.clone()), in_order(without_search(&spheres, &line)));
                undecided += u32::from(found.count() > 1);
            }
        }
        assert!(undecided > 1000, "{undecided}");
    }
}
