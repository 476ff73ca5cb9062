//! Two levels of cells: a grid over all spheres, whose crowded cells have grids of their own.

use glam::Vec3;

/// What a word of [`Grid::cells`] stands for, in its two highest bits.
pub(crate) mod word {
    /// No sphere meets the cell. Bits 3 o to 3 o + 2: how many cells ahead of it, for a ray in octant o and
    /// along all three axes, are empty as well; bit i of o is set for a ray that descends along axis i.
    pub(crate) const EMPTY: u32 = 0;
    /// The other bits: where the cell's list starts.
    pub(crate) const LIST: u32 = 1 << 30;
    /// Bits 27 to 29: the logarithm, to base 2, of how many cells the grid inside has along an axis. The
    /// lower bits: where its cells start in [`super::Grid::cells`], in units of eight.
    pub(crate) const GRID: u32 = 2 << 30;
    /// The bits that tell them apart.
    pub(crate) const KIND: u32 = 3 << 30;
    /// How many cells an octant's bits of an empty word can count.
    pub(crate) const REACH: u32 = 7;
    /// How many bits of an empty word an octant has.
    pub(crate) const REACH_BITS: u32 = 3;
    /// Where the logarithm in a word with a grid starts, and its bits once it is shifted down.
    pub(crate) const LEVEL_SHIFT: u32 = 27;
    pub(crate) const LEVEL: u32 = 7;
    /// The bits of a word with a grid that say where its cells start, and how many cells that counts by.
    pub(crate) const INNER_START: u32 = (1 << LEVEL_SHIFT) - 1;
    pub(crate) const INNER_UNIT: u32 = 8;

    /// Of a word with a grid, the logarithm of its cells along an axis.
    pub(crate) const fn level(word: u32) -> u32 {
        word >> LEVEL_SHIFT & LEVEL
    }

    /// Of a word with a grid, the index of its first cell's word.
    pub(crate) const fn first_inner(word: u32) -> usize {
        ((word & INNER_START) * INNER_UNIT) as usize
    }

    /// How many units so many words fill.
    pub(crate) const fn units(words: usize) -> u32 {
        (words / INNER_UNIT as usize) as u32
    }

    /// So many words, and what is missing to whole units.
    pub(crate) const fn in_whole_units(words: usize) -> usize {
        words.next_multiple_of(INNER_UNIT as usize)
    }
}

/// Marks the last element of a list: in `Referenced`, the highest bit of a reference; in `Copied`, the sign
/// of the radius.
pub(crate) const LAST: u32 = 1 << 31;

/// The most cells of one brick: their numbers are computed in f32, where they are exact.
pub(super) const MAX_CELLS: usize = 1 << 24;

/// How lists name their spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ListLayout {
    /// A list is a run of spheres: each is stored once for every cell it meets. A test loads one vector.
    Copied,
    /// A list is a run of references; each sphere is stored once. Less memory, one more load a test.
    Referenced,
}

/// Two levels of cells, as plain data. `shaders/accel/grid.wgsl` reads the same words.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The corner with the smallest coordinates, in the scene's frame.
    pub min: Vec3,
    /// The edge of a cell of the first level.
    pub cell_size: f32,
    /// How many cells the first level has along each axis.
    pub cell_counts: [u32; 3],
    /// A word per cell: the first level, x fastest, padded to a multiple of eight; then the grids inside
    /// cells, each 8ᵏ words.
    pub cells: Vec<u32>,
    /// With [`ListLayout::Referenced`], places of spheres; the last of a list has its highest bit set.
    pub references: Option<Vec<u32>>,
}

/// What a grid is like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridStatistics {
    /// Cells, of both levels.
    pub cells: usize,
    /// Cells of the first level that have a grid of their own.
    pub grids: usize,
    /// Cells without a sphere, of both levels.
    pub empty: usize,
    /// Elements of all lists.
    pub listed: usize,
    /// Elements of the longest list.
    pub longest_list: usize,
}

impl Grid {
    /// How many cells the first level has; its words are followed by up to seven unused ones.
    #[must_use]
    pub fn first_level_len(&self) -> usize {
        self.cell_counts.iter().map(|count| *count as usize).product()
    }

    /// Which layout the lists have.
    #[must_use]
    pub fn layout(&self) -> ListLayout {
        if self.references.is_some() { ListLayout::Referenced } else { ListLayout::Copied }
    }

    /// The list that starts at `start`: places of spheres, of which `spheres` is the array.
    pub(super) fn list<'a>(
        &'a self,
        spheres: &'a [[f32; 4]],
        start: u32,
    ) -> impl Iterator<Item = u32> + 'a {
        let mut next = Some(start as usize);
        std::iter::from_fn(move || {
            let at = next?;
            let (shape_index, is_last) = match &self.references {
                Some(references) => {
                    let reference = *references.get(at)?;
                    (reference & !LAST, reference & LAST != 0)
                }
                None => (at as u32, spheres.get(at)?[3].is_sign_negative()),
            };
            next = (!is_last).then_some(at + 1);
            Some(shape_index)
        })
    }

    /// Whether a walk needs to know of grids inside cells, or of empty cells ahead.
    #[must_use]
    pub fn is_nested(&self) -> bool {
        self.cells[..self.first_level_len()]
            .iter()
            .any(|cell| cell & word::KIND == word::GRID || (1..word::LIST).contains(cell))
    }

    /// Counts what there is.
    #[must_use]
    pub fn statistics(&self, spheres: &[[f32; 4]]) -> GridStatistics {
        let mut statistics = GridStatistics { cells: self.cells.len(), ..Default::default() };
        for &cell in &self.cells {
            match cell & word::KIND {
                word::LIST => {
                    let len = self.list(spheres, cell & !word::KIND).count();
                    statistics.listed += len;
                    statistics.longest_list = statistics.longest_list.max(len);
                }
                word::GRID => statistics.grids += 1,
                _ => statistics.empty += 1,
            }
        }
        statistics
    }
}
