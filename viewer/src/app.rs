//! The window: its contents, and the effects of pointer and keys.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use eframe::egui::{self, Color32};
use pinhole_cli::viewing::{RenderFlags, StillPicture, ViewCamera, ViewError};

use crate::details::Details;
use crate::orbit::Orbit;
use crate::quick::Quick;
use crate::state::{Fields, State};
use crate::worker::{Message, News, Saving, Window, Worker};

/// Time without motion after which still pictures are rendered.
pub(crate) const STILL_AFTER: Duration = Duration::from_millis(120);

/// The environment variable that makes the viewer log events on standard error.
const LOG: &str = "PINHOLE_VIEWER_LOG";

/// The place for the error that ends the program.
pub(crate) type Ending = Arc<Mutex<Option<ViewError>>>;

pub(crate) struct App {
    pub(crate) state: State,
    pub(crate) worker: Worker,
    pub(crate) quick: Quick,
    pub(crate) news: Option<Box<News>>,
    pub(crate) orbit: Option<Orbit>,
    pub(crate) still: Option<Still>,
    pub(crate) picked: Option<Details>,
    pub(crate) fields: Fields,
    pub(crate) player: Player,
    pub(crate) saving: Option<Saving>,
    /// The last error, until the user closes it or a change of the flags succeeds.
    pub(crate) error: Option<String>,
    /// A message about the last action.
    pub(crate) said: String,
    /// The time since which a file is being read.
    pub(crate) busy: Option<Instant>,
    pub(crate) rate: Rate,
    /// The time at which the state changed; `None` after the worker was asked for it.
    changed: Option<Instant>,
    /// The time at which the camera last moved.
    pub(crate) moved: Option<Instant>,
    /// The visible quick picture: its state, and whether the camera was moving.
    pub(crate) seen: Option<(u64, bool)>,
    /// Whether the next pick sets the point around which the camera turns.
    pub(crate) centers: bool,
    ending: Ending,
    logs: bool,
}

pub(crate) struct Still {
    state: u64,
    pub(crate) texture: egui::TextureHandle,
    pub(crate) samples: u32,
    pub(crate) total: u32,
}

pub(crate) struct Player {
    pub(crate) plays: bool,
    pub(crate) frames_per_second: f32,
    last: Instant,
}

/// Counts quick pictures.
pub(crate) struct Rate {
    pub(crate) since: Instant,
    pub(crate) before: u64,
    /// Pictures per second while the camera moves.
    pub(crate) value: Option<f64>,
}

impl App {
    pub(crate) fn new(
        creation: &eframe::CreationContext<'_>,
        state: State,
        worker: Worker,
        first: Option<Message>,
        ending: Ending,
    ) -> Result<Self, String> {
        let render = creation.wgpu_render_state.clone().ok_or("the window has no device")?;
        let context = creation.egui_ctx.clone();
        dress(&context);
        let (device, queue) = (render.device.clone(), render.queue.clone());
        worker.attach(Window { context, device, queue });
        let now = Instant::now();
        let mut app = Self {
            fields: Fields::of(&state),
            state,
            worker,
            quick: Quick::new(render),
            news: None,
            orbit: None,
            still: None,
            picked: None,
            player: Player { plays: false, frames_per_second: 10.0, last: now },
            saving: None,
            error: None,
            said: String::new(),
            busy: Some(now),
            rate: Rate { since: now, before: 0, value: None },
            changed: Some(now),
            moved: None,
            seen: None,
            centers: false,
            ending,
            logs: std::env::var_os(LOG).is_some(),
        };
        if let Some(first) = first {
            app.hear(first, &creation.egui_ctx);
        }
        Ok(app)
    }

    /// Logs an event, for tests and measurements.
    pub(crate) fn log(&self, text: impl FnOnce() -> String) {
        if self.logs {
            pinhole_cli::viewing::print_note(&text());
        }
    }

