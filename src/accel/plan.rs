//! What will be built, why, and how large it may become: decided before anything is allocated.

use std::fmt;

use super::binary_tree::{BinaryNode, BinaryTree};
use super::brick::{Accel, Brick, Index, Structure};
use super::divide::{Divided, divide};
use super::grid::ListLayout;
use super::grid_build::{BuiltGrid, GridBudget, build_grid};
use super::statistics::SceneStatistics;
use super::wide_node::WideNode;
use super::wide_tree::WideTree;
use super::wide_tree_build::WIDE_BYTES_PER_SPHERE;

/// What a user asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum AccelChoice {
    /// What suits the data.
    #[default]
    Auto,
    /// Two levels of cells.
    Grid,
    /// A tree with eight children a node.
    Tree,
    /// A tree with two children a node: slower, and simpler.
    BinaryTree,
    /// Every sphere is tried: slow, and what the others are compared with.
    List,
}

/// Up to so many spheres no structure pays.
const FEW: usize = 32;

/// With more spheres in about the smallest cell that a nested grid may have, a tree is better.
const MOST_IN_A_CUBE: f32 = 256.0;

/// How many spheres one dispatch tries without a structure: below the 65,535 iterations after which Mesa
/// 22.3's lavapipe leaves a loop silently.
pub(crate) const LIST_LEN: usize = 3 << 14;

/// What a binding may have on most devices; lists of more would not be numbered by 30 bits.
const MOST_BINDING_BYTES: u64 = i32::MAX as u64;

/// Up to so many spheres, lists are runs of copies: faster by a quarter on lavapipe, for about twice the
/// memory.
const MOST_COPIED: usize = 2_000_000;

/// With fewer rays for each sphere, making copies takes longer than they save: on lavapipe, 80 ns a sphere
/// and 13 ns a ray of a million random spheres.
const LEAST_RAYS_PER_COPIED: u64 = 6;

/// At most so many bytes of nodes a sphere: a node of 64 bytes has leaves of three or four, two of them.
const BINARY_BYTES_PER_SPHERE: usize = 32;

/// Of one buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedBuffer {
    /// What it holds.
    pub name: &'static str,
    /// At most so many bytes, in all bricks together.
    pub bytes: u64,
    /// At most so many bytes in one brick, which is what one binding must hold.
    pub bytes_per_binding: u64,
}

impl PlannedBuffer {
    /// A single buffer of so many bytes.
    #[must_use]
    pub const fn one(name: &'static str, bytes: u64) -> Self {
        Self { name, bytes, bytes_per_binding: bytes }
    }
}

/// What will be built of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct AccelPlan {
    /// What it was decided from.
    pub statistics: SceneStatistics,
    /// The structure.
    pub structure: Structure,
    /// Why this one.
    pub reason: String,
    /// In how many bricks.
    pub brick_count: usize,
    /// How large the grid of one brick may become.
    budget: GridBudget,
    /// Of the whole scene, on the device.
    pub buffers: Vec<PlannedBuffer>,
}

impl AccelPlan {
    /// Decides for a scene's spheres and a device whose bindings hold so many bytes. Many pictures will be
    /// made.
    #[must_use]
    pub fn new(spheres: &[[f32; 4]], choice: AccelChoice, binding_bytes: u64) -> Self {
        Self::for_rays(spheres, choice, binding_bytes, u64::MAX)
    }

    /// As [`AccelPlan::new`], where only so many rays will be traced: a structure that is slower, but built
    /// sooner, may be better then.
    #[must_use]
    pub fn for_rays(
        spheres: &[[f32; 4]],
        choice: AccelChoice,
        binding_bytes: u64,
        rays: u64,
    ) -> Self {
        let binding_bytes = binding_bytes.min(MOST_BINDING_BYTES);
        let statistics = SceneStatistics::of(spheres);
        let (structure, reason) = decide(&statistics, choice, rays);
        let count = statistics.count;
        let most_per_brick = most_per_brick(structure, binding_bytes);
        let brick_count = count.div_ceil(most_per_brick).max(1);
        let budget = grid_budget(structure, count.div_ceil(brick_count), binding_bytes);
        let mut plan =
            Self { statistics, structure, reason, brick_count, budget, buffers: Vec::new() };
        plan.buffers = plan.list_buffers();
        plan
    }

