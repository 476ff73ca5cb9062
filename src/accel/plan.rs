//! Plans: which structure is built, why, and how large it may become. Plans are made before anything is allocated.

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

/// The structure that a user chooses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum AccelChoice {
    /// The structure that suits the scene.
    #[default]
    Auto,
    /// A grid with one or two levels of cells.
    Grid,
    /// A tree with eight children for each node.
    Tree,
    /// A tree with two children for each node: slower, but simple.
    BinaryTree,
    /// No structure: every sphere is tested. Slow; serves as the reference for the others.
    List,
}

/// The number of spheres up to which no structure is worth its cost.
const FEW: usize = 32;

/// The number of spheres, in a cube of about the smallest cell of a nested grid, above which a tree is better.
const MAX_IN_A_CUBE: f32 = 256.0;

/// The number of spheres that one dispatch tests without a structure: below the 65,535 iterations after which lavapipe
/// in Mesa 22.3 silently leaves a loop.
pub(crate) const LIST_LEN: usize = 3 << 14;

/// The largest binding on most devices; larger lists could not be indexed with 30 bits.
const MAX_BINDING_BYTES: u64 = i32::MAX as u64;

/// The number of rays for each sphere below which making balls takes longer than they save: on lavapipe, 50 ns for
/// each sphere and 13 ns for each ray of a million random spheres.
const MIN_RAYS_FOR_BALLS: u64 = 4;

/// An upper limit for the bytes of nodes per sphere: a node of 64 bytes has two leaves of three or four spheres.
const BINARY_BYTES_PER_SPHERE: usize = 32;

/// The planned size of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedBuffer {
    /// What the buffer holds.
    pub name: &'static str,
    /// The largest number of bytes, in all bricks together.
    pub bytes: u64,
    /// The largest number of bytes in one brick, which a single binding must hold.
    pub bytes_per_binding: u64,
}

impl PlannedBuffer {
    /// A buffer of `bytes` bytes in a single binding.
    #[must_use]
    pub const fn one(name: &'static str, bytes: u64) -> Self {
        Self { name, bytes, bytes_per_binding: bytes }
    }
}

/// The acceleration structure that will be built for a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct AccelPlan {
    /// The statistics on which the decision is based.
    pub statistics: SceneStatistics,
    /// The structure that will be built.
    pub structure: Structure,
    /// Why this structure was chosen.
    pub reason: String,
    /// The number of bricks.
    pub brick_count: usize,
    /// The limits for the grid of one brick.
    budget: GridBudget,
    /// The buffers for the whole scene on the device.
    pub buffers: Vec<PlannedBuffer>,
}

impl AccelPlan {
    /// Makes a plan for the spheres of a scene, in the scene's frame, and a device whose bindings hold up to `binding_bytes`. Assumes that
    /// many pictures will be rendered.
    #[must_use]
    pub fn new(spheres: &[[f32; 4]], choice: AccelChoice, binding_bytes: u64) -> Self {
        Self::for_rays(spheres, choice, binding_bytes, u64::MAX)
    }

    /// Makes a plan like [`AccelPlan::new`], for a known number of rays in all pictures together: if there are few, a
    /// structure that is slower to trace but faster to build may be better.
    #[must_use]
    pub fn for_rays(
        spheres: &[[f32; 4]],
        choice: AccelChoice,
        binding_bytes: u64,
        rays: u64,
    ) -> Self {
        let binding_bytes = binding_bytes.min(MAX_BINDING_BYTES);
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

    /// The number of bytes of all buffers.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        self.buffers.iter().map(|buffer| buffer.bytes).sum()
    }

    /// The largest number of bytes of host memory that building needs, in addition to the scene itself.
    #[must_use]
    pub fn host_bytes(&self) -> u64 {
        let per_brick = self.statistics.count.div_ceil(self.brick_count) as u64;
        let structure: u64 = self.device_bytes();
        let building = match self.structure {
            Structure::List => 0,
            // The spheres of a brick, their ids twice, and the builder's data for each of them; growing vectors leave
            // some memory unused.
            Structure::WideTree | Structure::BinaryTree => per_brick * 72,
            // Sorted spheres with their ids; lists of indices, twice, and of balls.
            Structure::Grid(layout) | Structure::NestedGrid(layout) => {
                let bytes = if layout == ListLayout::Balls { 12 } else { 8 };
                per_brick * 24 + bytes * self.budget.listed as u64
            }
        };
        structure + building
    }

