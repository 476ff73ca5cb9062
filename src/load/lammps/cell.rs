//! The simulation box: an origin and three edges.

use crate::load::rows::{Values, number};

/// How the three lines of a box are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// Low and high end along x, y and z.
    Orthogonal,
    /// The same of the box around the cell, each followed by one of the tilt factors xy, xz and yz.
    Triclinic,
    /// The components of an edge and one component of the origin.
    General,
}

impl Shape {
    /// The shape that `ITEM: BOX BOUNDS` declares.
    pub(super) fn of_item(item: &str) -> Self {
        let mut words = item.split_whitespace();
        match words.nth(2) {
            Some("xy") => Self::Triclinic,
            Some("abc") => Self::General,
            _ => Self::Orthogonal,
        }
    }

    pub(super) const fn values(self) -> &'static str {
        match self {
            Self::Orthogonal => "two numbers belong here: low end and high end",
            Self::Triclinic => "three numbers belong here: low end, high end and tilt factor",
            Self::General => "four numbers belong here: an edge and a component of the origin",
        }
    }
}

/// An origin and three edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) origin: [f64; 3],
    pub(super) edges: [[f64; 3]; 3],
}

impl Cell {
    /// Reads the three lines of a box in a dump, or names the first that is wrong, from 0.
    pub(super) fn of_dump(shape: Shape, lines: [&[u8]; 3]) -> Result<Self, usize> {
        let mut rows = [[0.0; 4]; 3];
        let wanted = match shape {
            Shape::Orthogonal => 2,
            Shape::Triclinic => 3,
            Shape::General => 4,
        };
        for (index, (row, line)) in rows.iter_mut().zip(lines).enumerate() {
            let mut values = Values { rest: line };
            for value in row.iter_mut().take(wanted) {
                let parsed = values.next().and_then(number).filter(|number| number.is_finite());
                *value = parsed.ok_or(index)?;
            }
            if values.next().is_some() {
                return Err(index);
            }
        }
        let [a, b, c] = rows;
        Ok(match shape {
            Shape::Orthogonal => Self::tilted([a[0], b[0], c[0]], [a[1], b[1], c[1]], [0.0; 3]),
            Shape::Triclinic => {
                let [xy, xz, yz] = [a[2], b[2], c[2]];
                // What a dump has is the box around the cell.
                let ends = [0.0, xy, xz, xy + xz];
                let least = ends.into_iter().fold(f64::INFINITY, f64::min);
                let most = ends.into_iter().fold(f64::NEG_INFINITY, f64::max);
                let low = [a[0] - least, b[0] - yz.min(0.0), c[0]];
                let high = [a[1] - most, b[1] - yz.max(0.0), c[1]];
                Self::tilted(low, high, [xy, xz, yz])
            }
            Shape::General => {
                Self { origin: [a[3], b[3], c[3]], edges: [a, b, c].map(|[x, y, z, _]| [x, y, z]) }
            }
        })
    }

    /// A cell whose first edge lies along x and whose second lies in the plane of x and y.
    pub(super) fn tilted(low: [f64; 3], high: [f64; 3], [xy, xz, yz]: [f64; 3]) -> Self {
        let [x, y, z] = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        Self { origin: low, edges: [[x, 0.0, 0.0], [xy, y, 0.0], [xz, yz, z]] }
    }

    /// The place with these fractions of the edges.
    pub(super) fn place(&self, fractions: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.edges;
        let [u, v, w] = fractions;
        [0, 1, 2].map(|axis| self.origin[axis] + u * a[axis] + v * b[axis] + w * c[axis])
    }
}