    /// Bytes of all buffers.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        self.buffers.iter().map(|buffer| buffer.bytes).sum()
    }

    /// Bytes of host memory that building takes at most, beside the scene itself.
    #[must_use]
    pub fn host_bytes(&self) -> u64 {
        let per_brick = self.statistics.count.div_ceil(self.brick_count) as u64;
        let structure: u64 = self.device_bytes();
        let building = match self.structure {
            Structure::List => 0,
            // The brick's spheres, their ids twice, and what a builder makes of each of them; vectors that
            // grow leave some unused.
            Structure::WideTree | Structure::BinaryTree => per_brick * 72,
            // Sorted spheres with their ids; lists as places, twice.
            Structure::Grid(_) | Structure::NestedGrid(_) => {
                per_brick * 24 + 8 * self.budget.listed as u64
            }
        };
        structure + building
    }

    /// Builds it, of the spheres that were planned for.
    #[must_use]
    pub fn build(&self, spheres: &[[f32; 4]]) -> Accel {
        let (min, max) = self.statistics.inflated_bounds();
        let margin = self.statistics.margin();
        let per_brick = self.statistics.count.div_ceil(self.brick_count).max(1);
        let divided = match self.structure {
            // Slices in the order of ids, whatever is in them.
            Structure::List => Divided { parts: Vec::new(), may_part_equals: self.brick_count > 1 },
            _ => divide(spheres, self.brick_count),
        };
        let parts = divided.parts.into_iter().filter(|ids| !ids.is_empty());
        let bricks: Vec<Brick> = match self.structure {
            Structure::List => spheres
                .chunks(per_brick)
                .zip((0_u32..).step_by(per_brick))
                .map(|(spheres, first)| Brick {
                    index: Index::List,
                    spheres: spheres.to_vec(),
                    ids: (first..first + spheres.len() as u32).collect(),
                })
                .collect(),
            Structure::Grid(layout) | Structure::NestedGrid(layout) => {
                let build = |ids: Vec<u32>| {
                    let BuiltGrid { grid, spheres, ids } =
                        build_grid(spheres, &ids, margin, layout, self.budget);
                    Brick { index: Index::Grid(grid), spheres, ids }
                };
                parts.map(build).collect()
            }
            Structure::WideTree => build_trees(spheres, parts, |spheres| {
                let tree = WideTree::build(spheres, margin);
                (tree.ids().to_vec(), Index::WideTree(tree))
            }),
            Structure::BinaryTree => build_trees(spheres, parts, |spheres| {
                let tree = BinaryTree::build(spheres, margin);
                (tree.ids().to_vec(), Index::BinaryTree(tree))
            }),
        };
        let structure = final_structure(self.structure, &bricks);
        let bricks = or_empty(bricks);
        Accel { structure, bricks, min, max, may_part_equals: divided.may_part_equals }
    }

    fn list_buffers(&self) -> Vec<PlannedBuffer> {
        let bricks = self.brick_count as u64;
        let per_brick = self.statistics.count.div_ceil(self.brick_count) as u64;
        let listed = self.budget.listed as u64;
        let shape_indices = match self.structure {
            Structure::Grid(ListLayout::Copied) => listed,
            _ => per_brick,
        };
        let mut buffers = vec![("spheres", 16 * shape_indices), ("ids", 4 * shape_indices)];
        match self.structure {
            Structure::WideTree | Structure::BinaryTree => {
                buffers.push(("nodes", node_bytes(self.structure, per_brick)));
            }
            _ => {}
        }
        if let Structure::Grid(layout) = self.structure {
            buffers.push(("cells", 4 * self.budget.cells as u64));
            if layout == ListLayout::Referenced {
                buffers.push(("references", 4 * listed));
            }
        }
        buffers
            .into_iter()
            .map(|(name, bytes)| PlannedBuffer {
                name,
                bytes: bytes * bricks,
                bytes_per_binding: bytes,
            })
            .collect()
    }
}

impl Structure {
    /// What to choose where rays take too many steps in this one, as among very many spheres in one place; a
    /// list always ends.
    #[must_use]
    pub const fn instead(self) -> Option<AccelChoice> {
        match self {
            Self::List => None,
            Self::Grid(_) | Self::NestedGrid(_) => Some(AccelChoice::Tree),
            Self::WideTree | Self::BinaryTree => Some(AccelChoice::List),
        }
    }
}

impl fmt::Display for AccelChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Grid => "grid",
            Self::Tree => "tree",
            Self::BinaryTree => "binary-tree",
            Self::List => "list",
        })
    }
}

