//! A walk of the compressed 8-wide tree in f64. The caller tests the spheres.
//!
//! # Why it misses no sphere
//! A caller tests spheres with `intersect` of `src/cpu/sphere.rs`, in f64. Let u be 2⁻⁵³, l the vector from the ray's
//! origin o to a centre, r the radius, d the direction, β how far |d|² is from one, and D the distance from o to the
//! farthest point of the box of all spheres. Every sphere lies in that box, so that |l| + r ≤ D. For a ray, all boxes
//! are widened by the margin, (256 u + 16 β) D. If β is 1/16 or more, they all contain o, and nothing is left out. Let
//! it be less. If the test accepts the distance t, then the ray is in the sphere, with its radius widened by (48 u + 4
//! β) D, at t or enters it before:
//!
//! 1. *The line comes near enough.* With the computed b ≈ l·d, the foot vector f = l − b d leads from a point of the
//!    line to the centre, whatever the error of b. Only the roundings of l, of b d and of the difference are errors:
//!    less than 4 u |l|. The test accepts no |f| greater than r (1 + 4 u).
//! 2. *The point at b ± h is near the sphere.* With h = √(r² − |f|²), computed from the same f, that point is at the root
//!    of |f|² + h² |d|² ∓ 2 h f·d from the centre, and |f·d| is at most (β + 6 u) |l|. So it is off by less than
//!    (2 β + 8 u) D, although near a tangent h has a large error.
//! 3. *The quotient does no harm.* A ray that starts outside gets t = c/(b + h) instead of b − h, where r ≤ |l| and b > 0.
//!    The computed c is off from b² − h² by at most k = (β + 16 u) |l|². If b ≥ |l|/2, then t is off by at most
//!    2 k/|l|, which is (2 β + 32 u) |l|. Otherwise r ≥ |f| > 0.8 |l|. A sphere that is wider by w is entered at
//!    (c − 2 r w)/(b + h'), where h' ≥ h by more than the error of b. With w = k/|l| this is no later than the
//!    computed t, or o is in that sphere.
//! 4. *A ray that starts inside*, by the sign of the computed c, starts in the widened sphere. So does one that starts
//!    on a sphere, whose distance the caller does not compute by the test.
//!
//! The box test moves a plane by at most 16 u D: the distance to it is a sum of two products and a distance before
//! which the ray does not enter the node, with seven roundings of numbers that stand for lengths up to 2 D. All this
//! together is less than half of the margin. So there is a point of the ray, at t or before, that is in every computed
//! box around an accepted sphere: the box of a node and those of its children. A box is left out only if its entry is
//! greater than its exit or than the limit. A search among rays that graze spheres, up to 10¹⁶ radii away, found that
//! less than 4 u D is needed.
//!
//! The last sum is in f32, four boxes at once: a whole number of cells up to 255 times the size s of a cell along the ray,
//! plus a start a. With v = 2⁻²⁴, rounding s and a, the product and the sum move a plane by at most
//! v (2 |a| + 3 · 255 |s|) (1 + 4 v), so it is moved outward by 4 v (|a| + 256 |s|) and by the smallest normal f32, for
//! subnormal numbers. Distances count from where the ray may enter the node. So what rounding loses is small beside the
//! node, however far away it is. A plane that is too far away for f32 is at infinity, as are limits beyond it.

use std::ops::Range;

use glam::{DVec3, Vec4};

use super::wide_tree::{LEAF_COUNT_SHIFT, LEAF_FIRST, WIDE_LEVELS, WideNode, WideTree};

/// The margin for a direction of exactly unit length, relative to the longest vector.
const BESIDE: f64 = 128.0 * f64::EPSILON;

/// The smallest magnitude of a direction's component in box tests. Smaller ones are replaced by it. Over the longest
/// distance, that moves a ray by far less than the margin.
const SMALLEST: f64 = 1e-18;

/// The longest vector for which boxes are tested. Up to it, no number of a box test is NaN.
const FARTHEST: f64 = 1e36;

