//! Cubic cells, and which of them a sphere's surface meets.

use glam::Vec3;

/// Cells along the side of a block: its spheres fit into a processor's nearest cache, or two of its pages.
const BLOCK: u32 = 4;

/// Of how many cells along x a sphere's distances are kept from row to row.
const KNOWN: usize = 4;

/// A box of equal cubes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cells {
    /// The corner with the smallest coordinates.
    pub(super) min: Vec3,
    /// The edge of a cell.
    pub(super) size: f32,
    /// How many cells there are along each axis.
    pub(super) counts: [u32; 3],
}

impl Cells {
    pub(super) fn len(&self) -> usize {
        self.counts.iter().map(|count| *count as usize).product()
    }

    /// The cell that holds a point, or the nearest one.
    fn coordinates(&self, at: Vec3) -> [u32; 3] {
        let cells = (at - self.min) / self.size;
        let [width, height, depth] = self.counts;
        // A float is cast to the nearest u32, so what lies below becomes 0.
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

    /// How many numbers [`Self::index_in_blocks`] may give.
    pub(super) fn len_in_blocks(&self) -> usize {
        self.counts.iter().map(|count| count.next_multiple_of(BLOCK) as usize).product()
    }

    /// A number for the cell of a sphere's centre, such that cells near each other in space, along any axis,
    /// have numbers near each other: block by block.
    pub(super) fn index_in_blocks(&self, sphere: &[f32; 4]) -> usize {
        let coordinates = self.coordinates(Vec3::new(sphere[0], sphere[1], sphere[2]));
        let blocks = self.counts.map(|count| count.div_ceil(BLOCK));
        let join = |[x, y, z]: [u32; 3], [width, height]: [u32; 2]| {
            (z as usize * height as usize + y as usize) * width as usize + x as usize
        };
        let block = join(coordinates.map(|i| i / BLOCK), [blocks[0], blocks[1]]);
        block * BLOCK.pow(3) as usize + join(coordinates.map(|i| i % BLOCK), [BLOCK, BLOCK])
    }

    /// As [`Self::met_by`], for cells that are only a part of what the sphere may meet: a sphere beside
    /// them meets none.
    pub(super) fn met_by_clipped(&self, sphere: &[f32; 4], margin: f32, meet: impl FnMut(usize)) {
        // The nearest cell is only met if the exact test says so.
        self.meet(sphere, margin, false, meet);
    }

    /// Calls `meet` with every cell that lies within `margin` of the sphere's surface.
    ///
    /// A cell wholly inside is left out: a ray meets nothing of the sphere there. So a large sphere
    /// is listed in as many cells as its surface crosses, not in as many as it holds; all of them are looked at.
    pub(super) fn met_by(&self, sphere: &[f32; 4], margin: f32, meet: impl FnMut(usize)) {
        self.meet(sphere, margin, true, meet);
    }

    fn meet(&self, sphere: &[f32; 4], margin: f32, is_within: bool, mut meet: impl FnMut(usize)) {
        let &[x, y, z, radius] = sphere;
        let center = [x, y, z];
        let outer = radius + margin;
        let inner = (radius - margin).max(0.0);
        let first = self.coordinates(Vec3::from(center) - outer);
        let last = self.coordinates(Vec3::from(center) + outer);
        if is_within && first == last {
            return meet(self.index(first));
        }
        // Squared distances along an axis from the centre to the near and the far side of a cell.
        let along = |axis: usize, i: u32| {
            let low = self.min[axis] + i as f32 * self.size - center[axis];
            let high = low + self.size;
            let near = low.max(-high).max(0.0);
            let far = high.max(-low);
            (near * near, far * far)
        };
        let (outer, inner) = (outer * outer, inner * inner);
        // Of the first cells along x, which every row has again; most spheres meet no others.
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
                        meet(self.index([i, j, k]));
                    }
                }
            }
        }
    }
}

/// How many cells of edge `size`, on average over all positions, the surface of a sphere of this radius
/// meets.
///
/// By Minkowski's sum: the centres of the cells that meet a ball fill the volume
/// size³ + 6 size² r + 3π size r² + 4/3 π r³ (Steiner's formula for a cube), less about a ball whose radius
/// is shorter by half a cell's diagonal, where the cells are wholly inside.
pub(super) fn mean_cells_met(size: f32, radius: f32) -> f32 {
    const BALL: f32 = 4.188_790_2;
    let r = radius / size;
    let inside = (r - 0.866).max(0.0);
    1.0 + r * (6.0 + r * (9.424_778 + r * BALL)) - BALL * inside * inside * inside
}
