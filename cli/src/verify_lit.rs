//! The lit picture of a scene in the report of `pinhole verify`. It is not checked.

use anyhow::Result;
use serde::Serialize;

use super::verify_pictures::{Window, encoded};
use pinhole::image::Image;
use pinhole::image::color::to_srgb8;
use pinhole::image::encoding::Encoding;

/// A lit picture with few samples.
pub(super) struct LitPicture {
    image: Image,
    encoding: Encoding,
    integrator: &'static str,
    samples: u32,
    /// Number of samples that the scene asks for.
    wanted: u32,
}

/// What the page shows of it.
#[derive(Serialize)]
pub(super) struct LitFigure {
    color: String,
    integrator: &'static str,
    samples: u32,
    wanted: u32,
}

impl LitPicture {
    /// Draws the picture, encoded as the scene asks for it, but with its background.
    pub(super) fn figure(&self, window: Window) -> Result<LitFigure> {
        let (color, alpha) = (self.image.color(), self.image.alpha());
        let width = self.image.width() as usize;
        let shown = |i: usize| match (alpha, self.encoding.background()) {
            (Some(alpha), Some(background)) => {
                self.encoding.display_over(color[i], alpha[i], background)
            }
            _ => self.encoding.display(color[i]),
        };
        let color = encoded(window, |pixels| {
            let mut sum = [0.0; 3];
            let mut count = 0.0;
            for i in pixels.indices(width) {
                let shown = shown(i);
                (0..3)
                    .for_each(|channel| sum[channel] += f64::from(shown[channel].clamp(0.0, 1.0)));
                count += 1.0;
            }
            to_srgb8(sum.map(|sum| (sum / count) as f32))
        });
        let Self { integrator, samples, wanted, .. } = *self;
        Ok(LitFigure { color: color?, integrator, samples, wanted })
    }
}

#[cfg(feature = "gpu")]
pub(super) use rendered::render;

#[cfg(feature = "gpu")]
mod rendered {
    use super::*;
    use crate::device::explained_alone;
    use crate::failure::Failure;
    use crate::input::Input;
    use crate::views::Views;
    use crate::with_scene::{upload, with_structures};
    use crate::{interrupt, progress, render as job};
    use pinhole::accel::AccelChoice;
    use pinhole::gpu::Headless;

    /// More samples would take long, and change little at the size that a page has.
    const SAMPLES: u32 = 16;

    /// Renders the scene with its light and few samples, in the view that is checked.
    pub(crate) fn render(
        headless: &Headless,
        input: &Input,
        choice: AccelChoice,
    ) -> Result<LitPicture, Failure> {
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
        let (integrator, samples) = (settings.integrator.name(), settings.sampling.samples);
        Ok(LitPicture { image: picture.image, encoding, integrator, samples, wanted })
    }
}
