//! Appearance of spheres in the form that kernels read. Twin of `shaders/scene/appearance.wgsl`.

use crate::gpu::shader::records::Color;
use crate::image::color::LinearRgb;
use crate::scene::{Appearance, Colors, SceneAppearance, alpha_of};

/// The words that encode the appearance of a brick's spheres, and the numbers that are needed to decode them.
#[derive(Debug)]
pub(crate) struct AppearanceWords {
    /// The words, of which there is always at least one.
    pub(crate) words: Vec<u32>,
    pub(crate) color_shift: u32,
    pub(crate) color_mask: u32,
    pub(crate) material_first: u32,
    pub(crate) material_mask: u32,
}

impl AppearanceWords {
    /// Encodes the appearance of the spheres with the given ids.
    pub(crate) fn of(appearance: &SceneAppearance, ids: &[u32]) -> Self {
        let colors = appearance.colors();
        let mut words = color_words(colors, ids.iter().copied());
        let material_first = words.len() as u32;
        let has_materials = has_materials(appearance);
        if has_materials {
            words.extend(ids.iter().map(|id| appearance.material_row(*id)));
        }
        if words.is_empty() {
            words.push(0);
        }
        let (color_shift, color_mask) = match colors {
            Colors::One(_) => (0, 0),
            Colors::Palette { .. } | Colors::Scalars { .. } => (0, u32::MAX),
            Colors::Rgba8(_) => (8, 0xff),
        };
        let material_mask = if has_materials { u32::MAX } else { 0 };
        Self { words, color_shift, color_mask, material_first, material_mask }
    }
}

/// Whether spheres have words with the indices of their materials.
fn has_materials(appearance: &SceneAppearance) -> bool {
    appearance.material_rows().len() > 1
}

/// The number of words of every sphere of a scene with this appearance.
pub(crate) fn words_per_sphere(appearance: &SceneAppearance) -> u64 {
    let has_colors = !matches!(appearance.colors(), Colors::One(_));
    u64::from(has_colors) + u64::from(has_materials(appearance))
}

/// The colour words of some spheres. There are none if all spheres of the scene have the same colour.
pub(crate) fn color_words(colors: &Colors, ids: impl Iterator<Item = u32>) -> Vec<u32> {
    match colors {
        Colors::One(_) => Vec::new(),
        Colors::Palette { indices, .. } => ids.map(|id| indices[id as usize]).collect(),
        Colors::Rgba8(colors) => ids.map(|id| u32::from_le_bytes(colors[id as usize])).collect(),
        Colors::Scalars { values, map } => ids.map(|id| map.index(values[id as usize]) as u32).collect(),
    }
}

/// Number of elements of the palette.
pub(crate) fn palette_length(appearance: &Appearance) -> usize {
    match appearance.colors() {
        Colors::One(_) => 1,
        Colors::Palette { palette, .. } => palette.len().max(1),
        Colors::Rgba8(_) => BYTES,
        Colors::Scalars { map, .. } => map.colors().len(),
    }
}

/// Number of different values of a byte.
const BYTES: usize = 256;

