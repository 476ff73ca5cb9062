//! Validity checks for trees, whatever their node format, and statistics.

use std::array::from_fn;

use super::outliers::Margins;

/// Why a tree is not valid for kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TreeError {
    /// The box of a child does not contain the spheres below it, inflated by the margin.
    #[error("the box of slot {slot} of node {node} does not contain the spheres below it")]
    Box {
        /// Index of the node.
        node: u32,
        /// The slot of the child.
        slot: u32,
    },
    /// An inner child is not a later node with a single parent, or a leaf is not a valid range of spheres.
    #[error(
        "slot {slot} of node {node} does not point to a later node of its own, or to a range of spheres"
    )]
    Link {
        /// Index of the node.
        node: u32,
        /// The slot of the child.
        slot: u32,
    },
    /// The ids of a leaf are not in ascending order.
    #[error("the ids of the leaf in slot {slot} of node {node} are not in ascending order")]
    Order {
        /// Index of the node.
        node: u32,
        /// The slot of the child.
        slot: u32,
    },
    /// An index in leaf order is not in exactly one leaf, or its id is not that of exactly one sphere.
    #[error("the sphere at index {shape_index} of the structure is not in exactly one leaf")]
    Sphere {
        /// The index in leaf order.
        shape_index: u32,
    },
    /// A node is not the child of any node.
    #[error("node {node} is not the child of any node")]
    Unreached {
        /// Index of the node.
        node: u32,
    },
    /// The number of levels differs from the stated one, or exceeds the size of a kernel's stack.
    #[error("the tree has {found} levels, but states {stated}; at most {most} are allowed")]
    Levels {
        /// The number of levels counted.
        found: u32,
        /// The number of levels that the tree states.
        stated: u32,
        /// The largest number of levels for a kernel's stack.
        most: u32,
    },
}

/// The size of a tree, and the expected cost of tracing a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TreeStatistics {
    /// The number of nodes.
    pub nodes: usize,
    /// The number of leaves.
    pub leaves: usize,
    /// The number of nodes on the longest path from the root, both ends included.
    pub levels: u32,
    /// The number of bytes of nodes for each sphere.
    pub bytes_per_sphere: f64,
    /// The average number of spheres in a leaf.
    pub spheres_per_leaf: f64,
    /// The expected number of nodes that a random line through the root's box visits, by the surface area of boxes.
    pub expected_nodes: f64,
    /// The expected number of spheres against which such a line is tested.
    pub expected_spheres: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// An inner child: index of its node.
    Inner(u32),
    /// A leaf: index of its first sphere in leaf order, and number of spheres.
    Leaf(u32, u32),
}

/// A child of a node, decoded as kernels do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Child {
    pub(super) slot: u32,
    /// The corners of the box with the smallest and the largest coordinates.
    pub(super) bounds: [[f64; 3]; 2],
    pub(super) target: Target,
}

/// A tree, as kernels read it.
pub(super) trait Tree {
    const BYTES_PER_NODE: usize;
    /// The largest number of levels for the kernel's stack.
    const MAX_LEVELS: u32;
    const MAX_IN_LEAF: u32;

    fn node_count(&self) -> usize;
    fn ids(&self) -> &[u32];
    fn levels(&self) -> u32;
    fn children(&self, node: usize) -> impl Iterator<Item = Child>;
}

type Bounds = [[f64; 3]; 2];
const NOTHING: Bounds = [[f64::MAX; 3], [f64::MIN; 3]];

fn union(a: Bounds, b: Bounds) -> Bounds {
    [from_fn(|i| a[0][i].min(b[0][i])), from_fn(|i| a[1][i].max(b[1][i]))]
}

fn contains(outer: Bounds, inner: Bounds) -> bool {
    (0..3).all(|i| outer[0][i] <= inner[0][i] && inner[1][i] <= outer[1][i])
}

fn half_area([low, high]: Bounds) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|i| (high[i] - low[i]).max(0.0));
    x * y + y * z + z * x
}

