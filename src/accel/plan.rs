//! Plans: which structure is built, why, and how large it can become. Plans are made before anything is allocated.

use glam::Vec3;

use super::divide::largest_part;
use super::grid::{GridBudget, MAX_FIRST_LEVEL};
use super::statistics::{Crowd, SceneStatistics};
#[cfg(feature = "gpu")]
use super::structure::Primitive;
use super::structure::{AccelChoice, Structure};
use super::wide_tree::{WIDE_BYTES_PER_SPHERE, WideNode};

/// Up to this number of spheres, no structure is worth its cost.
const FEW: usize = 32;

/// Above this number of spheres in a cube of about the smallest cell of a nested grid, a tree is better.
const MAX_IN_A_CUBE: f32 = 256.0;

/// The number of spheres that one dispatch tests without a structure. It is below the 65,535 iterations after which
/// lavapipe in Mesa 22.3 silently leaves a loop.
pub(crate) const LIST_LEN: usize = 3 << 14;

/// The largest binding on most devices. Larger lists could not be indexed with 30 bits.
pub(super) const MAX_BINDING_BYTES: u64 = i32::MAX as u64;

/// The size of a box for ray queries, in bytes.
const BOX_BYTES: usize = size_of::<[f32; 6]>();

/// The planned size of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedBuffer {
    /// The content of the buffer.
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

/// The structure of a scene's cones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConesPlan {
    /// A grid, or a tree or a list if that was asked for.
    pub structure: Structure,
    /// The number of bricks, in addition to those of the spheres.
    pub brick_count: usize,
    pub(super) per_brick: usize,
    /// The limits for the grid of one brick.
    pub(super) budget: GridBudget,
}

/// The acceleration structure that will be built for a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct AccelPlan {
    /// The statistics on which the decision is based.
    pub statistics: SceneStatistics,
    /// The crowd, which is all spheres that are not outliers. `None` if there are no outliers.
    pub crowd: Option<Crowd>,
    /// The structure that will be built.
    pub structure: Structure,
    /// Why this structure was chosen.
    pub reason: String,
    /// The bricks of the scene's cones, if there are any.
    pub cones: Option<ConesPlan>,
    /// The choice that was asked for.
    pub choice: AccelChoice,
    /// The number of bricks.
    pub brick_count: usize,
    /// The limits for the grid of one brick.
    pub(super) budget: GridBudget,
    /// The margin of boxes for ray queries, as a multiple of [`SceneStatistics::margin`].
    pub(super) box_margin: f32,
    /// The buffers for the whole scene on the device.
    pub buffers: Vec<PlannedBuffer>,
}

impl AccelPlan {
    /// Makes a plan for the spheres of a scene, in the scene's frame, and a device whose bindings hold up to
    /// `binding_bytes`.
    #[must_use]
    pub fn new(spheres: &[[f32; 4]], choice: AccelChoice, binding_bytes: u64) -> Self {
        Self::decided(spheres, choice, binding_bytes, |statistics, crowd| decide(statistics, crowd, choice, "spheres"))
    }

    /// Makes a plan for the given structure, whatever it costs, for example to measure it. A grid may be built with two
    /// levels. A scene without spheres always has a list.
    #[must_use]
    pub fn of(spheres: &[[f32; 4]], structure: Structure, binding_bytes: u64) -> Self {
        let structure = match structure {
            _ if spheres.is_empty() => Structure::List,
            Structure::NestedGrid => Structure::Grid,
            structure => structure,
        };
        Self::decided(spheres, structure.choice(), binding_bytes, |_, _| (structure, "asked for".to_owned()))
    }

