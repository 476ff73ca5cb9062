//! Division of spheres among bricks, on all cores. Many spheres are divided by cuts that halve a sample of them. Each
//! sphere is then read once for any number of bricks, while exact cuts read it several times for each doubling of that
//! number.
use glam::Vec3A;

use super::split::Extent;
use crate::geometry::math::equal_bits;
use crate::parallel::{both, for_each, map, map_chunks, map_parts, ranges, split_mut};

/// The division of a scene into parts.
pub(super) struct Division {
    /// The ids of the spheres of each part, in ascending order.
    pub(super) parts: Vec<Vec<u32>>,
    /// Whether spheres with equal centres may be in different parts.
    pub(super) may_split_duplicates: bool,
}

/// Divides spheres into parts of about the same number, by repeated median cuts across the longest side. The cuts halve
/// a sample if there are many spheres, and are exact otherwise. The centres of each part lie in a box that no other
/// part enters.
pub(super) fn divide(spheres: &[[f32; 4]], parts: usize) -> Division {
    if let Some(parts) = divide_by_sample(spheres, parts) {
        return Division { parts, may_split_duplicates: false };
    }
    cut(spheres, (0..spheres.len() as u32).collect(), parts)
}

/// Divides a list of ascending ids. The ids of each part ascend as well.
fn cut(spheres: &[[f32; 4]], ids: Vec<u32>, parts: usize) -> Division {
    if parts <= 1 {
        return Division { parts: vec![ids], may_split_duplicates: false };
    }
    let axis = longest_side(spheres, &ids);
    let left_parts = parts / 2;
    let middle = ids.len() * left_parts / parts;
    let key = |id: &u32| (ascending(spheres[*id as usize][axis]), *id);
    let mut keys = map(ids.len(), |index| key(&ids[index]));
    let first_right = (middle < ids.len()).then(|| *keys.select_nth_unstable(middle).1);
    drop(keys);
    let is_left = |id: &u32| first_right.is_none_or(|first| key(id) < first);
    let chunks = map_chunks(&ids, |_, ids| ids.iter().partition::<Vec<u32>, _>(|id| is_left(id)));
    let (mut left, mut right) = (Vec::with_capacity(middle), Vec::with_capacity(ids.len() - middle));
    drop(ids);
    // Chunks are moved one by one, so that not all of them exist twice.
    for (more_left, more_right) in chunks {
        left.extend(more_left);
        right.extend(more_right);
    }
    // Spheres with equal centres are separated only if they have the coordinate of the first on the right.
    let is_on_cut = |id: &u32| first_right.is_some_and(|first| key(id).0 == first.0);
    let mut on_the_cut: Vec<u32> = left.iter().copied().filter(is_on_cut).collect();
    if !on_the_cut.is_empty() {
        on_the_cut.extend(right.iter().copied().filter(is_on_cut));
    }
    let (mut all, others) = both(true, || cut(spheres, left, left_parts), || cut(spheres, right, parts - left_parts));
    all.parts.extend(others.parts);
    all.may_split_duplicates |= others.may_split_duplicates || has_equals(spheres, &on_the_cut);
    all
}

/// Whether any two of the spheres have equal centres. Positive and negative zero are equal.
fn has_equals(spheres: &[[f32; 4]], ids: &[u32]) -> bool {
    let center = |id: &u32| {
        let [x, y, z, _] = spheres[*id as usize];
        [x, y, z].map(equal_bits)
    };
    let mut centers: Vec<[u32; 3]> = ids.iter().map(center).collect();
    centers.sort_unstable();
    centers.windows(2).any(|pair| pair[0] == pair[1])
}

