//! The spheres that a ray may hit, found with a search tree of the checker's own. It is in f64 and as simple as
//! possible, because the results that it judges were found by other structures.

use glam::{DVec3, Vec3};

use super::line::Line;
use super::rounding::U;
use crate::geometry::math::wide;
use crate::parallel::{both, try_map};
use crate::scene::SceneError;

/// The largest number of spheres in a leaf.
const LEAF: usize = 6;

/// The largest number of levels, because a tree has at most as many levels as an id has bits.
const LEVELS: usize = 32;

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
#[derive(Clone, Copy, Debug, Default)]
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

    /// The box of all spheres.
    pub(super) fn bounds(&self) -> (Vec3, Vec3) {
        (self.nodes[0].low, self.nodes[0].high)
    }

    /// The length of the longest vector from a point to a sphere's centre.
    pub(super) fn longest_from(&self, point: DVec3) -> f64 {
        farthest(point, &self.nodes[0])
    }

    /// Calls `offer` for every sphere that a ray, displaced by up to `moved`, may hit before `nearest`. The return
    /// value of `offer` is the new `nearest`.
    pub(super) fn visit(
        &self,
        line: &Line,
        moved: f64,
        nearest: f64,
        offer: impl FnMut(&Candidate) -> f64,
    ) {
        let longest = self.longest_from(line.origin) + moved;
        self.visit_beside(line, (BESIDE + 2.0 * line.bend) * longest + moved, nearest, offer);
    }

    /// Calls `offer` for every sphere that comes within `beside` of a ray before `nearest`, as [`Candidates::visit`] does.
    pub(super) fn visit_beside(
        &self,
        line: &Line,
        beside: f64,
        mut nearest: f64,
        mut offer: impl FnMut(&Candidate) -> f64,
    ) {
        let root = &self.nodes[0];
        let slab = Slab { origin: line.origin, inverse: line.inverse(), beside };
        // The entry of a box that is not hit is infinite, which is farther than any limit.
        nearest = nearest.min(f64::MAX);
        let mut stack = [Visit::default(); LEVELS];
        let mut top = 0;
        let end = self.items.len();
        let entry = slab.entry(root);
        let mut next = Visit { node: 0, level: self.levels, start: 0, end, entry };
        loop {
            if next.entry > nearest || next.start == next.end {
                // Nothing nearer can be found there.
            } else if next.level == 0 {
                let items = self.items[next.start..next.end].iter();
                for item in items.filter(|item| slab.may_hit(line, item)) {
                    nearest = offer(item).min(f64::MAX);
                }
            } else {
                let [near, far] = self.children(&slab, next);
                if far.entry <= nearest {
                    stack[top] = far;
                    top += 1;
                }
                if near.entry <= nearest {
                    next = near;
                    continue;
                }
            }
            if top == 0 {
                return;
            }
            top -= 1;
            next = stack[top];
        }
    }

    /// Both children, the nearer one first.
    fn children(&self, slab: &Slab, Visit { node, level, start, end, .. }: Visit) -> [Visit; 2] {
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
    both(
        level > SMALL,
        || build(left_items, left, level - 1),
        || build(right_items, right, level - 1),
    );
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

/// The length of the longest vector from a point to a point of a box.
fn farthest(point: DVec3, node: &Node) -> f64 {
    let low = (node.low.as_dvec3() - point).abs();
    low.max((node.high.as_dvec3() - point).abs()).length()
}

struct Slab {
    origin: DVec3,
    inverse: DVec3,
    beside: f64,
}

impl Slab {
    /// Whether the ray comes close enough to the sphere that a kernel may find a hit.
    fn may_hit(
        &self,
        line: &Line,
        Candidate { sphere: [x, y, z, radius], .. }: &Candidate,
    ) -> bool {
        let to_center = wide([*x, *y, *z]) - line.origin;
        let along = to_center.dot(line.direction);
        let foot = to_center - along * line.direction;
        foot.length_squared() <= (f64::from(*radius) + self.beside).powi(2)
    }

    /// The distance at which the ray enters the box, widened by `beside` on all sides; infinity if it misses.
    fn entry(&self, node: &Node) -> f64 {
        let low = (node.low.as_dvec3() - self.beside - self.origin) * self.inverse;
        let high = (node.high.as_dvec3() + self.beside - self.origin) * self.inverse;
        let entry = low.min(high).max_element().max(0.0);
        let exit = low.max(high).min_element();
        if entry <= exit { entry } else { f64::INFINITY }
    }
}