    /// Builds the planned structure; `spheres` must be those of the plan.
    #[must_use]
    pub fn build(&self, spheres: &[[f32; 4]]) -> Accel {
        let (min, max) = self.statistics.inflated_bounds();
        let margin = self.statistics.margin();
        let per_brick = self.statistics.count.div_ceil(self.brick_count).max(1);
        let divided = match self.structure {
            // Without a structure, bricks are consecutive spheres in the order of ids.
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
        let cells = self.budget.cells as u64;
        let mut buffers = vec![("spheres", 16 * per_brick)];
        match self.structure {
            Structure::List => buffers.push(("ids", 4 * per_brick)),
            Structure::WideTree | Structure::BinaryTree => {
                buffers.push(("ids", 4 * per_brick));
                buffers.push(("nodes", node_bytes(self.structure, per_brick)));
            }
            Structure::Grid(ListLayout::Referenced)
            | Structure::NestedGrid(ListLayout::Referenced) => {
                buffers.push(("ids", 4 * per_brick));
                buffers.push(("cells", 4 * cells));
                buffers.push(("references", 4 * listed));
            }
            Structure::Grid(ListLayout::Balls) | Structure::NestedGrid(ListLayout::Balls) => {
                buffers.push(("ids, cells and references", 4 * (per_brick + cells + listed)));
                buffers.push(("balls", 4 * listed));
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
    /// The choice to use instead if rays take too many steps in this structure, for example among very many overlapping
    /// spheres; `None` for the list, which always terminates.
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
    let (layout, why) = if rays / MIN_RAYS_FOR_BALLS < count as u64 {
        (ListLayout::Referenced, "too few rays for balls in cells to pay")
    } else {
        (ListLayout::Balls, "enough rays for balls in cells to pay")
    };
    match choice {
        _ if count == 0 => (Structure::List, "there are no spheres".to_owned()),
        AccelChoice::List => (Structure::List, "asked for".to_owned()),
        AccelChoice::Tree => (Structure::WideTree, "asked for".to_owned()),
        AccelChoice::BinaryTree => (Structure::BinaryTree, "asked for".to_owned()),
        AccelChoice::Auto if count <= FEW => {
            (Structure::List, format!("for up to {FEW} spheres, no structure is worth its cost"))
        }
        AccelChoice::Auto if statistics.densest > MAX_IN_A_CUBE => (
            Structure::WideTree,
            format!(
                "about {:.0} spheres lie in a cube of 1/4096 of the scene's side, too close together for two levels of cells",
                statistics.densest
            ),
        ),
        AccelChoice::Auto => (Structure::Grid(layout), format!("{count} spheres, {why}")),
        AccelChoice::Grid => (Structure::Grid(layout), format!("asked for; {why}")),
    }
}

fn grid_budget(structure: Structure, count: usize, binding_bytes: u64) -> GridBudget {
    // In u64, because these products exceed the 32 bits of a browser's addresses.
    let count = count as u64;
    // Small scenes may have more cells and list elements for each sphere, because the total is small.
    let layout = match structure {
        Structure::Grid(layout) => layout,
        _ => return GridBudget { listed: 0, cells: 0 },
    };
    let cells = count * 11 / 20 + (64 * count).min(1 << 16);
    // Larger cells are cheaper than a second brick.
    let listed = match layout {
        ListLayout::Referenced => {
            let most = count * 18 / 5 + (64 * count).min(1 << 16);
            most.min((binding_bytes / 4).max(count * 10 / 3))
        }
        ListLayout::Balls => {
            let most = count * 13 / 2 + (128 * count).min(1 << 18);
            most.min((binding_bytes / 4).saturating_sub(count + cells).max(count * 4))
        }
    };
    let [listed, cells] = [listed, cells].map(|most| usize::try_from(most).unwrap_or(usize::MAX));
    GridBudget { listed, cells }
}

/// The largest number of bytes of a tree's nodes, including the root.
fn node_bytes(structure: Structure, count: u64) -> u64 {
    let (per_sphere, root) = match structure {
        Structure::WideTree => (WIDE_BYTES_PER_SPHERE, size_of::<WideNode>()),
        Structure::BinaryTree => (BINARY_BYTES_PER_SPHERE, size_of::<BinaryNode>()),
        _ => (0, 0),
    };
    per_sphere as u64 * count + root as u64
}

/// The largest number of spheres in a brick whose buffers all fit into a binding.
fn most_per_brick(structure: Structure, binding_bytes: u64) -> usize {
    let most = (binding_bytes / 16) as usize;
    let fits = |count: usize| {
        let budget = grid_budget(structure, count, binding_bytes);
        let (listed, cells) = (budget.listed as u64, budget.cells as u64);
        let words = match structure {
            Structure::Grid(ListLayout::Balls) => count as u64 + cells + listed,
            _ => cells.max(listed),
        };
        let grid = (4 * words).max(16 * count as u64);
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

/// The structure as built: it is nested if the grid of any brick is.
fn final_structure(planned: Structure, bricks: &[Brick]) -> Structure {
    let is_nested =
        bricks.iter().any(|brick| matches!(&brick.index, Index::Grid(grid) if grid.is_nested()));
    match planned {
        Structure::Grid(layout) if is_nested => Structure::NestedGrid(layout),
        planned => planned,
    }
}

/// Builds a tree for each part. `build` returns the order of the given spheres in the tree, and the tree.
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

/// Adds an empty brick if there are none, because kernels need at least one.
fn or_empty(mut bricks: Vec<Brick>) -> Vec<Brick> {
    if bricks.is_empty() {
        bricks.push(Brick { index: Index::List, spheres: Vec::new(), ids: Vec::new() });
    }
    bricks
}
