//! Building the compressed 8-wide tree, level by level from the root.
//!
//! The spheres of a node are split in two, and so are the parts, until there are eight parts. Parts of at most three
//! spheres are leaves. No binary tree is built first.

use super::split::{Cluster, Extent, Item, Reach};
use super::statistics::Margins;
use super::wide_tree::{WIDE_BYTES_PER_SPHERE, WIDE_LEAF, WIDE_LEVELS, WideNode, WideTree, octant_slots};
use crate::geometry::cone::ConeInFrame;
use crate::parallel::{both, map_parts};

/// Up to this number of spheres, a node has only leaves.
const LEAVES_ONLY: usize = 8 * WIDE_LEAF;
/// The number of spheres for each child of a node. Smaller numbers waste slots, larger ones waste levels.
const SPHERES_PER_CHILD: usize = 16;
/// From this number of spheres on, a second thread is worth its cost.
const PARALLEL: usize = 1 << 13;
/// The number of nodes that are drafts at the same time.
const DRAFTS: usize = 1 << 14;

impl WideTree {
    /// Builds the tree of spheres (centre x, y, z in the scene's frame, radius). Each box contains its spheres inflated
    /// by `margin`.
    ///
    /// Takes time proportional to n log n for any spheres, and 28 bytes per sphere in addition to the tree, which has
    /// at most 14 bytes of nodes per sphere and one more node. The same spheres give the same tree, to the bit, for any
    /// number of threads.
    #[must_use]
    pub fn build(spheres: &[[f32; 4]], margin: f32) -> Self {
        Self::build_with(spheres, Margins::one(margin))
    }

    /// Builds the tree with a margin for each sphere.
    pub(super) fn build_with(spheres: &[[f32; 4]], margins: Margins) -> Self {
        let mut items = Item::all(spheres, &margins);
        let (nodes, ids, levels) = build(&mut items);
        Self { nodes, ids, levels, margins }
    }

    /// Builds the tree of cones, with one margin.
    pub(crate) fn of_cones(cones: &[ConeInFrame], margin: f32) -> Self {
        let (nodes, ids, levels) = build(&mut Item::of_cones(cones, margin));
        Self { nodes, ids, levels, margins: Margins::one(margin) }
    }
}

/// The largest number of nodes of a tree of `count` spheres.
fn max_nodes(count: usize) -> usize {
    1 + count * WIDE_BYTES_PER_SPHERE / size_of::<WideNode>()
}

/// The number of levels that a tree of `count` spheres needs if every split is in half. It is the smallest L ≥ 1 with 3
/// · 8^L ≥ count, because ⌈⌈⌈n/2⌉/2⌉/2⌉ ≤ c if n ≤ 8 c.
pub(super) fn levels_by_halves(count: usize) -> u32 {
    let mut levels = 1;
    let mut reach = LEAVES_ONLY;
    while reach < count {
        levels += 1;
        reach = reach.saturating_mul(8);
    }
    levels
}

/// Builds a tree. Returns its nodes, the ids in leaf order, and the number of levels.
///
/// There are at most [`WIDE_LEVELS`] levels. For every node of level l (from 0) with n spheres, l +
/// [`levels_by_halves`]`(n)` is at most that number. It holds for the root because there are fewer than 2³² spheres,
/// which need eleven levels. If it is less, any split is allowed, since a child has fewer spheres than its parent. If
/// it is equal, splits are in half, and a child needs one level less than its parent.
fn build<R: Reach>(items: &mut [Item<R>]) -> (Vec<WideNode>, Vec<u32>, u32) {
    let most = max_nodes(items.len());
    let by_cost = nodes_by_level(items, false, most);
    if by_cost.0.len() <= most { by_cost } else { nodes_by_level(items, true, usize::MAX) }
}

/// Builds a tree level by level. Stops early if there are more than `most` nodes.
fn nodes_by_level<R: Reach>(items: &mut [Item<R>], in_halves: bool, most: usize) -> (Vec<WideNode>, Vec<u32>, u32) {
    let mut ids = Vec::with_capacity(items.len());
    if items.is_empty() {
        return (vec![WideNode::empty()], ids, 1);
    }
    let mut nodes = Vec::new();
    let mut level = vec![Cluster::new(items)];
    let mut levels = 0;
    while !level.is_empty() && nodes.len() <= most {
        let first_of_next = nodes.len() + level.len();
        let mut next = Vec::new();
        let mut rest = level.into_iter();
        loop {
            let some: Vec<_> = rest.by_ref().take(DRAFTS).collect();
            if some.is_empty() || nodes.len() > most {
                break;
            }
            for draft in map_parts(some, |cluster| draft(cluster, levels, in_halves)) {
                let mut node = draft.node;
                // There are fewer than 2³² spheres, and fewer nodes than spheres.
                node.0[4] = (first_of_next + next.len()) as u32;
                node.0[5] = ids.len() as u32;
                ids.extend_from_slice(&draft.ids[..draft.leaf_spheres]);
                next.extend(draft.inner);
                nodes.push(node);
            }
        }
        level = next;
        levels += 1;
    }
    nodes.shrink_to_fit();
    (nodes, ids, levels)
}

/// A node whose children have no indices yet.
struct Draft<'a, R> {
    node: WideNode,
    /// The ids of the spheres in its leaves.
    ids: [u32; LEAVES_ONLY],
    leaf_spheres: usize,
    /// The inner children in the order of their slots.
    inner: Vec<Cluster<'a, R>>,
}