fn decide(statistics: &SceneStatistics, choice: AccelChoice, rays: u64) -> (Structure, String) {
    let count = statistics.count;
    let (layout, why) = if count > MOST_COPIED {
        (ListLayout::Referenced, "too many to copy into cells")
    } else if rays / LEAST_RAYS_PER_COPIED < count as u64 {
        (ListLayout::Referenced, "too few rays for copies of them in cells to pay")
    } else {
        (ListLayout::Copied, "few enough to copy into cells")
    };
    match choice {
        _ if count == 0 => (Structure::List, "there are no spheres".to_owned()),
        AccelChoice::List => (Structure::List, "asked for".to_owned()),
        AccelChoice::Tree => (Structure::WideTree, "asked for".to_owned()),
        AccelChoice::BinaryTree => (Structure::BinaryTree, "asked for".to_owned()),
        AccelChoice::Auto if count <= FEW => {
            (Structure::List, format!("up to {FEW} spheres, no structure pays"))
        }
        AccelChoice::Auto if statistics.densest > MOST_IN_A_CUBE => (
            Structure::WideTree,
            format!(
                "about {:.0} spheres lie in 1/4096 of the scene's side, which two levels of cells cannot tell apart",
                statistics.densest
            ),
        ),
        AccelChoice::Auto => (Structure::Grid(layout), format!("{count} spheres, {why}")),
        AccelChoice::Grid => (Structure::Grid(layout), format!("asked for; {why}")),
    }
}

fn grid_budget(structure: Structure, count: usize, binding_bytes: u64) -> GridBudget {
    // A small scene may have more a sphere: it is little in all.
    let (listed, cells, bytes) = match structure {
        Structure::Grid(ListLayout::Copied) => {
            (count * 17 / 4 + (64 * count).min(1 << 20), count + (256 * count).min(1 << 21), 16)
        }
        Structure::Grid(ListLayout::Referenced) => (
            count * 18 / 5 + (64 * count).min(1 << 16),
            count * 11 / 20 + (64 * count).min(1 << 16),
            4,
        ),
        _ => return GridBudget { listed: 0, cells: 0 },
    };
    // Larger cells cost less than a second brick.
    let one_binding = (binding_bytes / bytes) as usize;
    GridBudget { listed: listed.min(one_binding.max(count * 10 / 3)), cells }
}

/// At most so many bytes of a tree's nodes, the root among them.
fn node_bytes(structure: Structure, count: u64) -> u64 {
    let (per_sphere, root) = match structure {
        Structure::WideTree => (WIDE_BYTES_PER_SPHERE, size_of::<WideNode>()),
        Structure::BinaryTree => (BINARY_BYTES_PER_SPHERE, size_of::<BinaryNode>()),
        _ => (0, 0),
    };
    per_sphere as u64 * count + root as u64
}

/// How many spheres a brick may have, so that each of its buffers fits into a binding.
fn most_per_brick(structure: Structure, binding_bytes: u64) -> usize {
    let most = (binding_bytes / 16) as usize;
    let fits = |count: usize| {
        let budget = grid_budget(structure, count, binding_bytes);
        let listed = match structure {
            Structure::Grid(ListLayout::Copied) => 16 * budget.listed,
            _ => 4 * budget.listed,
        };
        let grid = listed.max(4 * budget.cells).max(16 * count) as u64;
        grid.max(node_bytes(structure, count as u64)) <= binding_bytes
    };
    if structure == Structure::List {
        return LIST_LEN.min(most).max(1);
    }
    // The largest count that fits, by bisection.
    let (mut low, mut high) = (1, most.max(1));
    while low < high {
        let middle = low + (high - low).div_ceil(2);
        if fits(middle) { low = middle } else { high = middle - 1 }
    }
    low
}

/// A grid is nested if one of its bricks is.
fn final_structure(planned: Structure, bricks: &[Brick]) -> Structure {
    let is_nested =
        bricks.iter().any(|brick| matches!(&brick.index, Index::Grid(grid) if grid.is_nested()));
    match planned {
        Structure::Grid(layout) if is_nested => Structure::NestedGrid(layout),
        planned => planned,
    }
}

/// A tree for each part; `build` gives that of some spheres, and their order in it.
fn build_trees(
    spheres: &[[f32; 4]],
    parts: impl Iterator<Item = Vec<u32>>,
    build: impl Fn(&[[f32; 4]]) -> (Vec<u32>, Index),
) -> Vec<Brick> {
    let brick = |ids: Vec<u32>| {
        let own: Vec<[f32; 4]> = ids.iter().map(|id| spheres[*id as usize]).collect();
        let (order, index) = build(&own);
        Brick {
            index,
            spheres: order.iter().map(|shape_index| own[*shape_index as usize]).collect(),
            ids: order.iter().map(|shape_index| ids[*shape_index as usize]).collect(),
        }
    };
    parts.map(brick).collect()
}

/// An empty scene has an empty brick.
fn or_empty(mut bricks: Vec<Brick>) -> Vec<Brick> {
    if bricks.is_empty() {
        bricks.push(Brick { index: Index::List, spheres: Vec::new(), ids: Vec::new() });
    }
    bricks
}
