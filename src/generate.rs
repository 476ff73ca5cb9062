//! Generated scenes for measurements and experiments. A kind, a count and a seed determine the spheres.
//!
//! The same kind, count and seed give the same bytes on every machine. Numbers that are not integers are computed in
//! f64 with only +, −, ·, / and √, whose rounding IEEE 754 defines, and are rounded to f32 at the end.

use glam::DVec3;

use crate::camera::film::{Film, FilmError};
use crate::camera::{CameraError, PinholeCamera, Pose};
use crate::parallel;

/// The arrangement of generated spheres. All centres lie in the unit cube [0, 1]³, except for those in the tails of
/// clusters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// Uniform centres in the cube, and uniform radii between a half and all of 0.5/∛n.
    Random,
    /// Touching spheres on a face-centred cubic lattice of m³ cells, with the smallest m for which 4·m³ ≥ n. Cells are
    /// ordered by x, then y, then z. Each has a sphere at its corner and at the middles of the faces across x, y and z.
    /// Spheres beyond the n-th are left out. The seed has no effect.
    Lattice,
    /// n/1000 clusters, at least one, whose centres are uniform in the cube. Sphere i belongs to cluster i modulo the
    /// number of clusters. Offsets are nearly normal, the sum of twelve uniform numbers (Irwin–Hall). Their standard
    /// deviations are log-uniform in [0.005, 0.08]. Radii are log-uniform in [10⁻⁶, 10⁻²].
    Clusters,
    /// Haines' sphereflake, in which every sphere has nine children of a third of its radius, in breadth-first order.
    /// Spheres beyond the n-th are left out. The seed has no effect.
    Sphereflake,
}

/// The reason why spheres cannot be generated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct GenerateError(String);

/// The largest number of spheres in a scene.
pub const MAX_COUNT: u64 = u32::MAX as u64 - 1;

/// The number of bytes of a sphere.
pub const BYTES_PER_SPHERE: u64 = 16;

impl Kind {
    /// All kinds.
    pub const ALL: &'static [Self] = &[Self::Random, Self::Lattice, Self::Clusters, Self::Sphereflake];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Lattice => "lattice",
            Self::Clusters => "clusters",
            Self::Sphereflake => "sphereflake",
        }
    }

    /// Generates `count` spheres (x, y, z, radius). A count of zero is not an error.
    ///
    /// # Errors
    /// Returns an error if `count` exceeds [`MAX_COUNT`], or if there is not enough memory.
    pub fn spheres(self, count: u64, seed: u64) -> Result<Vec<[f32; 4]>, GenerateError> {
        check_count(count)?;
        let uniform = Uniform::new(seed);
        match self {
            Self::Random => {
                let largest = 0.5 / cube_root(count);
                filled(count, |i| random(&uniform, i, largest))
            }
            Self::Lattice => {
                let cells = cells_per_side(count);
                filled(count, |i| lattice(i, cells))
            }
            Self::Clusters => {
                let clusters = (count / 1000).max(1);
                // Computed once, not for each sphere of a cluster.
                let clusters: Vec<_> = (0..clusters).map(|c| cluster(&uniform, c)).collect();
                filled(count, |i| in_cluster(&uniform, i, clusters[i as usize % clusters.len()]))
            }
            Self::Sphereflake => {
                let flake = Sphereflake::new();
                filled(count, |i| flake.sphere(i))
            }
        }
    }
}

/// Checks that a scene can have `count` spheres.
///
/// # Errors
/// Returns an error if `count` exceeds [`MAX_COUNT`].
pub fn check_count(count: u64) -> Result<(), GenerateError> {
    let message = "spheres are too many; a scene has at most";
    match count {
        0..=MAX_COUNT => Ok(()),
        _ => Err(GenerateError(format!("{count} {message} {MAX_COUNT}"))),
    }
}

fn filled(count: u64, sphere: impl Fn(u64) -> [f64; 4] + Send + Sync) -> Result<Vec<[f32; 4]>, GenerateError> {
    let length = usize::try_from(count).unwrap_or(usize::MAX);
    parallel::try_map(length, |i| sphere(i as u64).map(|x| x as f32)).map_err(|_| {
        let bytes = count * BYTES_PER_SPHERE;
        GenerateError(format!("there is not enough memory for {count} spheres, which need {bytes} bytes"))
    })
}

