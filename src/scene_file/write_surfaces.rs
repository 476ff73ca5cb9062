//! Writes the tables of materials of a scene file.

use crate::scene::material::{Material, SurfaceProperties};

/// Surface properties that have a name in the file.
#[derive(Default)]
pub(super) struct Surfaces(Vec<SurfaceProperties>);

impl Surfaces {
    /// The key for surface properties, unless they are those that hold without one.
    pub(super) fn key(
        &mut self,
        surface: SurfaceProperties,
        base: SurfaceProperties,
    ) -> Option<String> {
        if surface == base {
            return None;
        }
        let known = self.0.iter().position(|one| *one == surface);
        let index = known.unwrap_or_else(|| {
            self.0.push(surface);
            self.0.len() - 1
        });
        Some(format!("material = \"surface-{index}\""))
    }

    pub(super) fn tables(&self) -> Vec<String> {
        let table = |(index, surface): (usize, &SurfaceProperties)| {
            let opacity = surface.opacity;
            let keys = match surface.material {
                Material::Lambert { specular, roughness } => {
                    format!(
                        "kind = \"lambert\"\nspecular = {specular:?}\nroughness = {roughness:?}"
                    )
                }
                Material::Conductor { roughness } => {
                    format!("kind = \"conductor\"\nroughness = {roughness:?}")
                }
                Material::Dielectric { ior, roughness, attenuation_distance } => {
                    let attenuation = attenuation_distance
                        .map_or(String::new(), |far| format!("\nattenuation_distance = {far:?}"));
                    format!(
                        "kind = \"dielectric\"\nior = {ior:?}\nroughness = {roughness:?}{attenuation}"
                    )
                }
                Material::Emissive { strength } => {
                    format!("kind = \"emissive\"\nstrength = {strength:?}")
                }
            };
            format!("\n[materials.surface-{index}]\n{keys}\nopacity = {opacity:?}")
        };
        self.0.iter().enumerate().map(table).collect()
    }
}
