//! Pictures for a window, as `pinhole render` makes them, with increasing numbers of samples.

use std::sync::Arc;

use anyhow::Context;

use super::OpenView;
use super::RenderFlags;
use super::ViewError;
use crate::render;
use crate::render::device::{OpenDevice, explained};
use crate::render::with_scene::{upload, with_structures};
use crate::terminal::failure::Failure;
use pinhole::accel::AccelChoice;
use pinhole::cpu::{self, RenderError, SearchStructure};
use pinhole::gpu::{Decision, GpuError, Headless, Picture, SceneBuffers, Wait};
use pinhole::image::encoding::Bits;
use pinhole::image::{Image, LayerSet};
use pinhole::render::RenderSettings;
use pinhole::scene::Scene;
use pinhole_figure::write::png;

/// Renders a view on a device of its own.
pub struct StillRenderer {
    opened: OpenDevice,
    uploaded: Option<DeviceScene>,
}

/// A scene on the device.
struct DeviceScene {
    scene: Arc<Scene>,
    /// The integrator for which the structures were planned.
    integrator: std::mem::Discriminant<pinhole::render::Integrator>,
    buffers: SceneBuffers,
}

/// A picture with some of its samples, encoded and with annotations.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct StillPicture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Red, green, blue and alpha of every pixel in sRGB, row by row from the top. Colours are not premultiplied.
    pub rgba: Vec<u8>,
    /// The number of samples of each pixel. If it equals `total`, `pinhole render` writes the same pixels.
    pub samples: u32,
    /// The number of samples that each pixel will have.
    pub total: u32,
}

impl StillRenderer {
    /// Opens the device that the flags ask for.
    pub fn open(flags: &RenderFlags) -> Result<Self, ViewError> {
        Ok(Self { opened: flags.job()?.device.open()?, uploaded: None })
    }

    /// A warning about the device, if there is one.
    pub fn warning(&self) -> Option<&str> {
        match &self.opened {
            OpenDevice::Device { warning, .. } => warning.as_deref(),
            OpenDevice::CpuInstead => Some("still pictures are rendered by the CPU reference, which is slower"),
            OpenDevice::Cpu => None,
        }
    }

    /// Renders the picture, first with few samples and at last with all, and calls `show` with each stage. Ends
    /// early, and returns false, once `is_wanted` returns false.
    pub fn render(
        &mut self,
        shown: &OpenView,
        is_wanted: &dyn Fn() -> bool,
        show: &mut dyn FnMut(StillPicture),
    ) -> Result<bool, ViewError> {
        let mut encoding = shown.encoding;
        encoding.bits = Bits::Eight;
        let layers = encoding.layers().iter().chain(LayerSet::COLOR.iter()).collect();
        let mut settings = shown.input.settings.clone();
        let total = if settings.integrator.is_primary() { 1 } else { settings.sampling.samples };
        for samples in steps(total) {
            settings.sampling.samples = samples;
            let Some(image) = self.image(shown, &settings, layers, is_wanted)? else {
                return Ok(false);
            };
            let pixels = png::samples_annotated(&image, &encoding, &shown.annotations);
            let pixels = pixels.context("the picture cannot be shown").map_err(Failure::from)?;
            let rgba = if encoding.transparent {
                pixels
            } else {
                pixels.chunks_exact(3).flat_map(|rgb| [rgb[0], rgb[1], rgb[2], 255]).collect()
            };
            show(StillPicture { size: [image.width(), image.height()], rgba, samples, total });
        }
        Ok(true)
    }

    /// Renders the view; `None` if it is no longer wanted.
    fn image(
        &mut self,
        shown: &OpenView,
        settings: &RenderSettings,
        layers: LayerSet,
        is_wanted: &dyn Fn() -> bool,
    ) -> Result<Option<Image>, Failure> {
        let OpenDevice::Device { headless, choice, .. } = &self.opened else {
            return on_cpu(shown, settings, layers, is_wanted);
        };
        let watch = || if is_wanted() { Decision::GoOn } else { Decision::Stop };
        let render = |buffers: &SceneBuffers| {
            let view = shown.input.view();
            headless.render_uploaded(buffers, &view, settings, layers, &mut |_| watch()).wait()
        };
        let (scene, integrator) = (&shown.input.scene, std::mem::discriminant(&settings.integrator));
        let is_of_scene = |up: &DeviceScene| Arc::ptr_eq(&up.scene, scene) && up.integrator == integrator;
        let uploaded = self.uploaded.as_ref().filter(|uploaded| is_of_scene(uploaded));
        let rendered = uploaded.map(|uploaded| render(&uploaded.buffers));
        let rendered = match rendered {
            Some(done @ (Ok(_) | Err(GpuError::Stopped))) => done,
            // The structure may not suit this view, so others are tried.
            Some(Err(_)) | None => {
                self.uploaded = None;
                let first = first_render(headless, shown, layers, *choice, &render)?;
                first.map(|(buffers, picture)| {
                    let scene = Arc::clone(scene);
                    self.uploaded = Some(DeviceScene { scene, integrator, buffers });
                    picture
                })
            }
        };
        match rendered {
            Ok(picture) => Ok(Some(picture.image)),
            Err(GpuError::Stopped) => Ok(None),
            Err(error) => Err(explained(headless, &error)),
        }
    }
}

/// Copies the scene to the device and renders. Tries another structure if the first one does not suit.
fn first_render(
    headless: &Headless,
    shown: &OpenView,
    layers: LayerSet,
    choice: AccelChoice,
    render: &dyn Fn(&SceneBuffers) -> Result<Picture, GpuError>,
) -> Result<Result<(SceneBuffers, Picture), GpuError>, Failure> {
    let input = &shown.input;
    let view = [input.view()];
    let plan = |choice| render::plan(headless, input, &view, layers, choice, false);
    let done = with_structures(headless, choice, plan, |plan| {
        let uploaded = upload(headless, &input.scene, plan);
        Ok(uploaded.and_then(|buffers| {
            let picture = render(&buffers)?;
            Ok((buffers, picture))
        }))
    })?;
    Ok(done.map(|(done, _)| done))
}

fn on_cpu(
    shown: &OpenView,
    settings: &RenderSettings,
    layers: LayerSet,
    is_wanted: &dyn Fn() -> bool,
) -> Result<Option<Image>, Failure> {
    let structure = SearchStructure::new(&shown.input.scene).context("the structure cannot be built")?;
    let watch = &mut |_: &_| if is_wanted() { Decision::GoOn } else { Decision::Stop };
    match cpu::render_watched(&structure, &shown.input.view(), settings, layers, watch) {
        Ok(picture) => Ok(Some(picture.image)),
        Err(RenderError::Stopped) => Ok(None),
        Err(error) => Err(anyhow::Error::new(error).context("the CPU cannot render this picture").into()),
    }
}

/// The numbers of samples of the pictures to show, up to all.
fn steps(total: u32) -> impl Iterator<Item = u32> {
    let fewer = std::iter::successors(Some(1_u32), |samples| samples.checked_mul(4));
    // A picture with almost all samples would cost more than it is worth.
    fewer.take_while(move |samples| *samples <= total / 2).chain([total])
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_last_picture_has_all_samples() {
        let steps = |total| super::steps(total).collect::<Vec<_>>();
        assert_eq!(steps(1), [1]);
        assert_eq!(steps(2), [1, 2]);
        assert_eq!(steps(8), [1, 4, 8]);
        assert_eq!(steps(100), [1, 4, 16, 100]);
        assert_eq!(steps(u32::MAX).last(), Some(&u32::MAX));
    }
}