    fn decided(
        spheres: &[[f32; 4]],
        choice: AccelChoice,
        binding_bytes: u64,
        decide: impl FnOnce(&SceneStatistics, Option<&Crowd>) -> (Structure, String),
    ) -> Self {
        let binding_bytes = binding_bytes.min(MAX_BINDING_BYTES);
        let statistics = SceneStatistics::of(spheres);
        let crowd = Crowd::find(spheres, &statistics);
        let (structure, reason) = decide(&statistics, crowd.as_ref());
        let count = statistics.count;
        let most_per_brick = most_per_brick(structure, binding_bytes);
        let mut brick_count = count.div_ceil(most_per_brick).max(1);
        // If bricks differ in size, this takes one more brick at most.
        while most_in_brick(structure, count, brick_count) > most_per_brick {
            brick_count += 1;
        }
        let largest = most_in_brick(structure, count, brick_count);
        let budget = grid_budget(structure, largest, binding_bytes);
        let (buffers, box_margin) = (Vec::new(), 1.0);
        let cones = None;
        let mut plan =
            Self { statistics, crowd, structure, reason, cones, choice, brick_count, budget, box_margin, buffers };
        plan.buffers = plan.list_buffers();
        plan
    }

    /// The plan with another margin of the boxes for ray queries, as a multiple of [`SceneStatistics::margin`].
    /// Below 1, spheres may be missed. Use it to measure when a driver begins to miss some.
    #[must_use]
    pub fn with_box_margin(self, box_margin: f32) -> Self {
        Self { box_margin, ..self }
    }

    /// The plan for spheres that are a part of a scene with the given box, in the scene's frame. Rays start in
    /// that box, and the margin is that of the whole scene.
    #[must_use]
    pub fn within(mut self, (min, max): (Vec3, Vec3)) -> Self {
        // The margin of a crowd is for rays that start in the box of these spheres.
        (self.statistics.min, self.statistics.max, self.crowd) = (min, max, None);
        self
    }

    /// The number of bricks of all shapes.
    #[cfg(feature = "gpu")]
    pub(crate) fn count_bricks(&self) -> usize {
        let of = |primitive| match primitive {
            Primitive::Sphere => self.brick_count,
            Primitive::Cone => self.cones.map_or(0, |cones| cones.brick_count),
        };
        self.primitives().map(of).sum()
    }

    /// The primitives of the bricks.
    #[cfg(feature = "gpu")]
    pub(crate) fn primitives(&self) -> impl Iterator<Item = Primitive> {
        let has_spheres = self.statistics.count > 0 || self.cones.is_none();
        let of_spheres = has_spheres.then_some(Primitive::Sphere);
        of_spheres.into_iter().chain(self.cones.is_some().then_some(Primitive::Cone))
    }

