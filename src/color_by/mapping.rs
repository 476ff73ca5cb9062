//! Everything of spheres that columns may decide, together.

use std::collections::HashMap;

use super::column::numbers;
use super::error::ColorByError;
use super::surface::{EmissionBy, Strengths, check_factor, opacities, strengths};
use super::{ColorBy, ColorKey, Coloring, is_kept};
use crate::added::{Added, Additions, Base};
use crate::image::color::LinearRgb;
use crate::load::{Column, Loaded};
use crate::scene::material::{Material, SurfaceProperties};
use crate::scene::sphere_array::SphereArray;
use crate::scene::{Appearance, Colors, Scene};

/// What columns decide of spheres: colour, radius, opacity, strength of light, each if it is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mapping {
    /// The colours.
    pub color: Option<ColorBy>,
    /// The radii.
    pub radius: Option<RadiusBy>,
    /// The column of the opacities, from 0 to 1; others are clamped, with a note. They are rounded to 256 levels.
    pub opacity: Option<String>,
    /// The strengths of light, which make spheres emit light in their colour. They are rounded to 255 levels, with equal
    /// ratios between them, and 0.
    pub emission: Option<EmissionBy>,
}

/// Radii from a column.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiusBy {
    /// The column; see [`column::column`](super::column::column).
    pub column: String,
    /// The factor by which its numbers are multiplied.
    pub factor: f64,
}

/// What columns gave to spheres; see [`Mapping::apply`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mapped {
    coloring: Option<Coloring>,
    opacities: Option<Vec<u8>>,
    strengths: Option<Strengths>,
    notes: Vec<String>,
}

impl Mapping {
    /// Whether columns decide nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// This mapping, and where it says nothing, `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            color: self.color.or(other.color),
            radius: self.radius.or(other.radius),
            opacity: self.opacity.or(other.opacity),
            emission: self.emission.or(other.emission),
        }
    }

    /// Looks up the columns. Radii are written to `spheres`; colours, opacities and strengths of light are returned.
    /// `left_out` says for each sphere whether it is left out of the picture; it may be empty.
    ///
    /// # Errors
    /// Returns an error if there is no such column, or its values cannot be used.
    pub fn apply(
        &self,
        spheres: &mut SphereArray,
        columns: &[Column],
        left_out: &[bool],
    ) -> Result<Mapped, ColorByError> {
        let mut mapped = Mapped::default();
        if let Some(by) = &self.color {
            let mut coloring = by.apply(spheres, columns, left_out)?;
            mapped.notes.append(&mut coloring.notes);
            mapped.coloring = Some(coloring);
        }
        if let Some(column) = &self.opacity {
            let (name, values) = numbers(column, spheres, columns)?;
            mapped.opacities = Some(opacities(&name, &values, &mut mapped.notes));
        }
        if let Some(by) = &self.emission {
            let (name, values) = numbers(&by.column, spheres, columns)?;
            mapped.strengths = Some(strengths(by, &name, &values, &mut mapped.notes)?);
        }
        if let Some(by) = &self.radius {
            let (name, values) = numbers(&by.column, spheres, columns)?;
            let values = values.into_owned();
            set_radii(spheres, &name, by.factor, &values, left_out)?;
        }
        Ok(mapped)
    }
}

impl Mapping {
    /// Makes a scene of a file's spheres, and returns what its columns gave beside it. Spheres that neither a column nor
    /// the file gives a colour have `color`. Opacities are those of the column, or else of the file.
    ///
    /// # Errors
    /// Returns an error if a column cannot be used, or names the first sphere that is out of range.
    pub fn scene(&self, loaded: Loaded, color: LinearRgb) -> Result<(Scene, Mapped), ColorByError> {
        let (scene, mapped, _) = self.scene_with(loaded, color, &Additions::default())?;
        Ok((scene, mapped))
    }

