//! Primitives: the shapes of which bricks consist. `docs/extending.md` explains how to add one.

use super::brick::Structure;

/// The kind of shapes in a brick. All shapes of a brick have the same kind, so that each kernel handles a single kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Primitive {
    /// A sphere: a centre and a radius.
    #[default]
    Sphere,
}

impl Primitive {
    /// All primitives.
    pub const ALL: &'static [Self] = &[Self::Sphere];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
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
    /// All combinations of the given structures and primitives that are supported.
    pub fn of<'a>(
        structures: &'a [Structure],
        primitives: &'a [Primitive],
    ) -> impl Iterator<Item = Self> + 'a {
        let kinds = primitives.iter().flat_map(|&primitive| {
            structures.iter().map(move |&structure| Self { structure, primitive })
        });
        kinds.filter(|kind| kind.exists())
    }

    /// Whether the structure supports the primitive.
    const fn exists(self) -> bool {
        match self.primitive {
            Primitive::Sphere => true,
        }
    }
}
