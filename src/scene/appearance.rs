//! The appearance of a scene's spheres, apart from their geometry.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::ops::Deref;
use std::sync::OnceLock;

use super::color_map::ColorMap;
use super::error::SceneError;
use crate::image::color::LinearRgb;
use crate::scene::material::{Material, SurfaceProperties};

/// The colours of a scene's spheres, in input order.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Colors {
    /// All spheres have the same colour.
    One(LinearRgb),
    /// Every sphere has a colour from a palette, in 4 bytes per sphere.
    Palette {
        /// The colours.
        palette: Vec<LinearRgb>,
        /// For every sphere, the index of its colour in the palette.
        indices: Vec<u32>,
    },
    /// Every sphere has its own colour, in 4 bytes per sphere. Red, green and blue are in sRGB. Alpha is linear and
    /// multiplies the opacity of the sphere's surface. Colours are not premultiplied by alpha.
    Rgba8(Vec<[u8; 4]>),
    /// Every sphere has a number, in 4 bytes per sphere, and a colour map turns numbers into colours.
    Scalars {
        /// The number of every sphere. NaN is an error.
        values: Vec<f32>,
        /// The map from numbers to colours.
        map: ColorMap,
    },
}

/// The appearance of spheres: colours, surface properties, and the assignment of both to spheres.
///
/// ```
/// use pinhole::{Appearance, SurfaceProperties, SphereArray, Scene};
///
/// // Four bytes per sphere. The last is opacity.
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
    /// The appearance of matt, opaque spheres. The colours are not copied.
    #[must_use]
    pub fn new(colors: Colors) -> Self {
        Self { colors, surfaces: vec![SurfaceProperties::default()], surface_indices: None }
    }

    /// The colours on spheres that all have the same surface properties.
    #[must_use]
    pub fn with_surface(self, surface: SurfaceProperties) -> Self {
        self.with(vec![surface], None)
    }

    /// The colours with several surface properties: a list of them, and for every sphere an index into the list.
    #[must_use]
    pub fn with_surfaces(self, surfaces: Vec<SurfaceProperties>, indices: Vec<u32>) -> Self {
        self.with(surfaces, Some(indices))
    }

    pub(super) fn with(self, surfaces: Vec<SurfaceProperties>, surface_indices: Option<Vec<u32>>) -> Self {
        Self { surfaces, surface_indices, ..self }
    }

    /// The colours of the spheres.
    #[must_use]
    pub fn colors(&self) -> &Colors {
        &self.colors
    }

    /// The list of surface properties. Opacities do not include the alpha of colours.
    #[must_use]
    pub fn surfaces(&self) -> &[SurfaceProperties] {
        &self.surfaces
    }

    /// For every sphere, the index of its surface properties. `None` if all spheres have the first.
    #[must_use]
    pub fn surface_indices(&self) -> Option<&[u32]> {
        self.surface_indices.as_deref()
    }

    /// Checks that the appearance is valid for `count` spheres.
    ///
    /// # Errors
    /// Returns an error if a colour or a set of surface properties is missing for a sphere, an index is out of range,
    /// or a number is NaN (the error names the first such sphere), or if there are more colours or indices than
    /// spheres.
    pub fn check(&self, count: usize) -> Result<(), SceneError> {
        let all = |what: &str, found: usize| {
            let lack = match found.cmp(&count) {
                Ordering::Equal => return Ok(()),
                Ordering::Less => format!("sphere {found} has no {what}"),
                Ordering::Greater => format!("{what} {count} has no sphere"),
            };
            Err(SceneError::Invalid(format!("{lack}: there are {found} for {count} spheres")))
        };
        match &self.colors {
            Colors::One(_) => {}
            Colors::Palette { palette, indices } => {
                let colors = palette.len();
                if let Some(index) = indices.iter().position(|index| *index as usize >= colors) {
                    return Err(SceneError::color(index, colors));
                }
                all("color", indices.len())?;
            }
            Colors::Rgba8(colors) => all("color", colors.len())?,
            Colors::Scalars { values, .. } => {
                if let Some(index) = values.iter().position(|value| value.is_nan()) {
                    return Err(SceneError::scalar(index));
                }
                all("color", values.len())?;
            }
        }
        let surfaces = self.surfaces.len();
        let outside = match &self.surface_indices {
            None => (surfaces == 0 && count > 0).then_some(0),
            Some(indices) => indices.iter().position(|index| *index as usize >= surfaces),
        };
        match (outside, &self.surface_indices) {
            (Some(index), _) => Err(SceneError::Invalid(format!(
                "the surface index of sphere {index} is out of range; there are {surfaces} surfaces"
            ))),
            (None, Some(indices)) => all("surface index", indices.len()),
            (None, None) => Ok(()),
        }
    }

    /// The colour of a sphere, by its index in input order. `None` if there is no such sphere. If all spheres have the
    /// same colour, the index is not checked.
    #[must_use]
    pub fn color(&self, id: u32) -> Option<LinearRgb> {
        let index = id as usize;
        match &self.colors {
            Colors::One(color) => Some(*color),
            Colors::Palette { palette, indices } => palette.get(*indices.get(index)? as usize).copied(),
            Colors::Rgba8(colors) => {
                let [r, g, b, _] = *colors.get(index)?;
                Some(LinearRgb::from_srgb8([r, g, b]))
            }
            Colors::Scalars { values, map } => values.get(index).map(|value| map.color(*value)),
        }
    }

    /// The alpha of a sphere's colour, from 0 to 1. It is 1 if colours have no alpha.
    pub(crate) fn alpha(&self, id: u32) -> f32 {
        match &self.colors {
            Colors::Rgba8(colors) => colors.get(id as usize).map_or(1.0, |[_, _, _, alpha]| alpha_of(*alpha)),
            Colors::One(_) | Colors::Palette { .. } | Colors::Scalars { .. } => 1.0,
        }
    }

    /// Whether any component of a colour may exceed 1.
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

