//! The compressed 8-wide tree, which needs few bytes per sphere and few nodes per ray.
//!
//! The format follows Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs" (2017). The boxes of up to eight children are stored on a grid of 256³ cells over the node. A child's slot
//! tells in which octant of the node it lies, so that one table of bits orders the children for every direction.
//! Differences: the count of a leaf is a number, not unary; hits remain in slots until they are ordered at once; and an
//! inner child needs no byte of its own.
use glam::Vec3A;

use super::slab::NODE_PART;
use super::split::Extent;
use super::statistics::Margins;

/// A tree whose nodes have up to eight children, and the order of the spheres in its leaves.
///
/// Node 0 is the root. Children come after their parents, and those of one node are consecutive. A tree without spheres
/// has one node without children, so kernels need no special case.
#[derive(Clone, Debug, PartialEq)]
pub struct WideTree {
    /// All nodes, as kernels read them.
    pub nodes: Vec<WideNode>,
    /// For each position in leaf order, the index of the sphere in input order. Ascending within a leaf.
    pub ids: Vec<u32>,
    /// The number of nodes on the longest path from the root to the parent of a leaf, both included. At most
    /// `WIDE_LEVELS`.
    pub levels: u32,
    pub(crate) margins: Margins,
}

/// The largest number of spheres in a leaf.
pub(crate) const WIDE_LEAF: usize = 3;

/// The largest number of levels of a tree, and the size of the kernel's stack. A proof at `build` shows that no tree
/// has more. A walk leaves at most one entry on the stack for each level except the first.
pub(crate) const WIDE_LEVELS: u32 = 16;

/// The largest number of bytes of nodes per sphere, apart from one more node. Splits by cost stay far below it, unless
/// spheres are placed so that most splits separate very few. Splits in half always stay below it, as a test shows.
pub(super) const WIDE_BYTES_PER_SPHERE: usize = 14;

/// The mask of the first sphere in the byte of a leaf, and the position of the count there.
pub(crate) const LEAF_FIRST: u32 = 31;
pub(crate) const LEAF_COUNT_SHIFT: u32 = 5;

/// A node of 80 bytes: twenty words, or five `vec4u`.
///
/// | words | hold |
/// |---|---|
/// | 0, 1, 2 | the grid's origin x, y, z: f32 |
/// | 3 | bits 0–7, 8–15, 16–23: exponents of the cell's sizes x, y, z, as in an f32; bits 24–31: the inner mask, bit s for slot s |
/// | 4 | index of the first inner child; the others follow in the order of their slots |
/// | 5 | index of the first sphere of the node's leaves |
/// | 6, 7 | a byte for each slot that holds a leaf: bits 0–4 the first sphere, counted from word 5; bits 5–7 how many spheres, 1 to 3. Zero for inner children and empty slots |
/// | 8, 9; 10, 11; 12, 13 | a byte for each slot: low x; low y; low z, in cells |
/// | 14, 15; 16, 17; 18, 19 | a byte for each slot: high x; high y; high z, in cells |
///
/// Slot 0 is the lowest byte of the first word, slot 4 of the second. Bits 0, 1, 2 of a slot's number say
/// whether the child lies towards +x, +y, +z. An empty slot has neither inner bit nor spheres; its box
/// does not matter, but low is 255 and high is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(transparent)]
pub struct WideNode(pub [u32; 20]);

/// The content of a slot.
#[cfg(test)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    Empty,
    /// An inner child: index of its node.
    Inner(u32),
    /// A leaf: index of its first sphere in leaf order, and number of spheres.
    Leaf(u32, u32),
}

impl WideNode {
    /// A node without children.
    pub(super) fn empty() -> Self {
        let mut words = [0; 20];
        words[3] = 0x007f_7f7f;
        words[8..14].fill(u32::MAX);
        Self(words)
    }

    /// A node whose children have these boxes. The children themselves are added later.
    pub(super) fn with_boxes(boxes: &[Option<Extent>; 8]) -> Self {
        let whole = boxes.iter().flatten().fold(Extent::EMPTY, |all, b| all.union(*b));
        let mut node = Self::empty();
        for axis in 0..3 {
            let [low, high] = [whole.low[axis], whole.high[axis]].map(f64::from);
            // Allows for the rounding of kernels, which is proportional to the node's size; `slab.rs` says how much.
            let wider = NODE_PART * (high - low).max(0.0);
            let origin = below(low - wider);
            node.0[axis] = origin.to_bits();
            let exponent = cell_exponent(high + wider - f64::from(origin));
            node.0[3] &= !(0xff << (8 * axis));
            node.0[3] |= exponent << (8 * axis);
            let cell = f64::from(f32::from_bits(exponent << 23));
            for (slot, child) in boxes.iter().enumerate() {
                let Some(child) = child else { continue };
                let cells = |x: f64| (x - f64::from(origin)) / cell;
                // Conversions to u8 saturate.
                node.set_byte(8 + 2 * axis, slot, cells(f64::from(child.low[axis]) - wider).floor() as u8);
                node.set_byte(14 + 2 * axis, slot, cells(f64::from(child.high[axis]) + wider).ceil() as u8);
            }
        }
        node
    }

