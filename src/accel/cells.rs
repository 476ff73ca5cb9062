//! Cubic cells, and two searches for the cells that a sphere's surface overlaps: a full one, and a fast one for most
//! spheres.

use std::ops::Range;

use glam::{Vec3, Vec3A};

/// The number of cells along x whose distances to a sphere are computed once and reused in every row.
const KNOWN: usize = 4;

/// A box of equal cubic cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cells {
    /// The corner with the smallest coordinates.
    pub(super) min: Vec3,
    /// The edge length of a cell.
    pub(super) size: f32,
    /// The number of cells along each axis.
    pub(super) counts: [u32; 3],
}

impl Cells {
    pub(super) fn len(&self) -> usize {
        self.counts.iter().map(|count| *count as usize).product()
    }

    /// The cell that contains a point. For points outside, the nearest cell.
    fn coordinates(&self, at: Vec3) -> [u32; 3] {
        let cells = (at - self.min) / self.size;
        let [width, height, depth] = self.counts;
        // A cast to u32 saturates, so negative values become 0.
        [(cells.x as u32).min(width - 1), (cells.y as u32).min(height - 1), (cells.z as u32).min(depth - 1)]
    }

    pub(super) fn index(&self, [x, y, z]: [u32; 3]) -> usize {
        let [width, height, _] = self.counts.map(|count| count as usize);
        (z as usize * height + y as usize) * width + x as usize
    }

    /// The number of rows of cells along x. The rows of a layer are consecutive.
    pub(super) fn rows(&self) -> usize {
        self.counts[1] as usize * self.counts[2] as usize
    }

    /// Calls `f` with the first and the last row, in each layer, of a box of cells. The box contains all points within
    /// `margin` of the sphere's surface. Rows ascend.
    pub(super) fn for_each_range_of_rows(
        &self,
        &[x, y, z, radius]: &[f32; 4],
        margin: f32,
        mut f: impl FnMut(usize, usize),
    ) {
        let (center, outer) = (Vec3::new(x, y, z), radius + margin);
        let first = self.coordinates(center - outer);
        let last = self.coordinates(center + outer);
        for k in first[2]..=last[2] {
            let row = |y: u32| k as usize * self.counts[1] as usize + y as usize;
            f(row(first[1]), row(last[1]));
        }
    }

    /// Calls `f` with the index of every cell within `margin` of the sphere's surface, in the given rows. `is_within`
    /// must be false if the cells cover only a part of the sphere. The clamped range of cells may then contain cells
    /// that the exact test rejects.
    ///
    /// Cells that are completely inside are left out, because a ray cannot hit the sphere there. A large sphere is
    /// therefore listed only in the cells that its surface crosses, although all cells inside are examined.
    pub(super) fn for_each_near(
        &self,
        &[x, y, z, radius]: &[f32; 4],
        margin: f32,
        is_within: bool,
        rows: &Range<usize>,
        mut f: impl FnMut(usize),
    ) {
        let center = [x, y, z];
        let outer = radius + margin;
        let inner = (radius - margin).max(0.0);
        let first = self.coordinates(Vec3::from(center) - outer);
        let last = self.coordinates(Vec3::from(center) + outer);
        let height = self.counts[1];
        let rows = rows.start as u32..rows.end as u32;
        if is_within && first == last {
            if rows.contains(&(first[2] * height + first[1])) {
                f(self.index(first));
            }
            return;
        }
        // Squared distances along an axis from the centre to the near side and to the far side of a cell.
        let along = |axis: usize, i: u32| {
            let low = self.min[axis] + i as f32 * self.size - center[axis];
            let high = low + self.size;
            let near = low.max(-high).max(0.0);
            let far = high.max(-low);
            (near * near, far * far)
        };
        let (outer, inner) = (outer * outer, inner * inner);
        // The distances of the first cells along x are the same in every row. Most spheres overlap no other cells.
        let known: [(f32, f32); KNOWN] = std::array::from_fn(|i| along(0, first[0] + i as u32));
        // Other layers contain none of the rows.
        let layers = first[2].max(rows.start / height)..=last[2].min((rows.end - 1) / height);
        for k in layers {
            let (near_z, far_z) = along(2, k);
            for j in first[1]..=last[1] {
                let (near_y, far_y) = along(1, j);
                let (near_yz, far_yz) = (near_y + near_z, far_y + far_z);
                if near_yz > outer || !rows.contains(&(k * height + j)) {
                    continue;
                }
                for i in first[0]..=last[0] {
                    let step = (i - first[0]) as usize;
                    let (near_x, far_x) = known.get(step).copied().unwrap_or_else(|| along(0, i));
                    if near_x + near_yz <= outer && far_x + far_yz >= inner {
                        f(self.index([i, j, k]));
                    }
                }
            }
        }
    }
}

