//! The objects on egui's device, and the callback that draws them in a panel.

use std::time::Duration;

use eframe::egui;
use eframe::egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};
use pinhole::camera::CameraKind;
use pinhole::gpu::{
    Composite, CompositeOptions, CompositePicture, LitPicture, LitProgress, LitRenderer, LitState, PickedPixel, Picker,
    Renderer, RendererOptions, SceneBuffers, TargetTextures, Wait, wgpu,
};
use pinhole::{Film, RenderSettings, Scene, View};
use pinhole_host_common::{Budget, Orbit, Outcome};

/// The state of the panel, which egui keeps in `CallbackResources`.
pub(crate) struct Spheres {
    renderer: LitRenderer,
    composite: Composite,
    buffers: SceneBuffers,
    picker: Picker,
    panel: Option<Panel>,
    budget: Budget,
    progress: Option<LitProgress>,
    failed: Option<String>,
}

/// The objects that depend on the size of the panel.
struct Panel {
    film: Film,
    first_pixel: [u32; 2],
    textures: TargetTextures,
    lit: LitPicture,
    shown: CompositePicture,
}

impl Spheres {
    pub(crate) fn new(egui: &RenderState, scene: &Scene) -> Outcome<Self> {
        let device = &egui.device;
        let options =
            RendererOptions { cameras: vec![CameraKind::Pinhole], data_layers: true, ..RendererOptions::default() };
        let renderer = LitRenderer::new(Renderer::new(device, &options).wait()?);
        // The render pass of egui has no depth.
        let options = CompositeOptions::without_depth(egui.target_format);
        let composite = Composite::new(device, &options).wait()?;
        let buffers = SceneBuffers::for_studio(renderer.renderer(), device, &egui.queue, scene).wait()?;
        Ok(Self {
            renderer,
            composite,
            buffers,
            picker: Picker::new(device, 3).wait()?,
            panel: None,
            budget: Budget::new(Duration::from_millis(40)),
            progress: None,
            failed: None,
        })
    }

    /// The film of the panel and its first pixel in the window, once it was drawn.
    pub(crate) fn panel(&self) -> Option<(Film, [u32; 2])> {
        self.panel.as_ref().map(|panel| (panel.film, panel.first_pixel))
    }

    /// The progress of the last drawing.
    pub(crate) fn progress(&self) -> Option<LitProgress> {
        self.progress
    }

    /// The picked pixel, if the device has returned one.
    pub(crate) fn take_pick(&mut self) -> Outcome<Option<PickedPixel>> {
        Ok(self.picker.take()?)
    }

    /// The error of the last drawing, if there was one. Callbacks of egui cannot return errors.
    pub(crate) fn failed(&mut self) -> Option<String> {
        self.failed.take()
    }
}

/// A single drawing of the panel.
pub(crate) struct Draw {
    /// egui's context, from which frames are requested while samples remain.
    pub(crate) context: egui::Context,
    /// The panel, in points.
    pub(crate) rect: egui::Rect,
    pub(crate) orbit: Orbit,
    pub(crate) settings: RenderSettings,
    /// The place where the panel was clicked, in points of the window.
    pub(crate) clicked: Option<egui::Pos2>,
}

impl CallbackTrait for Draw {
    /// Records compute passes into egui's encoder, which egui will submit.
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(spheres) = resources.get_mut::<Spheres>()
            && let Err(error) = self.record(spheres, device, queue, screen, encoder)
        {
            spheres.failed = Some(error.to_string());
        }
        Vec::new()
    }

    /// Draws the picture in egui's render pass.
    fn paint(&self, _: egui::PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, resources: &CallbackResources) {
        if let Some(spheres) = resources.get::<Spheres>()
            && let Some(panel) = &spheres.panel
            && let Err(error) = spheres.composite.draw(pass, &panel.shown)
        {
            log::error!("{error}");
        }
    }
}

impl Draw {
    fn record(
        &self,
        spheres: &mut Spheres,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Outcome<()> {
        // The pixels of the panel, rounded as egui does for the viewport.
        let scale = screen.pixels_per_point;
        let pixels = egui::epaint::ViewportInPixels::from_points(&self.rect, scale, screen.size_in_pixels);
        let [left, top, width, height] = [pixels.left_px, pixels.top_px, pixels.width_px, pixels.height_px]
            .map(|pixels| u32::try_from(pixels).unwrap_or(0));
        if width == 0 || height == 0 {
            return Ok(());
        }
        let Spheres { renderer, composite, buffers, picker, panel, budget, progress, .. } = spheres;
        let film = Film::new(width, height)?;
        let camera = self.orbit.camera(film.aspect())?;
        let view = View::new(&camera, film);
        if panel.as_ref().is_none_or(|panel| panel.textures.size() != [width, height]) {
            *panel = None;
        }
        let panel = match panel {
            Some(panel) => panel,
            None => {
                let textures = TargetTextures::new(renderer.renderer(), device, [width, height]).wait()?;
                let (targets, settings) = (textures.targets(), &self.settings);
                panel.insert(Panel {
                    film,
                    first_pixel: [0, 0],
                    lit: LitPicture::new(renderer, device, queue, buffers, &view, settings, &targets).wait()?,
                    shown: CompositePicture::new(composite, device, &targets).wait()?,
                    textures,
                })
            }
        };
        panel.first_pixel = [left, top];
        panel.shown.set_place(queue, panel.first_pixel);
        panel.lit.set(renderer, device, queue, buffers, &view, &self.settings).wait()?;
        let next = budget.record(&mut panel.lit, renderer, queue, encoder, buffers)?;
        let is_done = |progress: Option<LitProgress>| progress.is_some_and(|progress| progress.state == LitState::Done);
        // The widgets show this progress in the next frame.
        if !(is_done(next) && is_done(*progress)) {
            self.context.request_repaint();
        }
        *progress = next;
        if let Some(clicked) = self.clicked {
            let pixel = [clicked.x * scale, clicked.y * scale].map(|place| place as u32);
            let pixel = [pixel[0].saturating_sub(left), pixel[1].saturating_sub(top)];
            picker.record(encoder, &panel.textures.targets(), &view, pixel)?;
        }
        Ok(())
    }
}
