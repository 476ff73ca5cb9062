//! Division of spheres among bricks, on all cores.

use super::divide_by_sample::divide_by_sample;
use crate::geometry::math::equal_bits;
use crate::parallel::{both, map_chunks};

/// The division of a scene into parts.
pub(super) struct Divided {
    /// The ids of the spheres of each part, in ascending order.
    pub(super) parts: Vec<Vec<u32>>,
    /// Whether spheres with equal centres may be in different parts.
    pub(super) may_part_equals: bool,
}

/// Divides spheres into parts of about the same number, by repeated median cuts across the longest side: those of a
/// sample if there are many spheres, otherwise exact ones. The centres of each part lie in a box that no other part
/// enters.
pub(super) fn divide(spheres: &[[f32; 4]], parts: usize) -> Divided {
    if let Some(parts) = divide_by_sample(spheres, parts) {
        return Divided { parts, may_part_equals: false };
    }
    cut(spheres, (0..spheres.len() as u32).collect(), parts)
}

/// Divides a list of ascending ids; the ids of each part ascend as well.
fn cut(spheres: &[[f32; 4]], ids: Vec<u32>, parts: usize) -> Divided {
    if parts <= 1 {
        return Divided { parts: vec![ids], may_part_equals: false };
    }
    let axis = longest_side(spheres, &ids);
    let left_parts = parts / 2;
    let middle = ids.len() * left_parts / parts;
    let key = |id: u32| (ascending(spheres[id as usize][axis]), id);
    let Split { left, right, on_the_cut } = split(ids, middle, key);
    let (mut all, others) =
        both(true, || cut(spheres, left, left_parts), || cut(spheres, right, parts - left_parts));
    all.parts.extend(others.parts);
    all.may_part_equals |= others.may_part_equals || has_equals(spheres, &on_the_cut);
    all
}

/// Whether any two of the spheres have equal centres. Zeros of both signs are equal.
fn has_equals(spheres: &[[f32; 4]], ids: &[u32]) -> bool {
    let center = |id: &u32| {
        let [x, y, z, _] = spheres[*id as usize];
        [x, y, z].map(equal_bits)
    };
    let mut centers: Vec<[u32; 3]> = ids.iter().map(center).collect();
    centers.sort_unstable();
    centers.windows(2).any(|pair| pair[0] == pair[1])
}

/// A list that has been cut in two.
struct Split {
    left: Vec<u32>,
    right: Vec<u32>,
    /// The ids on both sides whose keys have the same first number as the first key on the right; empty if all of these
    /// are on the right.
    on_the_cut: Vec<u32>,
}

/// Splits a list into the first `count` ids in the order of their keys, and the others.
fn split(ids: Vec<u32>, count: usize, key: impl Fn(u32) -> (u32, u32) + Sync) -> Split {
    if count == ids.len() {
        return Split { left: ids, right: Vec::new(), on_the_cut: Vec::new() };
    }
    let (first_right, on_the_cut) = select(&ids, count, &key);
    let is_left = |id: &u32| key(*id) < first_right;
    let chunks = map_chunks(&ids, |_, ids| ids.iter().partition::<Vec<u32>, _>(|id| is_left(id)));
    let (mut left, mut right) = (Vec::with_capacity(count), Vec::with_capacity(ids.len() - count));
    drop(ids);
    for (more_left, more_right) in chunks {
        left.extend(more_left);
        right.extend(more_right);
    }
    Split { left, right, on_the_cut }
}

/// The key with the given rank: the number of smaller keys. Found by counting keys that agree in the digits known so
/// far. Also returns all ids whose keys have the same first number, if some of these come before it. The time is
/// proportional to the number of ids, which are read in order.
fn select(
    ids: &[u32],
    mut rank: usize,
    key: impl Fn(u32) -> (u32, u32) + Sync,
) -> ((u32, u32), Vec<u32>) {
    const DIGIT: u32 = 1 << DIGIT_BITS;
    const DIGIT_BITS: u32 = 8;
    // The highest digits, which are known, and the number of bits below them.
    let (mut known, mut below) = (0, u32::BITS);
    while below > 0 {
        let next = below - DIGIT_BITS;
        let counts = map_chunks(ids, |_, ids| {
            let mut counts = [0_usize; DIGIT as usize];
            for id in ids {
                let coordinate = key(*id).0;
                if u64::from(coordinate) >> below == known {
                    counts[(coordinate >> next & (DIGIT - 1)) as usize] += 1;
                }
            }
            counts
        });
        let mut digit = 0;
        loop {
            let here: usize = counts.iter().map(|counts| counts[digit]).sum();
            if rank < here || digit + 1 == DIGIT as usize {
                break;
            }
            rank -= here;
            digit += 1;
        }
        known = known << DIGIT_BITS | digit as u64;
        below = next;
    }
    let known = known as u32;
    let same: Vec<Vec<u32>> = map_chunks(ids, |_, ids| -> Vec<u32> {
        ids.iter().copied().filter(|id| key(*id).0 == known).collect()
    });
    let same = same.concat();
    let first_right = (known, same[rank]);
    (first_right, if rank > 0 { same } else { Vec::new() })
}

/// Maps a float to an integer with the same order; zeros of both signs give the same integer.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with sorting, for spheres of which many share a coordinate, and for zeros of both signs.
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
                let Divided { parts: bricks, may_part_equals } = divide(&spheres, parts);
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
                let is_in = |of: &[u32], center: &[f32]| {
                    of.iter().any(|id| spheres[*id as usize][..3] == *center)
                };
                let parts_equals = count <= 1000
                    && spheres.iter().any(|sphere| {
                        bricks.iter().filter(|ids| is_in(ids, &sphere[..3])).count() > 1
                    });
                assert!(may_part_equals || !parts_equals, "{count} in {parts}");
                times_parted += u32::from(parts_equals);
            }
        }
        assert!(times_parted > 0);
    }
}
