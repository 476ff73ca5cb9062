//! Properties of surfaces as numbers.

use super::RunFileError;
use super::container::{Container, contradiction};
use crate::scene::Appearance;
use crate::scene::material::{Material, SurfaceProperties};

/// The numbers of a surface: the kind of its material, three parameters, and the opacity.
pub(super) fn surface_numbers(surface: &SurfaceProperties) -> [f32; 5] {
    surface.bits().map(f32::from_bits)
}

/// The inverse of [`surface_numbers`]; `None` if there is no such kind.
fn surface([kind, a, b, c, opacity]: [f32; 5]) -> Option<SurfaceProperties> {
    let material = match kind.to_bits() {
        0 => Material::Lambert { specular: a, roughness: b },
        bits if bits == 1_f32.to_bits() => Material::Conductor { roughness: a },
        bits if bits == 2_f32.to_bits() => {
            let attenuation_distance = (c.to_bits() != 0).then_some(c);
            Material::Dielectric { ior: a, roughness: b, attenuation_distance }
        }
        bits if bits == 3_f32.to_bits() => Material::Emissive { strength: a },
        _ => return None,
    };
    Some(SurfaceProperties { material, opacity })
}

/// Adds the surfaces of a file with so many spheres; without any, they are the default.
pub(super) fn with_surfaces(
    file: &Container<'_>,
    appearance: Appearance,
    spheres: usize,
) -> Result<Appearance, RunFileError> {
    if !file.has("surfaces") {
        return Ok(appearance);
    }
    let count = file.shape("surfaces")?.first().copied().unwrap_or_default();
    let numbers = file.items::<f32, 5>("surfaces", &[count])?;
    let surfaces = (0..).zip(numbers).map(|(index, numbers): (usize, _)| {
        let no = |error: String| contradiction(format!("the surface {index}: {error}"));
        let surface = surface(numbers).ok_or_else(|| no("there is no such material".to_owned()))?;
        surface.check().map_err(|error| no(error.to_string()))?;
        Ok(surface)
    });
    let surfaces: Vec<_> = surfaces.collect::<Result<_, RunFileError>>()?;
    if file.has("surface_index") {
        let indices = file.numbers("surface_index", &[spheres])?;
        return Ok(appearance.with_surfaces(surfaces, indices));
    }
    match surfaces[..] {
        [surface] => Ok(appearance.with_surface(surface)),
        _ => Err(contradiction("there are several surfaces, but no array `surface_index`")),
    }
}