fn wanted_slots(count: usize) -> usize {
    count.div_ceil(SPHERES_PER_CHILD).min(8)
}

fn draft<R: Reach>(cluster: Cluster<'_, R>, level: u32, in_halves: bool) -> Draft<'_, R> {
    let mut parts = Vec::with_capacity(8);
    if cluster.len() <= LEAVES_ONLY {
        cut_into_leaves(cluster, &mut parts);
    } else if level + levels_by_halves(cluster.len()) >= WIDE_LEVELS {
        cut(cluster, 8, true, &mut parts);
    } else {
        let slots = wanted_slots(cluster.len());
        cut(cluster, slots, in_halves, &mut parts);
    }

    let mut extents = [Extent::EMPTY; 8];
    for (extent, part) in extents.iter_mut().zip(&parts) {
        *extent = part.extent;
    }
    let slot_of = octant_slots(&extents[..parts.len()]);
    let mut in_slots = [const { None }; 8];
    for (part, slot) in parts.into_iter().zip(slot_of) {
        in_slots[slot] = Some(part);
    }
    let boxes = in_slots.each_ref().map(|part| part.as_ref().map(|p| p.extent));
    let mut draft =
        Draft { node: WideNode::with_boxes(&boxes), ids: [0; LEAVES_ONLY], leaf_spheres: 0, inner: Vec::new() };
    for (slot, part) in in_slots.into_iter().enumerate() {
        let Some(part) = part else { continue };
        if part.len() > WIDE_LEAF {
            draft.node.set_inner(slot);
            draft.inner.push(part);
            continue;
        }
        draft.node.set_leaf(slot, draft.leaf_spheres, part.len());
        let ids = &mut draft.ids[draft.leaf_spheres..draft.leaf_spheres + part.len()];
        for (id, item) in ids.iter_mut().zip(&*part.items) {
            *id = item.id;
        }
        ids.sort_unstable();
        draft.leaf_spheres += part.len();
    }
    draft
}

/// Splits a cluster into at most `slots` parts. Each side of a split gets slots in proportion to its spheres.
fn cut<'a, R: Reach>(cluster: Cluster<'a, R>, slots: usize, in_halves: bool, parts: &mut Vec<Cluster<'a, R>>) {
    let count = cluster.len();
    if slots == 1 || count <= WIDE_LEAF {
        parts.push(cluster);
        return;
    }
    let (first, second) = if in_halves { cluster.split_at(count.div_ceil(2)) } else { cluster.split_by_cost() };
    let share = (slots * first.len() + count / 2) / count;
    let share = if in_halves { slots / 2 } else { share.clamp(1, slots - 1) };
    if count < PARALLEL {
        cut(first, share, in_halves, parts);
        cut(second, slots - share, in_halves, parts);
        return;
    }
    let parts_of = |cluster, slots| {
        let mut parts = Vec::with_capacity(8);
        cut(cluster, slots, in_halves, &mut parts);
        parts
    };
    let (first, second) = both(true, || parts_of(first, share), || parts_of(second, slots - share));
    parts.extend(first);
    parts.extend(second);
}

/// Splits a cluster into leaves. All of them are full except one.
fn cut_into_leaves<'a, R: Reach>(cluster: Cluster<'a, R>, parts: &mut Vec<Cluster<'a, R>>) {
    if cluster.len() <= WIDE_LEAF {
        parts.push(cluster);
        return;
    }
    let leaves = cluster.len().div_ceil(WIDE_LEAF);
    let (first, second) = cluster.split_at(leaves / 2 * WIDE_LEAF);
    cut_into_leaves(first, parts);
    cut_into_leaves(second, parts);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Appends the sizes of the parts that `cut` makes if it splits in half.
    fn halves(count: usize, slots: usize, parts: &mut Vec<usize>) {
        if slots == 1 || count <= WIDE_LEAF {
            return parts.push(count);
        }
        halves(count.div_ceil(2), slots / 2, parts);
        halves(count / 2, slots - slots / 2, parts);
    }

    /// Checks every number of spheres up to 2^16. Above that, the eight children of a node differ in size by less than
    /// an eighth of the node, and the limit already holds for them.
    #[test]
    fn halves_make_few_nodes() {
        let mut nodes = vec![0; WIDE_LEAF + 1];
        for count in nodes.len()..1 << 16 {
            let mut parts = Vec::new();
            if count > LEAVES_ONLY {
                halves(count, wanted_slots(count), &mut parts);
            }
            nodes.push(1 + parts.iter().map(|part| nodes[*part]).sum::<usize>());
            assert!(nodes[count] <= max_nodes(count), "{count}: {} nodes", nodes[count]);
        }
    }

    /// A bunch of spheres, and others that are each farther away than all before. Splits by cost separate these one by
    /// one.
    #[test]
    fn spheres_that_are_cut_off_one_by_one_do_not_cost_more_than_planned() {
        let bunch = (0..24).map(|_| [0.0, 0.0, 0.0, 1.0]);
        let outliers = (0..9).map(|i| [100.0 * 17.0_f32.powi(i), 0.0, 0.0, 1.0]);
        let spheres: Vec<_> = bunch.chain(outliers).collect();
        let mut items = Item::all(&spheres, &Margins::one(0.0));
        let (nodes, _, _) = nodes_by_level(&mut items, false, usize::MAX);
        assert!(nodes.len() > max_nodes(spheres.len()));
        let (nodes, ids, _) = build(&mut items);
        assert!(nodes.len() <= max_nodes(spheres.len()));
        assert_eq!(ids.len(), spheres.len());
    }
}
