//! The shapes that are in a scene file itself, and the list `spheres`.

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::cones::OwnCones;
use super::materials::{Materials, over};
use super::span::{SceneFileError, WithSpan, default_color};
use crate::settings::places::Places;
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::{List, Table};
use pinhole::scene::cone::Cone;
use pinhole::scene::material::SurfaceProperties;
use pinhole::scene::sphere::Sphere;
use pinhole::scene::sphere_array::SphereArray;
use pinhole::scene::{Appearance, Scene, SceneError};

/// The shapes of a scene file, without those of its data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnShapes {
    /// The spheres.
    pub spheres: Vec<Sphere>,
    /// The cylinders of each table, and then the cones.
    pub cones: Vec<OwnCones>,
}

impl OwnShapes {
    /// The number of cylinders and cones.
    #[must_use]
    pub fn cone_count(&self) -> usize {
        self.cones.iter().map(|own| own.cones.len()).sum()
    }

    /// The scene of these shapes.
    ///
    /// # Errors
    /// Returns an error if a shape is out of range.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        self.scene_with(SphereArray::F64(Vec::new()), &[], LinearRgb::WHITE.into())
    }

    /// The scene of these shapes and of those of data: first all spheres, and those at round ends of cones, then all cones,
    /// each time those of data last. Without own shapes, the array is not copied.
    pub(super) fn scene_with(
        &self,
        spheres: SphereArray,
        sticks: &[Cone],
        appearance: Appearance,
    ) -> Result<Scene, SceneError> {
        if self.spheres.is_empty() && self.cones.is_empty() {
            return Scene::from_shapes(spheres, sticks, appearance);
        }
        let look = |id: usize| look_of(&appearance, id);
        let count = spheres.len();
        let of_own = self.spheres.iter().map(|sphere| (sphere.color, sphere.surface));
        let of_ends = self.cones.iter().flat_map(OwnCones::looks_of_ends);
        let of_cones = self.cones.iter().flat_map(OwnCones::looks);
        let of_sticks = (count..count + sticks.len()).map(look);
        let looks: Vec<_> =
            of_own.chain(of_ends).chain((0..count).map(look)).chain(of_cones).chain(of_sticks).collect();
        let own = self.spheres.iter().map(|sphere| {
            let [x, y, z] = sphere.center;
            [x, y, z, sphere.radius]
        });
        let ends = self.cones.iter().flat_map(|own| &own.ends).copied();
        let all = own.chain(ends).chain((0..count).map(|index| spheres.at(index))).collect();
        let cones: Vec<Cone> = self.cones.iter().flat_map(|own| &own.cones).chain(sticks).copied().collect();
        Scene::from_shapes(SphereArray::F64(all), &cones, Appearance::distinct(&looks))
    }
}

/// The colour and the surface properties of a shape, without the alpha of its colour.
pub(super) fn look_of(appearance: &Appearance, id: usize) -> (LinearRgb, SurfaceProperties) {
    let color = appearance.color(id as u32).unwrap_or(LinearRgb::WHITE);
    let number = appearance.surface_indices().map_or(Some(0), |all| all.get(id).copied());
    let surface = number.and_then(|number| appearance.surfaces().get(number as usize));
    (color, surface.copied().unwrap_or_default())
}

/// A table of the list `spheres`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SphereTable {
    /// The centre in scene units.
    center: List<3>,
    /// The radius in scene units, greater than 0.
    radius: f64,
    /// The colour; a light grey by default.
    #[serde(default = "default_color")]
    color: LinearRgb,
    /// The name of a material.
    material: Option<String>,
    /// Opacity, from 0 (clear) to 1 (opaque).
    opacity: Option<f64>,
}

/// The tables of a list.
type Tables<T> = [Spanned<Table<T>>];

/// Reads the list `spheres`. A scene checks the spheres.
pub(super) fn spheres(
    tables: &Tables<SphereTable>,
    materials: &Materials,
    places: &Places<'_>,
) -> Result<Vec<WithSpan<Sphere>>, SceneFileError> {
    let sphere = |(index, table): (usize, &Spanned<Table<SphereTable>>)| {
        let Table(SphereTable { center, radius, color, material, opacity }) = table.get_ref();
        let of = |error| places.refused(&format!("spheres.{index}"), error);
        let base = SurfaceProperties::default();
        let surface = over(materials, base, material.as_deref(), *opacity).map_err(of)?;
        let mut value = Sphere::new(center.0, *radius, *color);
        value.surface = surface;
        Ok(WithSpan { value, span: places.lines.span(table.span().start) })
    };
    tables.iter().enumerate().map(sphere).collect()
}
