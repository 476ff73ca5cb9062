//! Splitting a set of spheres in two at the lowest expected cost of rays.
//!
//! The method is the surface area heuristic with bins of Wald, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies" (2007), along the longest axis of the centres only. If it finds no split, as among coincident centres,
//! and wherever a tree must not become deeper, the set is split in half by number.

use super::extent::{Extent, Item};

const BINS: usize = 16;

/// A set of spheres, the bounding box of these, and that of their centres.
#[derive(Debug)]
pub(super) struct Cluster<'a> {
    pub(super) items: &'a mut [Item],
    pub(super) extent: Extent,
    pub(super) centers: Extent,
}

impl<'a> Cluster<'a> {
    pub(super) fn new(items: &'a mut [Item]) -> Self {
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
        // The conversion saturates, and turns NaN into 0.
        let bin_of = |item: &Item| (((item.center[axis] - low) * scale) as usize).min(BINS - 1);
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

/// The first bin after the cheapest split, and the union of the bins before and after it; `None` if all spheres are in
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
fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) -> usize {
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
