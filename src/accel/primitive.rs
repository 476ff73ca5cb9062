//! What a brick consists of. `ARCHITECTURE.md` says how to add a primitive.

use super::brick::Structure;

/// What the shapes of a brick are. A brick has one kind of them, so that a kernel is made for each, and none asks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Primitive {
    /// A centre and a radius.
    #[default]
    Sphere,
}

impl Primitive {
    /// All of them.
    pub const ALL: &'static [Self] = &[Self::Sphere];

    /// What it is called in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
        }
    }
}

/// What kernels differ in by the brick that they search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BrickKind {
    /// What finds the shapes.
    pub structure: Structure,
    /// What they are.
    pub primitive: Primitive,
}

impl BrickKind {
    /// Bricks of some structures and of some primitives, as far as there are such.
    pub fn of<'a>(
        structures: &'a [Structure],
        primitives: &'a [Primitive],
    ) -> impl Iterator<Item = Self> + 'a {
        let kinds = primitives.iter().flat_map(|&primitive| {
            structures.iter().map(move |&structure| Self { structure, primitive })
        });
        kinds.filter(|kind| kind.exists())
    }

    /// Whether a structure can find such shapes.
    const fn exists(self) -> bool {
        match self.primitive {
            Primitive::Sphere => true,
        }
    }
}
