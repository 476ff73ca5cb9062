//! Division of many spheres among bricks by cuts that halve a sample of them. Each sphere is read once, whatever the
//! number of bricks, while exact cuts (`divide`) read it several times for each doubling of that number.

use glam::Vec3A;

use super::extent::Extent;
use crate::parallel::{for_each, map_parts, ranges, split_mut};

/// The number of spheres from which on a sample is used.
const MANY: usize = 1 << 22;

/// The number of spheres of the sample. One of twelve parts then differs from the mean by 0.3 %, as a standard deviation.
const SAMPLED: usize = 1 << 20;

/// The number of spheres that one task handles.
const CHUNK: usize = 1 << 18;

/// The largest number of spheres in one of `parts` parts of `count` spheres: with a sample, 2 % more than the mean.
pub(super) fn largest_part(count: usize, parts: usize) -> usize {
    let mean = count.div_ceil(parts.max(1));
    if parts > 1 && count >= MANY { mean + mean / 50 } else { mean }
}

/// A cut across an axis, or a part of the spheres. A walk takes as many steps to each part, without a branch that depends on
/// the sphere, because a processor guesses half of such branches wrong.
#[derive(Clone, Copy)]
struct Node {
    axis: usize,
    /// Centres with a smaller coordinate are on the left.
    at: f32,
    /// The nodes on the left and on the right. Those of a part are the part itself.
    next: [u32; 2],
    part: u16,
}

/// Cuts as a tree, of which the first node is the root.
#[derive(Default)]
struct Tree {
    nodes: Vec<Node>,
    /// The number of cuts on the longest way from the root to a part.
    depth: usize,
}

/// Divides spheres into parts of about the same number: the ids of each part, in ascending order. Spheres with equal
/// centres are in the same part. Returns `None` if there are few spheres, or if a part would have more than
/// [`largest_part`], for example because many spheres have the same coordinate.
pub(super) fn divide_by_sample(spheres: &[[f32; 4]], parts: usize) -> Option<Vec<Vec<u32>>> {
    if parts <= 1 || parts > usize::from(u16::MAX) || spheres.len() < MANY {
        return None;
    }
    let stride = spheres.len().div_ceil(SAMPLED);
    let mut sample: Vec<[f32; 3]> =
        spheres.iter().step_by(stride).map(|[x, y, z, _]| [*x, *y, *z]).collect();
    let mut tree = Tree::default();
    tree.halve(&mut sample, (0, parts), 0);
    drop(sample);
    let chunks = ranges(spheres.len(), CHUNK);
    // The part of each sphere, so that spheres need not be read again.
    let mut part_of = vec![0_u16; spheres.len()];
    let tasks = spheres.chunks(CHUNK).zip(part_of.chunks_mut(CHUNK)).collect();
    let counts: Vec<Vec<usize>> =
        map_parts(tasks, |(spheres, part_of): (&[[f32; 4]], &mut [u16])| {
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
    // For each chunk, the places of its ids in every part.
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
            // There is a place for each, and the number of spheres fits into u32.
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

    /// Cuts a sample across the longest side of its box until there are so many parts, numbered from `first`. Returns the
    /// number of the node.
    fn halve(
        &mut self,
        sample: &mut [[f32; 3]],
        (first, parts): (usize, usize),
        depth: usize,
    ) -> u32 {
        let own = self.nodes.len() as u32;
        self.depth = self.depth.max(depth);
        self.nodes.push(Node { axis: 0, at: 0.0, next: [own; 2], part: first as u16 });
        if parts <= 1 || sample.is_empty() {
            return own;
        }
        let extent = sample
            .iter()
            .fold(Extent::EMPTY, |all, center| all.with_point(Vec3A::from_array(*center)));
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
            // The first cut is across the longest side, so some plane parts the first half from the others.
            let z = |ids: &Vec<u32>| ids.iter().map(|id| spheres[*id as usize][2]).collect();
            let sides: Vec<Vec<f32>> = divided.iter().map(z).collect();
            let (left, right) = sides.split_at(parts / 2);
            let most = left.iter().flatten().copied().fold(f32::MIN, f32::max);
            let least = right.iter().flatten().copied().fold(f32::MAX, f32::min);
            assert!(most < least, "{most} {least}");
        }
    }

    /// What a sample cannot divide is left to exact cuts.
    #[test]
    fn few_spheres_and_equal_coordinates_are_not_divided() {
        assert_eq!(divide_by_sample(&random(1000), 3), None);
        assert_eq!(divide_by_sample(&vec![[1.0; 4]; MANY], 2), None);
        assert_eq!(divide_by_sample(&random(MANY), 1), None);
    }
}