/// The error of rounding the distance to a plane to f32, relative to the terms of its sum.
const ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

/// The largest number of waiting nodes: on each level but the last, all children but the visited one.
const MOST_WAITING: usize = 7 * WIDE_LEVELS as usize + 1;

/// A ray prepared for box tests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxRay {
    origin: DVec3,
    inverse: DVec3,
    /// The extra width of all boxes for the ray.
    pub(crate) margin: f64,
    /// The relative error of rounding the distance to a plane to f32.
    pub(crate) rounding: f64,
}

impl BoxRay {
    /// Prepares a ray for a tree whose spheres lie between two corners. Returns `None` if the ray is not finite, or so
    /// far away that numbers overflow. No box can be skipped then.
    pub(crate) fn new(origin: DVec3, direction: DVec3, [low, high]: [DVec3; 2]) -> Option<Self> {
        let farthest = (low - origin).abs().max((high - origin).abs()).length();
        let bend = (1.0 - direction.length_squared()).abs();
        let margin = (BESIDE + 16.0 * bend) * farthest;
        let size = direction.abs().max(DVec3::splat(SMALLEST));
        let inverse = 1.0 / size.copysign(direction);
        let is_near = farthest <= FARTHEST && margin.is_finite();
        is_near.then_some(Self { origin, inverse, margin, rounding: ROUNDING })
    }
}

/// A node that waits for its visit, and a distance before which the ray does not enter it.
#[derive(Clone, Copy, Debug, Default)]
struct NodeVisit {
    entry: f32,
    node: u32,
}

impl WideTree {
    /// Two opposite corners of a box around all boxes of the tree. `None` if there are no spheres.
    pub(crate) fn corners(&self) -> Option<[DVec3; 2]> {
        let root = &self.nodes[0];
        let boxes = (0..8).filter(|slot| root.inner_mask() >> slot & 1 == 1 || root.byte(6, *slot) > 0);
        boxes.map(|slot| root.slot_box(slot).map(DVec3::from)).reduce(|[low, high], [l, h]| [low.min(l), high.max(h)])
    }

    /// Calls `offer` with ranges of spheres, in the order of [`WideTree::ids`], that together contain every sphere for
    /// which `intersect` in f64 finds a distance of at most `limit`. `offer` returns the new limit, or a negative
    /// number to end the walk. Near spheres tend to come first.
    #[inline]
    pub(crate) fn visit(&self, ray: &BoxRay, mut limit: f64, mut offer: impl FnMut(Range<usize>) -> f64) {
        let octant = (0..3).fold(0, |bits, axis| bits | usize::from(ray.inverse[axis] < 0.0) << axis);
        let mut waiting = [NodeVisit::default(); MOST_WAITING];
        let mut count = 0;
        let mut at = NodeVisit::default();
        loop {
            let node = &self.nodes[at.node as usize];
            let base = f64::from(at.entry);
            let mut left_over = limit_from(base, limit);
            let (entries, hits) = node.entries(ray, base, left_over);
            let inner = node.inner_mask();
            let mut leaves = octant_order(hits & !inner, octant as u32);
            while leaves != 0 {
                let slot = leaves.trailing_zeros() as usize ^ octant;
                leaves &= leaves - 1;
                let leaf = u32::from(node.byte(6, slot));
                if leaf != 0 && entries[slot] <= left_over {
                    let first = (node.0[5] + (leaf & LEAF_FIRST)) as usize;
                    limit = offer(first..first + (leaf >> LEAF_COUNT_SHIFT) as usize);
                    left_over = limit_from(base, limit);
                }
            }
            let mut left = hits & inner;
            let before = count;
            while left != 0 {
                let slot = left.trailing_zeros() as usize;
                left &= left - 1;
                if entries[slot] > left_over {
                    continue;
                }
                let child = node.0[4] + (inner & ((1 << slot) - 1)).count_ones();
                let entry = (base + f64::from(entries[slot])) as f32;
                let new = NodeVisit { entry: entry * (1.0 - f32::EPSILON), node: child };
                // Keeps the nearest last.
                let mut place = count;
                while place > before && waiting[place - 1].entry < new.entry {
                    waiting[place] = waiting[place - 1];
                    place -= 1;
                }
                waiting[place] = new;
                count += 1;
            }
            loop {
                if count == 0 || limit < 0.0 {
                    return;
                }
                count -= 1;
                if f64::from(waiting[count].entry) <= limit {
                    at = waiting[count];
                    break;
                }
            }
        }
    }
}

