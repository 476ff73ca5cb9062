//! Cubic cells, and the cells that the surface of a sphere overlaps.

use std::ops::Range;

use glam::Vec3;

/// The number of cells along x for which distances to a sphere are computed once and reused in every row.
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

    /// The cell that contains a point; for points outside, the nearest cell.
    fn coordinates(&self, at: Vec3) -> [u32; 3] {
        let cells = (at - self.min) / self.size;
        let [width, height, depth] = self.counts;
        // A cast to u32 saturates, so negative values become 0.
        [
            (cells.x as u32).min(width - 1),
            (cells.y as u32).min(height - 1),
            (cells.z as u32).min(depth - 1),
        ]
    }

    pub(super) fn index(&self, [x, y, z]: [u32; 3]) -> usize {
        let [width, height, _] = self.counts.map(|count| count as usize);
        (z as usize * height + y as usize) * width + x as usize
    }

    /// The number of rows of cells along x; those of a layer follow each other.
    pub(super) fn rows(&self) -> usize {
        self.counts[1] as usize * self.counts[2] as usize
    }

    /// Calls `f` with the first and the last row, in each layer, of a box of cells that contains all within `margin` of
    /// the sphere's surface. Rows ascend.
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

    /// Like [`Self::for_each_near`] for all rows of cells that may cover only a part of the sphere: a sphere outside has
    /// no cells.
    pub(super) fn for_each_near_clipped(
        &self,
        sphere: &[f32; 4],
        margin: f32,
        f: impl FnMut(usize),
    ) {
        // The clamped range of cells may contain cells that the exact test rejects.
        self.for_each_in_range(sphere, margin, false, &(0..self.rows()), f);
    }

    /// Calls `f` with the index of every cell that lies within `margin` of the sphere's surface, in some rows.
    ///
    /// Cells that are completely inside are left out, because a ray cannot hit the sphere there. A large sphere is
    /// therefore listed only in the cells that its surface crosses, although all cells inside are examined.
    pub(super) fn for_each_near(
        &self,
        sphere: &[f32; 4],
        margin: f32,
        rows: &Range<usize>,
        f: impl FnMut(usize),
    ) {
        self.for_each_in_range(sphere, margin, true, rows, f);
    }

    fn for_each_in_range(
        &self,
        sphere: &[f32; 4],
        margin: f32,
        is_within: bool,
        rows: &Range<usize>,
        mut f: impl FnMut(usize),
    ) {
        let &[x, y, z, radius] = sphere;
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
        // The distances of the first cells along x, which are the same in every row; most spheres overlap no other
        // cells.
        let known: [(f32, f32); KNOWN] = std::array::from_fn(|i| along(0, first[0] + i as u32));
        // Other layers have none of the rows.
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
/// By Minkowski sums: the centres of the cells that overlap a ball fill the volume size³ + 6 size² r + 3π size r² + 4/3
/// π r³ (Steiner's formula for a cube). Subtracted is approximately a ball whose radius is smaller by half the diagonal
/// of a cell, because the cells inside it are completely inside the sphere.
pub(super) fn mean_overlapped_cells(size: f32, radius: f32) -> f32 {
    const BALL: f32 = 4.188_790_2;
    let r = radius / size;
    let inside = (r - 0.866).max(0.0);
    1.0 + r * (6.0 + r * (9.424_778 + r * BALL)) - BALL * inside * inside * inside
}
