//! Cubic cells, and the cells that the surface of a sphere overlaps.

use glam::Vec3;

/// The number of cells along each side of a block: the spheres of a block fit into a processor's L1 cache, or into two
/// pages.
const BLOCK: u32 = 4;

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

    fn index(&self, [x, y, z]: [u32; 3]) -> usize {
        let [width, height, _] = self.counts.map(|count| count as usize);
        (z as usize * height + y as usize) * width + x as usize
    }

    /// An upper bound for [`Self::index_in_blocks`].
    pub(super) fn len_in_blocks(&self) -> usize {
        self.counts.iter().map(|count| count.next_multiple_of(BLOCK) as usize).product()
    }

    /// An index of the cell of a sphere's centre, such that cells that are close in space, along any axis, have close
    /// indices: block by block.
    pub(super) fn index_in_blocks(&self, sphere: &[f32; 4]) -> usize {
        let coordinates = self.coordinates(Vec3::new(sphere[0], sphere[1], sphere[2]));
        let blocks = self.counts.map(|count| count.div_ceil(BLOCK));
        let join = |[x, y, z]: [u32; 3], [width, height]: [u32; 2]| {
            (z as usize * height as usize + y as usize) * width as usize + x as usize
        };
        let block = join(coordinates.map(|i| i / BLOCK), [blocks[0], blocks[1]]);
        block * BLOCK.pow(3) as usize + join(coordinates.map(|i| i % BLOCK), [BLOCK, BLOCK])
    }

    /// Like [`Self::for_each_near`], for cells that may cover only a part of the sphere: a sphere outside has no cells.
    pub(super) fn for_each_near_clipped(
        &self,
        sphere: &[f32; 4],
        margin: f32,
        f: impl FnMut(usize),
    ) {
        // The clamped range of cells may contain cells that the exact test rejects.
        self.for_each_in_range(sphere, margin, false, f);
    }

    /// Calls `f` with the index of every cell that lies within `margin` of the sphere's surface.
    ///
    /// Cells that are completely inside are left out, because a ray cannot hit the sphere there. A large sphere is
    /// therefore listed only in the cells that its surface crosses, although all cells inside are examined.
    pub(super) fn for_each_near(&self, sphere: &[f32; 4], margin: f32, f: impl FnMut(usize)) {
        self.for_each_in_range(sphere, margin, true, f);
    }

    fn for_each_in_range(
        &self,
        sphere: &[f32; 4],
        margin: f32,
        is_within: bool,
        mut f: impl FnMut(usize),
    ) {
        let &[x, y, z, radius] = sphere;
        let center = [x, y, z];
        let outer = radius + margin;
        let inner = (radius - margin).max(0.0);
        let first = self.coordinates(Vec3::from(center) - outer);
        let last = self.coordinates(Vec3::from(center) + outer);
        if is_within && first == last {
            return f(self.index(first));
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
        for k in first[2]..=last[2] {
            let (near_z, far_z) = along(2, k);
            for j in first[1]..=last[1] {
                let (near_y, far_y) = along(1, j);
                let (near_yz, far_yz) = (near_y + near_z, far_y + far_z);
                if near_yz > outer {
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