/// Converts a limit to a distance from `base`, rounded up. If it is negative, nothing in the node counts.
#[inline(always)]
fn limit_from(base: f64, limit: f64) -> f32 {
    (limit - base) as f32 * (1.0 + 2.0 * f32::EPSILON) + f32::MIN_POSITIVE
}

/// The distances to planes of four boxes: `start`, plus `step` for each cell.
#[inline(always)]
fn planes(cells: u32, step: Vec4, start: Vec4) -> Vec4 {
    let [a, b, c, d] = cells.to_le_bytes();
    Vec4::new(a.into(), b.into(), c.into(), d.into()) * step + start
}

impl WideNode {
    /// The distance from `base` at which the ray enters the box of each slot, and a mask of the slots whose boxes it
    /// enters at or before `limit`. Boxes are widened by the margin and the largest rounding error. `limit` also counts
    /// from `base`. The ray does not enter the node before `base`.
    #[inline(always)]
    fn entries(&self, ray: &BoxRay, base: f64, limit: f32) -> ([f32; 8], u32) {
        let (mut first, mut second) = (Vec4::ZERO, Vec4::ZERO);
        let (mut first_exit, mut second_exit) = (Vec4::splat(limit), Vec4::splat(limit));
        for axis in 0..3 {
            let inverse = ray.inverse[axis];
            let [origin, cell] = self.grid(axis);
            let step = cell * inverse;
            let start = (origin - ray.origin[axis]) * inverse - base;
            let margin = ray.margin * inverse.abs();
            let rounded = ray.rounding * (start.abs() + margin + 256.0 * step.abs());
            let wider = margin + rounded + f64::from(f32::MIN_POSITIVE);
            let (low, high) = (8 + 2 * axis, 14 + 2 * axis);
            let (near, far) = if inverse < 0.0 { (high, low) } else { (low, high) };
            let step = Vec4::splat(step as f32);
            let start_near = Vec4::splat((start - wider) as f32);
            let start_far = Vec4::splat((start + wider) as f32);
            first = first.max(planes(self.0[near], step, start_near));
            second = second.max(planes(self.0[near + 1], step, start_near));
            first_exit = first_exit.min(planes(self.0[far], step, start_far));
            second_exit = second_exit.min(planes(self.0[far + 1], step, start_far));
        }
        let hits = second.cmple(second_exit).bitmask() << 4 | first.cmple(first_exit).bitmask();
        let [a, b, c, d] = first.to_array();
        let [e, f, g, h] = second.to_array();
        ([a, b, c, d, e, f, g, h], hits)
    }
}

/// Moves bit s to bit `s ^ octant`. The lowest set bit is then the child that a ray of this octant hits first. The WGSL
/// twin is `octant_order` in `shaders/accel/wide_group.wgsl`.
#[inline]
fn octant_order(mask: u32, octant: u32) -> u32 {
    let mut mask = mask;
    if octant & 1 != 0 {
        mask = (mask & 0x55) << 1 | mask >> 1 & 0x55;
    }
    if octant & 2 != 0 {
        mask = (mask & 0x33) << 2 | mask >> 2 & 0x33;
    }
    if octant & 4 != 0 {
        mask = (mask & 0x0f) << 4 | mask >> 4;
    }
    mask
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_move_to_where_the_octant_sends_them() {
        for octant in 0..8 {
            for mask in 0..256_u32 {
                let expected = (0..8).fold(0, |m, s| m | (mask >> s & 1) << (s ^ octant));
                assert_eq!(octant_order(mask, octant), expected);
            }
        }
    }
}
