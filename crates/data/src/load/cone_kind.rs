//! The two kinds of files of cones: cylinders, and cones.

/// The shapes of a file, all of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConeKind {
    /// Cylinders, which have one radius.
    Cylinder,
    /// Cones, which have a radius at each end.
    Cone,
}

impl ConeKind {
    /// The name of the shapes of a file.
    pub(super) const fn plural(self) -> &'static str {
        match self {
            Self::Cylinder => "cylinders",
            Self::Cone => "cones",
        }
    }

    /// The name of the radii in scene files and archives.
    #[must_use]
    pub const fn radii(self) -> &'static str {
        match self {
            Self::Cylinder => "radius",
            Self::Cone => "radii",
        }
    }

    /// The columns of radii that a file has beside both ends, for messages.
    pub(super) const fn columns(self) -> &'static str {
        match self {
            Self::Cylinder => "`radius`, of shape (n,) in an archive",
            Self::Cone => "`radius_start` and `radius_end`, or `radii` of shape (n, 2) in an archive",
        }
    }

    /// The columns of a plain array.
    pub(super) const fn names(self) -> &'static [&'static str] {
        match self {
            Self::Cylinder => &["start.x", "start.y", "start.z", "end.x", "end.y", "end.z", "radius"],
            Self::Cone => &["start.x", "start.y", "start.z", "end.x", "end.y", "end.z", "radius.start", "radius.end"],
        }
    }
}
