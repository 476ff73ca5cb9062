//! Lists of the spheres that may be seen in each tile of a picture, the nearest first, in slabs of depth.
//!
//! A slab holds the spheres whose near distances (`tiles.rs`) follow those of the slab before it. After a slab is traced,
//! the tiles in which all pixels have nearer hits than the next slab are done, and its spheres are listed in the others
//! only. In crowded scenes most spheres are behind those of the first slabs, and are never listed.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use super::bricks::{Brick, Index};
use super::structure::Primitive;
use super::tiles::{TileLists, TileRange, TileView};
use crate::geometry::cone::ConeInFrame;
use crate::parallel::{for_each, map, map_chunks, map_parts, ranges, threads};

/// Spheres for which a picture is a single slab.
pub(crate) const ONE_SLAB: usize = 1 << 18;

/// Number of steps of depth. Each has about as many spheres as the others.
const STEPS: usize = 40;

/// Number of steps in the first of several slabs. Each later one has three times as many as that before it.
const FIRST_STEPS: usize = 4;

/// Spheres whose near distances say where steps end.
const SAMPLES: usize = 1 << 12;

/// The most spheres in a list. Kernels go through a list in one dispatch, in which few iterations are allowed.
const LONGEST: u32 = 4096;

/// The most bricks of a picture. Where spheres lie so dense that more would be needed, another structure is better.
const MOST_BRICKS: usize = 48;

