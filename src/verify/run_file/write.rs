//! Writing of run files.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Write};

use crate::image::Image;
use crate::scene::material::SurfaceProperties;
use crate::scene::{Colors, Scene};
use crate::verify::run_file::container::{Array, Flag};
use crate::verify::run_file::{LIMIT, Provenance, container, scene_sha256};
use crate::verify::{PlainRender, Recording, TracedPixel, UploadedView};

/// Writes a run file in small pieces: 98 bytes for each pixel, 130 if a different picture was rendered, 16 to 24 for each
/// sphere, and 32 to 40 for each cone.
///
/// # Errors
/// Returns an error if writing fails, or if the recording has another size than its film or lacks a layer.
pub fn write(scene: &Scene, recording: &Recording, provenance: &Provenance, out: &mut dyn Write) -> io::Result<()> {
    let Recording { camera, uploaded, film, primary, pixels, image, rendered } = recording;
    let shape = [film.height() as usize, film.width() as usize];
    let layers = layers_of(image, shape, "recording", ["color", "depth", "normal", "id"])?;
    if pixels.len() as u64 != film.pixel_count() {
        return Err(io::Error::other("the recording has another size than its film"));
    }

    let mut texts: BTreeMap<String, String> =
        provenance.clone().texts().map(|(key, text)| (key.to_owned(), text.clone())).into();
    let limits = provenance.limits.iter();
    texts.extend(limits.map(|(name, limit)| (format!("{LIMIT}{name}"), limit.to_string())));
    let rendered_as = match rendered {
        PlainRender::None => None,
        PlainRender::Same => Some(("rendered", "same")),
        PlainRender::Other(_) => Some(("rendered", "other")),
    };
    let (y_axis, shading, digest) = (film.y_axis().name(), primary.shading.name(), scene_sha256(scene));
    let known = [("camera", camera.kind.name()), ("y_axis", y_axis), ("shading", shading), ("scene_sha256", &digest)];
    texts.extend(known.into_iter().chain(rendered_as).map(|(key, text)| (key.to_owned(), text.to_owned())));

    let vectors = &camera.vectors;
    let numbers = vectors.numbers.into();
    let camera = vec![vectors.origin, vectors.right, vectors.up, vectors.forward, numbers];
    let UploadedView { origin, right, up, forward, numbers, scene_min, scene_max, .. } = *uploaded;
    let view = vec![origin, right, up, forward, numbers, scene_min, scene_max];
    let ray = |pixel: &TracedPixel| pixel.ray.unwrap_or_default();
    let shading = |pixel: &TracedPixel| pixel.shading_ray.unwrap_or_default();
    let mut arrays = vec![
        Array::list("camera", camera, |vector| vector.to_array()),
        Array::new("scene_origin", &[], vec![scene.origin()], |origin| origin.to_array()),
        Array::new("background", &[], vec![primary.background], |color| color.to_array()),
        Array::list("view", view, |vector| *vector),
        Array::list("advance", vec![uploaded.advance], |advance| [*advance]),
        Array::new("ray_origin", &shape, pixels, move |pixel| ray(pixel).origin),
        Array::new("ray_direction", &shape, pixels, move |pixel| ray(pixel).direction),
        Array::new("ray_distance", &shape, pixels, move |pixel| [ray(pixel).distance]),
        Array::new("shading_origin", &shape, pixels, move |pixel| shading(pixel).origin),
        Array::new("shading_direction", &shape, pixels, move |pixel| shading(pixel).direction),
        Array::new("shading_distance", &shape, pixels, move |pixel| [shading(pixel).distance]),
        Array::new("hit_t", &shape, pixels, |pixel| [pixel.t]),
        Array::new("hit_id", &shape, pixels, |pixel| [pixel.id]),
    ];
    arrays.extend(layers);
    arrays.extend(Array::shapes(scene));
    if let PlainRender::Other(image) = rendered {
        let names = ["rendered_color", "rendered_depth", "rendered_normal", "rendered_id"];
        arrays.extend(layers_of(image, shape, "rendered picture", names)?);
    }
    let appearance = scene.appearance();
    let (palette, indices): (_, Cow<'_, [u32]>) = match appearance.colors() {
        Colors::One(color) => (Some(std::slice::from_ref(color)), Cow::default()),
        Colors::Palette { palette, indices } => (Some(&palette[..]), indices.into()),
        Colors::Scalars { values, map } => {
            (Some(map.colors()), values.iter().map(|value| map.index(*value) as u32).collect())
        }
        Colors::Rgba8(colors) => {
            arrays.push(Array::list("color_rgba8", colors, |color| *color));
            (None, Cow::default())
        }
    };
    arrays.extend(palette.map(|all| Array::list("palette", all, |color| color.to_array())));
    if !indices.is_empty() {
        arrays.push(Array::list("color_index", indices, |index| [*index]));
    }
    let is_traced = |pixel: &TracedPixel| [Flag(pixel.ray.is_some().into())];
    arrays.push(Array::new("traced", &shape, pixels, is_traced));
    let is_shaded = |pixel: &TracedPixel| [Flag(pixel.shading_ray.is_some().into())];
    arrays.push(Array::new("shaded", &shape, pixels, is_shaded));
    let has_default = *appearance.surfaces() == [SurfaceProperties::default()];
    if !has_default || appearance.surface_indices().is_some() {
        let numbers = |surface: &SurfaceProperties| surface.bits().map(f32::from_bits);
        arrays.push(Array::list("surfaces", appearance.surfaces(), numbers));
    }
    let indices = appearance.surface_indices();
    arrays.extend(indices.map(|all| Array::list("surface_index", all, |index| [*index])));
    container::write(texts, arrays, out)
}

fn layers_of<'a>(
    image: &'a Image,
    shape: [usize; 2],
    what: &str,
    names: [&'static str; 4],
) -> io::Result<[Array<'a>; 4]> {
    let (Some(depths), Some(normals), Some(ids)) = (image.depth(), image.normal(), image.id()) else {
        return Err(io::Error::other(format!("the {what} lacks a layer")));
    };
    if [image.height(), image.width()].map(|n| n as usize) != shape {
        return Err(io::Error::other(format!("the {what} has another size than its film")));
    }
    let [color, depth, normal, id] = names;
    Ok([
        Array::new(color, &shape, image.color(), |color| *color),
        Array::new(depth, &shape, depths, |depth| [*depth]),
        Array::new(normal, &shape, normals, |normal| *normal),
        Array::new(id, &shape, ids, |id| [*id]),
    ])
}
