//! Bricks: a brick is a part of a scene that fits into a device's bindings, with its own acceleration structure. Bricks
//! are built one after the other, so that not all of them have to be in memory.
use std::collections::VecDeque;
use std::ops::Range;

use glam::Vec3;

use super::cone_grid::build_cone_grid;
use super::divide::{Division, divide};
use super::grid::Grid;
use super::grid_build::{BuiltGrid, build_grid};
use super::plan::{AccelPlan, ConesPlan};
use super::split::Item;
use super::statistics::Margins;
#[cfg(feature = "gpu")]
use super::structure::BrickKind;
use super::structure::{Primitive, Structure};
#[cfg(feature = "gpu")]
use super::tiles::TileLists;
use super::wide_tree::WideTree;
use crate::geometry::cone::ConeInFrame;
#[cfg(feature = "gpu")]
use crate::parallel::map_chunks;
use crate::parallel::ranges;

/// The acceleration structure of a brick.
#[derive(Clone, Debug, Default)]
pub enum Index {
    /// No structure: every sphere is tested.
    #[default]
    List,
    /// One or two levels of grid cells.
    Grid(Grid),
    /// A tree with eight children for each node.
    WideTree(WideTree),
    /// One box for each sphere, as its smallest and largest coordinates. A driver builds its own structure from the
    /// boxes for ray queries. The kernels are in `shaders/accel/ray_query.wgsl`. The host searches without a structure.
    ///
    /// Vulkan guarantees only that a box is reported if the ray meets it, not how that test is rounded. So each box
    /// holds its sphere inflated by the margin of trees, which exceeds the error of any arithmetic that rounds as WGSL
    /// allows (`slab.rs`). Only a certificate can show whether a driver's own arithmetic is as good.
    RayQuery(Vec<[f32; 6]>),
    /// Lists of the spheres of each tile of one picture.
    #[cfg(feature = "gpu")]
    Tiles(TileLists),
}

/// A part of a scene with its acceleration structure. The default is empty.
#[derive(Clone, Debug, Default)]
pub struct Brick {
    /// The kind of the shapes.
    pub primitive: Primitive,
    /// The acceleration structure of the spheres.
    pub index: Index,
    /// Centre (x, y, z) in the scene's frame, and radius. The order is that of the structure.
    pub spheres: Vec<[f32; 4]>,
    /// Cones in the scene's frame, in the place of spheres, in the order of the structure.
    pub cones: Vec<ConeInFrame>,
    /// Id of each shape.
    pub ids: Vec<u32>,
}

impl Brick {
    /// The kind by which the brick is searched.
    #[cfg(feature = "gpu")]
    pub(crate) fn kind(&self) -> BrickKind {
        let structure = match &self.index {
            Index::List => Structure::List,
            Index::Grid(grid) => Structure::Grid.with_nested(grid.is_nested()),
            Index::WideTree(_) => Structure::WideTree,
            Index::RayQuery(_) => Structure::RayQuery,
            Index::Tiles(_) => Structure::Tiles,
        };
        BrickKind { structure, primitive: self.primitive }
    }

    /// True if the spheres are in a grid in which some cells have grids of their own.
    pub(crate) fn is_nested(&self) -> bool {
        let is_of_spheres = self.primitive == Primitive::Sphere;
        matches!(&self.index, Index::Grid(grid) if is_of_spheres && grid.is_nested())
    }
}

/// All bricks of a scene, which have the same structure.
#[derive(Clone, Debug)]
pub struct Accel {
    pub(super) structure: Structure,
    pub(super) bricks: Vec<Brick>,
    pub(super) min: Vec3,
    pub(super) max: Vec3,
    pub(super) may_split_duplicates: bool,
}

impl Accel {
    /// The structure of the bricks.
    #[must_use]
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// The bricks. There is at least one, which may be empty.
    #[must_use]
    pub fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    /// The bounding box of all spheres in the scene's frame, inflated by the margin. Rays are moved to this box before
    /// they are traced.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        (self.min, self.max)
    }

    /// Returns true if equal shapes may be in different bricks.
    #[must_use]
    pub fn may_split_duplicates(&self) -> bool {
        self.may_split_duplicates
    }
}

/// Makes the boxes for ray queries of spheres (centre x, y, z in the scene's frame, radius), inflated by `margin`.
fn query_boxes(spheres: &[[f32; 4]], margin: f32) -> Vec<[f32; 6]> {
    let of_item = |item: &Item<f32>| {
        let ([x, y, z], reach) = (item.center, item.reach);
        [x - reach, y - reach, z - reach, x + reach, y + reach, z + reach]
    };
    Item::all(spheres, &Margins::one(margin)).iter().map(of_item).collect()
}

