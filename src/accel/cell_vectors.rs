//! The cells of points, on vectors: as fast as a processor divides, because a grid's builder asks for several cells of
//! every sphere. The result is that of dividing each coordinate, to the bit.

use glam::Vec3A;

use super::cells::Cells;

/// The number of cells along each side of a block: the spheres of a block fit into a processor's L1 cache, or into two
/// pages.
const BLOCK: usize = 4;

/// A box of cells, with what their search computes from it.
#[derive(Clone, Copy)]
pub(super) struct CellVectors {
    pub(super) min: Vec3A,
    pub(super) size: f32,
    /// The coordinates of the last cell.
    last: Vec3A,
    /// The numbers of cells along x and y.
    counts: [usize; 2],
    /// The numbers of blocks along all axes.
    blocks: [usize; 3],
}

impl CellVectors {
    pub(super) fn of(cells: &Cells) -> Self {
        let counts = cells.counts.map(|count| count as usize);
        Self {
            min: cells.min.into(),
            size: cells.size,
            last: Vec3A::from_array(cells.counts.map(|count| (count - 1) as f32)),
            counts: [counts[0], counts[1]],
            blocks: counts.map(|count| count.div_ceil(BLOCK)),
        }
    }

    /// The coordinates of the cell that contains a point, not yet rounded down; for points outside, those of the nearest
    /// cell.
    pub(super) fn coordinates(&self, at: Vec3A) -> Vec3A {
        ((at - self.min) / self.size).max(Vec3A::ZERO).min(self.last)
    }

    /// The index of a cell.
    pub(super) fn index(&self, coordinates: Vec3A) -> usize {
        let [x, y, z] = whole(coordinates);
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// An upper bound for [`Self::index_in_blocks`].
    pub(super) fn len_in_blocks(&self) -> usize {
        self.blocks.iter().product::<usize>() * BLOCK.pow(3)
    }

    /// An index of the cell of a sphere's centre, such that cells that are close in space, along any axis, have close
    /// indices: block by block.
    pub(super) fn index_in_blocks(&self, &[x, y, z, _]: &[f32; 4]) -> usize {
        let [x, y, z] = whole(self.coordinates(Vec3A::new(x, y, z)));
        let [width, height, _] = self.blocks;
        let block = (z / BLOCK * height + y / BLOCK) * width + x / BLOCK;
        ((block * BLOCK + z % BLOCK) * BLOCK + y % BLOCK) * BLOCK + x % BLOCK
    }
}

/// Rounds coordinates down, which are not negative and less than 2²⁴.
fn whole(coordinates: Vec3A) -> [usize; 3] {
    // A cast to i32 is faster than one to larger integers.
    coordinates.to_array().map(|x| x as i32 as usize)
}
