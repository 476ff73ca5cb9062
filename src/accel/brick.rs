//! Bricks: parts of a scene that each fit into a device's bindings and each have an acceleration structure.

use glam::Vec3;

use super::extent::Item;
use super::grid::Grid;
use super::outliers::Margins;
use super::structure::{BrickKind, Primitive, Structure};
use super::wide_tree::WideTree;

/// The acceleration structure of a brick.
#[derive(Clone, Debug)]
pub enum Index {
    /// No structure: every sphere is tested.
    List,
    /// One or two levels of grid cells.
    Grid(Grid),
    /// A tree with eight children for each node.
    WideTree(WideTree),
    /// Boxes from which a driver builds a structure. The host searches without one.
    RayQuery(QueryBoxes),
}

/// A part of a scene with its acceleration structure.
#[derive(Clone, Debug)]
pub struct Brick {
    /// The acceleration structure of the spheres.
    pub index: Index,
    /// Centre (x, y, z) in the scene's frame, and radius, in the order of the structure.
    pub spheres: Vec<[f32; 4]>,
    /// Index of each sphere in input order.
    pub ids: Vec<u32>,
}

impl Brick {
    /// Whether the index is a grid of which some cells have grids of their own.
    pub(crate) fn is_nested(&self) -> bool {
        matches!(&self.index, Index::Grid(grid) if grid.is_nested())
    }
}

/// All bricks of a scene, which have the same structure.
#[derive(Clone, Debug)]
pub struct Accel {
    pub(super) structure: Structure,
    pub(super) bricks: Vec<Brick>,
    pub(super) min: Vec3,
    pub(super) max: Vec3,
    pub(super) may_part_equals: bool,
}

impl Accel {
    /// The structure of the bricks.
    #[must_use]
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// The structure and the primitive for which kernels that search the bricks are made.
    #[must_use]
    pub fn kind(&self) -> BrickKind {
        BrickKind { structure: self.structure, primitive: Primitive::Sphere }
    }

    /// The bricks; at least one, which may be empty.
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

    /// Whether spheres with the same centre may be in different bricks.
    #[must_use]
    pub fn may_part_equals(&self) -> bool {
        self.may_part_equals
    }
}

/// A box for each sphere, in the order of a brick, from which a driver builds a structure of its own for ray queries. The
/// kernels are in `shaders/accel/ray_query.wgsl`.
///
/// Vulkan says of a box only that it is reported if the ray meets it, not how the meeting is rounded. So each box holds
/// its sphere and the margin of trees, which is more than the error of any arithmetic that rounds as WGSL allows
/// (`slab.rs`); whether a driver's own arithmetic is as good is for the certificate to say.
#[derive(Clone, Debug, PartialEq)]
pub struct QueryBoxes {
    boxes: Vec<[f32; 6]>,
}

impl QueryBoxes {
    /// The boxes of spheres (centre x, y, z in the scene's frame, radius), inflated by `margin`.
    #[must_use]
    pub fn of(spheres: &[[f32; 4]], margin: f32) -> Self {
        let items = Item::all(spheres, &Margins::one(margin));
        let of_item = |item: &Item| {
            let ([x, y, z], reach) = (item.center, item.reach);
            [x - reach, y - reach, z - reach, x + reach, y + reach, z + reach]
        };
        Self { boxes: items.iter().map(of_item).collect() }
    }

    /// The least coordinates and the greatest of each box.
    #[must_use]
    pub fn boxes(&self) -> &[[f32; 6]] {
        &self.boxes
    }
}