/// The palette: the colours to which the indices in colour words refer.
pub(crate) fn palette(appearance: &Appearance) -> Vec<Color> {
    let opaque = |color: &LinearRgb| {
        let [r, g, b] = color.to_array();
        [r, g, b, 1.0]
    };
    match appearance.colors() {
        Colors::One(color) => vec![opaque(color)],
        Colors::Palette { palette, .. } if palette.is_empty() => vec![[0.0; 4]],
        Colors::Palette { palette, .. } => palette.iter().map(opaque).collect(),
        Colors::Rgba8(_) => (0..=u8::MAX)
            .map(|byte| {
                let [r, g, b] = LinearRgb::from_srgb8([byte; 3]).to_array();
                [r, g, b, alpha_of(byte)]
            })
            .collect(),
        Colors::Scalars { map, .. } => map.colors().iter().map(opaque).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::material::{Material, SurfaceProperties};
    use crate::scene::sphere_array::SphereArray;
    use crate::scene::{ColorMap, Scene};

    fn scene(appearance: Appearance) -> Scene {
        let spheres = (0..4).map(|i| [i as f32 * 3.0, 0.0, 0.0, 1.0]).collect();
        Scene::from_parts(SphereArray::F32(spheres), appearance).unwrap()
    }

    /// Decodes colour and material index in the same way as `sphere_color` and `material_index` of
    /// `shaders/scene/appearance.wgsl`.
    fn read(appearances: &AppearanceWords, palette: &[Color], shape_index: u32) -> ([f32; 4], u32) {
        let last = appearances.words.len() as u32 - 1;
        let word = appearances.words[shape_index.min(last) as usize];
        let color = [0, 1, 2, 3].map(|k: u32| {
            let at = (word >> (appearances.color_shift * k)) & appearances.color_mask;
            palette[at as usize][k as usize]
        });
        let at = (appearances.material_first + shape_index).min(last);
        (color, appearances.words[at as usize] & appearances.material_mask)
    }

    #[test]
    fn decoded_words_match_the_scene() {
        let gray = |level: u8| LinearRgb::from_srgb8([level; 3]);
        let palette_of = vec![gray(10), gray(20), gray(30)];
        let map = ColorMap::new(palette_of.clone(), [0.0, 2.0]).unwrap();
        let glass = Material::Dielectric { ior: 1.5, roughness: 0.0, attenuation_distance: Some(2.0) };
        let surfaces = vec![
            SurfaceProperties { material: glass, opacity: 1.0 },
            SurfaceProperties { opacity: 0.25, ..SurfaceProperties::default() },
        ];
        for colors in [
            Colors::One(gray(77)),
            Colors::Palette { palette: palette_of, indices: vec![2, 0, 1, 2] },
            Colors::Rgba8(vec![[1, 2, 3, 4], [255; 4], [0; 4], [9, 8, 7, 128]]),
            Colors::Scalars { values: vec![0.0, 0.9, 5.0, -1.0], map },
        ] {
            for appearance in [
                Appearance::new(colors.clone()),
                Appearance::new(colors.clone()).with_surface(surfaces[0]),
                Appearance::new(colors).with_surfaces(surfaces.clone(), vec![0, 1, 0, 0]),
            ] {
                let scene = scene(appearance);
                let ids = [3, 1, 1, 0, 2];
                let (appearances, palette) =
                    (AppearanceWords::of(scene.checked_appearance(), &ids), palette(scene.appearance()));
                assert_eq!(palette.len(), palette_length(scene.appearance()));
                let used = words_per_sphere(scene.checked_appearance()) * 5;
                assert_eq!(appearances.words.len() as u64, used.max(1));
                for (shape_index, id) in (0..).zip(ids) {
                    let ([r, g, b, alpha], row) = read(&appearances, &palette, shape_index);
                    let kept = scene.checked_appearance().material_rows()[row as usize];
                    let surface = scene.surface(id);
                    let opacity = (alpha * kept.surface.opacity).to_bits();
                    assert_eq!(LinearRgb::new([r, g, b]), Ok(scene.color(id)));
                    assert_eq!(opacity, surface.opacity.to_bits());
                    assert_eq!(kept.surface.material, surface.material);
                    if surface.material == glass {
                        assert_eq!(kept.color, scene.color(id));
                    }
                }
            }
        }
    }

    /// Spheres need no material word if all have the same material, and a material that does not depend on the colour
    /// needs a single row.
    #[test]
    fn materials_are_told_apart_only_where_they_differ() {
        let colors = vec![[1, 2, 3, 255], [4, 5, 6, 255], [7, 8, 9, 255], [1, 2, 3, 0]];
        let metal = SurfaceProperties { material: Material::Conductor { roughness: 0.2 }, opacity: 1.0 };
        let one = scene(Appearance::from(colors.clone()).with_surface(metal));
        let counts = |scene: &Scene| {
            let appearance = scene.checked_appearance();
            (appearance.material_rows().len(), words_per_sphere(appearance))
        };
        assert_eq!(counts(&one), (1, 1));
        let glass = Material::Dielectric { ior: 1.5, roughness: 0.0, attenuation_distance: Some(2.0) };
        let tinted = Appearance::from(colors).with_surface(SurfaceProperties { material: glass, opacity: 1.0 });
        let tinted = scene(tinted);
        // The first and the last sphere have the same colour.
        assert_eq!(counts(&tinted), (3, 2));
        assert_eq!([0, 1, 2, 3].map(|id| tinted.checked_appearance().material_row(id)), [0, 1, 2, 0]);
    }

    #[test]
    fn an_empty_scene_has_a_word_and_a_color() {
        let none = Appearance::new(Colors::Palette { palette: Vec::new(), indices: Vec::new() });
        let scene = Scene::from_parts(SphereArray::F32(Vec::new()), none).unwrap();
        assert_eq!(AppearanceWords::of(scene.checked_appearance(), &[]).words, [0]);
        assert_eq!(palette(scene.appearance()), [[0.0; 4]]);
    }
}