fn random(uniform: &Uniform, i: u64, largest: f64) -> [f64; 4] {
    let [x, y, z, size] = [0, 1, 2, 3].map(|k| uniform.number(i, k));
    [x, y, z, largest * (0.5 + 0.5 * size)]
}

fn lattice(i: u64, cells: u64) -> [f64; 4] {
    let (cell, site) = (i / 4, i % 4);
    let cell = [cell % cells, cell / cells % cells, cell / cells / cells];
    // The corner, and the middles of the faces across x, y and z, which have two coordinates of one half.
    let halves = [[0.0; 3], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]][site as usize];
    let edge = 1.0 / cells as f64;
    // An offset of a quarter of a cell centres the lattice in the cube.
    let [x, y, z] = [0, 1, 2].map(|axis| (cell[axis] as f64 + halves[axis] + 0.25) * edge);
    // The distance between neighbours is half the diagonal of a face.
    [x, y, z, edge * std::f64::consts::SQRT_2 / 4.0]
}

/// The centre and the standard deviation of a cluster.
fn cluster(uniform: &Uniform, cluster: u64) -> [f64; 4] {
    // These slots differ from those of the sphere with the same index.
    let [x, y, z, size] = [16, 17, 18, 19].map(|slot| uniform.number(cluster, slot));
    // 0.08 is 2⁴ times 0.005.
    [x, y, z, 0.005 * power_of_two(4.0 * size)]
}

fn in_cluster(uniform: &Uniform, i: u64, [x, y, z, deviation]: [f64; 4]) -> [f64; 4] {
    let offset = |axis: u64| deviation * uniform.nearly_normal(i, 3 * axis);
    // 10⁻² is 10⁴ times 10⁻⁶.
    let radius = 1e-6 * power_of_two(4.0 * std::f64::consts::LOG2_10 * uniform.number(i, 9));
    [x + offset(0), y + offset(1), z + offset(2), radius]
}

/// The smallest m for which 4·m³ ≥ n. It is 1 for n = 0.
fn cells_per_side(count: u64) -> u64 {
    let mut cells = 1_u64;
    while 4 * cells * cells * cells < count {
        cells += 1;
    }
    cells
}

/// The cube root of a count by Newton's method, from above. It is 1 for a count of 0.
fn cube_root(count: u64) -> f64 {
    let n = count.max(1) as f64;
    let mut root = n;
    loop {
        let next = root - (root - n / (root * root)) / 3.0;
        if next >= root {
            return root;
        }
        root = next;
    }
}

/// A standard scene of the benchmarks, with its view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Standard {
    /// A million random spheres.
    R1M,
    /// Ten million random spheres.
    R10M,
    /// A lattice of 63³ cells, seen from outside along a corner.
    L1M,
    /// 200,000 spheres in clusters.
    C200k,
}

impl Standard {
    /// All standard scenes.
    pub const ALL: &'static [Self] = &[Self::R1M, Self::R10M, Self::L1M, Self::C200k];

    /// The seed of all standard scenes.
    pub const SEED: u64 = 1;

    /// The name of the scene.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().0
    }

    /// The number of spheres.
    #[must_use]
    pub const fn count(self) -> u64 {
        self.row().1
    }

    /// The arrangement of the spheres.
    #[must_use]
    pub const fn kind(self) -> Kind {
        self.row().2
    }

    const fn row(self) -> (&'static str, u64, Kind) {
        match self {
            Self::R1M => ("R1M", 1_000_000, Kind::Random),
            Self::R10M => ("R10M", 10_000_000, Kind::Random),
            Self::L1M => ("L1M", 4 * 63 * 63 * 63, Kind::Lattice),
            Self::C200k => ("C200k", 200_000, Kind::Clusters),
        }
    }

    /// The spheres (x, y, z, radius).
    ///
    /// # Errors
    /// Returns an error if there is not enough memory.
    pub fn spheres(self) -> Result<Vec<[f32; 4]>, GenerateError> {
        self.kind().spheres(self.count(), Self::SEED)
    }

    /// The camera. Its view plane is at distance 1.5 and has the half extent (1, 1).
    ///
    /// # Errors
    /// This never fails, because the values are in range.
    pub fn camera(self) -> Result<PinholeCamera, CameraError> {
        let (eye, look_at) = match self {
            Self::R1M | Self::R10M | Self::C200k => ([0.5, 0.6, -1.2], [0.5, 0.5, 0.5]),
            Self::L1M => ([-0.25, 1.10, -0.15], [0.6, 0.98, 0.55]),
        };
        PinholeCamera::new(Pose::looking_at(eye, look_at, [0.0, 1.0, 0.0])?, 1.5, [1.0, 1.0])
    }

    /// The film of 1024×1024 pixels.
    ///
    /// # Errors
    /// This never fails, because the size is in range.
    pub fn film(self) -> Result<Film, FilmError> {
        Film::new(1024, 1024)
    }
}