/// The bricks of a planned structure. The iterator builds each brick when it is asked for. Until then it keeps only the
/// ids of the spheres, in 4 bytes each.
#[derive(Debug)]
pub struct Bricks<'a> {
    plan: &'a AccelPlan,
    spheres: &'a [[f32; 4]],
    /// For each brick that has not been built, its spheres' indices in input order, ascending.
    parts: VecDeque<Vec<u32>>,
    cones: &'a [ConeInFrame],
    /// The cones of each brick that has not been built. These bricks come after those of the spheres.
    parts_of_cones: VecDeque<Range<usize>>,
    may_split_duplicates: bool,
}

impl AccelPlan {
    /// Divides the spheres, which must be those of the plan, into the planned bricks. There is at least one brick,
    /// which may be empty.
    #[must_use]
    pub fn bricks<'a>(&'a self, spheres: &'a [[f32; 4]]) -> Bricks<'a> {
        let count = spheres.len();
        let per_brick = count.div_ceil(self.brick_count).max(1);
        let Division { parts, may_split_duplicates } = match self.structure {
            // Without a structure, each brick holds consecutive spheres in the order of ids.
            Structure::List => Division {
                // The number of spheres fits into u32.
                parts: ranges(count, per_brick)
                    .into_iter()
                    .map(|range| (range.start as u32..range.end as u32).collect())
                    .collect(),
                may_split_duplicates: self.brick_count > 1,
            },
            _ => divide(spheres, self.brick_count),
        };
        let mut parts: VecDeque<_> = parts.into_iter().filter(|ids| !ids.is_empty()).collect();
        // Kernels need at least one brick.
        if parts.is_empty() {
            parts.push_back(Vec::new());
        }
        Bricks { plan: self, spheres, parts, cones: &[], parts_of_cones: VecDeque::new(), may_split_duplicates }
    }

    /// Builds the planned structure. `spheres` must be those of the plan. [`AccelPlan::bricks`] needs less memory.
    #[must_use]
    pub fn build(&self, spheres: &[[f32; 4]]) -> Accel {
        self.bricks(spheres).build()
    }
}

impl<'a> Bricks<'a> {
    /// Adds bricks for the cones of the plan. Without spheres, there are no other bricks.
    #[must_use]
    pub fn with_cones(mut self, cones: &'a [ConeInFrame]) -> Self {
        if let Some(plan) = &self.plan.cones {
            if self.spheres.is_empty() {
                self.parts.clear();
            }
            self.parts_of_cones = ranges(cones.len(), plan.per_brick).into();
            self.may_split_duplicates |= self.parts_of_cones.len() > 1;
            self.cones = cones;
        }
        self
    }

    /// Builds all bricks.
    #[must_use]
    pub fn build(self) -> Accel {
        let structure = self.plan.structure;
        let ((min, max), may_split_duplicates) = (self.bounds(), self.may_split_duplicates());
        let bricks: Vec<Brick> = self.collect();
        let structure = structure.with_nested(bricks.iter().any(Brick::is_nested));
        Accel { structure, bricks, min, max, may_split_duplicates }
    }
}

