//! Splitting a set of spheres in two at the lowest expected cost of rays.
//!
//! The method is the surface area heuristic with bins of Wald, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies" (2007), along the longest axis of the centres only. The set is split in half by number if this finds no
//! split, as among coincident centres, and wherever a tree must not become deeper.
use glam::{Vec3, Vec3A};

use super::statistics::Margins;
use crate::geometry::cone::ConeInFrame;

/// A box in the scene's frame, in f32. [`Extent::EMPTY`] contains nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
}

impl Extent {
    pub(super) const EMPTY: Self = Self { low: Vec3A::splat(f32::MAX), high: Vec3A::splat(f32::MIN) };

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

    /// The axis, 0 to 2, along which the box is longest. If several are equal, the first of them.
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

/// How far a shape reaches from its centre along each axis: one number for spheres, three for others.
pub(super) trait Reach: Copy + Send + Sync {
    fn along(self) -> Vec3A;
}

impl Reach for f32 {
    #[inline]
    fn along(self) -> Vec3A {
        Vec3A::splat(self)
    }
}

impl Reach for [f32; 3] {
    #[inline]
    fn along(self) -> Vec3A {
        self.into()
    }
}

/// A shape during the building of a tree, with the data needed for sorting and for bounding boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item<R> {
    pub(super) center: [f32; 3],
    /// At least radius plus margin, and large enough that `center ± reach` in f32 contains the inflated shape.
    pub(super) reach: R,
    /// Index in input order.
    pub(super) id: u32,
}

impl Item<[f32; 3]> {
    /// Makes one item for every cone.
    pub(super) fn of_cones(cones: &[ConeInFrame], margin: f32) -> Vec<Self> {
        let item = |(id, cone): (usize, &ConeInFrame)| {
            let [low, high] = cone.corners();
            let center = (0.5 * (low + high)).as_vec3();
            let largest = low.abs().max(high.abs()).max_element().max(margin.into());
            // Roundings of numbers that are at most 4 · largest: of the centre and the reach, and of their sum.
            let slack = f64::from(margin) + largest * f64::from(8.0 * f32::EPSILON);
            let reach = (0.5 * (high - low) + slack).as_vec3().to_array();
            Self { center: center.to_array(), reach, id: id as u32 }
        };
        cones.iter().enumerate().map(item).collect()
    }
}

impl Item<f32> {
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
}

impl<R: Reach> Item<R> {
    #[inline]
    pub(super) fn center(&self) -> Vec3A {
        Vec3::from_array(self.center).into()
    }

    #[inline]
    pub(super) fn extent(&self) -> Extent {
        let (center, reach) = (self.center(), self.reach.along());
        Extent { low: center - reach, high: center + reach }
    }

    /// The bounding box of the items, and the bounding box of their centres.
    pub(super) fn extents(items: &[Self]) -> (Extent, Extent) {
        items.iter().fold((Extent::EMPTY, Extent::EMPTY), |(boxes, centers), item| {
            (boxes.union(item.extent()), centers.with_point(item.center()))
        })
    }

    /// Reorders the items so that the first `at` have the smallest centres along an axis. Items with equal centres are
    /// ordered by id, so that the result depends only on the spheres.
    pub(super) fn select(items: &mut [Self], at: usize, axis: usize) {
        if at < items.len() {
            items.select_nth_unstable_by(at, |a, b| a.center[axis].total_cmp(&b.center[axis]).then(a.id.cmp(&b.id)));
        }
    }
}

const BINS: usize = 16;

/// A set of shapes, their bounding box, and the bounding box of their centres.
#[derive(Debug)]
pub(super) struct Cluster<'a, R> {
    pub(super) items: &'a mut [Item<R>],
    pub(super) extent: Extent,
    pub(super) centers: Extent,
}

impl<'a, R: Reach> Cluster<'a, R> {
    pub(super) fn new(items: &'a mut [Item<R>]) -> Self {
        let (extent, centers) = Item::extents(items);
        Self { items, extent, centers }
    }

    pub(super) fn len(&self) -> usize {
        self.items.len()
    }

    /// Splits the set into the `at` spheres with the smallest centres along the longest axis, and the others.
    pub(super) fn split_at(self, at: usize) -> (Self, Self) {
        let axis = self.centers.longest_axis();
        Item::select(self.items, at, axis);
        let (first, second) = self.items.split_at_mut(at);
        (Self::new(first), Self::new(second))
    }

    /// Splits the set where the surface area heuristic is lowest, or in half if it finds no split.
    pub(super) fn split_by_cost(self) -> (Self, Self) {
        let axis = self.centers.longest_axis();
        let low = self.centers.low[axis];
        let scale = BINS as f32 / (self.centers.high[axis] - low);
        // The conversion saturates and turns NaN into 0.
        let bin_of = |item: &Item<R>| (((item.center[axis] - low) * scale) as usize).min(BINS - 1);
        let mut bins = [Bin::EMPTY; BINS];
        for item in self.items.iter() {
            let bin = &mut bins[bin_of(item)];
            bin.count += 1;
            bin.extent = bin.extent.union(item.extent());
            bin.centers = bin.centers.with_point(item.center());
        }
        let Some((cut, before, after)) = cheapest_cut(&bins) else {
            let half = self.len().div_ceil(2);
            return self.split_at(half);
        };
        let at = partition(self.items, |item| bin_of(item) < cut);
        let (first, second) = self.items.split_at_mut(at);
        let cluster = |items, bin: Bin| Cluster { items, extent: bin.extent, centers: bin.centers };
        (cluster(first, before), cluster(second, after))
    }
}

#[derive(Clone, Copy, Debug)]
struct Bin {
    count: usize,
    extent: Extent,
    centers: Extent,
}

impl Bin {
    const EMPTY: Self = Self { count: 0, extent: Extent::EMPTY, centers: Extent::EMPTY };

    fn union(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            extent: self.extent.union(other.extent),
            centers: self.centers.union(other.centers),
        }
    }

    fn cost(&self) -> f32 {
        self.extent.half_area() * self.count as f32
    }
}

/// The first bin after the cheapest split, and the unions of the bins before and after it. `None` if all spheres are in
/// one bin, or every cost overflows.
fn cheapest_cut(bins: &[Bin; BINS]) -> Option<(usize, Bin, Bin)> {
    let mut after = [Bin::EMPTY; BINS + 1];
    for i in (0..BINS).rev() {
        after[i] = after[i + 1].union(bins[i]);
    }
    let mut best = (f32::MAX, None);
    let mut before = Bin::EMPTY;
    for cut in 1..BINS {
        before = before.union(bins[cut - 1]);
        if before.count == 0 || after[cut].count == 0 {
            continue;
        }
        let cost = before.cost() + after[cut].cost();
        if cost < best.0 {
            best = (cost, Some((cut, before, after[cut])));
        }
    }
    best.1
}

/// Moves the items for which `first` is true to the front, and returns their number.
fn partition<R>(items: &mut [Item<R>], first: impl Fn(&Item<R>) -> bool) -> usize {
    let (mut low, mut high) = (0, items.len());
    while low < high {
        if first(&items[low]) {
            low += 1;
        } else {
            high -= 1;
            items.swap(low, high);
        }
    }
    low
}
