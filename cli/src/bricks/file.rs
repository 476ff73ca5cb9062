//! The layout of a file of bricks: a line that names the format, the place of the header, the spheres brick by brick,
//! the header as JSON, and the digest of place and header. Numbers of the header are the bits of f64 and f32.

use pinhole::geometry::bounds::Bounds;
use pinhole::glam::{DVec3, Vec3};
use pinhole::scene::SceneExtent;
use serde::{Deserialize, Serialize};

/// The first bytes of a file of this version.
pub(super) const START: &[u8; 17] = b"pinhole bricks 2\n";

/// The start of this line, which all versions share.
pub(super) const NAME: &[u8] = b"pinhole bricks ";

/// Offset of the place and the length of the header, in eight bytes each.
pub(super) const PLACE: usize = 24;

/// Number of bytes before the first brick.
pub(super) const BEFORE: u64 = 40;

pub(super) const DIGEST: usize = 32;

/// Maximum header length in bytes.
pub(super) const LONGEST_HEADER: u64 = 1 << 26;

/// Number of bytes of a sphere, of its id, and of its colour if there are colours.
pub(super) const SPHERE: u64 = 16;
pub(super) const ID: u64 = 4;
pub(super) const COLOR: u64 = 4;

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Header {
    pub(super) version: String,
    /// Name of the file that was sorted.
    pub(super) source: String,
    pub(super) z_is_up: bool,
    pub(super) has_atoms: bool,
    pub(super) whole: WholeBits,
    pub(super) colors: StoredColors,
    /// The spheres that extend farthest in some direction. They follow the bricks and have no ids.
    pub(super) outer: Section,
    pub(super) bricks: Vec<Brick>,
}

/// A contiguous part of the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Section {
    /// The number of spheres.
    pub(super) count: u64,
    /// Offset of the first byte.
    pub(super) offset: u64,
    pub(super) sha256: String,
}

/// A brick: its spheres, then their ids in ascending order, then their colours.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Brick {
    pub(super) section: Section,
    /// The corners of the box of the spheres, in the frame of the scene.
    pub(super) min: [u32; 3],
    pub(super) max: [u32; 3],
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum StoredColors {
    None,
    /// All spheres have this linear colour.
    One([u32; 3]),
    /// Each sphere has an index into these linear colours.
    Palette(Vec<[u32; 3]>),
    Rgba8,
}

/// The numbers of [`SceneExtent`] as bits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WholeBits {
    pub(super) count: u64,
    /// The corners of the box in world space.
    bounds: [[u64; 3]; 2],
    /// The corners of the boxes of spheres and of centres, in the frame of the scene.
    spheres: [[u32; 3]; 2],
    centers: [[u32; 3]; 2],
    pub(super) radii: [u32; 2],
    radius_sum: u64,
}

pub(super) fn bits(corner: Vec3) -> [u32; 3] {
    corner.to_array().map(f32::to_bits)
}

pub(super) fn corner(bits: [u32; 3]) -> Vec3 {
    bits.map(f32::from_bits).into()
}

impl WholeBits {
    pub(super) fn of(whole: &SceneExtent) -> Self {
        let wide = |corner: DVec3| corner.to_array().map(f64::to_bits);
        Self {
            count: whole.count,
            bounds: [wide(whole.bounds.min()), wide(whole.bounds.max())],
            spheres: [bits(whole.min), bits(whole.max)],
            centers: [bits(whole.center_min), bits(whole.center_max)],
            radii: [whole.radius_min, whole.radius_max].map(f32::to_bits),
            radius_sum: whole.radius_sum.to_bits(),
        }
    }

    /// Returns the bounds of the whole; `None` if numbers are not finite or corners are in the wrong order.
    pub(super) fn whole(&self) -> Option<SceneExtent> {
        let [min, max] = self.bounds.map(|bits| DVec3::from(bits.map(f64::from_bits)));
        let bounds = extent(min, max)?;
        let [low, high] = self.spheres.map(corner);
        let [center_min, center_max] = self.centers.map(corner);
        let ordered = |low: Vec3, high: Vec3| low.is_finite() && high.is_finite() && low.cmple(high).all();
        let [radius_min, radius_max] = self.radii.map(f32::from_bits);
        let is_whole = ordered(low, high) && ordered(center_min, center_max) && self.count > 0;
        is_whole.then_some(SceneExtent {
            count: self.count,
            min: low,
            max: high,
            center_min,
            center_max,
            radius_min,
            radius_max,
            radius_sum: f64::from_bits(self.radius_sum),
            ..SceneExtent::new(bounds)
        })
    }
}

impl StoredColors {
    /// Number of bytes of a sphere's colour, beside its four numbers and its id.
    pub(super) fn bytes(&self) -> u64 {
        match self {
            Self::None | Self::One(_) => 0,
            Self::Palette(_) | Self::Rgba8 => COLOR,
        }
    }

    /// Number of bytes of a sphere in a brick.
    pub(super) fn sphere_bytes(&self) -> u64 {
        SPHERE + ID + self.bytes()
    }
}

/// Returns the box between two corners; `None` if they are not finite or in the wrong order.
pub(super) fn extent(min: DVec3, max: DVec3) -> Option<Bounds> {
    let is_box = min.is_finite() && max.is_finite() && min.cmple(max).all();
    is_box.then(|| Bounds::of_sphere(min, 0.0).union(Bounds::of_sphere(max, 0.0)))
}

impl Header {
    /// Whether the sections of the file follow each other without gaps, up to `end`, and have all spheres.
    pub(super) fn is_consistent(&self, end: u64) -> bool {
        let mut next = BEFORE;
        let mut follows = |section: &Section, each: u64| {
            let is_next = section.offset == next && section.count > 0;
            let bytes = section.count.checked_mul(each).and_then(|bytes| next.checked_add(bytes));
            next = bytes.unwrap_or(u64::MAX);
            is_next && bytes.is_some()
        };
        let each = self.colors.sphere_bytes();
        let all = self.bricks.iter().all(|brick| follows(&brick.section, each));
        let all = all && follows(&self.outer, SPHERE);
        let counts = self.bricks.iter().try_fold(0_u64, |sum, brick| sum.checked_add(brick.section.count));
        let Some(whole) = self.whole.whole() else { return false };
        let is_inside = |brick: &Brick| {
            let [min, max] = [corner(brick.min), corner(brick.max)];
            min.cmpge(whole.min).all() && max.cmple(whole.max).all() && min.cmple(max).all()
        };
        all && next == end
            && counts == Some(whole.count)
            && whole.count < u64::from(u32::MAX)
            && self.bricks.iter().all(is_inside)
    }
}