/// Visits the nodes from the last to the first. A child comes after its parent, so everything below a node is known
/// when the node is visited, and no link can lead in a circle.
pub(super) fn validate<T: Tree>(
    tree: &T,
    spheres: &[[f32; 4]],
    margins: &Margins,
) -> Result<(), TreeError> {
    let ids = tree.ids();
    let mut seen = vec![false; spheres.len()];
    for (shape_index, id) in ids.iter().enumerate() {
        match seen.get_mut(*id as usize) {
            Some(seen) if !*seen => *seen = true,
            _ => return Err(TreeError::Sphere { shape_index: shape_index as u32 }),
        }
    }
    if ids.len() != spheres.len() {
        return Err(TreeError::Sphere { shape_index: ids.len() as u32 });
    }

    let count = tree.node_count();
    let mut below = vec![NOTHING; count];
    let mut levels = vec![1_u32; count];
    let mut reached = vec![false; count];
    let mut placed = vec![false; ids.len()];
    for node in (0..count).rev() {
        for child in tree.children(node) {
            let (node_id, slot) = (node as u32, child.slot);
            let link = TreeError::Link { node: node_id, slot };
            let content = match child.target {
                Target::Inner(inner) => {
                    let inner = inner as usize;
                    if inner <= node || inner >= count || reached[inner] {
                        return Err(link);
                    }
                    reached[inner] = true;
                    levels[node] = levels[node].max(levels[inner] + 1);
                    below[inner]
                }
                Target::Leaf(first, length) => {
                    let (first, length) = (first as usize, length as usize);
                    let end = first.saturating_add(length);
                    if length == 0 || length > T::MAX_IN_LEAF as usize || end > ids.len() {
                        return Err(link);
                    }
                    if !ids[first..end].is_sorted() {
                        return Err(TreeError::Order { node: node_id, slot });
                    }
                    let mut content = NOTHING;
                    for shape_index in first..end {
                        if placed[shape_index] {
                            return Err(TreeError::Sphere { shape_index: shape_index as u32 });
                        }
                        placed[shape_index] = true;
                        let sphere = spheres[ids[shape_index] as usize];
                        content = union(content, inflated(sphere, margins.of(&sphere)));
                    }
                    content
                }
            };
            if !contains(child.bounds, content) {
                return Err(TreeError::Box { node: node_id, slot });
            }
            below[node] = union(below[node], content);
        }
    }
    if let Some(node) = (1..count).find(|node| !reached[*node]) {
        return Err(TreeError::Unreached { node: node as u32 });
    }
    if let Some(shape_index) = placed.iter().position(|placed| !placed) {
        return Err(TreeError::Sphere { shape_index: shape_index as u32 });
    }
    let (found, stated) = (levels[0], tree.levels());
    if found != stated || found > T::MAX_LEVELS {
        return Err(TreeError::Levels { found, stated, most: T::MAX_LEVELS });
    }
    Ok(())
}

fn inflated([x, y, z, radius]: [f32; 4], margin: f32) -> Bounds {
    let reach = f64::from(radius) + f64::from(margin);
    [[x, y, z].map(|x| f64::from(x) - reach), [x, y, z].map(|x| f64::from(x) + reach)]
}

pub(super) fn statistics<T: Tree>(tree: &T) -> TreeStatistics {
    let root = tree.children(0).fold(NOTHING, |all, child| union(all, child.bounds));
    let whole = half_area(root);
    let (mut leaves, mut expected_nodes, mut expected_spheres) = (0, 1.0, 0.0);
    for child in (0..tree.node_count()).flat_map(|node| tree.children(node)) {
        let chance = half_area(child.bounds) / whole;
        match child.target {
            Target::Inner(_) => expected_nodes += chance,
            Target::Leaf(_, count) => {
                leaves += 1;
                expected_spheres += chance * f64::from(count);
            }
        }
    }
    let spheres = tree.ids().len().max(1) as f64;
    TreeStatistics {
        nodes: tree.node_count(),
        leaves,
        levels: tree.levels(),
        bytes_per_sphere: (tree.node_count() * T::BYTES_PER_NODE) as f64 / spheres,
        spheres_per_leaf: tree.ids().len() as f64 / leaves.max(1) as f64,
        expected_nodes,
        expected_spheres,
    }
}
