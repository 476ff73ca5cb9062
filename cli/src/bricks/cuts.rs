//! Cuts of space into compact bricks of about equal numbers of spheres, by a sample of them.

/// Where a sphere lies among others along an axis: its coordinate as an integer with the same order, and its id, so that
/// spheres in one place can be divided too.
type Key = (u32, u32);

/// Spheres of the sample for each brick that are enough for bricks of about equal size.
const PER_BRICK: u64 = 1 << 12;

/// The most spheres in the sample.
const MOST: u64 = 1 << 21;

/// A sample of the spheres, chosen by their ids.
pub(super) struct Sample {
    /// Ids whose hash is below this are chosen.
    below: u64,
    spheres: Vec<([f32; 3], u32)>,
}

impl Sample {
    /// An empty sample of `count` spheres, for this many bricks.
    pub(super) fn new(count: u64, bricks: u64) -> Self {
        let wanted = (bricks * PER_BRICK).clamp(1 << 16, MOST);
        let below = if wanted >= count { u64::MAX } else { u64::MAX / count * wanted };
        Self { below, spheres: Vec::new() }
    }

    pub(super) fn add(&mut self, id: u32, [x, y, z, _]: [f32; 4]) {
        if hash(id) <= self.below {
            self.spheres.push(([x, y, z], id));
        }
    }

    /// The cuts of the sample into bricks.
    pub(super) fn cuts(mut self, bricks: usize) -> Cuts {
        let mut cuts = Cuts { nodes: Vec::new(), bricks };
        cuts.cut(&mut self.spheres, 0, bricks);
        cuts
    }
}

/// A bijection of numbers in which near ones are far apart (the finaliser of `SplitMix64`: Steele, Lea and Flood 2014).
fn hash(id: u32) -> u64 {
    let x = u64::from(id).wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Repeated cuts across the longest side. Bricks are numbered such that consecutive ones lie together.
pub(super) struct Cuts {
    nodes: Vec<Node>,
    pub(super) bricks: usize,
}

#[derive(Clone, Copy)]
enum Node {
    Cut { axis: usize, first_right: Key, right: usize },
    Brick(usize),
}

impl Cuts {
    /// Cuts some spheres of the sample into bricks from `first` on.
    fn cut(&mut self, spheres: &mut [([f32; 3], u32)], first: usize, bricks: usize) {
        let middle = spheres.len() * (bricks / 2) / bricks.max(1);
        if bricks <= 1 || middle == 0 {
            self.nodes.push(Node::Brick(first));
            return;
        }
        let axis = longest_side(spheres);
        let key = |(center, id): &([f32; 3], u32)| (ascending(center[axis]), *id);
        spheres.select_nth_unstable_by_key(middle, key);
        let first_right = key(&spheres[middle]);
        let (left, right) = spheres.split_at_mut(middle);
        let node = self.nodes.len();
        self.nodes.push(Node::Brick(first));
        self.cut(left, first, bricks / 2);
        self.nodes[node] = Node::Cut { axis, first_right, right: self.nodes.len() };
        self.cut(right, first + bricks / 2, bricks - bricks / 2);
    }

    /// The brick of a sphere.
    pub(super) fn brick(&self, id: u32, sphere: [f32; 4]) -> usize {
        let mut at = 0;
        loop {
            match self.nodes[at] {
                Node::Brick(brick) => return brick,
                Node::Cut { axis, first_right, right } => {
                    at = if (ascending(sphere[axis]), id) < first_right { at + 1 } else { right };
                }
            }
        }
    }
}

fn longest_side(spheres: &[([f32; 3], u32)]) -> usize {
    let mut sides = [(f32::MAX, f32::MIN); 3];
    for (center, _) in spheres {
        for (side, x) in sides.iter_mut().zip(center) {
            *side = (side.0.min(*x), side.1.max(*x));
        }
    }
    let length = |axis: &usize| sides[*axis].1 - sides[*axis].0;
    (0..3).max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or(0)
}

/// An integer with the same order as a number.
fn ascending(x: f32) -> u32 {
    let bits = (x + 0.0).to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of spheres of each brick.
    fn counts(spheres: &[[f32; 4]], bricks: usize) -> Vec<usize> {
        let mut sample = Sample::new(spheres.len() as u64, bricks as u64);
        (0..).zip(spheres).for_each(|(id, sphere)| sample.add(id, *sphere));
        let cuts = sample.cuts(bricks);
        let mut counts = vec![0; bricks];
        (0..).zip(spheres).for_each(|(id, sphere)| counts[cuts.brick(id, *sphere)] += 1);
        counts
    }

    #[test]
    fn bricks_have_about_equal_numbers_also_of_spheres_in_one_place() {
        let lattice = |i: u32| [(i % 64) as f32, (i / 64 % 64) as f32, (i / 4096) as f32, 0.5];
        let kinds: [fn(u32) -> [f32; 4]; 3] =
            [lattice, |_| [-3.0, 1e30, 0.0, 1.0], |i| [-(i as f32), 0.0, -0.0, 1.0]];
        for kind in kinds {
            let spheres: Vec<[f32; 4]> = (0..200_000).map(kind).collect();
            for bricks in [1, 2, 7, 48] {
                let counts = counts(&spheres, bricks);
                let even = spheres.len() / bricks;
                assert!(counts.iter().all(|count| count.abs_diff(even) <= even / 5), "{counts:?}");
            }
        }
    }

    #[test]
    fn few_spheres_make_bricks_of_one_or_none() {
        let spheres = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0]];
        assert_eq!(counts(&spheres, 3), [1, 1, 1]);
        assert_eq!(counts(&spheres, 8).iter().sum::<usize>(), 3);
        assert_eq!(counts(&[], 4), [0; 4]);
    }
}
