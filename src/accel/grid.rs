//! Grids with one or two levels of cells: crowded cells of the first level may have grids of their own.

use glam::Vec3;

/// The words of [`Grid::cells`]. The two highest bits of a word are its kind.
pub(crate) mod word {
    /// The kind of a cell that no sphere overlaps. Bits 3 o to 3 o + 2 are the number of cells ahead, along all three
    /// axes, that are empty as well for a ray in octant o. Bit i of o is set for a ray that descends along axis i.
    pub(crate) const EMPTY: u32 = 0;
    /// The kind of a cell with a list. The other bits are the start of the list.
    pub(crate) const LIST: u32 = 1 << 30;
    /// The kind of a cell with a grid inside. Bits 27 to 29 are the base-2 logarithm of the number of its cells along
    /// an axis. The lower bits are the start of its words in [`super::grid::Grid::cells`], in units of eight.
    pub(crate) const GRID: u32 = 2 << 30;
    /// The bits of the kind.
    pub(crate) const KIND: u32 = 3 << 30;
    /// The largest number of empty cells that an empty word can state for an octant.
    pub(crate) const REACH: u32 = 7;
    /// The number of bits for each octant in an empty word.
    pub(crate) const REACH_BITS: u32 = 3;
    /// The position of the logarithm in the word of a grid, and its mask after the shift.
    pub(crate) const LEVEL_SHIFT: u32 = 27;
    pub(crate) const LEVEL: u32 = 7;
    /// The mask of the start index in the word of a grid, and the number of words in its unit.
    pub(crate) const INNER_START: u32 = (1 << LEVEL_SHIFT) - 1;
    pub(crate) const INNER_UNIT: u32 = 8;

    /// The base-2 logarithm of the number of cells along an axis, from the word of a grid.
    pub(crate) const fn level(word: u32) -> u32 {
        word >> LEVEL_SHIFT & LEVEL
    }

    /// The index of the first cell's word, from the word of a grid.
    pub(crate) const fn first_inner(word: u32) -> usize {
        ((word & INNER_START) * INNER_UNIT) as usize
    }

    /// The number of units that `words` words fill.
    pub(crate) const fn units(words: usize) -> u32 {
        (words / INNER_UNIT as usize) as u32
    }

    /// The number of words rounded up to whole units.
    pub(crate) const fn in_whole_units(words: usize) -> usize {
        words.next_multiple_of(INNER_UNIT as usize)
    }
}

/// Marks the last reference of a list, and its last ball.
pub(crate) const LAST: u32 = 1 << 31;

/// The largest number of cells of a brick. Cell indices are computed in f32, which is exact up to this number.
pub(super) const MAX_CELLS: usize = 1 << 24;

/// The largest number of cells of the first level of a grid. The others are left to the second level.
pub(super) const MAX_FIRST_LEVEL: usize = MAX_CELLS / 2;

/// Limits for the size of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct GridBudget {
    /// The largest total number of elements of all lists.
    pub listed: usize,
    /// The largest number of cells, of both levels together.
    pub cells: usize,
}

/// A grid with one or two levels of cells, as plain data. `shaders/accel/nested_grid.wgsl` reads the same words.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The corner with the smallest coordinates, in the scene's frame.
    pub min: Vec3,
    /// The edge length of a first-level cell.
    pub cell_size: f32,
    /// The number of first-level cells along each axis.
    pub cell_counts: [u32; 3],
    /// One word for each cell. Those of the first level come first, x fastest, padded to a multiple of eight. Those of
    /// the grids inside cells follow, each with 8ᵏ words.
    pub cells: Vec<u32>,
    /// Indices of spheres, list after list. The last element of each list has its highest bit set.
    pub references: Vec<u32>,
    /// For each reference, a ball around the sphere in four bytes. Only spheres whose balls a ray meets are loaded and
    /// tested. The last ball of each list has its highest bit set. Lists are padded to a multiple of four.
    pub balls: Vec<u32>,
}

impl Grid {
    /// The number of first-level cells. Up to seven unused words follow theirs.
    #[must_use]
    pub fn first_level_len(&self) -> usize {
        self.cell_counts.iter().map(|count| *count as usize).product()
    }

    /// The list that starts at `start`, as indices into [`Grid::references`].
    #[cfg(test)]
    pub(super) fn list(&self, start: u32) -> impl Iterator<Item = usize> {
        let mut next = Some(start as usize);
        std::iter::from_fn(move || {
            let at = next?;
            let is_last = self.references.get(at)? & LAST != 0;
            next = (!is_last).then_some(at + 1);
            Some(at)
        })
    }

    /// Returns true if a walk has to handle grids inside cells, or to skip empty cells.
    #[must_use]
    pub fn is_nested(&self) -> bool {
        self.cells[..self.first_level_len()]
            .iter()
            .any(|cell| cell & word::KIND == word::GRID || (1..word::LIST).contains(cell))
    }
}