/// Converts a byte of alpha to a number from 0 to 1.
pub(crate) fn alpha_of(byte: u8) -> f32 {
    f32::from(byte) / 255.0
}

/// An appearance that has been checked for `count` spheres. Derived data is computed when it is first needed.
#[derive(Clone, Debug)]
pub(crate) struct SceneAppearance {
    pub(super) appearance: Appearance,
    count: usize,
    pub(super) material_table: OnceLock<MaterialTable>,
    pub(super) is_opaque: OnceLock<bool>,
}

impl Deref for SceneAppearance {
    type Target = Appearance;

    fn deref(&self) -> &Appearance {
        &self.appearance
    }
}

impl SceneAppearance {
    pub(crate) fn new(appearance: Appearance, count: usize) -> Self {
        Self { appearance, count, material_table: OnceLock::new(), is_opaque: OnceLock::new() }
    }

    /// The number of spheres.
    pub(crate) fn sphere_count(&self) -> usize {
        self.count
    }

    /// The colour of a sphere, whose index must be valid.
    pub(crate) fn color_of(&self, id: u32) -> LinearRgb {
        self.color(id).unwrap_or(LinearRgb::BLACK)
    }

    /// The index of a sphere's surface properties.
    pub(crate) fn surface_index(&self, id: u32) -> u32 {
        self.surface_indices().map_or(0, |indices| indices[id as usize])
    }

    /// The surface properties of a sphere of this scene, with the alpha of its colour.
    pub(crate) fn surface_of(&self, id: u32) -> SurfaceProperties {
        let SurfaceProperties { material, opacity } = self.surfaces()[self.surface_index(id) as usize];
        SurfaceProperties { material, opacity: opacity * self.alpha(id) }
    }

    /// Whether all spheres are opaque.
    pub(crate) fn is_opaque(&self) -> bool {
        *self.is_opaque.get_or_init(|| {
            let has_alpha = match self.colors() {
                Colors::Rgba8(colors) => colors.iter().any(|[_, _, _, alpha]| *alpha < u8::MAX),
                Colors::One(_) | Colors::Palette { .. } | Colors::Scalars { .. } => false,
            };
            !has_alpha && self.surfaces().iter().all(|surface| surface.opacity >= 1.0)
        })
    }

    /// The rows of the material table.
    pub(crate) fn material_rows(&self) -> &[MaterialRow] {
        &self.material_table.get_or_init(|| MaterialTable::of(self)).rows
    }

    /// The index of a sphere's material in the rows of the material table.
    pub(crate) fn material_row(&self, id: u32) -> u32 {
        let table = self.material_table.get_or_init(|| MaterialTable::of(self));
        match &table.indices {
            Some(indices) => indices[id as usize],
            None => self.surface_index(id),
        }
    }
}

/// The content of one row of the material table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MaterialRow {
    /// The surface properties. Their opacity must still be multiplied by the alpha of the sphere's colour.
    pub(crate) surface: SurfaceProperties,
    /// The colour, for a material whose absorption inside depends on it. White for all others.
    pub(crate) color: LinearRgb,
}

/// All rows of the material table, and the assignment of rows to spheres.
#[derive(Clone, Debug)]
pub(super) struct MaterialTable {
    rows: Vec<MaterialRow>,
    /// For every sphere, the index of its row. `None` if that is the index of its surface properties.
    indices: Option<Vec<u32>>,
}

/// Whether the surface has a material whose colour determines the absorption inside.
fn absorbs(surface: &SurfaceProperties) -> bool {
    matches!(surface.material, Material::Dielectric { attenuation_distance: Some(_), .. })
}

impl MaterialTable {
    /// Makes one row for each set of surface properties. If the material absorbs light, makes one row for each colour
    /// that occurs with it.
    fn of(appearance: &SceneAppearance) -> Self {
        let surfaces = appearance.surfaces();
        let mut rows: Vec<MaterialRow> =
            surfaces.iter().map(|surface| MaterialRow { surface: *surface, color: LinearRgb::WHITE }).collect();
        if !surfaces.iter().any(absorbs) {
            return Self { rows, indices: None };
        }
        let mut has_first = vec![false; surfaces.len()];
        let mut indices = HashMap::new();
        let indices = (0..appearance.sphere_count() as u32).map(|id| {
            let index = appearance.surface_index(id);
            let surface = &surfaces[index as usize];
            if !absorbs(surface) {
                return index;
            }
            let color = appearance.color_of(id);
            let key = (index, color.to_array().map(f32::to_bits));
            *indices.entry(key).or_insert_with(|| {
                let row = MaterialRow { surface: *surface, color };
                // The first colour uses the row of the surface properties.
                if std::mem::replace(&mut has_first[index as usize], true) {
                    rows.push(row);
                    return rows.len() as u32 - 1;
                }
                rows[index as usize] = row;
                index
            })
        });
        let indices: Vec<u32> = indices.collect();
        let differ = rows.len() > surfaces.len();
        Self { rows, indices: differ.then_some(indices) }
    }
}