/// The number of cells with edge length `size` that the surface of a sphere of this radius overlaps, averaged over all
/// positions.
///
/// The formula uses Minkowski sums. The centres of the cells that overlap a solid sphere fill the volume size³ + 6
/// size² r + 3π size r² + 4/3 π r³ (Steiner's formula for a cube). A solid sphere whose radius is smaller by half a
/// cell's diagonal is subtracted, because the cells inside it are about those completely inside the sphere.
pub(super) fn mean_overlapped_cells(size: f32, radius: f32) -> f32 {
    const BALL: f32 = 4.188_790_2;
    let r = radius / size;
    let inside = (r - 0.866).max(0.0);
    1.0 + r * (6.0 + r * (9.424_778 + r * BALL)) - BALL * inside * inside * inside
}

/// The number of cells along each side of a block. The spheres of a block fit into a processor's L1 cache, or into two
/// pages.
const BLOCK: usize = 4;

/// A box of cells, with precomputed values for searching it. A grid's builder looks up several cells of every sphere,
/// so the cells of points are computed on vectors, as fast as a processor divides. The result equals that of dividing
/// each coordinate, to the bit.
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

    /// The coordinates of the cell that contains a point, not yet rounded down. For points outside, those of the
    /// nearest cell.
    pub(super) fn coordinates(&self, at: Vec3A) -> Vec3A {
        ((at - self.min) / self.size).max(Vec3A::ZERO).min(self.last)
    }

    /// The index of the cell with the given coordinates.
    pub(super) fn index(&self, coordinates: Vec3A) -> usize {
        let [x, y, z] = whole(coordinates);
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// An upper bound of [`Self::index_in_blocks`].
    pub(super) fn len_in_blocks(&self) -> usize {
        self.blocks.iter().product::<usize>() * BLOCK.pow(3)
    }

    /// An index of the cell of a sphere's centre, block by block, so that cells close in space along any axis have
    /// close indices.
    pub(super) fn index_in_blocks(&self, &[x, y, z, _]: &[f32; 4]) -> usize {
        let [x, y, z] = whole(self.coordinates(Vec3A::new(x, y, z)));
        let [width, height, _] = self.blocks;
        let block = (z / BLOCK * height + y / BLOCK) * width + x / BLOCK;
        ((block * BLOCK + z % BLOCK) * BLOCK + y % BLOCK) * BLOCK + x % BLOCK
    }
}

/// Rounds down coordinates, which must be at least 0 and less than 2²⁴.
fn whole(coordinates: Vec3A) -> [usize; 3] {
    // A cast to i32 is faster than one to larger integers.
    coordinates.to_array().map(|x| x as i32 as usize)
}

/// The cells that the surface of a sphere overlaps, in 32 bits. A grid's builder needs them three times: to assign
/// spheres to slabs, to count, and to fill lists. It finds them once, on vectors, as [`Cells::for_each_near`] does.
///
/// The value holds the first of eight cells that form a cube, which has the smallest coordinates, and a bit for each
/// cell that the sphere overlaps. Bit i of a cell's number is set if it is the second along axis i. If the sphere may
/// overlap other cells as well, no bit is set, and [`Cells::for_each_near`] must find the cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Octet(u32);

