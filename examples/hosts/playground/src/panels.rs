//! Panels that take turns: in each frame one of them records rays, so that the time of the frame is that of the panel.

use std::time::Duration;

use eframe::egui;
use eframe::egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};
use pinhole::camera::CameraKind;
use pinhole::gpu::{
    Composite, CompositeOptions, CompositePicture, LitPicture, LitRenderer, LitState, LivePicture,
    Renderer, RendererOptions, SceneBuffers, TargetTextures, Targets, wgpu,
};
use pinhole::{Film, RenderSettings, Scene, View};
use pinhole_host_common::{Budget, Orbit, Outcome};

/// What egui keeps for all panels.
pub(crate) struct Panels {
    renderer: LitRenderer,
    composite: Composite,
    buffers: SceneBuffers,
    panels: Vec<Panel>,
    failed: Option<String>,
}

/// How a picture is shown.
#[derive(Clone, Copy)]
pub(crate) enum Way {
    /// Samples accumulate, and begin again when something moves.
    Samples,
    /// A few rays in each frame, averaged over the frames before.
    Live,
}

/// How far a picture is: samples, or frames that are averaged.
#[derive(Clone, Copy)]
pub(crate) struct Progress {
    pub(crate) samples: u32,
    pub(crate) total: u32,
    pub(crate) is_done: bool,
}

/// One way to light the scene.
struct Panel {
    way: Way,
    budget: Budget,
    shown: Option<Shown>,
    progress: Option<Progress>,
    /// Time of the device since the picture began.
    spent: Duration,
}

/// What belongs to a size of a panel.
struct Shown {
    film: Film,
    first_pixel: [u32; 2],
    textures: TargetTextures,
    picture: Picture,
    composed: CompositePicture,
}

enum Picture {
    Samples(Box<LitPicture>),
    /// With what it showed last, and the number of frames of it.
    Live(Box<LivePicture>, Option<(Orbit, f64)>, u32),
}

/// Number of frames of a live picture, after which they change no more that could be seen.
const FRAMES: u32 = 64;

/// What a panel tells of its picture.
#[derive(Clone, Copy)]
pub(crate) struct Report {
    pub(crate) progress: Progress,
    /// Rays of the last frame, and the time that the device took.
    pub(crate) last: Option<(u64, Duration)>,
    /// Time of the device since the picture began.
    pub(crate) spent: Duration,
    /// The film and its first pixel in the window.
    pub(crate) place: (Film, [u32; 2]),
}

impl Panels {
    pub(crate) fn new(egui: &RenderState, scene: &Scene, ways: &[Way]) -> Outcome<Self> {
        let device = &egui.device;
        let options = RendererOptions {
            cameras: vec![CameraKind::Pinhole],
            data_layers: true,
            ..RendererOptions::default()
        };
        let renderer = LitRenderer::new(Renderer::new(device, &options)?);
        let options = CompositeOptions::without_depth(egui.target_format);
        let composite = Composite::new(device, &options)?;
        let buffers = SceneBuffers::for_studio(renderer.renderer(), device, &egui.queue, scene)?;
        let panel = |way: &Way| Panel {
            way: *way,
            budget: Budget::new(Duration::from_millis(100)),
            shown: None,
            progress: None,
            spent: Duration::ZERO,
        };
        let panels = ways.iter().map(panel).collect();
        Ok(Self { renderer, composite, buffers, panels, failed: None })
    }

    pub(crate) fn report(&self, panel: usize) -> Option<Report> {
        let Panel { budget, shown, progress, spent, .. } = self.panels.get(panel)?;
        let place = shown.as_ref().map(|shown| (shown.film, shown.first_pixel))?;
        Some(Report { progress: (*progress)?, last: budget.last(), spent: *spent, place })
    }

    /// The next panel after `turn` whose picture has samples left; `turn` if none has.
    pub(crate) fn next_turn(&self, turn: usize) -> usize {
        let count = self.panels.len();
        let is_open = |panel: &usize| !self.panels[*panel].is_done();
        (1..=count).map(|i| (turn + i) % count).find(is_open).unwrap_or(turn)
    }

    pub(crate) fn is_done(&self) -> bool {
        self.panels.iter().all(Panel::is_done)
    }

    /// Why a panel could not be drawn.
    pub(crate) fn failed(&mut self) -> Option<String> {
        self.failed.take()
    }
}

impl Panel {
    fn is_done(&self) -> bool {
        self.progress.is_some_and(|progress| progress.is_done)
    }
}

