//! The ways to light a scene side by side, from the same camera, with the time that each takes.
//!
//! Drag in a panel to turn the camera, turn the wheel to come nearer. `s` writes the first panel as `Headless` renders it;
//! Escape quits.
//!
//! ```sh
//! cargo run --release -p pinhole-host-playground
//! ```
#![allow(clippy::print_stdout, reason = "a host tells what it did")]

mod panels;

use eframe::{egui, egui_wgpu};
use panels::{Draw, Panels, Report, Way};
use pinhole::{RenderSettings, Scene, View};
use pinhole_host_common::{Orbit, Outcome, molecule, paths, save_still, start_log, studio};

/// A way to light the scene: its name, how it is shown, and its settings for an angle of the light and a number of samples.
type Tier = (&'static str, Way, fn(f64, u32) -> RenderSettings);

/// What is shown, from left to right. Another way to light the scene is another row.
const TIERS: [Tier; 3] = [
    ("Studio", Way::Samples, studio),
    ("Studio while it moves", Way::Live, studio),
    ("Path tracing", Way::Samples, paths),
];

fn main() -> Outcome<()> {
    start_log();
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default().with_inner_size([1200.0, 520.0]),
        ..eframe::NativeOptions::default()
    };
    eframe::run_native(
        "pinhole playground",
        options,
        Box::new(|creation| match Playground::new(creation) {
            Ok(playground) => Ok(Box::new(playground)),
            Err(error) => Err(error.to_string().into()),
        }),
    )?;
    Ok(())
}

struct Playground {
    scene: Scene,
    orbit: Orbit,
    angle: f64,
    samples: u32,
    turn: usize,
    is_done: bool,
    message: Option<String>,
}

impl Playground {
    fn new(creation: &eframe::CreationContext<'_>) -> Outcome<Self> {
        let egui = creation.wgpu_render_state.as_ref().ok_or("eframe runs without wgpu")?;
        let scene = molecule()?;
        let panels = Panels::new(egui, &scene, &TIERS.map(|(_, way, _)| way))?;
        egui.renderer.write().callback_resources.insert(panels);
        let (orbit, angle, samples) = (Orbit::default(), -0.7, 8);
        Ok(Self { scene, orbit, angle, samples, turn: 0, is_done: false, message: None })
    }

    /// One panel: the spheres, and below them what they took.
    fn panel(&mut self, ui: &mut egui::Ui, panel: usize, report: Option<Report>) {
        let (name, way, settings) = TIERS[panel];
        let size = ui.available_size() - egui::vec2(0.0, 60.0);
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::drag());
        let dragged = response.drag_delta();
        self.orbit.drag([f64::from(dragged.x), f64::from(dragged.y)]);
        if response.hovered() {
            let scrolled = ui.input(|input| input.smooth_scroll_delta.y);
            self.orbit.zoom(f64::from(scrolled) / 40.0);
        }
        let settings = settings(self.angle, self.samples);
        let draw = Draw {
            panel,
            has_turn: self.turn == panel,
            context: ui.ctx().clone(),
            rect,
            orbit: self.orbit,
            angle: self.angle,
            settings,
        };
        ui.painter().add(egui_wgpu::Callback::new_paint_callback(rect, draw));
        ui.strong(name);
        let Some(Report { progress, last, spent, .. }) = report else { return };
        let what = match way {
            Way::Samples => "samples",
            Way::Live => "frames",
        };
        let seconds = spent.as_secs_f64();
        ui.label(format!("{} of {} {what} in {seconds:.2} s", progress.samples, progress.total));
        if let Some((rays, took)) = last {
            let (millions, seconds) = (rays as f64 / 1e6, took.as_secs_f64());
            ui.label(format!(
                "last frame: {:.0} ms, {millions:.2} million rays, {:.1} million a second",
                1e3 * seconds,
                millions / seconds
            ));
        }
    }

    fn write_first(&self, report: &Report) -> Outcome<()> {
        let (film, [x, y]) = report.place;
        let camera = self.orbit.camera(film.aspect())?;
        println!("panel {}x{}+{x}+{y}", film.width(), film.height());
        let settings = TIERS[0].2(self.angle, self.samples);
        save_still("playground", &self.scene, &View::new(&camera, film), &settings)
    }
}

impl eframe::App for Playground {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
        let mut reports = [None; TIERS.len()];
        if let Some(egui) = frame.wgpu_render_state()
            && let Some(panels) = egui.renderer.write().callback_resources.get_mut::<Panels>()
        {
            reports = std::array::from_fn(|panel| panels.report(panel));
            self.turn = panels.next_turn(self.turn);
            self.message = panels.failed().or(self.message.take());
            let is_done = panels.is_done();
            if std::mem::replace(&mut self.is_done, is_done) != is_done {
                println!("{}", if is_done { "done" } else { "refining" });
            }
        }
        if ui.input(|input| input.key_pressed(egui::Key::S))
            && let Some(report) = &reports[0]
            && let Err(error) = self.write_first(report)
        {
            self.message = Some(error.to_string());
        }
        egui::Panel::top("light").show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.add(egui::Slider::new(&mut self.angle, -3.1..=3.1).text("Light"));
                let samples = egui::Slider::new(&mut self.samples, 1..=1024).logarithmic(true);
                ui.add(samples.text("Samples"));
                if let Some(message) = &self.message {
                    ui.label(message);
                }
            });
        });
        egui::CentralPanel::default().show(ui, |ui| {
            ui.columns(TIERS.len(), |columns| {
                for (panel, ui) in columns.iter_mut().enumerate() {
                    self.panel(ui, panel, reports[panel]);
                }
            });
        });
    }
}
