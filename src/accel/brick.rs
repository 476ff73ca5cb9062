//! Bricks: parts of a scene, each small enough for a device's bindings, each with an index of its own.

use glam::Vec3;

use super::binary_tree::BinaryTree;
use super::grid::{Grid, ListLayout};
use super::list;
use super::plan::AccelChoice;
use super::primitive::{BrickKind, Primitive};
use super::query::{Nearest, RayF32};
use super::wide_tree::WideTree;

/// The structures that exist, as kernels know them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Structure {
    /// Every sphere is tried.
    List,
    /// One level of cells.
    Grid(ListLayout),
    /// Two levels of cells.
    NestedGrid(ListLayout),
    /// A tree with eight children a node, compressed.
    WideTree,
    /// A tree with two children a node: simple, and a second opinion.
    BinaryTree,
}

impl Structure {
    /// All of them.
    pub const ALL: &'static [Self] = &[
        Self::List,
        Self::Grid(ListLayout::Copied),
        Self::Grid(ListLayout::Referenced),
        Self::NestedGrid(ListLayout::Copied),
        Self::NestedGrid(ListLayout::Referenced),
        Self::WideTree,
        Self::BinaryTree,
    ];

    /// Those that are chosen where the user leaves it open.
    pub const AUTOMATIC: &'static [Self] = &[
        Self::List,
        Self::Grid(ListLayout::Copied),
        Self::Grid(ListLayout::Referenced),
        Self::NestedGrid(ListLayout::Copied),
        Self::NestedGrid(ListLayout::Referenced),
        Self::WideTree,
    ];

    /// What a user would have asked for.
    #[must_use]
    pub const fn choice(self) -> AccelChoice {
        match self {
            Self::List => AccelChoice::List,
            Self::Grid(_) | Self::NestedGrid(_) => AccelChoice::Grid,
            Self::WideTree => AccelChoice::Tree,
            Self::BinaryTree => AccelChoice::BinaryTree,
        }
    }

    /// What it is called in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::List => "list",
            Self::Grid(ListLayout::Copied) => "grid, spheres copied into cells",
            Self::Grid(ListLayout::Referenced) => "grid, cells refer to spheres",
            Self::NestedGrid(ListLayout::Copied) => "nested grids, spheres copied into cells",
            Self::NestedGrid(ListLayout::Referenced) => "nested grids, cells refer to spheres",
            Self::WideTree => "8-wide tree",
            Self::BinaryTree => "binary tree",
        }
    }
}

/// What finds the spheres of a brick.
#[derive(Clone, Debug)]
pub enum Index {
    /// Nothing: every sphere is tried.
    List,
    /// Two levels of cells.
    Grid(Grid),
    /// Eight children a node.
    WideTree(WideTree),
    /// Two children a node.
    BinaryTree(BinaryTree),
}

/// A part of a scene.
#[derive(Clone, Debug)]
pub struct Brick {
    /// What finds its spheres.
    pub index: Index,
    /// Centre in the scene's frame, and radius, in the order of the index; the sign of the radius means
    /// something to the index only.
    pub spheres: Vec<[f32; 4]>,
    /// Index of each in input order.
    pub ids: Vec<u32>,
}

impl Brick {
    /// Offers every sphere that may be nearer than `nearest`.
    pub fn find_nearest(&self, ray: &RayF32, nearest: &mut Nearest) {
        let Self { index, spheres, ids } = self;
        match index {
            Index::List => list::find_nearest(spheres, ids, ray, nearest),
            Index::Grid(grid) => grid.find_nearest(spheres, ids, ray, nearest),
            Index::WideTree(tree) => tree.find_nearest(spheres, ids, ray, nearest),
            Index::BinaryTree(tree) => tree.find_nearest(spheres, ids, ray, nearest),
        }
    }

    /// Whether any sphere is nearer than `t_max`.
    #[must_use]
    pub fn find_any(&self, ray: &RayF32, t_max: f32) -> bool {
        let Self { index, spheres, .. } = self;
        match index {
            Index::List => list::find_any(spheres, ray, t_max),
            Index::Grid(grid) => grid.find_any(spheres, ray, t_max),
            Index::WideTree(tree) => tree.find_any(spheres, ray, t_max),
            Index::BinaryTree(tree) => tree.find_any(spheres, ray, t_max),
        }
    }
}

/// All bricks of a scene, of one structure.
#[derive(Clone, Debug)]
pub struct Accel {
    pub(super) structure: Structure,
    pub(super) bricks: Vec<Brick>,
    pub(super) min: Vec3,
    pub(super) max: Vec3,
    pub(super) may_part_equals: bool,
}

impl Accel {
    /// Of what kind the bricks are.
    #[must_use]
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// What kernels that search the bricks are made for.
    #[must_use]
    pub fn kind(&self) -> BrickKind {
        BrickKind { structure: self.structure, primitive: Primitive::Sphere }
    }

    /// The bricks; at least one, if only an empty one.
    #[must_use]
    pub fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    /// The box of all spheres in the scene's frame, inflated by the margin; rays are moved to it before
    /// they are traced.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        (self.min, self.max)
    }

    /// Whether spheres with the same centre may be in several bricks.
    #[must_use]
    pub fn may_part_equals(&self) -> bool {
        self.may_part_equals
    }

    /// The nearest sphere of a ray, which starts in the box of [`Accel::bounds`] or on its wall.
    #[must_use]
    pub fn find_nearest(&self, ray: &RayF32) -> Nearest {
        let mut nearest = Nearest::NONE;
        for brick in &self.bricks {
            brick.find_nearest(ray, &mut nearest);
        }
        nearest
    }

    /// Whether any sphere is nearer than `t_max`.
    #[must_use]
    pub fn find_any(&self, ray: &RayF32, t_max: f32) -> bool {
        self.bricks.iter().any(|brick| brick.find_any(ray, t_max))
    }
}
