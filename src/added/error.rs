//! Why spheres cannot be added to those of data.

/// Why spheres cannot be added to those of data.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AddError {
    /// The data has no periodic cell.
    #[error(
        "the data has no periodic cell, so there is no box to draw; leave out `--box`, or the key `box`"
    )]
    NoCell,
    /// The cell has no extent, or is too far away.
    #[error(
        "the periodic cell has the edges {edges:?} and cannot be drawn as a box; leave out `--box`, or the key `box`"
    )]
    Cell {
        /// The edges.
        edges: [[f64; 3]; 3],
    },
    /// The width of the edges is out of range.
    #[error(
        "`box`: the width of the edges is {width}; it must lie between 1/20000 of the diagonal of the cell, which is \
         {diagonal:.4}, and the diagonal"
    )]
    Width {
        /// The width.
        width: f64,
        /// The diagonal of the cell.
        diagonal: f64,
    },
    /// The factor or the length of bonds is out of range.
    #[error("`bonds`: the {what} is {value}; it must be finite and greater than 0")]
    NotPositive {
        /// What has this value.
        what: &'static str,
        /// The value.
        value: f64,
    },
    /// The data does not say which elements the spheres are.
    #[error(
        "the data does not say which chemical elements its spheres are, from which the lengths of bonds follow; give the \
         length below which two spheres are bonded (--bond-length L, or bonds = {{ length = L }})"
    )]
    NoElements,
    /// There are too many pairs.
    #[error(
        "{pairs} pairs of {spheres} spheres would be bonds, more than {most} for each; choose a smaller factor or length \
         of bonds"
    )]
    TooManyBonds {
        /// The number of pairs that were found.
        pairs: usize,
        /// The number of spheres.
        spheres: usize,
        /// The number of bonds that each sphere may have, on average.
        most: usize,
    },
    /// Too many spheres are close together to find pairs in a reasonable time.
    #[error(
        "too many of the {spheres} spheres are close together to look for bonds; choose a smaller factor or length of \
         bonds, or select fewer spheres"
    )]
    TooDense {
        /// The number of spheres.
        spheres: usize,
    },
    /// Bonds are too thin for their length.
    #[error(
        "the bonds of {spheres} spheres would need more than {most} spheres, because they are thin for their length; \
         choose larger radii"
    )]
    TooThin {
        /// The number of spheres.
        spheres: usize,
        /// The number of spheres that may be added.
        most: usize,
    },
}
