//! A search tree over shapes, which is in f64 and as simple as possible, because it judges results that other structures
//! found.

use glam::{DVec3, Vec3};

use crate::parallel::{both, try_map};
use crate::scene::SceneError;
use crate::verify::sphere::Line;

const LEAF: usize = 6;

/// Subtrees of up to this number of levels are built by one thread.
const SMALL: u32 = 10;

/// A shape of a tree.
pub(super) trait Body: Copy + Send + Sync {
    /// The distance from the box of a shape, relative to the longest vector from a ray's origin to the box, at which a kernel
    /// may still find a hit.
    const BESIDE: f64;

    /// The corners of a box that contains all hits, up to [`Body::BESIDE`].
    fn corners(&self) -> [DVec3; 2];

    /// A point by which shapes are divided.
    fn middle(&self) -> Vec3;

    /// True for every ray that comes within `beside` of it.
    fn may_be_hit(&self, line: &Line, beside: f64) -> bool;
}

/// A shape in the scene's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate<S> {
    pub(super) shape: S,
    pub(super) id: u32,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
}

impl Node {
    fn corners(&self) -> [DVec3; 2] {
        [self.low, self.high].map(|corner| corner.as_dvec3())
    }
}

/// A tree of boxes in which each node halves its shapes. The left child of a node comes right after it, and the right
/// child after the whole left subtree, so that only boxes are stored.
#[derive(Debug)]
pub(super) struct Tree<S> {
    items: Vec<Candidate<S>>,
    nodes: Vec<Node>,
    levels: u32,
}

/// A node during the traversal, and the range of shapes below it.
#[derive(Clone, Copy, Debug)]
struct Visit {
    node: usize,
    level: u32,
    start: usize,
    end: usize,
    entry: f64,
}

impl<S: Body> Tree<S> {
    /// The tree of shapes whose ids begin with `first`.
    pub(super) fn new(shapes: &[S], first: usize) -> Result<Self, SceneError> {
        let memory = |_| SceneError::Memory { count: shapes.len() };
        let item = |i: usize| Candidate { shape: shapes[i], id: (first + i) as u32 };
        let mut items = try_map(shapes.len(), item).map_err(memory)?;
        let levels = items.len().div_ceil(LEAF).next_power_of_two().trailing_zeros();
        let empty = Node { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };
        let mut nodes = try_map((2 << levels) - 1, |_| empty).map_err(memory)?;
        build(&mut items, &mut nodes, levels);
        Ok(Self { items, nodes, levels })
    }

    /// The corners of the box of all boxes.
    pub(super) fn bounds(&self) -> [Vec3; 2] {
        [self.nodes[0].low, self.nodes[0].high]
    }

    /// The length of the longest vector from a point to the boxes.
    pub(super) fn longest_from(&self, point: DVec3) -> f64 {
        longest(point, self.nodes[0].corners())
    }

    /// Calls `offer` for every shape that a ray, displaced by up to `moved`, may hit before `nearest`. The return
    /// value of `offer` is the new `nearest`.
    pub(super) fn visit(&self, line: &Line, moved: f64, nearest: f64, offer: impl FnMut(&Candidate<S>) -> f64) {
        self.visit_beside(line, beside::<S>(line, self.nodes[0].corners(), moved), nearest, offer);
    }

    /// Calls `offer` for every shape that comes within `beside` of a ray before `nearest`, as [`Tree::visit`] does.
    pub(super) fn visit_beside(
        &self,
        line: &Line,
        beside: f64,
        nearest: f64,
        mut offer: impl FnMut(&Candidate<S>) -> f64,
    ) {
        let slab = Slab { line, inverse: line.inverse(), beside };
        let entry = slab.entry(self.nodes[0].corners());
        let root = Visit { node: 0, level: self.levels, start: 0, end: self.items.len(), entry };
        // The entry of a box that is not hit is infinite, which is farther than any limit.
        self.visit_node(&slab, root, &mut nearest.min(f64::MAX), &mut offer);
    }

