//! The picture in the window, which the pointer moves.

use std::time::{Duration, Instant};

use eframe::egui;

use crate::app::{App, Rate, STILL_AFTER};
use crate::details::Details;
use crate::quick::Sight;
use pinhole::camera::Camera;
use pinhole::glam::DVec3;

impl App {
    /// The camera of the current state, for the picture in the window.
    fn camera(&self) -> Option<Box<dyn Camera>> {
        let (news, orbit) = (self.news.as_ref()?, self.orbit.as_ref()?);
        let [width, height] = self.state.window.map(f64::from);
        let mut camera = orbit.camera.clone();
        camera.set_aspect(width / height);
        camera.parameters().ok()?.camera(width / height, &news.facts.scene.subject()).ok()
    }

    /// Shows the picture, and lets the pointer move it.
    pub(crate) fn picture(&mut self, ui: &mut egui::Ui) {
        let pixels_per_point = ui.ctx().pixels_per_point();
        let rect = fitted(ui.available_rect_before_wrap(), self.state.size, pixels_per_point);
        let window = [rect.width(), rect.height()].map(|side| ((side * pixels_per_point).round() as u32).max(1));
        let response = ui.allocate_rect(rect, egui::Sense::click_and_drag());
        if self.state.resize(window) {
            self.moved = Some(Instant::now());
            self.mark();
        }
        self.pointer(ui, &response);
        self.see(ui.ctx());
        let painter = ui.painter_at(rect);
        let still = self.current_still().map(|still| still.texture.id());
        painter.add(self.quick.callback(rect, still.is_none() && self.seen.is_some()));
        if let Some(texture) = still {
            let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
            painter.image(texture, rect, whole, egui::Color32::WHITE);
        }
        self.marker(&painter, rect);
        self.overlay(ui, rect);
    }

    fn pointer(&mut self, ui: &egui::Ui, response: &egui::Response) {
        use egui::PointerButton::{Middle, Primary, Secondary};
        let height = f64::from(response.rect.height().max(1.0));
        let by = response.drag_delta();
        let parts = [f64::from(by.x) / height, f64::from(by.y) / height];
        let (shift, command) = ui.input(|input| (input.modifiers.shift, input.modifiers.command));
        let is_pan =
            response.dragged_by(Secondary) || response.dragged_by(Middle) || response.dragged_by(Primary) && shift;
        if by != egui::Vec2::ZERO {
            if is_pan {
                let height = self.height_at_pivot();
                self.fly(|orbit| orbit.pan(parts, height));
            } else if response.dragged_by(Primary) && command {
                self.fly(|orbit| orbit.roll(-std::f64::consts::TAU * parts[0]));
            } else if response.dragged_by(Primary) {
                self.fly(|orbit| orbit.turn(parts));
            }
        } else if response.dragged() {
            // While a button is held still nothing moves, but the motion may continue.
            self.moved = self.moved.map(|_| Instant::now());
        }
        if response.hovered() {
            let wheel = ui.input(|input| input.smooth_scroll_delta().y);
            let pinch = ui.input(|input| input.zoom_delta());
            if wheel.abs() > 0.0 {
                self.fly(|orbit| orbit.zoom(f64::from(wheel)));
            }
            if (pinch - 1.0).abs() > 1e-6 {
                self.fly(|orbit| orbit.zoom(f64::from(pinch.ln()) / 0.003));
            }
        }
        if (response.clicked() || response.double_clicked())
            && let Some(at) = response.interact_pointer_pos()
        {
            self.centers = response.double_clicked();
            let part = (at - response.rect.min) / response.rect.size();
            // The pick needs a picture with all pixels.
            self.look(false);
            self.quick.pick([f64::from(part.x), f64::from(part.y)]);
        }
    }

    /// The height of the picture at the depth of the pivot.
    fn height_at_pivot(&self) -> f64 {
        let (Some(camera), Some(orbit)) = (self.camera(), &self.orbit) else { return 0.0 };
        let vectors = camera.vectors();
        let up = 2.0 * vectors.up.length();
        if orbit.camera.is_orthographic() {
            return up;
        }
        let forward = vectors.forward.length();
        let depth = (orbit.pivot - vectors.origin).dot(vectors.forward) / forward;
        up / forward * depth.abs()
    }

