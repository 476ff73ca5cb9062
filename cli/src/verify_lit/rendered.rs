//! The lit picture in the report of `pinhole verify`, rendered on a device.

use crate::device::explained_alone;
use crate::failure::Failure;
use crate::input::Input;
use crate::views::Views;
use crate::with_scene::{upload, with_structures};
use crate::{interrupt, progress, render as job};
use pinhole::accel::AccelChoice;
use pinhole::gpu::Headless;
use pinhole::image::Image;
use pinhole::image::color::to_srgb8;
use pinhole::image::encoding::Encoding;
use pinhole::verify::run_file::ShownPicture;

/// More samples would take long, and change little at the size that a page has.
const SAMPLES: u32 = 16;

/// Renders the scene with its light and few samples, in the view that is checked.
pub(crate) fn render(
    headless: &Headless,
    input: &Input,
    choice: AccelChoice,
) -> Result<ShownPicture, Failure> {
    let mut settings = input.settings.clone();
    let wanted = settings.sampling.samples;
    settings.sampling.samples = wanted.min(SAMPLES);
    settings.is_transparent = false;
    let background = settings.visible_background();
    let encoding = input.encoding.with_transparent(false).with_background(background);
    let layers = encoding.layers();
    let (view, views) = (input.view(), Views::of(input));
    let plan = |choice| job::plan(headless, input, &views, layers, choice);
    let done = with_structures(headless, choice, plan, |plan| {
        interrupt::on_device(|| {
            let buffers = upload(headless, &input.scene, plan)?;
            progress::stage("rendering with light");
            let watch = &mut |_: &_| interrupt::decide();
            headless.render_uploaded(&buffers, &view, &settings, layers, watch)
        })
    })?;
    let (picture, _) = done.map_err(|error| explained_alone(headless, &error))?;
    let samples = settings.sampling.samples;
    Ok(shown(&picture.image, &encoding, samples, wanted))
}

/// Encodes the picture as the scene asks for it, but with its background.
fn shown(image: &Image, encoding: &Encoding, samples: u32, wanted: u32) -> ShownPicture {
    let (color, alpha) = (image.color(), image.alpha());
    let srgb = (0..color.len()).map(|i| {
        to_srgb8(match (alpha, encoding.background()) {
            (Some(alpha), Some(background)) => {
                encoding.display_over(color[i], alpha[i], background)
            }
            _ => encoding.display(color[i]),
        })
    });
    let size = [image.width(), image.height()];
    ShownPicture { size, srgb: srgb.collect(), samples, wanted }
}