/// The number of children of every sphere. Sphere i has the children 9·i + 1 to 9·i + 9.
const CHILDREN: u64 = 9;

/// The radius of a child relative to its parent.
const SCALE: f64 = 1.0 / 3.0;

/// The generator of the sphereflake from Eric Haines' Standard Procedural Databases, for any number of spheres.
///
/// E. Haines, "A proposal for standard graphics environments", IEEE Computer Graphics and Applications 7(11), 1987. The
/// directions of the children are those of its program `balls`. Two things differ. The first sphere is in the middle of
/// the unit cube and has the radius ¼, so that the whole flake, which extends to twice its radius, fits into the cube.
/// Spheres are in breadth-first order.
struct Sphereflake {
    /// Directions of the children from a parent whose axis is z.
    directions: [DVec3; CHILDREN as usize],
}

impl Sphereflake {
    fn new() -> Self {
        Self { directions: std::array::from_fn(direction) }
    }

    /// Centre and radius of the i-th sphere.
    fn sphere(&self, i: u64) -> [f64; 4] {
        // The child to choose at each level, from the last level to the first. 2⁶⁴ spheres have fewer than 24 levels.
        let mut path = [0_usize; 24];
        let mut depth = 0;
        let mut sphere = i;
        while sphere > 0 {
            path[depth] = ((sphere - 1) % CHILDREN) as usize;
            sphere = (sphere - 1) / CHILDREN;
            depth += 1;
        }
        let (mut center, mut radius, mut axis) = (DVec3::splat(0.5), 0.25, DVec3::Z);
        for &child in path[..depth].iter().rev() {
            axis = turned(self.directions[child], axis);
            center += axis * (radius * (1.0 + SCALE));
            radius *= SCALE;
        }
        [center.x, center.y, center.z, radius]
    }
}

/// The direction of a child from a parent whose axis is z. There are three groups of three, a third of a turn apart.
fn direction(child: usize) -> DVec3 {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let corner = [DVec3::new(half, half, 0.0), DVec3::new(half, 0.0, -half), DVec3::new(0.0, half, -half)][child % 3];
    // Rotation about (1, −1, 0)/√2 by the angle whose sine is 2/√6, which makes the middle of the group horizontal.
    let about = DVec3::new(half, -half, 0.0);
    let (sine, cosine) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    let v = corner * cosine + about.cross(corner) * sine + about * (about.dot(corner) * (1.0 - cosine));
    // Rotation about z by 0, 1/3 or 2/3 of a turn.
    let root = 0.75_f64.sqrt();
    let (sine, cosine) = [(0.0, 1.0), (root, -0.5), (-root, -0.5)][child / 3];
    DVec3::new(v.x * cosine - v.y * sine, v.x * sine + v.y * cosine, v.z)
}

/// Rotates a vector by the shortest rotation that takes z to `axis`.
fn turned(v: DVec3, axis: DVec3) -> DVec3 {
    if axis.z <= -1.0 {
        return DVec3::new(-v.x, v.y, -v.z);
    }
    // Rodrigues' formula. The length of `about` is the sine.
    let about = DVec3::Z.cross(axis);
    v * axis.z + about.cross(v) + about * (about.dot(v) / (1.0 + axis.z))
}

/// The step of `SplitMix64`: 2⁶⁴ divided by the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// The number of slots of each index.
const SLOTS: u64 = 32;

/// The random numbers of `SplitMix64`, accessed by slot rather than in sequence. Its n-th state is the seed plus n
/// steps.
///
/// G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014. The constants are
/// those of S. Vigna's splitmix64.c. The seed is mixed once first, so that neighbouring seeds give unrelated numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Uniform {
    seed: u64,
}

impl Uniform {
    pub(crate) fn new(seed: u64) -> Self {
        Self { seed: mix(seed.wrapping_add(STEP)) }
    }

