//! The shapes that are in a scene file itself: the lists `spheres`, `cylinders` and `cones`.

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::materials::{Materials, over};
use super::span::{SceneFileError, WithSpan, default_color};
use crate::settings::places::Places;
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::{List, Table};
use pinhole::scene::cone::{Caps, Cone};
use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::sphere::Sphere;
use pinhole::scene::sphere_array::SphereArray;
use pinhole::scene::{Appearance, Scene, SceneError};

/// The shapes of a scene file, without those of its data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnShapes {
    /// The spheres.
    pub spheres: Vec<Sphere>,
    /// The cylinders, and then the cones.
    pub cones: Vec<OwnCone>,
}

/// A cone or cylinder of a scene file, and its look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnCone {
    /// The shape.
    pub cone: Cone,
    /// The colour.
    pub color: LinearRgb,
    /// The surface properties.
    pub surface: SurfaceProperties,
}

impl OwnShapes {
    /// The scene of these shapes.
    ///
    /// # Errors
    /// Returns an error if a shape is out of range.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        self.scene_with(SphereArray::F64(Vec::new()), &[], LinearRgb::WHITE.into())
    }

    /// The scene of these shapes and of those of data: first all spheres, then all cones, each time those of data last.
    /// Without own shapes, the array is not copied.
    pub(super) fn scene_with(
        &self,
        spheres: SphereArray,
        sticks: &[Cone],
        appearance: Appearance,
    ) -> Result<Scene, SceneError> {
        if self.spheres.is_empty() && self.cones.is_empty() {
            return Scene::from_shapes(spheres, sticks, appearance);
        }
        let surface_of = |id: usize| {
            let index = appearance.surface_indices().map_or(Some(0), |all| all.get(id).copied())?;
            appearance.surfaces().get(index as usize).copied()
        };
        let look = |id: usize| {
            let color = appearance.color(id as u32).unwrap_or(LinearRgb::WHITE);
            (color, surface_of(id).unwrap_or_default())
        };
        let count = spheres.len();
        let of_own = self.spheres.iter().map(|sphere| (sphere.color, sphere.surface));
        let of_cones = self.cones.iter().map(|own| (own.color, own.surface));
        let of_sticks = (count..count + sticks.len()).map(look);
        let looks: Vec<_> = of_own.chain((0..count).map(look)).chain(of_cones).chain(of_sticks).collect();
        let own = self.spheres.iter().map(|sphere| {
            let [x, y, z] = sphere.center;
            [x, y, z, sphere.radius]
        });
        let all = own.chain((0..count).map(|index| spheres.at(index))).collect();
        let cones: Vec<Cone> = self.cones.iter().map(|own| own.cone).chain(sticks.iter().copied()).collect();
        Scene::from_shapes(SphereArray::F64(all), &cones, Appearance::distinct(&looks))
    }
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

/// A table of the list `cylinders`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CylinderTable {
    /// The middle of the first end in scene units.
    start: List<3>,
    /// The middle of the second end.
    end: List<3>,
    /// The radius in scene units, greater than 0.
    radius: f64,
    /// The closed ends: `none`, `first`, `second` or `both`, which is the default.
    #[serde(default)]
    caps: Caps,
    /// The colour; a light grey by default.
    #[serde(default = "default_color")]
    color: LinearRgb,
    /// The name of a material, which must not be emissive.
    material: Option<String>,
    /// Opacity, from 0 (clear) to 1 (opaque).
    opacity: Option<f64>,
}

/// A table of the list `cones`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ConeTable {
    /// The middle of the first end in scene units.
    start: List<3>,
    /// The middle of the second end.
    end: List<3>,
    /// The radii of both ends in scene units. One of them may be 0, which makes a tip.
    radii: Pair,
    /// The closed ends: `none`, `first`, `second` or `both`, which is the default.
    #[serde(default)]
    caps: Caps,
    /// The colour; a light grey by default.
    #[serde(default = "default_color")]
    color: LinearRgb,
    /// The name of a material, which must not be emissive.
    material: Option<String>,
    /// Opacity, from 0 (clear) to 1 (opaque).
    opacity: Option<f64>,
}

type Pair = List<2>;

/// The keys `material` and `opacity` of a table.
type Surface<'a> = (Option<&'a str>, Option<f64>);

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

/// Reads the list `cylinders`, and then the list `cones`.
pub(super) fn cones(
    (cylinders, cones): (&Tables<CylinderTable>, &Tables<ConeTable>),
    materials: &Materials,
    places: &Places<'_>,
) -> Result<Vec<WithSpan<OwnCone>>, SceneFileError> {
    let read = |[list, what]: [&str; 2], index: usize, start: usize, cone: Cone, color, surface: Surface<'_>| {
        let surface = over(materials, SurfaceProperties::default(), surface.0, surface.1)
            .map_err(|error| places.refused(&format!("{list}.{index}"), error))?;
        let span = places.lines.span(start);
        cone.check().map_err(|error| span.error(format!("{what} {index}: {error}")))?;
        if matches!(surface.material, Material::Emissive { .. }) {
            return Err(span.error(format!(
                "{what} {index}: it has an emissive material, but only spheres emit light; name another material"
            )));
        }
        Ok(WithSpan { value: OwnCone { cone, color, surface }, span })
    };
    let cylinder = |(index, table): (usize, &Spanned<Table<CylinderTable>>)| {
        let Table(CylinderTable { start, end, radius, caps, color, material, opacity }) = table.get_ref();
        let cone = Cone::cylinder(start.0, end.0, *radius).with_caps(*caps);
        read(["cylinders", "cylinder"], index, table.span().start, cone, *color, (material.as_deref(), *opacity))
    };
    let cone = |(index, table): (usize, &Spanned<Table<ConeTable>>)| {
        let Table(ConeTable { start, end, radii, caps, color, material, opacity }) = table.get_ref();
        let cone = Cone::new(start.0, end.0, radii.0).with_caps(*caps);
        read(["cones", "cone"], index, table.span().start, cone, *color, (material.as_deref(), *opacity))
    };
    cylinders.iter().enumerate().map(cylinder).chain(cones.iter().enumerate().map(cone)).collect()
}