    pub(super) fn byte(&self, word: usize, slot: usize) -> u8 {
        (self.0[word + slot / 4] >> (8 * (slot % 4))) as u8
    }

    pub(super) fn set_byte(&mut self, word: usize, slot: usize, byte: u8) {
        let shift = 8 * (slot % 4);
        let word = &mut self.0[word + slot / 4];
        *word = *word & !(0xff << shift) | u32::from(byte) << shift;
    }

    pub(super) fn set_inner(&mut self, slot: usize) {
        self.0[3] |= 1 << (24 + slot);
    }

    /// Makes a slot a leaf. `offset` counts from the node's first sphere.
    pub(super) fn set_leaf(&mut self, slot: usize, offset: usize, count: usize) {
        self.set_byte(6, slot, (count << LEAF_COUNT_SHIFT | offset) as u8);
    }

    pub(super) fn inner_mask(&self) -> u32 {
        self.0[3] >> 24
    }

    /// The content of a slot, decoded as kernels do.
    #[cfg(test)]
    pub(super) fn slot(&self, slot: usize) -> Slot {
        let mask = self.inner_mask();
        if mask >> slot & 1 == 1 {
            return Slot::Inner(self.0[4].wrapping_add((mask & ((1 << slot) - 1)).count_ones()));
        }
        match self.byte(6, slot) {
            0 => Slot::Empty,
            byte => {
                let byte = u32::from(byte);
                let first = self.0[5].wrapping_add(byte & LEAF_FIRST);
                Slot::Leaf(first, byte >> LEAF_COUNT_SHIFT)
            }
        }
    }

    /// The grid along an axis, 0 to 2: its origin and the size of a cell.
    #[inline]
    pub(super) fn grid(&self, axis: usize) -> [f64; 2] {
        let exponent = self.0[3] >> (8 * axis) & 0xff;
        [f32::from_bits(self.0[axis]).into(), f32::from_bits(exponent << 23).into()]
    }

    fn origin(&self) -> Vec3A {
        Vec3A::from_array([0, 1, 2].map(|axis| f32::from_bits(self.0[axis])))
    }

    fn cell(&self) -> Vec3A {
        let size = |axis: usize| f32::from_bits((self.0[3] >> (8 * axis) & 0xff) << 23);
        Vec3A::from_array([0, 1, 2].map(size))
    }

    /// The box of a slot: its corners with the smallest and the largest coordinates.
    pub(super) fn slot_box(&self, slot: usize) -> [[f64; 3]; 2] {
        [8, 14].map(|words| {
            [0, 1, 2].map(|axis| {
                let cells = f64::from(self.byte(words + 2 * axis, slot));
                f64::from(self.origin()[axis]) + cells * f64::from(self.cell()[axis])
            })
        })
    }
}

/// The largest f32 that is not above `x`.
fn below(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

/// The exponent, as in an f32, of the smallest power of two such that 255 times it is at least `length`.
fn cell_exponent(length: f64) -> u32 {
    let cell = (length / 255.0) as f32;
    let exponent = (cell.to_bits() >> 23).clamp(1, 253);
    let reaches = |exponent: u32| f64::from(f32::from_bits(exponent << 23)) * 255.0 >= length;
    if reaches(exponent) { exponent } else { exponent + 1 }
}

/// Chooses the slot of each child by its box. The children farthest from the centre choose first, and each takes the
/// free octant that best matches its direction.
pub(super) fn octant_slots(boxes: &[Extent]) -> [usize; 8] {
    let whole = boxes.iter().fold(Extent::EMPTY, |all, b| all.union(*b)).center();
    let mut outward = [Vec3A::ZERO; 8];
    let mut order = [0, 1, 2, 3, 4, 5, 6, 7];
    for (outward, child) in outward.iter_mut().zip(boxes) {
        *outward = child.center() - whole;
    }
    let size = |child: &usize| outward[*child].abs().element_sum();
    let order = &mut order[..boxes.len()];
    order.sort_unstable_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
    let mut slots = [0; 8];
    let mut free = 0xff_u32;
    for &mut child in order {
        let mut best = None;
        for slot in (0..8_usize).filter(|slot| free >> slot & 1 == 1) {
            let sign = |axis: usize| if slot >> axis & 1 == 1 { 1.0 } else { -1.0 };
            let along = outward[child].dot(Vec3A::new(sign(0), sign(1), sign(2)));
            if best.is_none_or(|(most, _)| along > most) {
                best = Some((along, slot));
            }
        }
        // A free slot always exists, because there are at most eight children.
        let slot = best.map_or(0, |(_, slot)| slot);
        slots[child] = slot;
        free &= !(1 << slot);
    }
    slots
}
