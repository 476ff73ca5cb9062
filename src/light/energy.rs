//! Tables of the energy that a rough lobe keeps when light scatters only once at its surface.
//!
//! The entries are the mean weight of samples drawn from visible normals: E of E. Turquin, "Practical multiple
//! scattering compensation for microfacet models", 2019. Renderers divide by it, so that a white surface loses no
//! light. [`Lobe`] defines the samples and the weights.

use std::collections::{BTreeMap, HashMap};
use std::f64::consts::PI;
use std::sync::{Mutex, PoisonError};

use glam::DVec3;

use crate::parallel;
use crate::scene::material::{Material, SurfaceProperties};

/// The number of entries of a table. Entry k is for the cosine μ = (k/255)⁴. Entries are denser at grazing angles,
/// because lobes of roughness 0.02 change near μ = 0.0004.
///
/// The error of linear interpolation is below 0.0002 for reflection and 0.0005 for refraction (ior from 1.1), and that
/// of the entries themselves is below 0.0005 and 0.001.
pub(crate) const ENTRIES: usize = 256;

/// A lobe of reflected or refracted light, for which a table says how much energy a single scattering loses. Its normals follow the GGX distribution (Trowbridge and Reitz), with α = roughness².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Lobe {
    /// All light is reflected. The weight of a sample is G2/G1, with the height-correlated G2.
    Reflection {
        /// Roughness: 0.02 to 1.
        roughness: f32,
    },
    /// Light is reflected or refracted, with probabilities from Fresnel's equations. The weight of a sample is G1 of
    /// its outgoing direction.
    Refraction {
        /// Index of refraction, relative to the outside.
        ior: f32,
        /// Roughness: 0.02 to 1.
        roughness: f32,
        /// Whether light arrives from inside.
        is_leaving: bool,
    },
}

impl Lobe {
    /// The lobes of a material, in the order of their tables: from outside, then from inside.
    fn of(surface: &SurfaceProperties) -> Vec<Self> {
        match surface.material {
            Material::Lambert { specular, roughness } if specular > 0.0 => {
                vec![Self::Reflection { roughness }]
            }
            Material::Conductor { roughness } => vec![Self::Reflection { roughness }],
            Material::Dielectric { ior, roughness, .. } if roughness > 0.0 => {
                [false, true].map(|is_leaving| Self::Refraction { ior, roughness, is_leaving }).into()
            }
            _ => Vec::new(),
        }
    }

    /// The bits of all parameters. Only equal lobes have equal bits.
    fn bits(self) -> [u32; 3] {
        match self {
            Self::Reflection { roughness } => [0, roughness.to_bits(), 0],
            Self::Refraction { ior, roughness, is_leaving } => {
                [1 + u32::from(is_leaving), roughness.to_bits(), ior.to_bits()]
            }
        }
    }
}

/// The energy tables of all materials of a scene. They say how much light each rough lobe keeps when it scatters once,
/// so that renderers can compensate for the rest. Materials with equal lobes share tables.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct EnergyTables {
    /// The entries of all tables, one table after the other.
    pub(crate) entries: Vec<f32>,
    /// For each surface, the index in `entries` at which its first table starts. `None` for a material that needs no
    /// table. A rough dielectric has two consecutive tables: from outside, then from inside.
    pub(crate) starts: Vec<Option<u32>>,
}

impl EnergyTables {
    /// The tables for a list of surfaces.
    pub(crate) fn of(surfaces: &[SurfaceProperties]) -> Self {
        let mut indices = HashMap::new();
        let mut lobes: Vec<Lobe> = Vec::new();
        let starts = surfaces.iter().map(|surface| {
            let of_surface = Lobe::of(surface);
            let key: Vec<_> = of_surface.iter().map(|lobe| lobe.bits()).collect();
            let start = (lobes.len() * ENTRIES) as u32;
            (!key.is_empty()).then(|| {
                *indices.entry(key).or_insert_with(|| {
                    lobes.extend(of_surface);
                    start
                })
            })
        });
        let starts = starts.collect();
        Self { entries: lobes.into_iter().flat_map(remembered_table).collect(), starts }
    }
}

/// The table of a lobe, cached in this process, because each picture of a series and its check need it again.
fn remembered_table(lobe: Lobe) -> Vec<f32> {
    static TABLES: Mutex<BTreeMap<[u32; 3], Vec<f32>>> = Mutex::new(BTreeMap::new());
    /// The largest number of cached tables, which take a quarter of a megabyte.
    const MOST: usize = 256;
    let tables = || TABLES.lock().unwrap_or_else(PoisonError::into_inner);
    let known = tables().get(&lobe.bits()).cloned();
    // The lock is not held meanwhile, because a thread that waits for others may take up work that needs a table.
    known.unwrap_or_else(|| {
        let table = albedo_table(lobe);
        let mut tables = tables();
        if tables.len() >= MOST {
            tables.clear();
        }
        tables.insert(lobe.bits(), table.clone());
        table
    })
}

