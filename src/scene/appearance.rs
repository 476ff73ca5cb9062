//! What a scene's spheres look like, apart from where they are.

use super::SceneError;
use super::color_map::ColorMap;
use crate::image::color::LinearRgb;
use crate::scene::material::SurfaceProperties;

/// The colours of a scene's spheres, in input order.
#[derive(Clone, Debug, PartialEq)]
pub enum Colors {
    /// All spheres have one.
    One(LinearRgb),
    /// Some colours, of which every sphere has one: 4 bytes a sphere.
    Palette {
        /// The colours.
        palette: Vec<LinearRgb>,
        /// Of every sphere, the index of its colour in the palette.
        indices: Vec<u32>,
    },
    /// Every sphere has its own: 4 bytes a sphere, of red, green and blue in sRGB, and of alpha, which is not encoded
    /// and multiplies the opacity of the sphere's surface. Colours are not premultiplied by it.
    Rgba8(Vec<[u8; 4]>),
    /// Every sphere has a number, and numbers have colours: 4 bytes a sphere.
    Scalars {
        /// Of every sphere, its number. NaN is refused.
        values: Vec<f32>,
        /// The colours of numbers.
        map: ColorMap,
    },
}

/// What spheres look like: colours, surface properties, and which sphere has which.
///
/// ```
/// use pinhole::{Appearance, SurfaceProperties, SphereArray, Scene};
///
/// // Four bytes a sphere, of which the last is opacity.
/// let colors = vec![[255, 0, 0, 255], [0, 0, 255, 128]];
/// let spheres = vec![[0.0, 0.0, 0.0, 1.0], [3.0, 0.0, 0.0, 1.0]];
/// let scene = Scene::from_parts(SphereArray::F32(spheres), Appearance::from(colors))?;
/// assert_eq!(scene.color(1).to_srgb8(), [0, 0, 255]);
/// assert_eq!(scene.surface(1).opacity, 128.0 / 255.0);
/// # Ok::<(), pinhole::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Appearance {
    pub(super) colors: Colors,
    pub(super) surfaces: Vec<SurfaceProperties>,
    pub(super) surface_indices: Option<Vec<u32>>,
}

impl From<LinearRgb> for Appearance {
    fn from(color: LinearRgb) -> Self {
        Self::new(Colors::One(color))
    }
}

impl From<Vec<[u8; 4]>> for Appearance {
    fn from(colors: Vec<[u8; 4]>) -> Self {
        Self::new(Colors::Rgba8(colors))
    }
}

impl From<Colors> for Appearance {
    fn from(colors: Colors) -> Self {
        Self::new(colors)
    }
}

impl Appearance {
    /// Of matt, opaque spheres; what is given is not copied.
    #[must_use]
    pub fn new(colors: Colors) -> Self {
        Self { colors, surfaces: vec![SurfaceProperties::default()], surface_indices: None }
    }

    /// The same colours on spheres that all have the same surface properties.
    #[must_use]
    pub fn with_surface(self, surface: SurfaceProperties) -> Self {
        self.with(vec![surface], None)
    }

    /// The same colours on spheres with several surface properties: a list of them, and for every sphere an index into it.
    #[must_use]
    pub fn with_surfaces(self, surfaces: Vec<SurfaceProperties>, indices: Vec<u32>) -> Self {
        self.with(surfaces, Some(indices))
    }

    pub(super) fn with(
        self,
        surfaces: Vec<SurfaceProperties>,
        surface_indices: Option<Vec<u32>>,
    ) -> Self {
        Self { surfaces, surface_indices, ..self }
    }

    /// Which colours spheres have.
    #[must_use]
    pub fn colors(&self) -> &Colors {
        &self.colors
    }

    /// The surface properties that occur; opacities are without the alpha of colours.
    #[must_use]
    pub fn surfaces(&self) -> &[SurfaceProperties] {
        &self.surfaces
    }

    /// For every sphere, the index of its surface properties; `None` if all have the first.
    #[must_use]
    pub fn surface_indices(&self) -> Option<&[u32]> {
        self.surface_indices.as_deref()
    }

    /// Whether it is one of so many spheres.
    ///
    /// # Errors
    /// The first sphere whose colour or surface properties are missing, is none of those that there are, or is of the number NaN;
    /// that there are more of them than spheres.
    pub fn check(&self, count: usize) -> Result<(), SceneError> {
        let all = |what, found| match found {
            _ if found == count => Ok(()),
            _ => Err(SceneError::Count { what, found, spheres: count }),
        };
        match &self.colors {
            Colors::One(_) => {}
            Colors::Palette { palette, indices } => {
                let colors = palette.len();
                if let Some(index) = indices.iter().position(|index| *index as usize >= colors) {
                    return Err(SceneError::Color { index, colors });
                }
                all("color", indices.len())?;
            }
            Colors::Rgba8(colors) => all("color", colors.len())?,
            Colors::Scalars { values, .. } => {
                if let Some(index) = values.iter().position(|value| value.is_nan()) {
                    return Err(SceneError::Scalar { index });
                }
                all("color", values.len())?;
            }
        }
        let surfaces = self.surfaces.len();
        match &self.surface_indices {
            None if surfaces == 0 && count > 0 => {
                Err(SceneError::SurfaceProperties { index: 0, surfaces })
            }
            None => Ok(()),
            Some(indices) => match indices.iter().position(|index| *index as usize >= surfaces) {
                Some(index) => Err(SceneError::SurfaceProperties { index, surfaces }),
                None => all("surface index", indices.len()),
            },
        }
    }

    /// The colour of a sphere, by its index in input order; `None` if there is no such sphere, but where all
    /// have one colour.
    #[must_use]
    pub fn color(&self, id: u32) -> Option<LinearRgb> {
        let index = id as usize;
        match &self.colors {
            Colors::One(color) => Some(*color),
            Colors::Palette { palette, indices } => {
                palette.get(*indices.get(index)? as usize).copied()
            }
            Colors::Rgba8(colors) => {
                let [r, g, b, _] = *colors.get(index)?;
                Some(LinearRgb::from_srgb8([r, g, b]))
            }
            Colors::Scalars { values, map } => values.get(index).map(|value| map.color(*value)),
        }
    }

    /// The alpha of a sphere's colour: a 255th of a byte, or 1.
    pub(crate) fn alpha(&self, id: u32) -> f32 {
        match &self.colors {
            Colors::Rgba8(colors) => {
                colors.get(id as usize).map_or(1.0, |[_, _, _, alpha]| alpha_of(*alpha))
            }
            Colors::One(_) | Colors::Palette { .. } | Colors::Scalars { .. } => 1.0,
        }
    }

    /// Whether a component of some colour may exceed 1.
    pub(crate) fn may_exceed_one(&self) -> bool {
        let exceeds = |color: &LinearRgb| color.to_array().iter().any(|c| *c > 1.0);
        match &self.colors {
            Colors::One(color) => exceeds(color),
            Colors::Palette { palette, .. } => palette.iter().any(exceeds),
            Colors::Rgba8(_) => false,
            Colors::Scalars { map, .. } => map.colors().iter().any(exceeds),
        }
    }
}

/// What a byte of alpha stands for.
pub(crate) fn alpha_of(byte: u8) -> f32 {
    f32::from(byte) / 255.0
}
