//! Shapes that are equal to an earlier shape.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::geometry::math::equal_bits;
use crate::parallel::map_chunks;

/// The shapes whose numbers equal those of an earlier one of their kind. At equal distances a ray hits the shape with the
/// smaller index, so duplicates are never visible.
#[derive(Debug)]
pub(crate) struct Duplicates {
    /// For every shape, the index of the first shape equal to it. Empty if there are no duplicates.
    firsts: Vec<u32>,
}

impl Duplicates {
    /// Finds the duplicates among shapes of one kind, of which each is so many numbers: x, y, z and radius of a sphere. The
    /// time is proportional to the number of shapes. While it runs, it needs 4 bytes per shape.
    pub(crate) fn of<const N: usize>(shapes: &[[f32; N]]) -> Self {
        let mut suspects = suspects(shapes);
        let bits_of = |id: &u32| bits(&shapes[*id as usize]);
        suspects.sort_unstable_by_key(|id| (bits_of(id), *id));
        let equal = suspects.chunk_by(|a, b| bits_of(a) == bits_of(b));
        let mut firsts = Vec::new();
        for group in equal.filter(|group| group.len() > 1) {
            if firsts.is_empty() {
                firsts = (0..shapes.len() as u32).collect();
            }
            for id in group {
                firsts[*id as usize] = group[0];
            }
        }
        Self { firsts }
    }

    /// True if there are duplicates.
    #[cfg(any(feature = "gpu", test))]
    pub(crate) fn are_some(&self) -> bool {
        !self.firsts.is_empty()
    }

    /// The index of the first shape equal to the given one, which is usually the shape itself.
    pub(crate) fn first_of(&self, id: u32) -> u32 {
        self.firsts.get(id as usize).copied().unwrap_or(id)
    }
}

/// Lists all shapes that have an equal shape, and few others.
fn suspects<const N: usize>(shapes: &[[f32; N]]) -> Vec<u32> {
    const BITS_PER_SHAPE: usize = 16;
    let words = (shapes.len() * BITS_PER_SHAPE / 64).next_power_of_two();
    let clear = || -> Vec<AtomicU64> { (0..words).map(|_| AtomicU64::new(0)).collect() };
    // The word and the bit in it that belong to a shape. Equal shapes have the same.
    let bit_of = |shape: &[f32; N]| {
        let hash = hash(shape);
        ((hash >> 6) as usize & (words - 1), 1 << (hash & 63))
    };
    let (seen, seen_twice) = (clear(), clear());
    map_chunks(shapes, |_, shapes| {
        for shape in shapes {
            let (word, bit) = bit_of(shape);
            if seen[word].fetch_or(bit, Ordering::Relaxed) & bit != 0 {
                seen_twice[word].fetch_or(bit, Ordering::Relaxed);
            }
        }
    });
    let found = map_chunks(shapes, |first, shapes| -> Vec<u32> {
        (first as u32..)
            .zip(shapes)
            .filter(|(_, shape)| {
                let (word, bit) = bit_of(shape);
                seen_twice[word].load(Ordering::Relaxed) & bit != 0
            })
            .map(|(id, _)| id)
            .collect()
    });
    found.concat()
}

/// A hash whose lower bits are well mixed, by rounds of multiplying and folding.
fn hash<const N: usize>(shape: &[f32; N]) -> u64 {
    const ODD: [u64; 2] = [0x9e37_79b9_7f4a_7c15, 0xd6e8_feb8_6659_fd93];
    let fold = |x: u64, odd: u64| {
        let product = x.wrapping_mul(odd);
        product ^ product >> 32
    };
    let words = bits(shape).map(u64::from);
    words.chunks(2).zip([0, 1].into_iter().cycle()).fold(0, |hash, (pair, odd)| {
        let pair = pair.iter().rev().fold(0, |joined, word| joined << 32 | word);
        fold(hash ^ pair, ODD[odd])
    })
}

/// The bits of a shape. Equal shapes have equal bits.
fn bits<const N: usize>(shape: &[f32; N]) -> [u32; N] {
    shape.map(equal_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn firsts(spheres: &[[f32; 4]]) -> Vec<u32> {
        let duplicates = Duplicates::of(spheres);
        (0..spheres.len() as u32).map(|id| duplicates.first_of(id)).collect()
    }

    #[test]
    fn equal_numbers_are_equal_spheres() {
        let [a, b] = [[0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 3.5]];
        let minus = [-0.0, 1.0, 2.0, 3.0];
        assert_eq!(firsts(&[b, a, minus, b, a]), [0, 1, 1, 0, 1]);
        for none in [&[a, b][..], &[]] {
            assert!(!Duplicates::of(none).are_some());
        }
    }

    /// Compares with a search among all earlier spheres.
    #[test]
    fn many_are_found_among_many() {
        let mut random = fastrand::Rng::with_seed(31);
        for (count, sides) in [(300, 4), (3000, 30), (3000, 1 << 20), (2000, 1)] {
            let spheres: Vec<[f32; 4]> = (0..count)
                .map(|_| {
                    let [x, y] = [0; 2].map(|_| random.u32(..sides) as f32);
                    [x, y, 5.0 - x, 1.0 + y]
                })
                .collect();
            let wanted: Vec<u32> = spheres
                .iter()
                .map(|sphere| {
                    let is_equal = |other: &[f32; 4]| other.map(f32::to_bits) == sphere.map(f32::to_bits);
                    spheres.iter().position(is_equal).unwrap() as u32
                })
                .collect();
            assert_eq!(firsts(&spheres), wanted, "{count} of {sides}");
        }
    }
}
