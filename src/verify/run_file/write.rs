//! Writing of run files.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io;
use std::io::Write;

use crate::image::Image;
use crate::scene::material::SurfaceProperties;
use crate::scene::{Colors, Scene};
use crate::verify::run_file::container::{Array, Flag};
use crate::verify::run_file::lit_samples::{LitSamples, SAMPLES};
use crate::verify::run_file::{LIMIT, Provenance, container, lit_inputs, scene_sha256};
use crate::verify::{PlainRender, Recording, TracedPixel};

/// The contents that a run file may have besides the picture by one ray for each pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extras<'a> {
    /// Samples of the lit picture.
    pub light: Option<&'a LitSamples>,
    /// A noisy picture, and the result of the device's denoiser.
    pub denoised: Option<[&'a Image; 2]>,
    /// The lit picture as it is shown to people.
    pub shown: Option<&'a FinalPicture>,
}

/// A lit picture as people see it. It is not judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FinalPicture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The pixels in sRGB with 8 bits, row by row from the top, as exposure and tone curve make them.
    pub srgb: Vec<[u8; 3]>,
    /// The number of samples of each pixel.
    pub samples: u32,
    /// The number of samples that the scene asks for.
    pub wanted: u32,
}

/// Writes a run file in small pieces: 98 bytes for each pixel, 130 if a different picture was rendered, and 16 to 24
/// for each sphere. Each sample of light has 240 bytes for each pixel of its rectangle. Each surface adds 164 bytes, or in
/// studios 160 and 24 for each 32 lights or directions.
///
/// # Errors
/// Returns an error if writing fails, if the recording has another size than its film or lacks a layer, if the samples
/// have another camera or film than the recording, or if the noisy picture lacks a layer.
pub fn write_with(
    scene: &Scene,
    recording: &Recording,
    provenance: &Provenance,
    Extras { light, denoised, shown }: Extras<'_>,
    out: &mut dyn Write,
) -> io::Result<()> {
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
    for (key, text) in
        [("camera", camera.kind.name()), ("y_axis", film.y_axis().name()), ("shading", primary.shading.name())]
    {
        texts.insert(key.to_owned(), text.to_owned());
    }
    let is_rendered = match rendered {
        PlainRender::None => None,
        PlainRender::Same => Some("same"),
        PlainRender::Other(_) => Some("other"),
    };
    texts.extend(is_rendered.map(|text| ("rendered".to_owned(), text.to_owned())));
    texts.insert("scene_sha256".to_owned(), scene_sha256(scene));

    let vectors = &camera.vectors;
    let numbers = vectors.numbers.into();
    let camera = vec![vectors.origin, vectors.right, vectors.up, vectors.forward, numbers];
    let ray = |pixel: &TracedPixel| pixel.ray.unwrap_or_default();
    let shading = |pixel: &TracedPixel| pixel.shading_ray.unwrap_or_default();
    let mut arrays = vec![
        Array::list("camera", camera, |vector| vector.to_array()),
        Array::new("scene_origin", &[], vec![scene.origin()], |origin| origin.to_array()),
        Array::spheres(scene),
        Array::new("background", &[], vec![primary.background], |color| color.to_array()),
    ];
    arrays.extend(lit_inputs::view_arrays(uploaded, ["view", "advance"]));
    arrays.extend([
        Array::new("ray_origin", &shape, pixels, move |pixel| ray(pixel).origin),
        Array::new("ray_direction", &shape, pixels, move |pixel| ray(pixel).direction),
        Array::new("ray_distance", &shape, pixels, move |pixel| [ray(pixel).distance]),
        Array::new("shading_origin", &shape, pixels, move |pixel| shading(pixel).origin),
        Array::new("shading_direction", &shape, pixels, move |pixel| shading(pixel).direction),
        Array::new("shading_distance", &shape, pixels, move |pixel| [shading(pixel).distance]),
        Array::new("hit_t", &shape, pixels, |pixel| [pixel.t]),
        Array::new("hit_id", &shape, pixels, |pixel| [pixel.id]),
    ]);
    arrays.extend(layers);
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
    if let Some((samples, given)) = light.and_then(|samples| Some((samples, samples.given()?))) {
        if (&given.camera, &given.film) != (&recording.camera, film) {
            return Err(io::Error::other("the light is that of another camera or film"));
        }
        lit_inputs::add(given, &mut arrays, &mut texts)?;
        texts.insert(SAMPLES.to_owned(), samples.count().to_string());
        arrays.extend(samples.arrays());
    }
    if let Some([noisy, denoised]) = denoised {
        let layers = (noisy.normal(), noisy.depth(), noisy.albedo(), noisy.variance());
        let (Some(normal), Some(depth), Some(albedo), Some(variance)) = layers else {
            return Err(io::Error::other("the noisy picture lacks a layer"));
        };
        let [size, other] = [noisy, denoised].map(|image| [image.height() as usize, image.width() as usize]);
        arrays.extend([
            Array::new("noisy_color", &size, noisy.color(), |color| *color),
            Array::new("noisy_normal", &size, normal, |normal| *normal),
            Array::new("noisy_depth", &size, depth, |depth| [*depth]),
            Array::new("noisy_albedo", &size, albedo, |albedo| *albedo),
            Array::new("noisy_variance", &size, variance, |variance| [*variance]),
            Array::new("denoised_color", &other, denoised.color(), |color| *color),
        ]);
    }
    if let Some(FinalPicture { size: [width, height], srgb, samples, wanted }) = shown {
        if u64::from(*width) * u64::from(*height) != srgb.len() as u64 {
            return Err(io::Error::other("the shown picture does not have the size that it names"));
        }
        let size = [*height as usize, *width as usize];
        arrays.push(Array::new("shown", &size, srgb, |pixel| *pixel));
        texts.insert("shown_samples".to_owned(), samples.to_string());
        texts.insert("shown_wanted".to_owned(), wanted.to_string());
    }
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
