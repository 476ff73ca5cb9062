//! The names of structures and of shapes, as users choose them and as kernels distinguish them.

use std::fmt;

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
    /// No structure: every sphere is tested. Slow; serves as the reference for the others.
    List,
    /// A structure that the driver builds from boxes and searches by ray queries, in hardware or not. This is an
    /// experiment for devices that support ray queries and are opened with them.
    RayQuery,
    /// Lists of spheres for each tile of a single picture by one ray for each pixel. For all other work, it means what
    /// [`AccelChoice::Auto`] does, but [`RenderPlan::check`](crate::gpu::RenderPlan::check) refuses other pictures.
    Tiles,
}

impl fmt::Display for AccelChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::Grid => "grid",
            Self::Tree => "tree",
            Self::List => "list",
            Self::RayQuery => "query",
            Self::Tiles => "tiles",
        })
    }
}

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
    /// A structure that the driver builds from boxes and searches by ray queries, which not all devices support.
    RayQuery,
    /// No structure, but a list of spheres for each tile of one picture, which is made for its camera.
    Tiles,
}

impl Structure {
    /// All structures for which there are kernels. The last one needs ray queries, which not all devices support.
    pub(crate) const WITH_KERNELS: &'static [Self] =
        &[Self::List, Self::Grid, Self::NestedGrid, Self::WideTree, Self::RayQuery];

    /// All structures that any device can search, without [`Structure::RayQuery`]. [`AccelChoice::Auto`] chooses one.
    pub const ALL: &'static [Self] = match Self::WITH_KERNELS {
        [any @ .., Self::RayQuery] => any,
        all => all,
    };

    /// The structure, with nested grids if it is a grid and `is_nested` is true.
    pub(crate) const fn with_nested(self, is_nested: bool) -> Self {
        match self {
            Self::Grid if is_nested => Self::NestedGrid,
            other => other,
        }
    }

    /// The user's choice that leads to this structure.
    #[must_use]
    pub const fn choice(self) -> AccelChoice {
        match self {
            Self::List => AccelChoice::List,
            Self::Tiles => AccelChoice::Tiles,
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
            Self::Tiles => "tiles",
        }
    }

    /// The choice to use instead if rays take too many steps in this structure, for example among very many overlapping
    /// spheres. `None` for the list, which always terminates.
    #[must_use]
    pub const fn instead(self) -> Option<AccelChoice> {
        match self {
            Self::List => None,
            Self::Tiles => Some(AccelChoice::Grid),
            Self::Grid | Self::NestedGrid => Some(AccelChoice::Tree),
            Self::WideTree => Some(AccelChoice::List),
            Self::RayQuery => Some(AccelChoice::Tree),
        }
    }
}

/// The kind of shapes in a brick. All shapes of a brick have the same kind, so each kernel handles a single kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Primitive {
    /// A sphere: a centre and a radius.
    #[default]
    Sphere,
    /// A cone between two discs. A cylinder is one with equal radii.
    Cone,
}

impl Primitive {
    /// All primitives.
    pub const ALL: &'static [Self] = &[Self::Sphere, Self::Cone];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Cone => "cone",
        }
    }
}

/// The kind of brick for which a kernel is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BrickKind {
    /// The acceleration structure.
    pub structure: Structure,
    /// The kind of shapes.
    pub primitive: Primitive,
}

impl BrickKind {
    /// The combinations of the given structures and primitives for which there are kernels.
    pub fn of<'a>(structures: &'a [Structure], primitives: &'a [Primitive]) -> impl Iterator<Item = Self> + 'a {
        let all = primitives
            .iter()
            .flat_map(|&primitive| structures.iter().map(move |&structure| Self { structure, primitive }));
        all.filter(|kind| kind.exists())
    }

    /// The kind as which this brick is searched among all bricks: if any grid has grids inside its cells, all grids of
    /// these shapes are searched so.
    #[cfg(feature = "gpu")]
    pub(crate) fn among(self, all: &[Self]) -> Self {
        let is_nested = all.contains(&Self { structure: Structure::NestedGrid, ..self });
        Self { structure: self.structure.with_nested(is_nested), ..self }
    }

    /// True if the structure can find these shapes.
    const fn exists(self) -> bool {
        match self.primitive {
            Primitive::Sphere => true,
            Primitive::Cone => !matches!(self.structure, Structure::RayQuery),
        }
    }
}