impl Bricks<'_> {
    /// Returns the bounding box of all spheres of the plan in the scene's frame, inflated as in [`Accel::bounds`].
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.plan.statistics.inflated_bounds()
    }

    /// The planned structure. If it is a grid, some cells of some bricks may have grids of their own.
    #[must_use]
    pub fn structure(&self) -> Structure {
        self.plan.structure
    }

    /// Returns true if equal shapes may be in different bricks.
    #[must_use]
    pub fn may_split_duplicates(&self) -> bool {
        self.may_split_duplicates
    }

    fn build_part(&self, ids: Vec<u32>) -> Brick {
        let Self { plan, spheres, .. } = *self;
        let margin = plan.statistics.margin();
        let own = || -> Vec<[f32; 4]> { ids.iter().map(|id| spheres[*id as usize]).collect() };
        match plan.structure {
            Structure::List | Structure::Tiles => Brick { index: Index::List, spheres: own(), ids, ..Brick::default() },
            Structure::Grid | Structure::NestedGrid => {
                let BuiltGrid { grid, spheres, ids } = build_grid(spheres, &ids, margin, plan.budget);
                Brick { index: Index::Grid(grid), spheres, ids, ..Brick::default() }
            }
            Structure::WideTree => {
                let own = own();
                let margins = Margins { all: margin, crowd: plan.crowd };
                let tree = WideTree::build_with(&own, margins);
                Brick {
                    spheres: tree.ids.iter().map(|index| own[*index as usize]).collect(),
                    ids: tree.ids.iter().map(|index| ids[*index as usize]).collect(),
                    index: Index::WideTree(tree),
                    ..Brick::default()
                }
            }
            Structure::RayQuery => {
                let own = own();
                let boxes = query_boxes(&own, plan.box_margin * margin);
                Brick { index: Index::RayQuery(boxes), spheres: own, ids, ..Brick::default() }
            }
        }
    }

    /// Builds a brick of some cones.
    fn build_cones(&self, part: Range<usize>) -> Brick {
        let own = &self.cones[part.clone()];
        let first = (self.spheres.len() + part.start) as u32;
        let margin = self.plan.statistics.margin();
        let (index, order) = match &self.plan.cones {
            Some(ConesPlan { structure: Structure::WideTree, .. }) => {
                let tree = WideTree::of_cones(own, margin);
                let order = tree.ids.clone();
                (Index::WideTree(tree), order)
            }
            Some(ConesPlan { structure: Structure::Grid, budget, .. }) => {
                let (grid, order) = build_cone_grid(own, margin, *budget);
                (Index::Grid(grid), order)
            }
            _ => (Index::List, (0..own.len() as u32).collect()),
        };
        let cones = order.iter().map(|index| own[*index as usize]).collect();
        let ids = order.iter().map(|index| first + index).collect();
        Brick { index, primitive: Primitive::Cone, cones, ids, ..Brick::default() }
    }
}

#[cfg(feature = "gpu")]
impl Bricks<'_> {
    /// The bounds of the bricks that have not been built, in order.
    pub(crate) fn boxes(&self) -> Vec<BrickBounds> {
        self.parts.iter().map(|ids| BrickBounds::of_ids(self.spheres, ids)).collect()
    }

    /// Keeps the bricks with these numbers, in this order. Numbers count only the bricks that have not been built.
    pub(crate) fn keep(&mut self, numbers: &[usize]) {
        let mut parts: Vec<Option<Vec<u32>>> = self.parts.drain(..).map(Some).collect();
        let kept = numbers.iter().filter_map(|number| parts.get_mut(*number)?.take());
        self.parts = kept.collect();
    }

    /// Skips the next brick without building it.
    pub(crate) fn leave_out(&mut self) {
        self.parts.pop_front();
    }
}

impl Iterator for Bricks<'_> {
    type Item = Brick;

    fn next(&mut self) -> Option<Brick> {
        match self.parts.pop_front() {
            Some(part) => Some(self.build_part(part)),
            None => self.parts_of_cones.pop_front().map(|part| self.build_cones(part)),
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.parts.len() + self.parts_of_cones.len();
        (left, Some(left))
    }
}

impl ExactSizeIterator for Bricks<'_> {}

/// The bounding boxes of a brick's spheres and of their centres, in the scene's frame. Both are empty if there are no
/// spheres.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BrickBounds {
    pub(crate) primitive: Primitive,
    pub(crate) center_min: Vec3,
    pub(crate) center_max: Vec3,
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

#[cfg(feature = "gpu")]
impl BrickBounds {
    pub(crate) const EMPTY: Self = Self {
        primitive: Primitive::Sphere,
        center_min: Vec3::MAX,
        center_max: Vec3::MIN,
        min: Vec3::MAX,
        max: Vec3::MIN,
    };

    /// The bounds of spheres that fill a box.
    pub(crate) fn of_box((min, max): (Vec3, Vec3)) -> Self {
        Self { primitive: Primitive::Sphere, center_min: min, center_max: max, min, max }
    }

    /// Computes the bounds of the given spheres.
    pub(crate) fn of_spheres(spheres: &[[f32; 4]]) -> Self {
        Self::joined(map_chunks(spheres, |_, spheres| spheres.iter().fold(Self::EMPTY, Self::with)))
    }

    /// Computes the bounds of a brick's shapes.
    pub(crate) fn of_brick(brick: &Brick) -> Self {
        let of_cone = |cone: &ConeInFrame| {
            let [min, max] = cone.corners().map(|corner| corner.as_vec3());
            let center = 0.5 * (min + max);
            Self { center_min: center, center_max: center, min, max, ..Self::EMPTY }
        };
        match brick.primitive {
            Primitive::Sphere => Self::of_spheres(&brick.spheres),
            Primitive::Cone => {
                let all = Self::joined(brick.cones.iter().map(of_cone).collect());
                Self { primitive: Primitive::Cone, ..all }
            }
        }
    }