/// Computes the table of a lobe: E at [`ENTRIES`] cosines, by a quadrature that takes about ten milliseconds.
pub(crate) fn albedo_table(lobe: Lobe) -> Vec<f32> {
    let points = disk_points(POINTS);
    parallel::map(ENTRIES, |k| {
        let x = k as f64 / (ENTRIES - 1) as f64;
        mean_weight(lobe, x * x * x * x, &points) as f32
    })
}

/// Interpolates E in a table, at a cosine in [0, 1].
pub(crate) fn lookup(table: &[f32], cosine: f64) -> f64 {
    let last = ENTRIES - 1;
    let x = cosine.clamp(0.0, 1.0).sqrt().sqrt() * last as f64;
    let entry = (x.floor() as usize).min(last - 1);
    let [low, high] = [entry, entry + 1].map(|i| table.get(i).copied().map_or(1.0, f64::from));
    low + (x - entry as f64) * (high - low)
}

/// Points spread evenly over the half of the unit disk with x > 0: a Fibonacci lattice in r² and angle. It is the most
/// accurate of the quadratures that were tried (midpoints, Gauss, other maps) for weights with kinks along curves,
/// which occur at grazing angles.
///
/// `step` and `count` are consecutive Fibonacci numbers.
fn disk_points([step, count]: [usize; 2]) -> Vec<[f64; 2]> {
    let point = |i: usize| {
        let along = (i as f64 + 0.5) / count as f64;
        let around = ((i * step % count) as f64 + 0.5) / count as f64;
        let (sine, cosine) = (PI * (around - 0.5)).sin_cos();
        [cosine * along.sqrt(), sine * along.sqrt()]
    };
    (0..count).map(point).collect()
}

/// The step and the number of the points for computing tables.
const POINTS: [usize; 2] = [1597, 2584];

/// The smallest cosine. Smaller ones are clamped to it.
const MIN_COSINE: f64 = 1e-6;

fn mean_weight(lobe: Lobe, cosine: f64, points: &[[f64; 2]]) -> f64 {
    let cosine = cosine.clamp(MIN_COSINE, 1.0);
    let view = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let (Lobe::Reflection { roughness } | Lobe::Refraction { roughness, .. }) = lobe;
    let alpha = f64::from(roughness) * f64::from(roughness);
    let of_view = smith(cosine, alpha);
    let weight = |half: DVec3| {
        let m = view.dot(half);
        let up = 2.0 * m * half.z - view.z;
        match lobe {
            Lobe::Reflection { .. } if up > 0.0 => (1.0 + of_view) / (1.0 + of_view + smith(up, alpha)),
            Lobe::Reflection { .. } => 0.0,
            Lobe::Refraction { ior, is_leaving, .. } => {
                let eta = if is_leaving { 1.0 / f64::from(ior) } else { f64::from(ior) };
                let shadowing = |z: f64| if z > 0.0 { 1.0 / (1.0 + smith(z, alpha)) } else { 0.0 };
                let (reflected, inside) = fresnel(m, eta);
                let down = view.z / eta - (m / eta - inside) * half.z;
                reflected * shadowing(up) + (1.0 - reflected) * shadowing(down)
            }
        }
    };
    let sum: f64 = points.iter().map(|p| weight(visible_normal(view, alpha, *p))).sum();
    sum / points.len() as f64
}

/// Smith's function Λ for GGX, at a cosine.
fn smith(cosine: f64, alpha: f64) -> f64 {
    let square = cosine * cosine;
    0.5 * ((1.0 + alpha * alpha * (1.0 - square) / square).sqrt() - 1.0)
}

/// Maps a point of the disk to a normal that is visible from `view`, whose y is 0 (E. Heitz, "Sampling the GGX
/// Distribution of Visible Normals", JCGT 7(4), 2018).
fn visible_normal(view: DVec3, alpha: f64, [x, y]: [f64; 2]) -> DVec3 {
    let stretched = DVec3::new(alpha * view.x, 0.0, view.z).normalize_or(DVec3::Z);
    let s = 0.5 * (1.0 + stretched.z);
    let y = (1.0 - s) * (1.0 - x * x).max(0.0).sqrt() + s * y;
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    let normal = DVec3::new(z * stretched.x - y * stretched.z, x, z * stretched.z + y * stretched.x);
    DVec3::new(alpha * normal.x, alpha * normal.y, normal.z.max(1e-6)).normalize_or(DVec3::Z)
}

