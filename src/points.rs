//! Spheres as arrays hold them, without colours.

use crate::color::LinearRgb;
use crate::scene::{Scene, SceneError};
use crate::sphere::Sphere;

/// Spheres (x, y, z, radius), not checked, in the precision of their file. [`Points::scene`] checks them.
#[derive(Clone, Debug, PartialEq)]
pub enum Points {
    /// In f32.
    F32(Vec<[f32; 4]>),
    /// In f64.
    F64(Vec<[f64; 4]>),
}

impl Points {
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

    /// A scene of these spheres, all of one colour.
    ///
    /// # Errors
    /// As [`Scene::new`].
    pub fn scene(self, color: LinearRgb) -> Result<Scene, SceneError> {
        match self {
            Self::F32(spheres) => Scene::from_f32(spheres, color),
            Self::F64(spheres) => Scene::from_f64(&spheres, color),
        }
    }

    /// The spheres one by one, all of one colour.
    pub fn spheres(&self, color: LinearRgb) -> impl Iterator<Item = Sphere> {
        let sphere = move |[x, y, z, radius]: [f64; 4]| Sphere::new([x, y, z], radius, color);
        let (narrow, wide): (&[[f32; 4]], &[[f64; 4]]) = match self {
            Self::F32(spheres) => (spheres, &[]),
            Self::F64(spheres) => (&[], spheres),
        };
        narrow.iter().map(|s| s.map(f64::from)).chain(wide.iter().copied()).map(sphere)
    }
}