    /// Computes the bounds of the spheres with the given indices.
    pub(crate) fn of_ids(spheres: &[[f32; 4]], ids: &[u32]) -> Self {
        let with = |all: Self, id: &u32| all.with(&spheres[*id as usize]);
        Self::joined(map_chunks(ids, |_, ids| ids.iter().fold(Self::EMPTY, with)))
    }

    /// Whether there are no spheres.
    pub(crate) fn is_empty(&self) -> bool {
        self.min.x > self.max.x
    }

    fn with(self, &[x, y, z, radius]: &[f32; 4]) -> Self {
        let center = Vec3::new(x, y, z);
        Self {
            primitive: self.primitive,
            center_min: self.center_min.min(center),
            center_max: self.center_max.max(center),
            min: self.min.min(center - radius),
            max: self.max.max(center + radius),
        }
    }

    fn joined(parts: Vec<Self>) -> Self {
        parts.into_iter().fold(Self::EMPTY, |all, part| Self {
            primitive: all.primitive,
            center_min: all.center_min.min(part.center_min),
            center_max: all.center_max.max(part.center_max),
            min: all.min.min(part.min),
            max: all.max.max(part.max),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::AccelChoice;

    #[test]
    fn bricks_one_by_one_are_those_of_all() {
        let mut rng = fastrand::Rng::with_seed(3);
        let spheres: Vec<[f32; 4]> = (0..2000).map(|_| [rng.f32(), rng.f32(), rng.f32(), 0.01]).collect();
        for (choice, bytes) in [(AccelChoice::List, 4096), (AccelChoice::Tree, 4096), (AccelChoice::Grid, 1 << 17)] {
            let plan = AccelPlan::new(&spheres, choice, bytes);
            let (all, one_by_one) = (plan.build(&spheres), plan.bricks(&spheres));
            let count = one_by_one.len();
            assert!(count > 1 && count == all.bricks().len(), "{choice}");
            assert_eq!(one_by_one.bounds(), all.bounds());
            for (number, (one, other)) in one_by_one.zip(all.bricks()).enumerate() {
                assert_eq!((&one.ids, &one.spheres), (&other.ids, &other.spheres), "{number}");
            }
        }
        let plan = AccelPlan::new(&[], AccelChoice::Auto, 4096);
        assert_eq!(plan.build(&[]).bricks().len(), 1);
        assert_eq!(plan.bricks(&[]).map(|brick| brick.ids.len()).collect::<Vec<_>>(), [0]);
    }

    #[cfg(feature = "gpu")]
    #[test]
    fn some_bricks_in_another_order() {
        let spheres: Vec<[f32; 4]> = (0..1000).map(|i| [i as f32, 0.0, 0.0, 0.4]).collect();
        let plan = AccelPlan::new(&spheres, AccelChoice::Tree, 16 * 150);
        let all = plan.build(&spheres);
        let mut bricks = plan.bricks(&spheres);
        let boxes = bricks.boxes();
        for (bounds, brick) in boxes.iter().zip(all.bricks()) {
            assert_eq!(*bounds, BrickBounds::of_spheres(&brick.spheres));
        }
        bricks.keep(&[4, 0, 2]);
        assert_eq!(bricks.next().unwrap().ids, all.bricks()[4].ids);
        bricks.leave_out();
        assert_eq!(bricks.next().unwrap().ids, all.bricks()[2].ids);
        assert!(bricks.next().is_none());
    }

    #[cfg(feature = "gpu")]
    #[test]
    fn boxes_are_those_of_spheres_and_of_ids() {
        let spheres = [[1.0, 2.0, 3.0, 0.5], [-1.0, 2.0, 3.0, 0.25], [9.0, 9.0, 9.0, 1.0]];
        let bounds = BrickBounds::of_spheres(&spheres[..2]);
        assert_eq!(bounds, BrickBounds::of_ids(&spheres, &[1, 0]));
        assert_eq!(bounds.min, Vec3::new(-1.25, 1.5, 2.5));
        assert_eq!(bounds.max, Vec3::new(1.5, 2.5, 3.5));
        assert_eq!(bounds.center_min, Vec3::new(-1.0, 2.0, 3.0));
        assert!(!bounds.is_empty() && BrickBounds::of_spheres(&[]).is_empty());
    }
}