    /// Changes the flags, or shows the error if they are not valid.
    pub(crate) fn change(&mut self, change: impl FnOnce(&mut RenderFlags)) {
        match self.state.change(change) {
            Ok(true) => {
                self.error = None;
                self.mark();
            }
            Ok(false) => {}
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// Records that the state changed.
    pub(crate) fn mark(&mut self) {
        self.worker.cancel();
        self.changed = Some(Instant::now());
    }

    pub(crate) fn fly(&mut self, motion: impl FnOnce(&mut Orbit)) {
        let Some(orbit) = &mut self.orbit else { return };
        motion(orbit);
        orbit.camera.write_to(&mut self.state.flags);
        self.state.number += 1;
        self.moved = Some(Instant::now());
        self.mark();
    }

    /// Makes the camera frame everything without a change of its direction.
    pub(crate) fn fit(&mut self) {
        let Some(camera) = self.orbit.as_ref().map(|orbit| orbit.camera.clone()) else { return };
        self.change(|flags| camera.write_fit_to(flags));
    }

    /// Fixes the camera in its place, so that it does not follow the spheres.
    fn hold_camera(&mut self) {
        if self.state.flags.get("eye").is_none() {
            self.fly(|orbit| orbit.move_to(orbit.pivot));
        }
    }

    pub(crate) fn go_to(&mut self, frame: usize) {
        self.hold_camera();
        self.change(|flags| flags.set("frame", &frame.to_string()));
    }

    /// Copies the command that renders this view.
    pub(crate) fn copy(&mut self, context: &egui::Context) {
        let command = self.state.command();
        pinhole_cli::viewing::print_line(&command);
        context.copy_text(command);
        self.said = "copied the command line".to_owned();
    }

    pub(crate) fn save(&mut self, context: &egui::Context) {
        if self.saving.is_some() {
            return;
        }
        let (flags, output) = (self.state.saved(), self.state.output.clone());
        match Saving::start(flags, output, context.clone()) {
            Ok(saving) => (self.saving, self.error) = (Some(saving), None),
            Err(error) => self.error = Some(format!("a thread cannot be started: {error}")),
        }
    }

    pub(crate) fn is_moving(&self) -> bool {
        self.moved.is_some_and(|moved| moved.elapsed() < STILL_AFTER)
    }

    /// Returns the still picture, if it shows the current state.
    pub(crate) fn current_still(&self) -> Option<&Still> {
        self.still.as_ref().filter(|still| still.state == self.state.number)
    }

    fn hear(&mut self, message: Message, context: &egui::Context) {
        match message {
            Message::Shown(news) => self.learn(news),
            Message::Still { state, picture } => self.take_still(state, &picture, context),
            Message::Note(note) => self.said = note,
            Message::Failed { state, error } => self.fail(state, error, context),
        }
    }

    fn learn(&mut self, news: Box<News>) {
        if let Some(quick) = &news.quick {
            self.quick.set_scene(quick.clone());
            // The old scene's picture stays until there is a new one.
            self.seen = self.seen.map(|_| (0, false));
        }
        let is_new = |old: &News| !Arc::ptr_eq(&old.facts.scene, &news.facts.scene);
        if self.news.as_deref().is_none_or(is_new) {
            let (scene, columns) = (&news.facts.scene, &news.facts.columns);
            let same = |old: &News| old.facts.scene.shape_count() == scene.shape_count();
            let keeps = self.news.as_deref().is_some_and(same);
            let picked = self.picked.take().filter(|_| keeps);
            self.picked = picked.and_then(|old| Details::of(scene, columns, old.id));
            self.log(|| format!("shown: {} spheres", scene.len()));
        }
        if news.state == self.state.number {
            let bounds = news.facts.scene.bounds_to_frame();
            let camera = ViewCamera::new(&news.facts.camera);
            let length = bounds.size().length();
            self.orbit = camera.map(|camera| Orbit::new(camera, bounds.center(), length));
            self.busy = None;
        }
        self.news = Some(news);
    }

    fn take_still(&mut self, state: u64, picture: &StillPicture, context: &egui::Context) {
        if state != self.state.number {
            return;
        }
        let size = picture.size.map(|side| side as usize);
        let image = egui::ColorImage::from_rgba_unmultiplied(size, &picture.rgba);
        let (samples, total) = (picture.samples, picture.total);
        self.log(|| format!("still: {samples} of {total} samples"));
        let options = egui::TextureOptions::LINEAR;
        match &mut self.still {
            Some(still) => {
                still.texture.set(image, options);
                (still.state, still.samples, still.total) = (state, samples, total);
            }
            None => {
                let texture = context.load_texture("still picture", image, options);
                self.still = Some(Still { state, texture, samples, total });
            }
        }
    }

    /// Shows an error, and returns to the previous state. If there was none, the program ends.
    fn fail(&mut self, state: u64, error: ViewError, context: &egui::Context) {
        if self.news.is_none() {
            *self.ending.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            context.send_viewport_cmd(egui::ViewportCommand::Close);
            return;
        }
        self.log(|| format!("failed: {error}"));
        self.error = Some(error.to_string());
        if state != self.state.number {
            return;
        }
        (self.player.plays, self.busy) = (false, None);
        let Some(news) = &self.news else { return };
        let mut before = news.facts.flags.clone();
        before.remove("size");
        if before != self.state.flags {
            self.state.flags = before;
            self.state.number += 1;
            self.mark();
        }
    }

    /// Asks the worker for the pictures of the current state.
    fn ask(&mut self, context: &egui::Context) {
        let Some(changed) = self.changed else { return };
        let request = self.state.request(!self.player.plays);
        let is_read = self.news.as_ref().is_some_and(|news| request.flags.has_data_of(&news.facts.flags));
        if is_read && (self.is_moving() || changed.elapsed() < STILL_AFTER) {
            context.request_repaint_after(STILL_AFTER);
            return;
        }
        if !is_read {
            self.busy.get_or_insert_with(Instant::now);
        }
        self.changed = None;
        self.worker.ask(request);
    }

    fn play(&mut self, context: &egui::Context) {
        if !self.player.plays {
            return;
        }
        let Some(line) = self.news.as_ref().and_then(|news| news.facts.time_line.clone()) else {
            self.player.plays = false;
            return;
        };
        let step = Duration::from_secs_f32(1.0 / self.player.frames_per_second.max(0.1));
        let is_shown = self.busy.is_none() && self.changed.is_none();
        if is_shown && self.player.last.elapsed() >= step {
            self.player.last = Instant::now();
            self.go_to((line.frame + 1) % line.count);
        }
        context.request_repaint_after(step.min(Duration::from_millis(30)));
    }

    /// Starts or stops playing. Still pictures are rendered when it stops.
    pub(crate) fn toggle_play(&mut self) {
        self.player.plays = !self.player.plays;
        if !self.player.plays {
            self.mark();
        }
    }

    fn keys(&mut self, context: &egui::Context) {
        if context.egui_wants_keyboard_input() {
            return;
        }
        use egui::{Key, Modifiers};
        // The modifiers are those of the key's event, as a quick user releases them in the same frame.
        let pressed = |modifiers, key| context.input_mut(|input| input.consume_key(modifiers, key));
        let line = self.news.as_ref().and_then(|news| news.facts.time_line.clone());
        let is_copy = |event: &egui::Event| matches!(event, egui::Event::Copy);
        if context.input(|input| input.events.iter().any(is_copy)) {
            self.copy(context);
        }
        if pressed(Modifiers::COMMAND, Key::S) {
            self.save(context);
        }
        if pressed(Modifiers::COMMAND, Key::Q) {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        let pressed = |key| pressed(Modifiers::NONE, key);
        if pressed(Key::F) {
            self.fit();
        }
        if pressed(Key::Escape) {
            (self.picked, self.error) = (None, None);
        }
        if let Some(line) = line {
            if pressed(Key::Space) {
                self.toggle_play();
            }
            if pressed(Key::ArrowRight) {
                self.go_to((line.frame + 1) % line.count);
            }
            if pressed(Key::ArrowLeft) {
                self.go_to((line.frame + line.count - 1) % line.count);
            }
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        while let Some(message) = self.worker.message() {
            self.hear(message, &context);
        }
        if let Some(saving) = &self.saving
            && let Some(result) = saving.result()
        {
            match result {
                Ok(()) => {
                    let seconds = saving.started.elapsed().as_secs_f64();
                    self.said = format!("saved {} ({seconds:.1} s)", saving.output);
                    self.log(|| self.said.clone());
                }
                Err(error) => {
                    self.log(|| format!("failed: {error}"));
                    self.error = Some(error.to_string());
                }
            }
            self.saving = None;
        }
        if context.input(|input| input.viewport().close_requested()) && self.saving.is_some() {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.said = "the window closes when the picture is saved".to_owned();
            self.fields.closes = true;
        } else if self.fields.closes && self.saving.is_none() {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        self.keys(&context);
        self.panels(ui);
        self.play(&context);
        self.ask(&context);
    }

    fn clear_color(&self, _: &egui::Visuals) -> [f32; 4] {
        // Panels and pictures cover most of this colour.
        BESIDE.to_normalized_gamma_f32()
    }

    fn on_exit(&mut self) {
        self.worker.close();
    }
}

pub(crate) fn dress(context: &egui::Context) {
    context.set_theme(egui::Theme::Light);
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 5.0);
        style.spacing.combo_width = 140.0;
        style.visuals.panel_fill = Color32::from_rgb(248, 248, 250);
        style.visuals.window_fill = Color32::WHITE;
    });
}

/// The colour around a picture that does not fill its part of the window.
pub(crate) const BESIDE: Color32 = Color32::from_rgb(214, 216, 220);
