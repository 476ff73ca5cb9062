//! Lists of the spheres that may be seen in each tile of a picture, the nearest first, in slabs of depth.
//!
//! A slab holds the spheres whose near distances (`tiles.rs`) follow those of the slab before it. After a slab is traced,
//! the tiles in which all pixels have nearer hits than the next slab are done, and its spheres are listed in the others
//! only. In crowded scenes most spheres are behind those of the first slabs, and are never listed.

use super::bricks::{Brick, Index};
use super::tiles::{TileLists, TileRange, TileView};
use crate::parallel::{map_chunks, map_parts};

/// Spheres for which a picture is a single slab.
const ONE_SLAB: usize = 1 << 18;

/// The first of several slabs has one in this many spheres. Each later one has twice as many as that before it.
const FIRST_SLAB: usize = 10;

/// Spheres whose near distances say where slabs end.
const SAMPLES: usize = 1 << 12;

/// The most spheres in a list. Kernels go through a list in one dispatch, in which few iterations are allowed.
const LONGEST: u32 = 4096;

/// The most bricks of a picture. Where spheres lie so dense that more would be needed, another structure is better.
const MOST_BRICKS: usize = 48;

/// The most places in one brick.
pub(crate) const MOST_PLACES: usize = 1 << 22;

/// The most places in one brick of a scene with some spheres.
pub(crate) fn most_places(spheres: usize) -> usize {
    spheres.saturating_mul(4).saturating_add(1 << 18).min(MOST_PLACES)
}

/// The mean number of tiles in which a sphere may be seen.
pub(crate) fn mean_tiles(view: &TileView, spheres: &[[f32; 4]]) -> f64 {
    let stride = spheres.len().div_ceil(SAMPLES).max(1);
    let counts = spheres.iter().step_by(stride).map(|sphere| view.range(*sphere).map_or(0, |range| range.count()));
    let (sum, sampled) = counts.fold((0, 0_u32), |(sum, sampled), count| (sum + count, sampled + 1));
    sum as f64 / f64::from(sampled.max(1))
}

/// A sphere of a slab.
#[derive(Clone, Copy, Debug)]
struct Seen {
    near: f32,
    id: u32,
    range: TileRange,
}

/// Makes the bricks of a picture one after the other: the spheres in the order of the lists, with [`Index::Tiles`].
#[derive(Debug)]
pub(crate) struct TileBricks<'a> {
    view: TileView,
    spheres: &'a [[f32; 4]],
    /// The near distance of each sphere.
    nears: Vec<f32>,
    /// The near distances at which slabs end. The last is infinite.
    ends: std::vec::IntoIter<f32>,
    /// The spheres of this slab that are in no brick yet, the farthest first.
    left: Vec<Seen>,
    /// The end of this slab and of the one before it.
    slab: [f32; 2],
    most_places: usize,
    bricks: usize,
}

/// Why there is no next brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoBrick {
    /// All tiles are done, or all spheres are listed.
    Done,
    /// There would be too many bricks.
    TooMany,
}

impl<'a> TileBricks<'a> {
    pub(crate) fn new(view: TileView, spheres: &'a [[f32; 4]]) -> Self {
        let nears =
            map_chunks(spheres, |_, spheres| spheres.iter().map(|sphere| view.near(*sphere)).collect::<Vec<_>>());
        let nears = nears.concat();
        let ends = slab_ends(&view, spheres, &nears).into_iter();
        let most_places = most_places(spheres.len());
        Self { view, spheres, nears, ends, left: Vec::new(), slab: [f32::NEG_INFINITY; 2], most_places, bricks: 0 }
    }

    /// Makes the next brick. `farthest` has the distance of the farthest hit of each tile, row by row, which is infinite
    /// if a ray hits nothing.
    pub(crate) fn next(&mut self, farthest: &[f32]) -> Result<Brick, NoBrick> {
        let columns = self.view.columns();
        loop {
            let near = self.left.last().map_or(self.slab[1], |seen| seen.near);
            // At equal distances, a sphere with a smaller id is the nearest.
            let open: Vec<bool> = farthest.iter().map(|distance| *distance >= near).collect();
            if self.left.is_empty() {
                if self.bricks > 0 && !open.contains(&true) {
                    return Err(NoBrick::Done);
                }
                let Some(end) = self.ends.next() else { return Err(NoBrick::Done) };
                self.slab = [self.slab[1], end];
                self.left = self.seen(&open, columns);
                if self.left.is_empty() && self.bricks > 0 {
                    continue;
                }
            }
            if self.bricks == MOST_BRICKS {
                return Err(NoBrick::TooMany);
            }
            self.bricks += 1;
            return Ok(self.brick(&open, columns));
        }
    }