/// The most places in one brick.
const MOST_PLACES: usize = 1 << 22;

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
    /// The spheres, or a ball around each cone.
    spheres: Cow<'a, [[f32; 4]]>,
    /// The cones, if there are any, and the id of the first.
    cones: (&'a [ConeInFrame], u32),
    /// The ids of the spheres of each slab that is still to come, for each run of spheres that a thread has read.
    runs: Vec<std::vec::IntoIter<Vec<u32>>>,
    /// The near distances at which the steps of each slab that is still to come end. The last is infinite.
    slabs: std::vec::IntoIter<Vec<f32>>,
    /// The spheres of this slab that are in no brick yet, the farthest first.
    left: Vec<Seen>,
    /// The near distance at which this slab ends.
    end: f32,
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
        Self::of_balls(view, Cow::Borrowed(spheres), (&[], 0))
    }

    /// The bricks of cones, of which the first has an id.
    pub(crate) fn of_cones(view: TileView, cones: &'a [ConeInFrame], first: u32) -> Self {
        Self::of_balls(view, cones.iter().map(ConeInFrame::ball).collect(), (cones, first))
    }

    fn of_balls(view: TileView, spheres: Cow<'a, [[f32; 4]]>, cones: (&'a [ConeInFrame], u32)) -> Self {
        let slabs = slabs(&view, &spheres);
        let ends: Vec<f32> = slabs.iter().filter_map(|steps| steps.last().copied()).collect();
        let runs = map_chunks(&spheres, |first, spheres| {
            let mut of_slabs = vec![Vec::new(); ends.len()];
            for (id, sphere) in (first as u32..).zip(spheres) {
                of_slabs[place_of(view.near(*sphere), &ends)].push(id);
            }
            of_slabs.into_iter()
        });
        let (slabs, most_places) = (slabs.into_iter(), most_places(spheres.len()));
        Self { view, spheres, cones, runs, slabs, left: Vec::new(), end: f32::NEG_INFINITY, most_places, bricks: 0 }
    }

    /// Makes the next brick. `farthest` has the distance of the farthest hit of each tile, row by row, which is infinite
    /// if a ray hits nothing.
    pub(crate) fn next(&mut self, farthest: &[f32]) -> Result<Brick, NoBrick> {
        let columns = self.view.columns();
        loop {
            let near = self.left.last().map_or(self.end, |seen| seen.near);
            // At equal distances, a sphere with a smaller id is the nearest.
            let open: Vec<bool> = farthest.iter().map(|distance| *distance >= near).collect();
            if self.left.is_empty() {
                if self.bricks > 0 && !open.contains(&true) {
                    return Err(NoBrick::Done);
                }
                let Some(steps) = self.slabs.next() else { return Err(NoBrick::Done) };
                self.left = self.seen(&steps, &open, columns);
                self.end = steps.last().copied().unwrap_or(f32::INFINITY);
            } else {
                self.left.retain(|seen| seen.is_in_any(&open, columns));
            }
            if self.left.is_empty() && self.bricks > 0 {
                continue;
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
        !self.left.is_empty() || self.slabs.len() > 0
    }

    /// The spheres of the next slab that may be seen in open tiles, the farthest first. `ends` are those of its steps.
    fn seen(&mut self, ends: &[f32], open: &[bool], columns: usize) -> Vec<Seen> {
        let runs: Vec<Vec<u32>> = self.runs.iter_mut().filter_map(Iterator::next).collect();
        let of_run = |ids: Vec<u32>| {
            let mut steps = vec![Vec::new(); ends.len()];
            for id in ids {
                let sphere = self.spheres[id as usize];
                let Some(range) = self.view.range(sphere) else { continue };
                let seen = Seen { near: self.view.near(sphere), id, range };
                if seen.is_in_any(open, columns) {
                    steps[place_of(seen.near, ends)].push(seen);
                }
            }
            steps
        };
        let mut steps = vec![Vec::new(); ends.len()];
        for run in map_parts(runs, of_run) {
            steps.iter_mut().zip(run).for_each(|(step, seen)| step.push(seen));
        }
        let of_step = |of_runs: Vec<Vec<Seen>>| {
            let mut seen = of_runs.concat();
            seen.sort_unstable_by(|a, b| b.near.total_cmp(&a.near).then(b.id.cmp(&a.id)));
            seen
        };
        map_parts(steps.into_iter().rev().collect(), of_step).concat()
    }

    /// Lists as many of the nearest spheres that are left as fit into a brick.
    fn brick(&mut self, open: &[bool], columns: usize) -> Brick {
        let mut taken = std::mem::take(&mut self.left);
        let mut begins = counts(&taken, open, columns);
        let of_tile = |tile: usize| begins.iter().map(|counts| counts[tile]).sum::<u32>();
        let (places, longest) =
            (0..open.len()).map(of_tile).fold((0, 0), |(sum, most), n| (sum + n as usize, most.max(n)));
        if places > self.most_places || longest > LONGEST {
            let fitting = self.fitting(&taken, open, columns);
            self.left = taken;
            taken = self.left.split_off(self.left.len() - fitting);
            begins = counts(&taken, open, columns);
        }
        // The counts become the places at which the threads begin each list.
        let mut starts = Vec::with_capacity(open.len() + 1);
        let mut end = 0;
        for tile in 0..open.len() {
            starts.push(end);
            for begin in &mut begins {
                end += std::mem::replace(&mut begin[tile], end);
            }
        }
        starts.push(end);
        let listed: Vec<AtomicU32> = (0..end).map(|_| AtomicU32::default()).collect();
        for_each(
            parts_of(taken.len()).into_iter().zip(begins).collect(),
            |(part, mut next): (Range<usize>, Vec<u32>)| {
                for (index, seen) in (part.start as u32..).zip(nearest_first(&taken, part)) {
                    seen.in_each(open, columns, &mut next, |next| {
                        listed[*next as usize].store(index, Ordering::Relaxed);
                        *next += 1;
                    });
                }
            },
        );
        let at = |index: usize| taken[taken.len() - 1 - index].id as usize;
        let (all, first) = self.cones;
        let (primitive, [of_spheres, of_cones]) = match all {
            [] => (Primitive::Sphere, [taken.len(), 0]),
            _ => (Primitive::Cone, [0, taken.len()]),
        };
        let spheres = map(of_spheres, |index| self.spheres[at(index)]);
        let cones = map(of_cones, |index| all[at(index)]);
        let ids = taken.iter().rev().map(|seen| first + seen.id).collect();
        let nears = taken.iter().rev().map(|seen| seen.near).collect();
        let places = listed.into_iter().map(AtomicU32::into_inner).collect();
        let lists = TileLists { columns: columns as u32, starts, places, nears };
        Brick { index: Index::Tiles(lists), primitive, spheres, cones, ids }
    }

    /// How many of the nearest spheres fit into a brick.
    fn fitting(&self, left: &[Seen], open: &[bool], columns: usize) -> usize {
        let mut counts = vec![0_u32; open.len()];
        let (mut places, mut longest) = (0_usize, 0);
        let does_not_fit = |seen: &Seen| {
            seen.in_each(open, columns, &mut counts, |count| {
                *count += 1;
                places += 1;
                longest = longest.max(*count);
            });
            longest >= LONGEST || places >= self.most_places
        };
        left.iter().rev().position(does_not_fit).map_or(left.len(), |last| last + 1)
    }
}

/// The parts of a list of spheres that threads list, one each.
fn parts_of(spheres: usize) -> Vec<Range<usize>> {
    ranges(spheres, spheres.div_ceil(threads()).max(1 << 12))
}

/// A part of a list in which the farthest spheres are first, in reverse order.
fn nearest_first(seen: &[Seen], part: Range<usize>) -> impl Iterator<Item = &Seen> {
    seen[seen.len() - part.end..seen.len() - part.start].iter().rev()
}

/// For each part of a list of spheres, the number of its spheres in each tile.
fn counts(seen: &[Seen], open: &[bool], columns: usize) -> Vec<Vec<u32>> {
    map_parts(parts_of(seen.len()), |part| {
        let mut counts = vec![0; open.len()];
        nearest_first(seen, part).for_each(|seen| seen.in_each(open, columns, &mut counts, |count| *count += 1));
        counts
    })
}

impl Seen {
    /// True if the sphere may be seen in an open tile.
    fn is_in_any(&self, open: &[bool], columns: usize) -> bool {
        let TileRange { first, last } = self.range;
        let mut rows = first[1].into()..usize::from(last[1]) + 1;
        rows.any(|row| open[row * columns..][first[0].into()..usize::from(last[0]) + 1].contains(&true))
    }

    /// Calls `change` with the values of all open tiles in which the sphere may be seen.
    #[inline]
    fn in_each(&self, open: &[bool], columns: usize, values: &mut [u32], mut change: impl FnMut(&mut u32)) {
        let TileRange { first, last } = self.range;
        for row in first[1].into()..usize::from(last[1]) + 1 {
            let tiles = row * columns + usize::from(first[0])..row * columns + usize::from(last[0]) + 1;
            let values = values[tiles.clone()].iter_mut().zip(&open[tiles]);
            values.filter(|(_, open)| **open).for_each(|(value, _)| change(value));
        }
    }
}

/// The first place whose end is beyond a near distance, or the last.
fn place_of(near: f32, ends: &[f32]) -> usize {
    ends.partition_point(|end| *end <= near).min(ends.len() - 1)
}

/// The near distances at which the steps of each slab end. The last is infinite. Each step has about as many of the spheres
/// that are seen as the others, according to a sample.
fn slabs(view: &TileView, spheres: &[[f32; 4]]) -> Vec<Vec<f32>> {
    let stride = spheres.len().div_ceil(SAMPLES).max(1);
    let sample = spheres.iter().step_by(stride);
    let mut nears: Vec<f32> = sample.filter_map(|sphere| view.range(*sphere).map(|_| view.near(*sphere))).collect();
    nears.sort_unstable_by(f32::total_cmp);
    let mut ends: Vec<f32> = (1..STEPS).filter_map(|step| nears.get(step * nears.len() / STEPS).copied()).collect();
    ends.dedup();
    ends.push(f32::INFINITY);
    let mut size = if spheres.len() > ONE_SLAB { FIRST_STEPS } else { ends.len() };
    let mut slabs = Vec::new();
    while !ends.is_empty() {
        let rest = ends.split_off(size.min(ends.len()));
        slabs.push(std::mem::replace(&mut ends, rest));
        size *= 3;
    }
    slabs
}
