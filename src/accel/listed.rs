//! The shapes that the cells of a grid can list: spheres, and cones in `cone_cells.rs`.

use bytemuck::Pod;

use super::ball::BallFrame;
use super::cells::{Cells, mean_overlapped_cells};

/// A shape that a grid can list.
pub(super) trait Listed: Pod + Sync {
    /// The coarse shape around the part of this shape in a cell, in one word or two. A ray that misses it needs no test
    /// of the shape. The highest bit of the last word is free.
    type Guard: Pod;

    /// The number of guards in a vector of four words. Lists are padded to whole vectors.
    const PER_VECTOR: usize = size_of::<[u32; 4]>() / size_of::<Self::Guard>();

    /// The cost of a step from cell to cell, as a number of list elements.
    const STEP_COST: f32;

    /// The number of cells with edge length `size` that the shape overlaps, averaged over all positions.
    fn mean_overlapped_cells(&self, size: f32) -> f32;

    /// Calls `f` with the index of every cell within `margin` of the shape's surface, and maybe of a few others. The
    /// cells may cover only a part of the shape.
    fn for_each_near(&self, cells: &Cells, margin: f32, f: impl FnMut(usize));

    /// The guard in the cell of a frame.
    fn guard(&self, frame: &BallFrame) -> Self::Guard;
}

impl Listed for [f32; 4] {
    type Guard = u32;

    /// Measured on lavapipe with a million random spheres, where the time hardly changes between eight and sixteen.
    const STEP_COST: f32 = 12.0;

    fn mean_overlapped_cells(&self, size: f32) -> f32 {
        mean_overlapped_cells(size, self[3])
    }

    fn for_each_near(&self, cells: &Cells, margin: f32, f: impl FnMut(usize)) {
        Cells::for_each_near(cells, self, margin, false, &(0..cells.rows()), f);
    }

    fn guard(&self, frame: &BallFrame) -> u32 {
        frame.ball(*self)
    }
}

/// The number of elements of a list of `len` shapes, padded to whole vectors of guards.
pub(super) const fn elements<T: Listed>(len: usize) -> usize {
    len.next_multiple_of(T::PER_VECTOR)
}