/// Maps a float to an integer with the same order. Positive and negative zero give the same integer.
fn ascending(x: f32) -> u32 {
    let bits = equal_bits(x);
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

fn longest_side(spheres: &[[f32; 4]], ids: &[u32]) -> usize {
    let boxes = map_chunks(ids, |_, ids| {
        let mut sides = [(f32::MAX, f32::MIN); 3];
        for id in ids {
            for (side, x) in sides.iter_mut().zip(spheres[*id as usize]) {
                *side = (side.0.min(x), side.1.max(x));
            }
        }
        sides
    });
    let length = |axis: usize| {
        let low = boxes.iter().map(|sides| sides[axis].0).fold(f32::MAX, f32::min);
        let high = boxes.iter().map(|sides| sides[axis].1).fold(f32::MIN, f32::max);
        high - low
    };
    (0..3).max_by(|a, b| length(*a).total_cmp(&length(*b))).unwrap_or(0)
}

/// The number of spheres from which a sample is used.
const MANY: usize = 1 << 22;

/// The number of spheres of the sample. With twelve parts, a part's size has a standard deviation of 0.3 %.
const SAMPLED: usize = 1 << 20;

/// The number of spheres that one task handles.
const CHUNK: usize = 1 << 18;

/// The largest number of spheres in one of `parts` parts of `count` spheres: with a sample, the mean plus 2 %.
pub(super) fn largest_part(count: usize, parts: usize) -> usize {
    let mean = count.div_ceil(parts.max(1));
    if parts > 1 && count >= MANY { mean + mean / 50 } else { mean }
}

/// A cut across an axis, or a part of the spheres. Every walk takes the same number of steps without branching on the
/// sphere, because a processor mispredicts half of such branches.
#[derive(Clone, Copy)]
struct Node {
    axis: usize,
    /// Centres with a smaller coordinate are on the left.
    at: f32,
    /// The nodes on the left and on the right. For a part, both are the part itself.
    next: [u32; 2],
    part: u16,
}

/// Cuts as a tree. The first node is the root.
#[derive(Default)]
struct Tree {
    nodes: Vec<Node>,
    /// The number of cuts on the longest way from the root to a part.
    depth: usize,
}

/// Divides spheres into parts of about the same number. Returns the ids of each part, in ascending order. Spheres with
/// equal centres are in the same part. Returns `None` if there are few spheres, or if a part would have more than
/// [`largest_part`], for example because many spheres have the same coordinate.
pub(super) fn divide_by_sample(spheres: &[[f32; 4]], parts: usize) -> Option<Vec<Vec<u32>>> {
    if parts <= 1 || parts > usize::from(u16::MAX) || spheres.len() < MANY {
        return None;
    }
    let stride = spheres.len().div_ceil(SAMPLED);
    let mut sample: Vec<[f32; 3]> = spheres.iter().step_by(stride).map(|[x, y, z, _]| [*x, *y, *z]).collect();
    let mut tree = Tree::default();
    tree.halve(&mut sample, (0, parts), 0);
    drop(sample);
    let chunks = ranges(spheres.len(), CHUNK);
    // The part of each sphere, so that spheres need not be read again.
    let mut part_of = vec![0_u16; spheres.len()];
    let tasks = spheres.chunks(CHUNK).zip(part_of.chunks_mut(CHUNK)).collect();
    let counts: Vec<Vec<usize>> = map_parts(tasks, |(spheres, part_of): (&[[f32; 4]], &mut [u16])| {
        let mut counts = vec![0; parts];
        for (sphere, part) in spheres.iter().zip(part_of) {
            *part = tree.part_of(sphere);
            counts[usize::from(*part)] += 1;
        }
        counts
    });
    let total = |part: usize| counts.iter().map(|of_chunk| of_chunk[part]).sum::<usize>();
    let totals: Vec<usize> = (0..parts).map(total).collect();
    if totals.iter().any(|total| *total > largest_part(spheres.len(), parts)) {
        return None;
    }
    let mut all: Vec<Vec<u32>> = totals.iter().map(|total| vec![0; *total]).collect();
    // The places for each chunk's ids in every part.
    let mut tasks: Vec<_> = chunks.into_iter().map(|chunk| (chunk, Vec::new())).collect();
    for (part, ids) in all.iter_mut().enumerate() {
        let mut end = 0;
        let ends = counts.iter().map(|of_chunk| {
            end += of_chunk[part];
            end
        });
        let places = split_mut(ids, ends);
        for ((_, targets), place) in tasks.iter_mut().zip(places) {
            targets.push(place.iter_mut());
        }
    }
    for_each(tasks, |(chunk, mut targets)| {
        for id in chunk {
            // There is a place for each id, and the number of spheres fits into u32.
            if let Some(place) = targets[usize::from(part_of[id])].next() {
                *place = id as u32;
            }
        }
    });
    Some(all)
}

impl Tree {
    fn part_of(&self, &[x, y, z, _]: &[f32; 4]) -> u16 {
        let center = [x, y, z];
        let mut node = &self.nodes[0];
        for _ in 0..self.depth {
            let is_left = center[node.axis] < node.at;
            node = &self.nodes[node.next[usize::from(!is_left)] as usize];
        }
        node.part
    }

    /// Cuts a sample across the longest side of its box until there are `parts` parts, numbered from `first`. Returns
    /// the index of the node.
    fn halve(&mut self, sample: &mut [[f32; 3]], (first, parts): (usize, usize), depth: usize) -> u32 {
        let own = self.nodes.len() as u32;
        self.depth = self.depth.max(depth);
        self.nodes.push(Node { axis: 0, at: 0.0, next: [own; 2], part: first as u16 });
        if parts <= 1 || sample.is_empty() {
            return own;
        }
        let extent = sample.iter().fold(Extent::EMPTY, |all, center| all.with_point(Vec3A::from_array(*center)));
        let axis = extent.longest_axis();
        let left_parts = parts / 2;
        let middle = sample.len() * left_parts / parts;
        let (_, at, _) = sample.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis]));
        let at = at[axis];
        let (left, right) = sample.split_at_mut(middle);
        let left = self.halve(left, (first, left_parts), depth + 1);
        let right = self.halve(right, (first + left_parts, parts - left_parts), depth + 1);
        self.nodes[own as usize] = Node { axis, at, next: [left, right], part: 0 };
        own
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with sorting, for spheres many of which share a coordinate, and for positive and negative zero.
    #[test]
    fn parts_are_those_of_a_sort() {
        let coordinates = [-2.5, -1e-40, -0.0, 0.0, 3e-41, 1.0, 7e8];
        let mut rng = fastrand::Rng::with_seed(1);
        let mut times_parted = 0;
        for count in [0, 1, 2, 3, 1000, 150_000] {
            let spheres: Vec<[f32; 4]> = (0..count)
                .map(|_| {
                    let x = if rng.bool() { coordinates[rng.usize(..7)] } else { rng.f32() - 0.5 };
                    [x, 0.1 * rng.u32(..9) as f32, 0.0, 1.0]
                })
                .collect();
            let mut sorted: Vec<u32> = (0..count).collect();
            let coordinate = |id: &u32| spheres[*id as usize][0] + 0.0;
            sorted.sort_by(|a, b| coordinate(a).total_cmp(&coordinate(b)));
            for parts in [1, 2, 3] {
                let Division { parts: bricks, may_split_duplicates } = divide(&spheres, parts);
                assert_eq!(bricks.len(), parts);
                // The first cut is along x.
                let middle = count as usize * (parts / 2) / parts;
                let (left, _) = sorted.split_at(middle);
                let mut left = left.to_vec();
                left.sort_unstable();
                if parts > 1 {
                    assert_eq!(bricks[0], left);
                }
                assert!(bricks.iter().all(|ids| ids.is_sorted()));
                let mut all = bricks.concat();
                all.sort_unstable();
                assert!(all.into_iter().eq(0..count));
                let is_in = |of: &[u32], center: &[f32]| of.iter().any(|id| spheres[*id as usize][..3] == *center);
                let parts_equals = count <= 1000
                    && spheres.iter().any(|sphere| bricks.iter().filter(|ids| is_in(ids, &sphere[..3])).count() > 1);
                assert!(may_split_duplicates || !parts_equals, "{count} in {parts}");
                times_parted += u32::from(parts_equals);
            }
        }
        assert!(times_parted > 0);
    }

    fn random(count: usize) -> Vec<[f32; 4]> {
        let mut rng = fastrand::Rng::with_seed(1);
        (0..count).map(|_| [rng.f32() - 0.5, rng.f32(), 3.0 * rng.f32(), 0.1]).collect()
    }

    #[test]
    fn parts_have_all_spheres_and_no_others() {
        let spheres = random(MANY + 5);
        for parts in [2, 3, 12] {
            let divided = divide_by_sample(&spheres, parts).unwrap();
            assert_eq!(divided.len(), parts);
            let largest = largest_part(spheres.len(), parts);
            assert!(divided.iter().all(|ids| ids.len() <= largest && ids.is_sorted()));
            let mut all = divided.concat();
            all.sort_unstable();
            assert!(all.into_iter().eq(0..spheres.len() as u32));
            // The first cut is across the longest side, so some plane separates the first half from the others.
            let z = |ids: &Vec<u32>| ids.iter().map(|id| spheres[*id as usize][2]).collect();
            let sides: Vec<Vec<f32>> = divided.iter().map(z).collect();
            let (left, right) = sides.split_at(parts / 2);
            let most = left.iter().flatten().copied().fold(f32::MIN, f32::max);
            let least = right.iter().flatten().copied().fold(f32::MAX, f32::min);
            assert!(most < least, "{most} {least}");
        }
    }

    /// Exact cuts handle what a sample cannot divide.
    #[test]
    fn few_spheres_and_equal_coordinates_are_not_divided() {
        assert_eq!(divide_by_sample(&random(1000), 3), None);
        assert_eq!(divide_by_sample(&vec![[1.0; 4]; MANY], 2), None);
        assert_eq!(divide_by_sample(&random(MANY), 1), None);
    }
}