    /// Makes a scene like [`Mapping::scene`], with bonds or the edges of the cell after the spheres of the file. They do
    /// not count for the range of colours.
    ///
    /// # Errors
    /// The errors of [`Mapping::scene`], and an error if the file lacks what the additions need.
    pub fn scene_with(
        &self,
        mut loaded: Loaded,
        color: LinearRgb,
        additions: &Additions,
    ) -> Result<(Scene, Mapped, Added), ColorByError> {
        let mut mapped = self.apply(&mut loaded.spheres, &loaded.columns, &[])?;
        if self.radius.is_none() {
            additions.shrink(&mut loaded);
        }
        let added = additions.add(&Base::of(&loaded))?;
        if let (None, Some(of_file)) = (&mapped.opacities, &loaded.opacities) {
            let level = |opacity: &f32| (opacity * 255.0).round() as u8;
            mapped.opacities = Some(of_file.iter().map(level).collect());
        }
        let base = match loaded.colors {
            Some(colors) if mapped.coloring.is_none() => Colors::distinct(&colors),
            _ => Colors::One(color),
        };
        let count = loaded.spheres.len();
        let mut appearance = mapped.appearance(count, base, SurfaceProperties::default());
        if !added.is_empty() {
            appearance = added.extend_appearance(&appearance, count);
            added.extend_array(&mut loaded.spheres);
        }
        let scene = Scene::from_parts(loaded.spheres, appearance)?.with_added(added.len());
        Ok((scene, mapped, added))
    }
}

fn set_radii(
    spheres: &mut SphereArray,
    column: &str,
    factor: f64,
    values: &[f64],
    left_out: &[bool],
) -> Result<(), ColorByError> {
    check_factor(column, factor)?;
    for (index, value) in values.iter().enumerate() {
        let value = value * factor;
        // A radius in f32 must not become zero either.
        if !(value.is_finite() && value as f32 > 0.0) && is_kept(left_out, index) {
            return Err(ColorByError::Radius { index, column: column.to_owned(), value });
        }
    }
    let radii = values.iter().map(|value| value * factor);
    match spheres {
        SphereArray::F32(spheres) => {
            spheres.iter_mut().zip(radii).for_each(|(sphere, radius)| sphere[3] = radius as f32);
        }
        SphereArray::F64(spheres) => {
            spheres.iter_mut().zip(radii).for_each(|(sphere, radius)| sphere[3] = radius);
        }
    }
    Ok(())
}

impl Mapped {
    /// What the colours mean, if columns gave colours.
    #[must_use]
    pub fn key(&self) -> Option<&ColorKey> {
        self.coloring.as_ref().map(|coloring| &coloring.key)
    }

    /// Notes for the user, one line each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The colour of a sphere by its index in input order, if columns gave colours.
    #[must_use]
    pub fn color(&self, index: usize) -> Option<LinearRgb> {
        self.coloring.as_ref()?.color(index)
    }

    /// The surface properties of a sphere that would have those of `base`.
    #[must_use]
    pub fn surface(&self, base: SurfaceProperties, index: usize) -> SurfaceProperties {
        let levels = self.levels(index);
        self.of_levels(base, levels)
    }

    /// The levels of strength and opacity of a sphere.
    fn levels(&self, index: usize) -> [Option<u8>; 2] {
        let strength = self.strengths.as_ref().and_then(|s| s.indices.get(index).copied());
        let opacity = self.opacities.as_ref().and_then(|levels| levels.get(index).copied());
        [strength, opacity]
    }

    fn of_levels(
        &self,
        base: SurfaceProperties,
        [strength, opacity]: [Option<u8>; 2],
    ) -> SurfaceProperties {
        let strength = strength
            .and_then(|level| self.strengths.as_ref()?.strengths.get(usize::from(level)).copied());
        let material = strength.map_or(base.material, |strength| Material::Emissive { strength });
        let opacity = opacity.map_or(1.0, |level| f32::from(level) / 255.0);
        SurfaceProperties { material, opacity: base.opacity * opacity }
    }

    /// The appearance of `count` spheres that would have the colours and surface properties given here.
    #[must_use]
    pub fn appearance(&self, count: usize, colors: Colors, base: SurfaceProperties) -> Appearance {
        let mut surfaces = Vec::new();
        let mut indices = Vec::new();
        if self.opacities.is_some() || self.strengths.is_some() {
            let mut known = HashMap::new();
            indices = (0..count)
                .map(|index| {
                    let levels = self.levels(index);
                    *known.entry(levels).or_insert_with(|| {
                        surfaces.push(self.of_levels(base, levels));
                        // There are at most 256 levels of each.
                        surfaces.len() as u32 - 1
                    })
                })
                .collect();
        }
        let colors = self.coloring.as_ref().map_or(colors, Coloring::to_colors);
        let appearance = Appearance::new(colors);
        match surfaces.is_empty() {
            true => appearance.with_surface(base),
            false => appearance.with_surfaces(surfaces, indices),
        }
    }
}