    /// 64 random bits. `slot` must be less than [`SLOTS`].
    pub(crate) fn bits(&self, index: u64, slot: u64) -> u64 {
        let n = index.wrapping_mul(SLOTS).wrapping_add(slot).wrapping_add(1);
        mix(self.seed.wrapping_add(n.wrapping_mul(STEP)))
    }

    /// A uniform random number, which is a multiple of 2⁻⁵³ in [0, 1).
    pub(crate) fn number(&self, index: u64, slot: u64) -> f64 {
        (self.bits(index, slot) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The sum of twelve uniform 16-bit numbers minus its mean (Irwin–Hall). It has the mean 0 and the standard
    /// deviation 1 (except for 2⁻³²), and is never beyond ±6. It uses three slots from `slot` on.
    fn nearly_normal(&self, index: u64, slot: u64) -> f64 {
        let quarters = |bits: u64| (0..4).map(move |k| (bits >> (16 * k)) & 0xffff);
        let sum: u64 = (0..3).flat_map(|k| quarters(self.bits(index, slot + k))).sum();
        // Twelve half steps move the mean to zero.
        (sum as f64 + 6.0) / f64::from(1 << 16) - 6.0
    }
}

/// The output function of `SplitMix64`.
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// 2ˣ for 0 ≤ x < 60, by the exponential series of the fraction. The error after 20 terms is below the resolution of
/// f64. `f64::exp2` differs between platforms.
fn power_of_two(x: f64) -> f64 {
    let whole = x.floor();
    let y = (x - whole) * std::f64::consts::LN_2;
    let series = (1..=20).rev().fold(1.0, |sum, n| 1.0 + sum * y / f64::from(n));
    series * (1_u64 << whole as u64) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cube_roots() {
        for root in [1_u64, 2, 10, 100, 1000, 1600] {
            let found = cube_root(root * root * root);
            assert!((found / root as f64 - 1.0).abs() < 1e-15, "{root}: {found}");
        }
        assert!((cube_root(0) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn lattices_are_just_large_enough() {
        for (count, cells) in [(0, 1), (4, 1), (5, 2), (32, 2), (33, 3), (1_000_188, 63)] {
            assert_eq!(cells_per_side(count), cells, "{count}");
        }
    }

    #[test]
    fn children_touch_their_parent_and_lie_outside_it() {
        let flake = Sphereflake::new();
        for i in 1..9_u64.pow(5) {
            let [child, parent] = [i, (i - 1) / CHILDREN].map(|i| flake.sphere(i));
            let center = |s: [f64; 4]| DVec3::new(s[0], s[1], s[2]);
            let gap = (center(child) - center(parent)).length() - child[3] - parent[3];
            assert!(gap.abs() < 1e-9, "{i}: {gap}");
            assert!(child.iter().all(|x| (0.0..=1.0).contains(x)), "{child:?}");
        }
    }

    /// Six children lie around the equator and three above it.
    #[test]
    fn nine_directions() {
        let height = |child| direction(child).z;
        let on_equator = (0..9).filter(|child| height(*child).abs() < 1e-12).count();
        let above = (0..9).filter(|child| height(*child) > 0.5).count();
        assert_eq!((on_equator, above), (6, 3));
    }

    /// The first numbers of the published generator with the seed 0.
    #[test]
    fn the_stream_is_that_of_splitmix64() {
        let uniform = Uniform { seed: 0 };
        assert_eq!(
            [0, 1, 2].map(|slot| uniform.bits(0, slot)),
            [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]
        );
    }

    #[test]
    fn powers_of_two() {
        for i in 0..=1300 {
            let x = f64::from(i) / 100.0;
            assert!((power_of_two(x) / x.exp2() - 1.0).abs() < 1e-15, "{x}");
        }
    }

    #[test]
    fn moments() {
        let uniform = Uniform::new(7);
        let numbers = |f: fn(&Uniform, u64) -> f64| (0..100_000).map(move |i| f(&uniform, i));
        let mean = |numbers: &mut dyn Iterator<Item = f64>| numbers.sum::<f64>() / 1e5;
        assert!((mean(&mut numbers(|u, i| u.number(i, 0))) - 0.5).abs() < 0.01);
        assert!(mean(&mut numbers(|u, i| u.nearly_normal(i, 0))).abs() < 0.02);
        assert!((mean(&mut numbers(|u, i| u.nearly_normal(i, 0).powi(2))) - 1.0).abs() < 0.02);
    }
}
