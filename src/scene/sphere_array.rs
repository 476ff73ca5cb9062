//! Arrays of spheres without colours.

use crate::image::color::LinearRgb;
use crate::scene::sphere::Sphere;

/// Spheres (x, y, z, radius) in the precision of their source, which have not been checked.
/// [`Scene::from_parts`](crate::Scene::from_parts) checks them.
#[derive(Clone, Debug, PartialEq)]
pub enum SphereArray {
    /// Spheres in f32.
    F32(Vec<[f32; 4]>),
    /// Spheres in f64.
    F64(Vec<[f64; 4]>),
}

/// Radii that are stored separately from the centres of their spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Radii<'a, T> {
    /// All spheres have the same radius.
    All(T),
    /// Each sphere has its own radius.
    Each(&'a [T]),
}

/// An error for radii whose number differs from that of the positions.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct RadiiError(String);

impl SphereArray {
    /// Spheres from centres and radii in f32.
    ///
    /// # Errors
    /// Returns an error if the number of radii differs from the number of centres.
    pub fn from_f32(centers: &[[f32; 3]], radii: Radii<'_, f32>) -> Result<Self, RadiiError> {
        joined(centers, radii).map(Self::F32)
    }

    /// Spheres from centres and radii in f64.
    ///
    /// # Errors
    /// Returns an error if the number of radii differs from the number of centres.
    pub fn from_f64(centers: &[[f64; 3]], radii: Radii<'_, f64>) -> Result<Self, RadiiError> {
        joined(centers, radii).map(Self::F64)
    }

    /// The number of spheres.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::F32(spheres) => spheres.len(),
            Self::F64(spheres) => spheres.len(),
        }
    }

    /// Returns true if there are no spheres.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The centre and radius of a sphere.
    #[must_use]
    pub fn at(&self, index: usize) -> [f64; 4] {
        match self {
            Self::F32(spheres) => spheres[index].map(f64::from),
            Self::F64(spheres) => spheres[index],
        }
    }

    /// Replaces each radius by `radius_of` its index and itself. The precision of the array stays the same.
    pub fn map_radii(&mut self, radius_of: impl Fn(usize, f64) -> f64) {
        match self {
            Self::F32(all) => {
                (0..).zip(all).for_each(|(i, s)| s[3] = radius_of(i, s[3].into()) as f32);
            }
            Self::F64(all) => (0..).zip(all).for_each(|(i, s)| s[3] = radius_of(i, s[3])),
        }
    }

    /// Iterates over the spheres, with one colour for all of them.
    pub fn with_color(&self, color: LinearRgb) -> impl Iterator<Item = Sphere> {
        let sphere = move |[x, y, z, radius]: [f64; 4]| Sphere::new([x, y, z], radius, color);
        let (narrow, wide): (&[[f32; 4]], &[[f64; 4]]) = match self {
            Self::F32(spheres) => (spheres, &[]),
            Self::F64(spheres) => (&[], spheres),
        };
        narrow.iter().map(|s| s.map(f64::from)).chain(wide.iter().copied()).map(sphere)
    }
}

fn joined<T: Copy>(centers: &[[T; 3]], radii: Radii<'_, T>) -> Result<Vec<[T; 4]>, RadiiError> {
    let sphere = |([x, y, z], radius): (&[T; 3], T)| [*x, *y, *z, radius];
    match radii {
        Radii::All(radius) => Ok(centers.iter().map(|center| sphere((center, radius))).collect()),
        Radii::Each(radii) if radii.len() == centers.len() => {
            Ok(centers.iter().zip(radii.iter().copied()).map(sphere).collect())
        }
        Radii::Each(radii) => {
            let (radii, positions) = (radii.len(), centers.len());
            let lacking = match radii < positions {
                true => format!("position {radii} has no radius"),
                false => format!("radius {positions} has no position"),
            };
            Err(RadiiError(format!("{lacking}: there are {radii} radii for {positions} positions")))
        }
    }
}
