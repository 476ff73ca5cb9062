//! The noisy picture whose denoising `pinhole verify` checks, rendered on a device.

use anyhow::Context;

use crate::device::explained_alone;
use crate::failure::Failure;
use crate::input::Input;
use crate::with_scene::{upload, with_structures};
use crate::{interrupt, progress};
use pinhole::accel::AccelChoice;
use pinhole::camera::View;
use pinhole::camera::film::{Film, FilmError};
use pinhole::gpu::Headless;
use pinhole::image::Image;
use pinhole::image::denoise::GUIDES;

/// The longer side of the picture that is denoised, and its samples: the noisier, the more there is to do.
const SIDE: u32 = 160;
const SAMPLES: u32 = 4;

/// Renders a small noisy picture, and what the device makes of it.
pub(crate) fn render(
    headless: &Headless,
    input: &Input,
    choice: AccelChoice,
) -> Result<[Image; 2], Failure> {
    let mut settings = input.settings.unfinished();
    settings.sampling.samples = settings.sampling.samples.min(SAMPLES);
    let film = shrunk(&input.film, SIDE)
        .context("the picture is too narrow for its denoiser to be checked")?;
    let view = View::new(input.camera.as_ref(), film);
    let plan = |choice| headless.plan(&input.scene, &view, &settings, GUIDES, choice, 0);
    let done = with_structures(headless, choice, plan, |plan| {
        interrupt::on_device(|| {
            let buffers = upload(headless, &input.scene, plan)?;
            progress::stage("checking the denoiser");
            let watch = &mut |_: &_| interrupt::decide();
            let noisy = headless.render_uploaded(&buffers, &view, &settings, GUIDES, watch)?.image;
            let quiet = headless.denoise(&noisy)?;
            Ok([noisy, quiet])
        })
    })?;
    let (pictures, _) = done.map_err(|error| explained_alone(headless, &error))?;
    Ok(pictures)
}

/// The same picture with a longer side of at most this many pixels.
fn shrunk(film: &Film, longest: u32) -> Result<Film, FilmError> {
    let (width, height) = (film.width(), film.height());
    let shrink = |side: u32| {
        let side = u64::from(side) * u64::from(longest) / u64::from(width.max(height).max(longest));
        side.max(1) as u32
    };
    Ok(Film::new(shrink(width), shrink(height))?.with_y_axis(film.y_axis()))
}