    /// The number of bytes of all buffers.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        self.buffers.iter().map(|buffer| buffer.bytes).sum()
    }

    /// The largest number of bytes of host memory that [`AccelPlan::build`] needs, in addition to the scene itself.
    #[must_use]
    pub fn host_bytes(&self) -> u64 {
        self.dividing_bytes().max(self.device_bytes() + self.building_bytes())
    }

    /// The largest number of bytes of host memory that [`AccelPlan::bricks`] needs, in addition to the scene itself, if
    /// each brick is dropped before the next is built. `left` is the number of bytes that something else, for example a
    /// software device, keeps of each dropped brick. `copying` is the same for the brick built last.
    #[cfg(feature = "gpu")]
    #[must_use]
    pub(crate) fn host_bytes_by_brick(&self, left: u64, copying: u64) -> u64 {
        let bricks = self.brick_count as u64;
        let brick = self.device_bytes().div_ceil(bricks);
        let one = brick + self.building_bytes().max(copying);
        // The ids of bricks that have not been built.
        let ids = |left: u64| if bricks > 1 { 4 * self.per_brick() * left } else { 0 };
        // Each brick adds the same amount, so either the first or the last needs the most.
        let first = ids(bricks - 1) + one;
        let last = one + (bricks - 1) * left;
        self.dividing_bytes().max(first).max(last)
    }

    fn per_brick(&self) -> u64 {
        most_in_brick(self.structure, self.statistics.count, self.brick_count) as u64
    }

    /// The number of bytes needed to divide the spheres: their ids, and during a cut two more copies of the ids, one of
    /// them in growing vectors.
    fn dividing_bytes(&self) -> u64 {
        let ids = 4 * self.statistics.count as u64;
        match self.structure {
            Structure::List => ids,
            _ if self.brick_count == 1 => ids,
            _ => 3 * ids,
        }
    }

    /// The number of bytes that building a brick takes, in addition to the brick.
    fn building_bytes(&self) -> u64 {
        let per_brick = self.per_brick();
        let of_spheres = match self.structure {
            Structure::List | Structure::Tiles => 0,
            Structure::RayQuery => per_brick * 44,
            // The spheres of a brick, their ids twice, and the builder's data for each sphere. Growing vectors leave
            // some memory unused.
            Structure::WideTree => per_brick * 72,
            // Sorted spheres with their ids, lists of indices twice, and lists of balls.
            Structure::Grid | Structure::NestedGrid => per_brick * 24 + 12 * self.budget.listed as u64,
        };
        let of_cones = self.cones.map_or(0, |cones| match cones.structure {
            // Sorted cones with their order, the cells that they overlap in growing vectors, lists and capsules.
            Structure::Grid => {
                let GridBudget { listed, cells } = cones.budget;
                64 * cones.per_brick as u64 + 24 * listed as u64 + 8 * cells as u64
            }
            _ => 72 * cones.per_brick as u64,
        });
        of_spheres.max(of_cones)
    }

    fn list_buffers(&self) -> Vec<PlannedBuffer> {
        let bricks = self.brick_count as u64;
        let per_brick = self.per_brick();
        let listed = self.budget.listed as u64;
        let cells = self.budget.cells as u64;
        let mut buffers = vec![("spheres", 16 * per_brick)];
        match self.structure {
            Structure::List | Structure::Tiles => buffers.push(("ids", 4 * per_brick)),
            Structure::WideTree => {
                buffers.push(("ids", 4 * per_brick));
                buffers.push(("nodes", node_bytes(self.structure, per_brick)));
            }
            // Only the driver knows the size of what it builds from the boxes.
            Structure::RayQuery => {
                buffers.push(("ids", 4 * per_brick));
                buffers.push(("boxes", BOX_BYTES as u64 * per_brick));
            }
            Structure::Grid | Structure::NestedGrid => {
                buffers.push(("ids, cells and references", 4 * (per_brick + cells + listed)));
                buffers.push(("balls", 4 * listed));
            }
        }
        buffers
            .into_iter()
            .map(|(name, bytes)| PlannedBuffer { name, bytes: bytes * bricks, bytes_per_binding: bytes })
            .collect()
    }
}

/// Decides which structure to build for shapes with this name, and says why.
pub(super) fn decide(
    statistics: &SceneStatistics,
    crowd: Option<&Crowd>,
    choice: AccelChoice,
    shapes: &str,
) -> (Structure, String) {
    let SceneStatistics { count, densest, .. } = *statistics;
    let asked = |structure| (structure, "asked for".to_owned());
    match choice {
        _ if count == 0 => (Structure::List, format!("there are no {shapes}")),
        AccelChoice::List => asked(Structure::List),
        AccelChoice::Grid => asked(Structure::Grid),
        AccelChoice::Tree => asked(Structure::WideTree),
        AccelChoice::RayQuery => asked(Structure::RayQuery),
        AccelChoice::Auto | AccelChoice::Tiles if count <= FEW => {
            (Structure::List, format!("for up to {FEW} {shapes}, no structure is worth its cost"))
        }
        AccelChoice::Auto | AccelChoice::Tiles => match crowd.filter(|crowd| crowd.is_lost_in_margin(statistics)) {
            Some(Crowd { outliers, .. }) => (
                Structure::WideTree,
                format!(
                    "{outliers} of {count} {shapes} lie far away from the others, which have a margin of their own in a \
                     tree"
                ),
            ),
            None if densest > MAX_IN_A_CUBE => (
                Structure::WideTree,
                format!(
                    "about {densest:.0} {shapes} lie in a cube of 1/4096 of the scene's side, too close together for two \
                     levels of cells"
                ),
            ),
            None => (Structure::Grid, format!("{count} {shapes}")),
        },
    }
}

