//! Spheres as arrays hold them, without colours.

use crate::image::color::LinearRgb;
use crate::scene::sphere::Sphere;

/// Spheres (x, y, z, radius), not checked, in the precision of their source.
/// [`Scene::from_parts`](crate::Scene::from_parts) checks them.
#[derive(Clone, Debug, PartialEq)]
pub enum SphereArray {
    /// In f32.
    F32(Vec<[f32; 4]>),
    /// In f64.
    F64(Vec<[f64; 4]>),
}

/// Radii of spheres whose centres stand apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Radii<'a, T> {
    /// All have one.
    All(T),
    /// Each has its own.
    Each(&'a [T]),
}

/// There are not as many radii as positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{}: there are {radii} radii for {positions} positions",
    if radii < positions { format!("position {radii} has no radius") } else { format!("radius {positions} has no position") }
)]
pub struct RadiiError {
    /// How many positions there are.
    pub positions: usize,
    /// How many radii there are.
    pub radii: usize,
}

impl SphereArray {
    /// Spheres whose centres and radii stand apart, in f32.
    ///
    /// # Errors
    /// If there are not as many radii as centres.
    pub fn from_f32(centers: &[[f32; 3]], radii: Radii<'_, f32>) -> Result<Self, RadiiError> {
        joined(centers, radii).map(Self::F32)
    }

    /// Spheres whose centres and radii stand apart, in f64.
    ///
    /// # Errors
    /// If there are not as many radii as centres.
    pub fn from_f64(centers: &[[f64; 3]], radii: Radii<'_, f64>) -> Result<Self, RadiiError> {
        joined(centers, radii).map(Self::F64)
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::F32(spheres) => spheres.len(),
            Self::F64(spheres) => spheres.len(),
        }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Multiplies every radius; f32 stays f32.
    pub fn scale_radii(&mut self, factor: f64) {
        match self {
            Self::F32(spheres) => {
                spheres.iter_mut().for_each(|s| s[3] = (f64::from(s[3]) * factor) as f32);
            }
            Self::F64(spheres) => spheres.iter_mut().for_each(|s| s[3] *= factor),
        }
    }

    /// The spheres one by one, all of one colour.
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
        Radii::Each(radii) => Err(RadiiError { positions: centers.len(), radii: radii.len() }),
    }
}