impl Octet {
    /// Finds the cells of a grid, which has at most 2²⁴, that lie within `margin` of the sphere's surface.
    pub(super) fn of(&[x, y, z, radius]: &[f32; 4], cells: &CellVectors, margin: f32) -> Self {
        let center = Vec3A::new(x, y, z);
        let (outer, inner) = (radius + margin, (radius - margin).max(0.0));
        let first = cells.coordinates(center - outer).trunc();
        let last = cells.coordinates(center + outer).trunc();
        let start = cells.index(first) as u32;
        if first == last {
            return Self(start << 8 | 1);
        }
        let second = first + 1.0;
        if last.cmpgt(second).any() {
            return Self(0);
        }
        // Squared distances along all axes from the centre to the near side and to the far side of a cell.
        let along = |cell: Vec3A| {
            let low = cells.min + cell * cells.size - center;
            let high = low + cells.size;
            let (near, far) = (low.max(-high).max(Vec3A::ZERO), high.max(-low));
            (near * near, far * far)
        };
        let ((near, far), (second_near, second_far)) = (along(first), along(second));
        // A second cell that does not exist is too far away.
        let second_near = Vec3A::select(last.cmpgt(first), second_near, Vec3A::INFINITY);
        let (near, far) = ([near, second_near], [far, second_far]);
        let (outer, inner) = (outer * outer, inner * inner);
        let mut overlapped = 0;
        for number in 0..8 {
            let [i, j, k] = [number & 1, number >> 1 & 1, number >> 2];
            let is_near = near[i].x + (near[j].y + near[k].z) <= outer;
            let is_far = far[i].x + (far[j].y + far[k].z) >= inner;
            overlapped |= u32::from(is_near & is_far) << number;
        }
        Self(start << 8 | overlapped)
    }

    /// Whether the overlapped cells are known.
    pub(super) fn is_known(self) -> bool {
        self.0 & 255 != 0
    }

    /// The first of the eight cells.
    pub(super) fn first(self) -> usize {
        (self.0 >> 8) as usize
    }

    /// The last of the overlapped cells.
    pub(super) fn last(self, strides: &Strides) -> usize {
        self.first() + strides.0[(self.0 & 255 | 1).ilog2() as usize]
    }

    /// Calls `f` with the overlapped cells. `strides` are those of the same grid.
    pub(super) fn for_each(self, strides: &Strides, mut f: impl FnMut(usize)) {
        let mut left = self.0 & 255;
        while left != 0 {
            f(self.first() + strides.0[left.trailing_zeros() as usize & 7]);
            left &= left - 1;
        }
    }
}

/// For each of the eight cells, the difference between its index and that of the first.
pub(super) struct Strides([usize; 8]);

impl Strides {
    pub(super) fn of(cells: &Cells) -> Self {
        let [width, height, _] = cells.counts.map(|count| count as usize);
        Self(std::array::from_fn(|number| ((number >> 2) * height + (number >> 1 & 1)) * width + (number & 1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells of all numbers, and spheres of all sizes in and around them. Some spheres end exactly at cells' sides.
    #[test]
    fn cells_are_those_of_the_full_search() {
        let mut rng = fastrand::Rng::with_seed(1);
        let (mut known, mut several) = (0, 0);
        for round in 0..100_000 {
            let counts = [rng.u32(1..6), rng.u32(1..6), rng.u32(1..6)];
            let size = 2_f32.powi(rng.i32(-3..3)) * if rng.bool() { 1.0 } else { 1.1 };
            let cells = Cells { min: Vec3::new(-1.0, 0.5, 3.25), size, counts };
            let steps = if rng.bool() { 4.0 } else { 1024.0 };
            let mut at = |most: f32| (rng.f32() * most * steps).round() / steps * size;
            let [x, y, z] = [0, 1, 2].map(|axis| cells.min[axis] + at(counts[axis] as f32));
            let (radius, margin) = (at(0.8), if round % 3 == 0 { 0.0 } else { 1e-3 * size });
            let sphere = [x, y, z, radius];
            let octet = Octet::of(&sphere, &CellVectors::of(&cells), margin);
            if octet.is_known() {
                let (mut found, mut expected) = (Vec::new(), Vec::new());
                octet.for_each(&Strides::of(&cells), |cell| found.push(cell));
                let rows = 0..cells.rows();
                cells.for_each_near(&sphere, margin, true, &rows, |cell| expected.push(cell));
                assert_eq!(found, expected, "{sphere:?} {cells:?}");
                known += 1;
                several += usize::from(found.len() > 1);
            }
        }
        assert!(several > 20_000 && known < 95_000, "{several} {known}");
    }
}
