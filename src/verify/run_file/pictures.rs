//! Pictures in a run file beside the recorded one: those of the denoiser, and the lit one that people are
//! shown.

use std::collections::BTreeMap;
use std::io;

use super::RunFileError;
use super::container::{Container, contradiction};
use super::numbers::Array;
use crate::camera::film::Film;
use crate::image::denoise::GUIDES;
use crate::image::{Image, LayerSet};

/// A lit picture as people see it. It is not judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownPicture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The pixels in sRGB with 8 bits, row by row from the top, as exposure and tone curve make them.
    pub srgb: Vec<[u8; 3]>,
    /// The number of samples of each pixel.
    pub samples: u32,
    /// The number of samples that the scene asks for.
    pub wanted: u32,
}

fn shape(image: &Image) -> [usize; 2] {
    [image.height() as usize, image.width() as usize]
}

pub(super) fn add_denoised<'a>(
    [noisy, denoised]: [&'a Image; 2],
    arrays: &mut Vec<Array<'a>>,
) -> io::Result<()> {
    let layers = (noisy.normal(), noisy.depth(), noisy.albedo(), noisy.variance());
    let (Some(normal), Some(depth), Some(albedo), Some(variance)) = layers else {
        return Err(io::Error::other("the noisy picture lacks a layer"));
    };
    let size = shape(noisy);
    arrays.extend([
        Array::new("noisy_color", &size, noisy.color(), |color| *color),
        Array::new("noisy_normal", &size, normal, |normal| *normal),
        Array::new("noisy_depth", &size, depth, |depth| [*depth]),
        Array::new("noisy_albedo", &size, albedo, |albedo| *albedo),
        Array::new("noisy_variance", &size, variance, |variance| [*variance]),
        Array::new("denoised_color", &shape(denoised), denoised.color(), |color| *color),
    ]);
    Ok(())
}

/// Reads the noisy picture and the denoised one.
pub(super) fn denoised(file: &Container<'_>) -> Result<Option<[Image; 2]>, RunFileError> {
    if !file.has("noisy_color") {
        return Ok(None);
    }
    let size = size_of(file, "noisy_color")?;
    let all = [size[1] as usize, size[0] as usize];
    let other = || contradiction("the pictures of the denoiser have no valid size");
    let empty = |layers: LayerSet| Image::new(size[0], size[1], layers).map_err(|_| other());
    let (mut noisy, mut denoised) = (empty(GUIDES)?, empty(LayerSet::COLOR)?);
    let vectors = |name| file.items::<f32, 3>(name, &all);
    let numbers = |name| file.numbers::<f32>(name, &all);
    noisy.set_guides(
        [vectors("noisy_color")?, vectors("noisy_normal")?, vectors("noisy_albedo")?],
        [numbers("noisy_depth")?, numbers("noisy_variance")?],
    );
    denoised.color_mut().copy_from_slice(&vectors("denoised_color")?);
    Ok(Some([noisy, denoised]))
}

/// Width and height of a picture of three channels.
fn size_of(file: &Container<'_>, name: &str) -> Result<[u32; 2], RunFileError> {
    let [height, width, _] = *file.shape(name)? else {
        return Err(contradiction(format!("the array `{name}` does not have the shape (H, W, 3)")));
    };
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    let film = Film::new(side(width), side(height))
        .map_err(|error| contradiction(format!("the array `{name}`: {error}")))?;
    Ok([film.width(), film.height()])
}

pub(super) fn add_shown<'a>(
    shown: &'a ShownPicture,
    arrays: &mut Vec<Array<'a>>,
    texts: &mut BTreeMap<String, String>,
) -> io::Result<()> {
    let ShownPicture { size: [width, height], srgb, samples, wanted } = shown;
    if u64::from(*width) * u64::from(*height) != srgb.len() as u64 {
        return Err(io::Error::other("the shown picture does not have the size that it names"));
    }
    let size = [*height as usize, *width as usize];
    arrays.push(Array::new("shown", &size, srgb, |pixel| *pixel));
    texts.insert("shown_samples".to_owned(), samples.to_string());
    texts.insert("shown_wanted".to_owned(), wanted.to_string());
    Ok(())
}

/// Reads the lit picture that people are shown.
pub(super) fn shown(file: &Container<'_>) -> Result<Option<ShownPicture>, RunFileError> {
    if !file.has("shown") {
        return Ok(None);
    }
    let size = size_of(file, "shown")?;
    let srgb = file.items("shown", &[size[1] as usize, size[0] as usize])?;
    let (samples, wanted) = (file.whole("shown_samples")?, file.whole("shown_wanted")?);
    Ok(Some(ShownPicture { size, srgb, samples, wanted }))
}