fn grid_budget(structure: Structure, count: usize, binding_bytes: u64) -> GridBudget {
    // Uses u64, because these products exceed the 32 bits of a browser's addresses.
    let count = count as u64;
    // Small scenes may have more cells and list elements per sphere, because the total is small.
    if structure != Structure::Grid {
        return GridBudget { listed: 0, cells: 0 };
    }
    let cells = count * 11 / 20 + (64 * count).min(1 << 16);
    // Larger cells are cheaper than a second brick.
    let most = count * 13 / 2 + (128 * count).min(1 << 18);
    let listed = most.min((binding_bytes / 4).saturating_sub(count + cells).max(count * 4));
    let [listed, cells] = [listed, cells].map(|most| usize::try_from(most).unwrap_or(usize::MAX));
    GridBudget { listed, cells }
}

/// The largest number of bytes of a tree's nodes, including the root.
pub(super) fn node_bytes(structure: Structure, count: u64) -> u64 {
    let (per_sphere, root) = match structure {
        Structure::WideTree => (WIDE_BYTES_PER_SPHERE, size_of::<WideNode>()),
        Structure::RayQuery => (BOX_BYTES, 0),
        _ => (0, 0),
    };
    per_sphere as u64 * count + root as u64
}

/// The largest number of spheres in one of `bricks` bricks.
fn most_in_brick(structure: Structure, count: usize, bricks: usize) -> usize {
    match structure {
        Structure::List => count.div_ceil(bricks),
        _ => largest_part(count, bricks),
    }
}

/// The largest number of spheres in a brick whose buffers all fit into a binding.
fn most_per_brick(structure: Structure, binding_bytes: u64) -> usize {
    let most = (binding_bytes / 16) as usize;
    let fits = |count: usize| {
        let budget = grid_budget(structure, count, binding_bytes);
        let (listed, cells) = (budget.listed as u64, budget.cells as u64);
        let words = match structure {
            Structure::Grid => count as u64 + cells + listed,
            _ => 0,
        };
        let grid = (4 * words).max(16 * count as u64);
        let bytes = grid.max(node_bytes(structure, count as u64));
        // A grid with too few cells for its spheres has longer lists, which cost more than another brick.
        bytes <= binding_bytes && budget.cells <= MAX_FIRST_LEVEL
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Bricks are only as large as suits the number of cells of a grid, whatever a binding holds.
    #[test]
    fn the_largest_grids_have_as_many_cells_as_suit_them() {
        for mebibytes in [128, 1024, 2048] {
            let most = most_per_brick(Structure::Grid, mebibytes << 20);
            let budget = grid_budget(Structure::Grid, most, mebibytes << 20);
            assert!(budget.cells <= MAX_FIRST_LEVEL, "{most} spheres, {budget:?}");
        }
    }

    /// Building one brick at a time needs less memory than building all, and no more for a single brick.
    #[cfg(feature = "gpu")]
    #[test]
    fn one_brick_at_a_time_needs_less_memory() {
        let spheres: Vec<[f32; 4]> = (0..3000).map(|i| [i as f32, 0.0, 0.0, 0.5]).collect();
        let plan = |bytes| AccelPlan::new(&spheres, AccelChoice::Tree, bytes);
        let (one, several) = (plan(1 << 27), plan(16 * 300));
        assert_eq!(one.host_bytes_by_brick(0, 0), one.host_bytes());
        assert!(several.brick_count >= 10);
        assert!(several.host_bytes_by_brick(0, 0) < several.host_bytes() / 2);
        // A software device keeps the copied data.
        let brick = several.device_bytes() / several.brick_count as u64;
        assert!(several.host_bytes_by_brick(brick, 0) > several.device_bytes());
    }
}
