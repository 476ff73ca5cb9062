//! Bounding boxes that are used while a tree is built.

use glam::{Vec3, Vec3A};

use super::outliers::Margins;

/// A box in the scene's frame, in f32; [`Extent::EMPTY`] contains nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
}

impl Extent {
    pub(super) const EMPTY: Self =
        Self { low: Vec3A::splat(f32::MAX), high: Vec3A::splat(f32::MIN) };

    #[inline]
    pub(super) fn with_point(self, point: Vec3A) -> Self {
        Self { low: self.low.min(point), high: self.high.max(point) }
    }

    #[inline]
    pub(super) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    #[inline]
    pub(super) fn center(self) -> Vec3A {
        0.5 * self.low + 0.5 * self.high
    }

    /// Half of the surface area, or zero if the box is empty. A length is at most 2⁵⁹, so nothing overflows.
    #[inline]
    pub(super) fn half_area(self) -> f32 {
        let size = (self.high - self.low).max(Vec3A::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    /// The axis, 0 to 2, along which the box is longest; the first axis if several are equal.
    #[inline]
    pub(super) fn longest_axis(self) -> usize {
        let size = self.high - self.low;
        if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        }
    }
}

/// A sphere while a tree is built, with the data needed for sorting and for bounding boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) center: [f32; 3],
    /// At least radius plus margin, and large enough that `center ± reach` in f32 contains the inflated sphere.
    pub(super) reach: f32,
    /// Index in input order.
    pub(super) id: u32,
}

impl Item {
    /// Makes one item for every sphere (centre, radius).
    pub(super) fn all(spheres: &[[f32; 4]], margins: &Margins) -> Vec<Self> {
        let item = |(id, sphere): (usize, &[f32; 4])| {
            let [x, y, z, radius] = *sphere;
            let margin = margins.of(sphere);
            let largest = sphere.iter().fold(margin, |largest, x| largest.max(x.abs()));
            // Three roundings of numbers that are at most 4 · largest: two in `reach` and one in `center ± reach`.
            let roundings = largest * (8.0 * f32::EPSILON);
            // A scene has fewer than 2³² spheres.
            Self { center: [x, y, z], reach: radius + margin + roundings, id: id as u32 }
        };
        spheres.iter().enumerate().map(item).collect()
    }

    #[inline]
    pub(super) fn center(&self) -> Vec3A {
        Vec3::from_array(self.center).into()
    }

    #[inline]
    pub(super) fn extent(&self) -> Extent {
        let (center, reach) = (self.center(), Vec3A::splat(self.reach));
        Extent { low: center - reach, high: center + reach }
    }

    /// The bounding box of the items, and that of their centres.
    pub(super) fn extents(items: &[Self]) -> (Extent, Extent) {
        items.iter().fold((Extent::EMPTY, Extent::EMPTY), |(boxes, centers), item| {
            (boxes.union(item.extent()), centers.with_point(item.center()))
        })
    }

    /// Reorders the items so that the first `at` have the smallest centres along an axis. Items with equal centres are
    /// ordered by id, so that the result depends only on the spheres.
    pub(super) fn select(items: &mut [Self], at: usize, axis: usize) {
        if at < items.len() {
            items.select_nth_unstable_by(at, |a, b| {
                a.center[axis].total_cmp(&b.center[axis]).then(a.id.cmp(&b.id))
            });
        }
    }
}
