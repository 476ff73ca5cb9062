//! Spheres in a panel of egui, beside its widgets.
//!
//! Drag in the panel to turn the camera, turn the wheel to come nearer, click to pick a sphere. `s` writes the panel as
//! `Headless` renders it; Escape quits.
//!
//! ```sh
//! cargo run --release --manifest-path examples/hosts/Cargo.toml -p pinhole-host-egui
//! ```
#![allow(clippy::print_stdout, reason = "a host tells what it did")]

mod spheres;

use eframe::egui;
use eframe::egui_wgpu;
use pinhole::gpu::{LitProgress, LitState, PickedPixel};
use pinhole::render::Studio;
use pinhole::{Integrator, LinearRgb, RenderSettings, Scene, View};
use pinhole_host_common::{Orbit, Outcome, background, molecule, paths, save_still, start_log, studio};
use spheres::{Draw, Spheres};

fn main() -> Outcome<()> {
    start_log();
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default().with_inner_size([900.0, 600.0]),
        ..eframe::NativeOptions::default()
    };
    let title = "pinhole in egui";
    eframe::run_native(
        title,
        options,
        Box::new(|creation| match Panels::new(creation) {
            Ok(panels) => Ok(Box::new(panels)),
            Err(error) => Err(error.to_string().into()),
        }),
    )?;
    Ok(())
}

/// The style of the spheres' light.
#[derive(Clone, Copy, PartialEq)]
enum Style {
    Studio,
    Paths,
    /// Only the colours of the spheres.
    Flat,
}

struct Panels {
    scene: Scene,
    orbit: Orbit,
    style: Style,
    /// The angle of the light about the camera, in radians.
    angle: f64,
    samples: u32,
    background: [f32; 3],
    progress: Option<LitProgress>,
    /// Whether the result of a pick is pending.
    is_picking: bool,
    picked: Option<PickedPixel>,
    message: Option<String>,
}

impl Panels {
    fn new(creation: &eframe::CreationContext<'_>) -> Outcome<Self> {
        let egui = creation.wgpu_render_state.as_ref().ok_or("eframe runs without wgpu")?;
        let scene = molecule()?;
        let spheres = Spheres::new(egui, &scene)?;
        egui.renderer.write().callback_resources.insert(spheres);
        Ok(Self {
            scene,
            orbit: Orbit::default(),
            style: Style::Studio,
            angle: -0.7,
            samples: 16,
            background: background().to_array(),
            progress: None,
            is_picking: false,
            picked: None,
            message: None,
        })
    }

    fn settings(&self) -> RenderSettings {
        let mut settings = match self.style {
            Style::Studio => studio(self.angle, self.samples),
            Style::Paths => paths(self.angle, self.samples),
            Style::Flat => {
                let ambient = Studio { ambient: LinearRgb::WHITE, ..Studio::default() };
                RenderSettings {
                    integrator: Integrator::Studio(ambient),
                    lights: Vec::new(),
                    ..studio(self.angle, self.samples)
                }
            }
        };
        settings.background = LinearRgb::new(self.background).unwrap_or(LinearRgb::WHITE);
        settings
    }

    fn widgets(&mut self, ui: &mut egui::Ui) {
        ui.heading("Style");
        ui.radio_value(&mut self.style, Style::Studio, "Studio");
        ui.radio_value(&mut self.style, Style::Paths, "Path tracing");
        ui.radio_value(&mut self.style, Style::Flat, "Flat colours");
        ui.add(egui::Slider::new(&mut self.angle, -3.1..=3.1).text("Light"));
        ui.add(egui::Slider::new(&mut self.samples, 1..=256).logarithmic(true).text("Samples"));
        ui.horizontal(|ui| {
            ui.color_edit_button_rgb(&mut self.background);
            ui.label("Background");
        });
        ui.separator();
        ui.heading("Picked");
        match self.picked {
            None => ui.label("Click a sphere."),
            Some(PickedPixel { hit: None, .. }) => ui.label("No sphere."),
            Some(PickedPixel { hit: Some(hit), .. }) => {
                let [r, g, b] = self.scene.color(hit.id).to_srgb8();
                let color = egui::Color32::from_rgb(r, g, b);
                ui.colored_label(color, format!("Sphere {}", hit.id));
                let place = hit.place.to_array().map(|x| format!("{x:.2}")).join(", ");
                ui.label(format!("at {place}"))
            }
        };
        if let Some(progress) = self.progress {
            ui.separator();
            ui.label(format!("{} of {} samples", progress.samples, progress.total));
        }
        if let Some(message) = &self.message {
            ui.separator();
            ui.label(message);
        }
    }

    /// Shows the panel of spheres in the rest of the window.
    fn spheres(&mut self, ui: &mut egui::Ui) {
        let sense = egui::Sense::click_and_drag();
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), sense);
        let dragged = response.drag_delta();
        self.orbit.drag([f64::from(dragged.x), f64::from(dragged.y)]);
        if response.hovered() {
            let scrolled = ui.input(|input| input.smooth_scroll_delta.y);
            self.orbit.zoom(f64::from(scrolled) / 40.0);
        }
        let clicked = response.interact_pointer_pos().filter(|_| response.clicked());
        self.is_picking |= clicked.is_some();
        let (orbit, settings) = (self.orbit, self.settings());
        let draw = Draw { context: ui.ctx().clone(), rect, orbit, settings, clicked };
        ui.painter().add(egui_wgpu::Callback::new_paint_callback(rect, draw));
    }

    /// Takes the device's results since the last frame, and writes the panel to a file if `saves`.
    fn after_drawing(&mut self, spheres: &mut Spheres, saves: bool) -> Outcome<()> {
        if let Some(failed) = spheres.failed() {
            return Err(failed.into());
        }
        while let Some(picked) = spheres.take_pick()? {
            self.is_picking = false;
            let color = picked.hit.map(|hit| self.scene.color(hit.id).to_srgb8());
            println!("picked {:?} at {:?}, {color:?}", picked.hit.map(|hit| hit.id), picked.pixel);
            self.picked = Some(picked);
        }
        let progress = spheres.progress();
        let [before, now] =
            [self.progress, progress].map(|progress| progress.is_some_and(|progress| progress.state == LitState::Done));
        if now != before {
            println!("{}", if now { "done" } else { "refining" });
        }
        self.progress = progress;
        if let Some((film, [x, y])) = spheres.panel().filter(|_| saves) {
            let camera = self.orbit.camera(film.aspect())?;
            println!("panel {}x{}+{x}+{y}", film.width(), film.height());
            save_still("egui", &self.scene, &View::new(&camera, film), &self.settings())?;
        }
        Ok(())
    }
}

impl eframe::App for Panels {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
        let saves = ui.input(|input| input.key_pressed(egui::Key::S));
        if let Some(egui) = frame.wgpu_render_state() {
            let resources = &mut egui.renderer.write().callback_resources;
            if let Some(spheres) = resources.get_mut::<Spheres>()
                && let Err(error) = self.after_drawing(spheres, saves)
            {
                self.message = Some(error.to_string());
            }
        }
        egui::Panel::left("widgets").show(ui, |ui| self.widgets(ui));
        egui::CentralPanel::no_frame().show(ui, |ui| self.spheres(ui));
        if self.is_picking {
            ui.ctx().request_repaint();
        }
    }
}
