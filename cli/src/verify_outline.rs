//! Outlines in `pinhole verify`: of a scene with outlines, what was drawn into a small picture.

use anyhow::{Context, Result};
use serde::Serialize;

use super::verify_report::LISTED;
use pinhole::verify::outlined::{self, OutlineCertificate};
use pinhole::verify::run_file::OutlinedPicture;

/// The object `outline` of the JSON document.
#[derive(Serialize)]
pub(super) struct OutlineReport {
    pixels: u64,
    /// The number of pixels that a line may touch.
    touched: u64,
    /// The number of pixels of which lines may cover more or less, because rounding leaves open where they are.
    open: u64,
    undecided: u64,
    violation_count: u64,
    violations: Vec<String>,
    /// The widest interval of a pixel's share that is not undecided.
    widest: f64,
    outcome: &'static str,
}

impl From<&OutlineCertificate> for OutlineReport {
    fn from(certificate: &OutlineCertificate) -> Self {
        let OutlineCertificate { pixels, touched, open, undecided, violation_count, .. } =
            *certificate;
        Self {
            pixels,
            touched,
            open,
            undecided,
            violation_count,
            violations: certificate
                .violations
                .iter()
                .take(LISTED)
                .map(ToString::to_string)
                .collect(),
            widest: certificate.widest,
            outcome: certificate.outcome().name(),
        }
    }
}

impl OutlineReport {
    /// The report as one line of text.
    pub(super) fn line(&self) -> String {
        let Self { pixels, touched, undecided, violation_count, .. } = self;
        let legal = pixels.saturating_sub(undecided + violation_count);
        format!(
            "outline: {pixels} pixels, {touched} of them touched by lines: {legal} legal, {undecided} undecided, \
             {violation_count} violations"
        )
    }
}

/// Judges what was drawn.
pub(super) fn judge(
    OutlinedPicture { outline, before, after }: &OutlinedPicture,
) -> Result<OutlineCertificate> {
    outlined::certify(before, after, outline).context("the outlines cannot be checked")
}

#[cfg(feature = "gpu")]
pub(super) use rendered::render;

#[cfg(feature = "gpu")]
mod rendered {
    use super::*;
    use crate::device::explained_alone;
    use crate::failure::Failure;
    use crate::input::Input;
    use crate::verify_denoiser::shrunk;
    use crate::with_scene::{upload, with_structures};
    use crate::{interrupt, progress};
    use pinhole::accel::AccelChoice;
    use pinhole::camera::View;
    use pinhole::gpu::Headless;
    use pinhole::image::{Layer, LayerSet};
    use pinhole::render::Integrator;

    /// The longer side of the picture: in most pictures, lines are then drawn in several bands.
    const SIDE: u32 = 512;

    /// Renders a small picture, and draws the scene's outlines into it as `render` does. `None` if it has none.
    pub(crate) fn render(
        headless: &Headless,
        input: &Input,
        choice: AccelChoice,
    ) -> Result<Option<OutlinedPicture>, Failure> {
        let mut settings = input.settings.clone();
        let Integrator::Studio(studio) = &mut settings.integrator else { return Ok(None) };
        let Some(outline) = studio.outline else { return Ok(None) };
        // Lines are mixed with any light.
        (studio.occlusion, studio.has_shadows) = (None, false);
        (settings.sampling.samples, settings.is_denoised) = (1, false);
        let film = shrunk(&input.film, SIDE)
            .context("the picture is too narrow for its outlines to be checked")?;
        let view = View::new(input.camera.as_ref(), film);
        let wanted = LayerSet::COLOR.with(Layer::Alpha);
        let (unfinished, layers) = (settings.unfinished(), settings.layers_for(wanted));
        let plan = |choice| headless.plan(&input.scene, &view, &unfinished, layers, choice, 0);
        let done = with_structures(headless, choice, plan, |plan| {
            interrupt::on_device(|| {
                let buffers = upload(headless, &input.scene, plan)?;
                progress::stage("checking outlines");
                let watch = &mut |_: &_| interrupt::decide();
                let before =
                    headless.render_uploaded(&buffers, &view, &unfinished, layers, watch)?.image;
                let after = headless.finish(before.clone(), &settings, wanted)?;
                Ok(OutlinedPicture { outline, before, after })
            })
        })?;
        let (pictures, _) = done.map_err(|error| explained_alone(headless, &error))?;
        Ok(Some(pictures))
    }
}
