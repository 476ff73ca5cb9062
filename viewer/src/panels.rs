//! The controls around the picture. Each shows a flag of `pinhole render`, under its own name.

use eframe::egui::{self, Align, Color32, Layout, RichText};

use crate::app::App;
use crate::details::readable;
use pinhole_cli::viewing::grouped;

const RED: Color32 = Color32::from_rgb(176, 32, 32);

impl App {
    pub(crate) fn panels(&mut self, ui: &mut egui::Ui) {
        egui::Panel::bottom("command").show(ui, |ui| self.command_row(ui));
        if self.news.as_ref().is_some_and(|news| news.facts.time_line.is_some()) {
            egui::Panel::bottom("time").show(ui, |ui| self.time_row(ui));
        }
        egui::Panel::right("controls").default_size(272.0).size_range(220.0..=420.0).show(ui, |ui| {
            egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                self.heading(ui);
                section(ui, "View", |ui| self.view_section(ui));
                section(ui, "Style", |ui| self.style_section(ui));
                section(ui, "Color", |ui| self.color_section(ui));
                section(ui, "Selection, box and bonds", |ui| self.structure_section(ui));
                section(ui, "Picture file", |ui| self.file_section(ui));
                section(ui, "Other flags", |ui| self.others_section(ui));
            });
        });
        if self.picked.is_some() {
            self.picked_window(ui.ctx());
        }
        egui::CentralPanel::no_frame().show(ui, |ui| self.picture(ui));
    }

    fn heading(&mut self, ui: &mut egui::Ui) {
        ui.add_space(4.0);
        let path = std::path::Path::new(self.state.flags.path());
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
        ui.label(RichText::new(name).strong().size(16.0));
        let Some(news) = &self.news else { return };
        let count = news.facts.scene.len() - news.facts.scene.added();
        let has_species = news.facts.columns.iter().any(|column| column.name == "species");
        let noun = if has_species { "atoms" } else { "spheres" };
        let frames = news.facts.time_line.as_ref().map(|line| format!(" · {} frames", grouped(line.count)));
        ui.label(RichText::new(format!("{} {noun}{}", grouped(count), frames.unwrap_or_default())).weak());
        if !news.facts.notes.is_empty() {
            let title = match news.facts.notes.len() {
                1 => "1 note about the file".to_owned(),
                notes => format!("{notes} notes about the file"),
            };
            egui::CollapsingHeader::new(RichText::new(title).weak()).id_salt("notes").show(ui, |ui| {
                for note in &news.facts.notes {
                    ui.label(RichText::new(note).small());
                }
            });
        }
    }

    fn picked_window(&mut self, context: &egui::Context) {
        let Some(details) = self.picked.clone() else { return };
        let mut is_open = true;
        let (mut select, mut centers) = (None, false);
        egui::Window::new(details.title())
            .id(egui::Id::unique("picked"))
            .open(&mut is_open)
            .anchor(egui::Align2::LEFT_TOP, [10.0, 10.0])
            .resizable(false)
            .default_width(230.0)
            .show(context, |ui| {
                egui::ScrollArea::vertical().max_height(380.0).show(ui, |ui| {
                    egui::Grid::new("values").num_columns(3).striped(true).show(ui, |ui| {
                        let plain = |ui: &mut egui::Ui, name: &str, value: String| {
                            ui.label(RichText::new(name).weak());
                            ui.label(RichText::new(value).monospace());
                            ui.label("");
                            ui.end_row();
                        };
                        plain(ui, "id", details.id.to_string());
                        let place = details.center.to_array().map(readable).join(", ");
                        plain(ui, "position", place);
                        plain(ui, "radius", readable(details.radius));
                        for value in &details.rows {
                            ui.label(RichText::new(&value.name).weak());
                            ui.label(RichText::new(&value.value).monospace());
                            if let Some(expression) = &value.select {
                                let only = ui.small_button("only").on_hover_text(format!("--select '{expression}'"));
                                if only.clicked() {
                                    select = Some(expression.clone());
                                }
                            } else {
                                ui.label("");
                            }
                            ui.end_row();
                        }
                    });
                });
                centers = ui.button("Turn around this").clicked();
            });
        if let Some(expression) = select {
            self.fields.select.clone_from(&expression);
            self.set_or_remove("select", &expression);
        }
        if centers {
            self.fly(|orbit| orbit.move_to(details.center));
        }
        if !is_open {
            self.picked = None;
        }
    }

    fn time_row(&mut self, ui: &mut egui::Ui) {
        let Some(line) = self.news.as_ref().and_then(|news| news.facts.time_line.clone()) else {
            return;
        };
        ui.horizontal(|ui| {
            let text = if self.player.plays { "Pause" } else { "Play" };
            let button = egui::Button::new(text).min_size(egui::vec2(52.0, 0.0));
            if ui.add(button).on_hover_text("space").clicked() {
                self.toggle_play();
            }
            let asked = self.state.flags.get("frame").and_then(|frame| frame.parse().ok());
            let mut frame: usize = asked.unwrap_or(line.frame);
            ui.spacing_mut().slider_width = (ui.available_width() - 230.0).max(60.0);
            let slider = egui::Slider::new(&mut frame, 0..=line.count - 1).show_value(false);
            if ui.add(slider).changed() {
                self.player.plays = false;
                self.go_to(frame);
            }
            ui.monospace(format!("{frame} of 0–{}", line.count - 1));
            let speed = egui::DragValue::new(&mut self.player.frames_per_second);
            ui.add(speed.range(0.5..=60.0).speed(0.1).suffix(" frames/s").max_decimals(1));
        });
    }

    fn command_row(&mut self, ui: &mut egui::Ui) {
        ui.add_space(2.0);
        ui.horizontal(|ui| {
            let copy = ui.button("Copy as command line");
            if copy.on_hover_text("The command that renders this picture (Ctrl+C)").clicked() {
                self.copy(&ui.ctx().clone());
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(RichText::new(self.status()).weak());
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let command = RichText::new(self.state.command()).monospace().size(11.0);
                    ui.add(egui::Label::new(command).truncate().selectable(true));
                });
            });
        });
    }

    /// A text about the current or the last action.
    fn status(&self) -> String {
        let doing = match (self.rate.value, self.current_still()) {
            (Some(rate), _) => format!("{rate:.0} pictures/s"),
            (None, Some(still)) if still.samples < still.total => {
                format!("{} of {} samples", still.samples, still.total)
            }
            (None, Some(still)) if still.total > 1 => format!("{} samples", still.total),
            (None, Some(_)) => "done".to_owned(),
            (None, None) if self.news.is_some() => "rendering …".to_owned(),
            (None, None) => String::new(),
        };
        if self.said.is_empty() { doing } else { format!("{} · {doing}", self.said) }
    }

    /// Draws over the picture: errors, and a note while a file is read.
    pub(crate) fn overlay(&mut self, ui: &mut egui::Ui, rect: egui::Rect) {
        let is_long = |since: &std::time::Instant| since.elapsed().as_millis() > 250;
        if self.busy.as_ref().is_some_and(is_long) {
            let what = match (&self.news, self.state.flags.get("frame")) {
                (Some(_), Some(frame)) if self.player.plays => format!("reading frame {frame} …"),
                _ => format!("loading {} …", self.state.flags.path()),
            };
            let middle = egui::Area::new(egui::Id::unique("loading")).order(egui::Order::Foreground);
            middle.fixed_pos(rect.center_top() + egui::vec2(-110.0, 14.0)).show(ui.ctx(), |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.horizontal(|ui| {
                        ui.spinner();
                        ui.label(what);
                    });
                });
            });
        } else if self.busy.is_some() {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(260));
        }
        let Some(error) = self.error.clone() else { return };
        let area = egui::Area::new(egui::Id::unique("error")).order(egui::Order::Foreground);
        let width = (rect.width() - 60.0).clamp(120.0, 620.0);
        area.fixed_pos(rect.left_bottom() + egui::vec2(14.0, -14.0)).pivot(egui::Align2::LEFT_BOTTOM).show(
            ui.ctx(),
            |ui| {
                let frame = egui::Frame::popup(ui.style()).stroke(egui::Stroke::new(1.0, RED));
                frame.show(ui, |ui| {
                    ui.set_max_width(width);
                    ui.horizontal_top(|ui| {
                        if ui.small_button("×").clicked() {
                            self.error = None;
                        }
                        ui.add(egui::Label::new(RichText::new(error).color(RED)).wrap());
                    });
                });
            },
        );
    }
}

/// A section of the controls, with a title.
fn section(ui: &mut egui::Ui, title: &str, contents: impl FnOnce(&mut egui::Ui)) {
    let title = RichText::new(title).strong();
    egui::CollapsingHeader::new(title).default_open(true).show_unindented(ui, contents);
}
