//! The cells that the surface of a sphere overlaps, in 32 bits: of most spheres, they are among eight.
//!
//! A grid's builder needs these cells three times: to assign spheres to slabs, to count, and to fill lists. It finds them
//! once, with the arithmetic of [`Cells::for_each_near`], on vectors.

use glam::Vec3A;

use super::cell_vectors::CellVectors;
use super::cells::Cells;

/// The cell with the smallest coordinates of eight that form a cube, and a bit for each of them that a sphere overlaps. Bit i of
/// a cell's number is set if it is the second along axis i. No bit is set if the sphere may overlap other cells as well,
/// and [`Cells::for_each_near`] must tell which.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Octet(u32);

impl Octet {
    /// The cells of a grid, of which there are at most 2²⁴, that lie within `margin` of the sphere's surface.
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
        // No distance to a second cell that is not there is short enough.
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

    /// Whether the cells are known.
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

    /// Calls `f` with the overlapped cells. `strides` are the differences between cells that are neighbours along axes.
    pub(super) fn for_each(self, strides: &Strides, mut f: impl FnMut(usize)) {
        let mut left = self.0 & 255;
        while left != 0 {
            f(self.first() + strides.0[left.trailing_zeros() as usize & 7]);
            left &= left - 1;
        }
    }
}

/// The differences between the index of each of eight cells and that of the first.
pub(super) struct Strides([usize; 8]);

impl Strides {
    pub(super) fn of(cells: &Cells) -> Self {
        let [width, height, _] = cells.counts.map(|count| count as usize);
        Self(std::array::from_fn(|number| {
            ((number >> 2) * height + (number >> 1 & 1)) * width + (number & 1)
        }))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// Cells of all numbers, and spheres of all sizes in and around them, of which some end at cells' sides.
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
                cells.for_each_near(&sphere, margin, &rows, |cell| expected.push(cell));
                assert_eq!(found, expected, "{sphere:?} {cells:?}");
                known += 1;
                several += usize::from(found.len() > 1);
            }
        }
        assert!(several > 20_000 && known < 95_000, "{several} {known}");
    }
}