    /// Renders a quick picture if the visible one is out of date.
    fn see(&mut self, context: &egui::Context) {
        let is_moving = self.is_moving() || self.player.plays;
        let wanted = (self.state.number, is_moving);
        self.quick.poll();
        // Work requested below is recorded with this frame of the window.
        let is_waiting = self.quick.is_waiting();
        // The window's pictures wait for the device, so only as many are recorded as it can render.
        if self.seen != Some(wanted)
            && (is_moving || self.current_still().is_none())
            && self.seen != Some((self.state.number, false))
        {
            self.look(is_moving);
        }
        if self.is_moving() {
            context.request_repaint_after(STILL_AFTER / 2);
        }
        while let Some(picked) = self.quick.picked() {
            self.show_picked(picked.hit);
        }
        if is_waiting {
            context.request_repaint_after(Duration::from_millis(4));
        }
        if let Some(error) = self.quick.take_error() {
            self.error = Some(format!("the window's device: {error}"));
        }
        self.count(is_moving);
    }

    /// Renders a quick picture of the current state.
    fn look(&mut self, is_moving: bool) {
        let (Some(camera), Some(news)) = (self.camera(), &self.news) else { return };
        let (settings, size) = (news.facts.settings.clone(), self.state.window);
        self.quick.see(Sight { camera, settings, size, is_moving });
        self.seen = Some((self.state.number, is_moving));
    }

    fn show_picked(&mut self, hit: Option<pinhole::gpu::PickedHit>) {
        let news = self.news.as_ref();
        self.picked = hit.and_then(|hit| {
            let news = news?;
            Details::of(&news.facts.scene, &news.facts.columns, hit.id)
        });
        self.log(|| match &self.picked {
            Some(details) => format!("picked: id {} {}", details.id, details.title()),
            None => "picked: nothing".to_owned(),
        });
        if let Some(details) = self.picked.as_ref().filter(|_| self.centers) {
            let center = details.center;
            self.fly(|orbit| orbit.move_to(center));
        }
    }

    fn count(&mut self, is_moving: bool) {
        let (now, count) = (Instant::now(), self.quick.count());
        if !is_moving {
            (self.rate.since, self.rate.before, self.rate.value) = (now, count, None);
            return;
        }
        let elapsed = (now - self.rate.since).as_secs_f64();
        if elapsed >= 1.0 {
            let value = (count - self.rate.before) as f64 / elapsed;
            self.rate = Rate { since: now, before: count, value: Some(value) };
            let size = self.quick.size().unwrap_or_default();
            self.log(|| format!("rate: {value:.1} pictures/s of {}x{}", size[0], size[1]));
        }
    }

    /// Draws a ring around the picked sphere.
    fn marker(&self, painter: &egui::Painter, rect: egui::Rect) {
        let (Some(details), Some(camera)) = (&self.picked, self.camera()) else { return };
        let up = camera.vectors().up.normalize_or_zero();
        let at = |point: DVec3| {
            let location = camera.location_of(point)?;
            let (x, y) = (0.5 + 0.5 * location.x, 0.5 - 0.5 * location.y);
            Some(rect.min + egui::vec2(x as f32 * rect.width(), y as f32 * rect.height()))
        };
        let (Some(middle), Some(edge)) = (at(details.center), at(details.center + details.radius * up)) else {
            return;
        };
        let radius = (edge - middle).length().max(4.0) + 2.0;
        painter.circle_stroke(middle, radius, egui::Stroke::new(3.5, egui::Color32::WHITE));
        let ring = egui::Stroke::new(1.5, egui::Color32::from_rgb(214, 96, 0));
        painter.circle_stroke(middle, radius, ring);
    }
}

/// The part of a rectangle that a picture of this size fills, on whole pixels.
fn fitted(rect: egui::Rect, size: Option<[u32; 2]>, pixels_per_point: f32) -> egui::Rect {
    let mut sides = rect.size();
    if let Some([width, height]) = size.map(|size| size.map(|side| side.max(1) as f32)) {
        let scale = (sides.x / width).min(sides.y / height);
        sides = egui::vec2(width * scale, height * scale);
    }
    let to_pixels = |point: f32| (point * pixels_per_point).round() / pixels_per_point;
    let min = rect.center() - 0.5 * sides;
    let min = egui::pos2(to_pixels(min.x), to_pixels(min.y));
    egui::Rect::from_min_size(min, egui::vec2(to_pixels(sides.x), to_pixels(sides.y)))
}