/// One drawing of a panel.
pub(crate) struct Draw {
    /// Asked for another frame while samples remain, or another panel is to show the new camera.
    pub(crate) context: egui::Context,
    pub(crate) panel: usize,
    /// Whether it is the panel's turn to record rays.
    pub(crate) has_turn: bool,
    pub(crate) rect: egui::Rect,
    pub(crate) orbit: Orbit,
    /// Angle of the light.
    pub(crate) angle: f64,
    pub(crate) settings: RenderSettings,
}

impl CallbackTrait for Draw {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(panels) = resources.get_mut::<Panels>()
            && let Err(error) = self.record(panels, device, queue, screen, encoder)
        {
            panels.failed = Some(error.to_string());
        }
        Vec::new()
    }

    fn paint(
        &self,
        _: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(panels) = resources.get::<Panels>()
            && let Some(shown) = &panels.panels[self.panel].shown
            && let Err(error) = panels.composite.draw(pass, &shown.composed)
        {
            log::error!("{error}");
        }
    }
}

impl Draw {
    fn record(
        &self,
        panels: &mut Panels,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Outcome<()> {
        let scale = screen.pixels_per_point;
        let pixels =
            egui::epaint::ViewportInPixels::from_points(&self.rect, scale, screen.size_in_pixels);
        let [left, top, width, height] =
            [pixels.left_px, pixels.top_px, pixels.width_px, pixels.height_px]
                .map(|pixels| u32::try_from(pixels).unwrap_or(0));
        if width == 0 || height == 0 {
            return Ok(());
        }
        let Panels { renderer, composite, buffers, .. } = panels;
        let panel = &mut panels.panels[self.panel];
        let film = Film::new(width, height)?;
        let camera = self.orbit.camera(film.aspect())?;
        let (view, settings) = (View::new(&camera, film), &self.settings);
        if panel.shown.as_ref().is_none_or(|shown| shown.textures.size() != [width, height]) {
            panel.shown = None;
            panel.progress = None;
        }
        let shown = match &mut panel.shown {
            Some(shown) => shown,
            none => {
                let textures = TargetTextures::new(renderer.renderer(), device, [width, height])?;
                let targets = textures.targets();
                none.insert(Shown {
                    film,
                    first_pixel: [left, top],
                    picture: make(
                        panel.way,
                        (renderer, device, queue),
                        buffers,
                        &view,
                        settings,
                        &targets,
                    )?,
                    composed: CompositePicture::new(composite, device, &targets)?,
                    textures,
                })
            }
        };
        shown.first_pixel = [left, top];
        shown.composed.set_place(queue, shown.first_pixel);
        let is_new = match &mut shown.picture {
            Picture::Samples(lit) => lit.set(renderer, device, queue, buffers, &view, settings)?,
            Picture::Live(live, last, frames) => {
                live.set(renderer, device, queue, buffers, &view, settings)?;
                let is_new = *last != Some((self.orbit, self.angle));
                *last = Some((self.orbit, self.angle));
                *frames = if is_new { 0 } else { *frames };
                is_new
            }
        };
        if is_new {
            (panel.progress, panel.spent) = (None, Duration::ZERO);
        }
        if self.has_turn && !panel.progress.is_some_and(|progress| progress.is_done) {
            let before = panel.budget.last();
            let progress = match &mut shown.picture {
                Picture::Samples(lit) => panel
                    .budget
                    .record(lit, renderer, queue, encoder, buffers)?
                    .map(|progress| Progress {
                        samples: progress.samples,
                        total: progress.total,
                        is_done: progress.state == LitState::Done,
                    }),
                Picture::Live(live, _, frames) => {
                    let progress = live.record(renderer, queue, encoder, buffers)?;
                    // A live picture has as many rays as it has.
                    panel.budget.rays();
                    panel.budget.watch(encoder, progress.rays);
                    *frames += u32::from(progress.rays > 0);
                    Some(Progress { samples: *frames, total: FRAMES, is_done: *frames >= FRAMES })
                }
            };
            if let Some((_, took)) = panel.budget.last().filter(|last| Some(*last) != before) {
                panel.spent += took;
            }
            panel.progress = progress.or(panel.progress);
            self.context.request_repaint();
        }
        if !panel.is_done() {
            self.context.request_repaint();
        }
        Ok(())
    }
}

fn make(
    way: Way,
    (renderer, device, queue): (&LitRenderer, &wgpu::Device, &wgpu::Queue),
    buffers: &SceneBuffers,
    view: &View<'_>,
    settings: &RenderSettings,
    targets: &Targets<'_>,
) -> Outcome<Picture> {
    Ok(match way {
        Way::Samples => Picture::Samples(Box::new(LitPicture::new(
            renderer, device, queue, buffers, view, settings, targets,
        )?)),
        Way::Live => {
            let live = LivePicture::new(renderer, device, queue, buffers, view, settings, targets)?;
            Picture::Live(Box::new(live), None, 0)
        }
    })
}