    /// Visits a node. Calls are nested at most 32 deep, because a tree has no more levels than an id has bits.
    fn visit_node(
        &self,
        slab: &Slab<'_>,
        visit: Visit,
        nearest: &mut f64,
        offer: &mut impl FnMut(&Candidate<S>) -> f64,
    ) {
        let Visit { level, start, end, entry, .. } = visit;
        if entry > *nearest || start == end {
            // Nothing nearer can be found there.
        } else if level == 0 {
            for item in self.items[start..end].iter().filter(|item| item.shape.may_be_hit(slab.line, slab.beside)) {
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
        let left_entry = slab.entry(self.nodes[left].corners());
        let right_entry = slab.entry(self.nodes[right].corners());
        let left = Visit { node: left, level, start, end: middle, entry: left_entry };
        let right = Visit { node: right, level, start: middle, end, entry: right_entry };
        if right_entry < left_entry { [right, left] } else { [left, right] }
    }
}

/// Orders the shapes, and computes the boxes of a subtree whose root is the first node.
fn build<S: Body>(items: &mut [Candidate<S>], nodes: &mut [Node], level: u32) {
    if level == 0 {
        for [low, high] in items.iter().map(|item| item.shape.corners()) {
            nodes[0].low = nodes[0].low.min(rounded(low, f32::next_down));
            nodes[0].high = nodes[0].high.max(rounded(high, f32::next_up));
        }
        return;
    }
    let axis = longest_axis(items);
    let middle = items.len() / 2;
    if middle > 0 {
        items.select_nth_unstable_by(middle, |a, b| a.shape.middle()[axis].total_cmp(&b.shape.middle()[axis]));
    }
    let (left_items, right_items) = items.split_at_mut(middle);
    let (root, below) = nodes.split_at_mut(1);
    let (left, right) = below.split_at_mut((2 << (level - 1)) - 1);
    both(level > SMALL, || build(left_items, left, level - 1), || build(right_items, right, level - 1));
    root[0] = Node { low: left[0].low.min(right[0].low), high: left[0].high.max(right[0].high) };
}

/// Converts to f32 and moves each component one step outwards.
pub(super) fn rounded(v: DVec3, beyond: fn(f32) -> f32) -> Vec3 {
    Vec3::from(v.as_vec3().to_array().map(beyond))
}

/// The axis along which the middles are farthest apart.
fn longest_axis<S: Body>(items: &[Candidate<S>]) -> usize {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for middle in items.iter().map(|item| item.shape.middle()) {
        (low, high) = (low.min(middle), high.max(middle));
    }
    (high - low).max_position()
}

/// The length of the longest vector from a point to a box.
fn longest(point: DVec3, [low, high]: [DVec3; 2]) -> f64 {
    (low - point).abs().max((high - point).abs()).length()
}

/// The distance from shapes in a box at which a kernel may still find that a ray, displaced by up to `moved`, hits them.
pub(super) fn beside<S: Body>(line: &Line, corners: [DVec3; 2], moved: f64) -> f64 {
    (S::BESIDE + 2.0 * line.bend) * (longest(line.origin, corners) + moved) + moved
}

/// The distance at which a ray enters a box, widened by `beside` on all sides; infinity if it misses.
pub(super) fn entry(line: &Line, corners: [DVec3; 2], beside: f64) -> f64 {
    Slab { line, inverse: line.inverse(), beside }.entry(corners)
}

struct Slab<'a> {
    line: &'a Line,
    inverse: DVec3,
    beside: f64,
}

impl Slab<'_> {
    /// The distance at which the ray enters the box; see [`entry`].
    fn entry(&self, [low, high]: [DVec3; 2]) -> f64 {
        let low = (low - self.beside - self.line.origin) * self.inverse;
        let high = (high + self.beside - self.line.origin) * self.inverse;
        let entry = low.min(high).max_element().max(0.0);
        let exit = low.max(high).min_element();
        if entry <= exit { entry } else { f64::INFINITY }
    }
}
