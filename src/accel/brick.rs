//! Bricks: parts of a scene that each fit into a device's bindings and each have an acceleration structure.

use glam::Vec3;

use super::grid::Grid;
use super::list;
use super::plan::AccelChoice;
use super::primitive::{BrickKind, Primitive};
use super::query::{Nearest, RayF32};
use super::query_boxes::QueryBoxes;
use super::wide_tree::WideTree;

/// The acceleration structures, as kernels distinguish them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Structure {
    /// No structure: every sphere is tested.
    List,
    /// One level of grid cells.
    Grid,
    /// Two levels of grid cells: crowded cells have grids of their own.
    NestedGrid,
    /// A compressed tree with eight children for each node.
    WideTree,
    /// A structure that the driver builds from boxes, and searches by ray queries; not all devices have these.
    RayQuery,
}

impl Structure {
    /// All structures for which there are kernels; the last needs more than any device has.
    pub(crate) const WITH_KERNELS: &'static [Self] =
        &[Self::List, Self::Grid, Self::NestedGrid, Self::WideTree, Self::RayQuery];

    /// All structures that any device can search: not [`Structure::RayQuery`]. [`AccelChoice::Auto`] chooses among them.
    pub const ALL: &'static [Self] = match Self::WITH_KERNELS {
        [any @ .., Self::RayQuery] => any,
        all => all,
    };

    /// The same structure, with nested grids if it is a grid and `is_nested`.
    pub(crate) const fn with_nested(self, is_nested: bool) -> Self {
        match self {
            Self::Grid if is_nested => Self::NestedGrid,
            other => other,
        }
    }

    /// The choice of a user that leads to this structure.
    #[must_use]
    pub const fn choice(self) -> AccelChoice {
        match self {
            Self::List => AccelChoice::List,
            Self::Grid | Self::NestedGrid => AccelChoice::Grid,
            Self::WideTree => AccelChoice::Tree,
            Self::RayQuery => AccelChoice::RayQuery,
        }
    }

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::List => "list",
            Self::Grid => "grid",
            Self::NestedGrid => "nested grids",
            Self::WideTree => "8-wide tree",
            Self::RayQuery => "ray query",
        }
    }
}

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

    /// Updates `nearest` with the nearest sphere of the brick.
    pub fn find_nearest(&self, ray: &RayF32, nearest: &mut Nearest) {
        let Self { index, spheres, ids } = self;
        match index {
            Index::List | Index::RayQuery(_) => list::find_nearest(spheres, ids, ray, nearest),
            Index::Grid(grid) => grid.find_nearest(spheres, ids, ray, nearest),
            Index::WideTree(tree) => tree.find_nearest(spheres, ids, ray, nearest),
        }
    }

    /// Whether the ray hits a sphere of the brick before `t_max`.
    #[must_use]
    pub fn find_any(&self, ray: &RayF32, t_max: f32) -> bool {
        let Self { index, spheres, .. } = self;
        match index {
            Index::List | Index::RayQuery(_) => list::find_any(spheres, ray, t_max),
            Index::Grid(grid) => grid.find_any(spheres, ray, t_max),
            Index::WideTree(tree) => tree.find_any(spheres, ray, t_max),
        }
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

    /// The nearest sphere hit by a ray, which must start inside the box of [`Accel::bounds`] or on its surface.
    #[must_use]
    pub fn find_nearest(&self, ray: &RayF32) -> Nearest {
        let mut nearest = Nearest::NONE;
        for brick in &self.bricks {
            brick.find_nearest(ray, &mut nearest);
        }
        nearest
    }

    /// Whether the ray hits any sphere before `t_max`.
    #[must_use]
    pub fn find_any(&self, ray: &RayF32, t_max: f32) -> bool {
        self.bricks.iter().any(|brick| brick.find_any(ray, t_max))
    }
}