/// The fraction of unpolarised light that is reflected, and the cosine of the refracted direction, by Fresnel's
/// equations.
fn fresnel(cosine: f64, eta: f64) -> (f64, f64) {
    let sine_squared = (1.0 - cosine * cosine) / (eta * eta);
    if sine_squared >= 1.0 {
        return (1.0, 0.0);
    }
    let inside = (1.0 - sine_squared).sqrt();
    let parallel = (eta * cosine - inside) / (eta * cosine + inside);
    let across = (cosine - eta * inside) / (cosine + eta * inside);
    (0.5 * (parallel * parallel + across * across), inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lobes(roughness: f32) -> Vec<Lobe> {
        let mut lobes = vec![Lobe::Reflection { roughness }];
        for ior in [1.1, 1.5, 4.0] {
            lobes.extend([false, true].map(|is_leaving| Lobe::Refraction { ior, roughness, is_leaving }));
        }
        lobes
    }

    /// Checks half-way between entries, where the error of interpolation is largest.
    #[test]
    fn tables_are_fine_enough() {
        let points = disk_points([6765, 10946]);
        for roughness in [0.02, 0.1, 0.4, 1.0] {
            for lobe in lobes(roughness) {
                let exact = |k: f64| mean_weight(lobe, (k / 255.0).powi(4), &points);
                let bound = match lobe {
                    Lobe::Reflection { .. } => 2e-4,
                    Lobe::Refraction { .. } => 5e-4,
                };
                for k in (0..255).step_by(12).chain(252..255).map(f64::from) {
                    let error = 0.5 * (exact(k) + exact(k + 1.0)) - exact(k + 0.5);
                    assert!(error.abs() < bound, "{lobe:?}, {k}: {error}");
                }
            }
        }
    }

    /// Compares with a finer quadrature over the lobe's directions: ∫ D G2/(4 cos) over the hemisphere.
    #[test]
    fn entries_are_what_the_lobe_reflects() {
        const STEPS: u32 = 500;
        for roughness in [0.3_f32, 0.6, 1.0] {
            let alpha = f64::from(roughness) * f64::from(roughness);
            let table = albedo_table(Lobe::Reflection { roughness });
            for cosine in [0.1_f64, 0.35, 0.7, 0.95] {
                let view = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
                let mut sum = 0.0;
                for i in 0..STEPS {
                    let (sine, z) = (0.5 * PI * (f64::from(i) + 0.5) / f64::from(STEPS)).sin_cos();
                    for j in 0..STEPS {
                        let (y, x) = (PI * (f64::from(j) + 0.5) / f64::from(STEPS)).sin_cos();
                        let h = (view + DVec3::new(sine * x, sine * y, z)).normalize_or(DVec3::Z);
                        let t = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z;
                        let shadowing = 1.0 / (1.0 + smith(cosine, alpha) + smith(z, alpha));
                        sum += sine * shadowing / (PI * alpha * alpha * t * t * 4.0 * cosine);
                    }
                }
                // The sum covers half of the hemisphere. The factor counts both halves.
                let wanted = sum * PI * PI / f64::from(STEPS).powi(2);
                let found = lookup(&table, cosine);
                assert!((found - wanted).abs() < 5e-4, "{roughness}, {cosine}: {found}, {wanted}");
            }
        }
    }

    /// Compares with a quadrature with 76 times as many points.
    #[test]
    fn entries_do_not_depend_on_the_quadrature() {
        let finer = disk_points([121_393, 196_418]);
        let points = disk_points(POINTS);
        for roughness in [0.05, 0.3, 1.0] {
            for lobe in lobes(roughness) {
                for cosine in [0.02, 0.3, 0.8] {
                    let found = mean_weight(lobe, cosine, &points);
                    let wanted = mean_weight(lobe, cosine, &finer);
                    let bound = if matches!(lobe, Lobe::Reflection { .. }) { 5e-4 } else { 1e-3 };
                    assert!((found - wanted).abs() < bound, "{lobe:?}: {found}, {wanted}");
                }
            }
        }
    }

    #[test]
    fn lookups_interpolate() {
        let table: Vec<f32> = (0..ENTRIES).map(|k| k as f32).collect();
        assert!((lookup(&table, 0.0)).abs() < 1e-12);
        assert!((lookup(&table, 1.0) - 255.0).abs() < 1e-12);
        assert!((lookup(&table, (100.25_f64 / 255.0).powi(4)) - 100.25).abs() < 1e-9);
    }

    #[test]
    fn materials_share_tables() {
        let surface = |material| SurfaceProperties { material, opacity: 1.0 };
        let glass = Material::Dielectric { ior: 1.5, roughness: 0.3, attenuation_distance: None };
        let tables = EnergyTables::of(&[
            surface(Material::default()),
            surface(Material::Conductor { roughness: 0.3 }),
            surface(glass),
            surface(Material::Lambert { specular: 0.1, roughness: 0.3 }),
            surface(Material::Emissive { strength: 1.0 }),
            surface(glass),
        ]);
        assert_eq!(tables.starts, [None, Some(0), Some(256), Some(0), None, Some(256)]);
        assert_eq!(tables.entries.len(), 3 * 256);
        let leaving = Lobe::Refraction { ior: 1.5, roughness: 0.3, is_leaving: true };
        assert_eq!(tables.entries[512..], albedo_table(leaving));
    }
}