    /// Number of bricks that were made.
    pub(crate) fn made(&self) -> usize {
        self.bricks
    }

    /// True if there may be more bricks.
    pub(crate) fn may_go_on(&self) -> bool {
        !self.left.is_empty() || self.ends.len() > 0
    }

    /// The spheres of this slab that may be seen in open tiles, the farthest first.
    fn seen(&self, open: &[bool], columns: usize) -> Vec<Seen> {
        let [start, end] = self.slab;
        let parts = map_chunks(&self.nears, |first, nears| {
            let seen = (first..).zip(nears).filter_map(|(id, near)| {
                let range = if (start..end).contains(near) { self.view.range(self.spheres[id])? } else { return None };
                let is_open = tiles_of(&range, columns).any(|tile| open[tile]);
                is_open.then_some(Seen { near: *near, id: id as u32, range })
            });
            let mut seen: Vec<Seen> = seen.collect();
            seen.sort_unstable_by(|a, b| b.near.total_cmp(&a.near).then(b.id.cmp(&a.id)));
            seen
        });
        merged(parts)
    }

    /// Lists as many of the nearest spheres that are left as fit into a brick.
    fn brick(&mut self, open: &[bool], columns: usize) -> Brick {
        let mut counts = vec![0_u32; open.len()];
        let (mut places, mut taken) = (0_usize, 0);
        for seen in self.left.iter().rev() {
            let mut longest = 0;
            for tile in tiles_of(&seen.range, columns).filter(|tile| open[*tile]) {
                counts[tile] += 1;
                places += 1;
                longest = longest.max(counts[tile]);
            }
            taken += 1;
            if longest >= LONGEST || places >= self.most_places {
                break;
            }
        }
        let mut starts = Vec::with_capacity(open.len() + 1);
        let mut end = 0;
        for count in counts {
            starts.push(end);
            end += count;
        }
        starts.push(end);
        let mut next = starts.clone();
        let (mut spheres, mut ids, mut nears) = (vec![[0.0; 4]; places], vec![0; places], vec![0.0; places]);
        let left = self.left.len() - taken;
        for seen in self.left.drain(left..).rev() {
            let sphere = self.spheres[seen.id as usize];
            for tile in tiles_of(&seen.range, columns).filter(|tile| open[*tile]) {
                let place = next[tile] as usize;
                next[tile] += 1;
                (spheres[place], ids[place], nears[place]) = (sphere, seen.id, seen.near);
            }
        }
        let lists = TileLists { columns: columns as u32, starts, nears };
        Brick { index: Index::Tiles(lists), spheres, ids }
    }
}

fn tiles_of(range: &TileRange, columns: usize) -> impl Iterator<Item = usize> + use<> {
    let TileRange { first, last } = *range;
    (first[1]..=last[1])
        .flat_map(move |row| (first[0]..=last[0]).map(move |column| usize::from(row) * columns + usize::from(column)))
}

/// Merges lists, the farthest spheres first.
fn merged(mut parts: Vec<Vec<Seen>>) -> Vec<Seen> {
    while parts.len() > 1 {
        let mut pairs = Vec::new();
        let mut rest = parts.into_iter();
        while let Some(one) = rest.next() {
            pairs.push((one, rest.next().unwrap_or_default()));
        }
        parts = map_parts(pairs, |(one, other)| {
            let mut all = Vec::with_capacity(one.len() + other.len());
            let (mut one, mut other) = (one.into_iter().peekable(), other.into_iter().peekable());
            while let (Some(a), Some(b)) = (one.peek(), other.peek()) {
                let is_first = (b.near, b.id) <= (a.near, a.id);
                all.extend(if is_first { one.next() } else { other.next() });
            }
            all.extend(one.chain(other));
            all
        });
    }
    parts.pop().unwrap_or_default()
}

/// The near distances at which slabs end.
fn slab_ends(view: &TileView, spheres: &[[f32; 4]], nears: &[f32]) -> Vec<f32> {
    let mut ends = Vec::new();
    if spheres.len() > ONE_SLAB {
        let stride = spheres.len().div_ceil(SAMPLES).max(1);
        let sample = spheres.iter().zip(nears).step_by(stride);
        let mut nears: Vec<f32> = sample.filter_map(|(sphere, near)| view.range(*sphere).map(|_| *near)).collect();
        nears.sort_unstable_by(f32::total_cmp);
        let mut size = nears.len() / FIRST_SLAB;
        let mut end = size;
        while size > 0 && end < nears.len() {
            ends.push(nears[end]);
            size *= 3;
            end += size;
        }
        ends.dedup();
    }
    ends.push(f32::INFINITY);
    ends
}
