//! Generated scenes for measurements and experiments: spheres from a kind, a count and a seed.
//!
//! The same kind, count and seed give the same bytes on every machine: whatever is not an integer is computed in f64
//! with only +, −, ·, / and √, whose rounding IEEE 754 defines, and is rounded to f32 at the end.

mod sphereflake;
mod standard;
mod uniform;

pub use standard::Standard;
pub(crate) use uniform::Uniform;

use crate::parallel;
use sphereflake::Sphereflake;
use uniform::power_of_two;

/// The arrangement of generated spheres. All centres lie in the unit cube [0, 1]³, except for those in the tails of
/// clusters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// Centres are uniform in the cube, radii uniform between a half and all of 0.5/∛n.
    Random,
    /// Touching spheres on a face-centred cubic lattice of m³ cells, with the smallest m for which 4·m³ ≥ n. Cells are
    /// ordered by x, then y, then z; each has the corner and the middles of the faces across x, y and z. Spheres beyond
    /// the n-th are left out. The seed has no effect.
    Lattice,
    /// n/1000 clusters, at least one, whose centres are uniform in the cube; sphere i belongs to cluster i modulo the
    /// number of clusters. Offsets are nearly normal, the sum of twelve uniform numbers (Irwin–Hall), with standard
    /// deviations log-uniform in [0.005, 0.08]; radii are log-uniform in [10⁻⁶, 10⁻²].
    Clusters,
    /// Haines' sphereflake: every sphere has nine children of a third of its radius, in breadth-first order. Spheres
    /// beyond the n-th are left out. The seed has no effect.
    Sphereflake,
}

/// Why spheres cannot be generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// More spheres are requested than a scene can have.
    #[error("{count} spheres are too many; a scene has at most {}", MAX_COUNT)]
    TooMany {
        /// The number of spheres requested.
        count: u64,
    },
    /// There is not enough memory.
    #[error("there is not enough memory for {count} spheres, which need {} bytes", count * BYTES_PER_SPHERE)]
    Memory {
        /// The number of spheres requested.
        count: u64,
    },
}

/// The largest number of spheres in a scene.
pub const MAX_COUNT: u64 = u32::MAX as u64 - 1;

/// The number of bytes of a sphere.
pub const BYTES_PER_SPHERE: u64 = 16;

impl Kind {
    /// All kinds.
    pub const ALL: &'static [Self] =
        &[Self::Random, Self::Lattice, Self::Clusters, Self::Sphereflake];

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

    /// Generates `count` spheres (x, y, z, radius); a count of zero is not an error.
    ///
    /// # Errors
    /// Returns an error if `count` exceeds [`MAX_COUNT`], or if there is not enough memory.
    pub fn spheres(self, count: u64, seed: u64) -> Result<Vec<[f32; 4]>, GenerateError> {
        if count > MAX_COUNT {
            return Err(GenerateError::TooMany { count });
        }
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

fn filled(
    count: u64,
    sphere: impl Fn(u64) -> [f64; 4] + Send + Sync,
) -> Result<Vec<[f32; 4]>, GenerateError> {
    let memory = |_| GenerateError::Memory { count };
    let length = usize::try_from(count).map_err(|_| GenerateError::Memory { count })?;
    parallel::try_map(length, |i| sphere(i as u64).map(|x| x as f32)).map_err(memory)
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
    // The distance of neighbours is half the diagonal of a face.
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

/// The smallest m for which 4·m³ ≥ n; 1 for n = 0.
fn cells_per_side(count: u64) -> u64 {
    let mut cells = 1_u64;
    while 4 * cells * cells * cells < count {
        cells += 1;
    }
    cells
}

/// The cube root of a count by Newton's method, from above; 1 for a count of 0.
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
}
