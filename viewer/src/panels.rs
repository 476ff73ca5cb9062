//! The controls around the picture. Each shows a flag of `pinhole render`, under its own name.

use eframe::egui::{self, Align, Color32, Layout, RichText};
use pinhole::color_by::MapName;
use pinhole::load::{Column, ColumnValues};
use pinhole::style::Style;

use crate::app::App;
use crate::details::readable;
use crate::state::State;

/// What the user types, until it becomes a flag.
pub(crate) struct Fields {
    select: String,
    range: String,
    background: String,
    /// Any flags, as on a command line.
    others: String,
    width: u32,
    height: u32,
    /// Whether the window closes when it has saved a picture.
    pub(crate) closes: bool,
}

impl Fields {
    pub(crate) fn of(state: &State) -> Self {
        let text = |name| state.flags.get(name).unwrap_or_default().to_owned();
        let [width, height] = state.size.unwrap_or([1600, 1200]);
        Self {
            select: text("select"),
            range: text("range"),
            background: text("background"),
            others: String::new(),
            width,
            height,
            closes: false,
        }
    }
}

/// The columns that all spheres have.
const BUILT_IN: [&str; 5] = ["index", "radius", "x", "y", "z"];

/// The look of the window.
pub(crate) fn dress(context: &egui::Context) {
    context.set_theme(egui::Theme::Light);
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 5.0);
        style.spacing.combo_width = 140.0;
        style.visuals.panel_fill = Color32::from_rgb(248, 248, 250);
        style.visuals.window_fill = Color32::WHITE;
    });
}

const RED: Color32 = Color32::from_rgb(176, 32, 32);

impl App {
    pub(crate) fn panels(&mut self, ui: &mut egui::Ui) {
        egui::Panel::bottom("command").show(ui, |ui| self.command_row(ui));
        if self.news.as_ref().is_some_and(|news| news.time_line.is_some()) {
            egui::Panel::bottom("time").show(ui, |ui| self.time_row(ui));
        }
        egui::Panel::right("controls").default_size(272.0).size_range(220.0..=420.0).show(
            ui,
            |ui| {
                egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                    self.heading(ui);
                    section(ui, "View", |ui| self.view_section(ui));
                    section(ui, "Style", |ui| self.style_section(ui));
                    section(ui, "Color", |ui| self.color_section(ui));
                    section(ui, "Selection, box and bonds", |ui| self.structure_section(ui));
                    section(ui, "Picture file", |ui| self.file_section(ui));
                    section(ui, "Other flags", |ui| self.others_section(ui));
                });
            },
        );
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
        let count = news.scene.len() - news.scene.added();
        let has_species = news.columns.iter().any(|column| column.name == "species");
        let noun = if has_species { "atoms" } else { "spheres" };
        let frames =
            news.time_line.as_ref().map(|line| format!(" · {} frames", grouped(line.count)));
        ui.label(
            RichText::new(format!("{} {noun}{}", grouped(count), frames.unwrap_or_default()))
                .weak(),
        );
        if !news.notes.is_empty() {
            let title = match news.notes.len() {
                1 => "1 note about the file".to_owned(),
                notes => format!("{notes} notes about the file"),
            };
            egui::CollapsingHeader::new(RichText::new(title).weak()).id_salt("notes").show(
                ui,
                |ui| {
                    for note in &news.notes {
                        ui.label(RichText::new(note).small());
                    }
                },
            );
        }
    }

    fn view_section(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            if ui.button("Fit").on_hover_text("Frame everything from this side (F)").clicked() {
                self.fit();
            }
            for view in ["x", "-x", "y", "-y", "z", "-z", "iso"] {
                ui.spacing_mut().item_spacing.x = 3.0;
                let button = egui::Button::new(view).min_size(egui::vec2(22.0, 0.0));
                if ui.add(button).on_hover_text(format!("--view {view}")).clicked() {
                    let camera = self.state.flags.get("camera").map(str::to_owned);
                    self.change(|flags| {
                        flags.remove_camera();
                        flags.set("view", view);
                        if let Some(camera) = &camera {
                            flags.set("camera", camera);
                        }
                    });
                }
            }
        });
        row(ui, "--camera", |ui| {
            let now = self.state.flags.get("camera").unwrap_or("pinhole").to_owned();
            let mut wanted = None;
            egui::ComboBox::from_id_salt("camera").selected_text(&now).show_ui(ui, |ui| {
                for camera in ["pinhole", "orthographic"] {
                    if ui.selectable_label(now == camera, camera).clicked() {
                        wanted = Some(camera);
                    }
                }
            });
            if let (Some(wanted), Some(orbit)) = (wanted.filter(|w| *w != now), &self.orbit) {
                let camera = orbit.camera.clone();
                self.change(|flags| {
                    camera.write_fit_to(flags);
                    let [direction, up] =
                        ["direction", "up"].map(|name| flags.get(name).map(str::to_owned));
                    flags.remove_camera();
                    flags.set("camera", wanted);
                    for (name, value) in [("direction", direction), ("up", up)] {
                        if let Some(value) = value {
                            flags.set(name, &value);
                        }
                    }
                });
            }
        });
        ui.label(
            RichText::new("drag: turn · right or shift: move · ctrl: roll · wheel: zoom · double click: center")
                .small()
                .weak(),
        );
    }

    fn style_section(&mut self, ui: &mut egui::Ui) {
        let own = self.news.as_ref().and_then(|news| news.style).unwrap_or("of the file");
        let styles: Vec<&str> = Style::ALL.iter().map(|style| style.name()).collect();
        self.choice(ui, "style", own, &styles);
        let integrator = self.news.as_ref().map(|news| match news.settings.integrator {
            pinhole::render::Integrator::Primary(_) => "primary",
            pinhole::render::Integrator::Path(_) => "path",
            _ => "studio",
        });
        self.choice(
            ui,
            "integrator",
            integrator.unwrap_or("studio"),
            &["primary", "studio", "path"],
        );
        row(ui, "--samples", |ui| {
            let own = self.news.as_ref().map_or(1, |news| news.settings.sampling.samples);
            let given = self.state.flags.get("samples").and_then(|text| text.parse().ok());
            let mut samples: u32 = given.unwrap_or(own);
            let drag = egui::DragValue::new(&mut samples).range(1..=65536).speed(0.2);
            if ui.add(drag).changed() {
                self.change(|flags| flags.set("samples", &samples.to_string()));
            }
            self.reset(ui, "samples");
        });
        row(ui, "--background", |ui| {
            let edit = egui::TextEdit::singleline(&mut self.fields.background);
            let edit = ui.add(edit.hint_text("white, #f3f4f6 …").desired_width(120.0));
            if edit.lost_focus() {
                let text = self.fields.background.clone();
                self.set_or_remove("background", &text);
            }
        });
        ui.horizontal(|ui| {
            self.switch(ui, "transparent", "transparent");
            self.switch(ui, "scale-bar", "scale bar");
            self.switch(ui, "denoise", "denoise");
        });
    }

    fn color_section(&mut self, ui: &mut egui::Ui) {
        let Some(news) = &self.news else { return };
        let own = news.own_color_by.clone();
        let mut columns: Vec<String> =
            news.columns.iter().map(|column| column.name.clone()).collect();
        for built_in in BUILT_IN {
            if columns.iter().all(|column| column != built_in) {
                columns.push(built_in.to_owned());
            }
        }
        let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
        self.choice(ui, "color-by", own.as_deref().unwrap_or("of the file"), &columns);
        if self.state.flags.get("color-by").is_none() {
            return;
        }
        let maps: Vec<&str> = MapName::all().collect();
        self.choice(ui, "cmap", "automatic", &maps);
        row(ui, "--range", |ui| {
            let edit = egui::TextEdit::singleline(&mut self.fields.range);
            let edit = ui.add(edit.hint_text("LO,HI or 2%,98%").desired_width(120.0));
            if edit.lost_focus() {
                let text = self.fields.range.clone();
                self.set_or_remove("range", &text);
            }
        });
        ui.horizontal(|ui| {
            self.switch(ui, "legend", "legend");
            self.switch(ui, "cmap-reverse", "reverse");
            self.switch(ui, "log", "logarithm");
        });
    }

    fn structure_section(&mut self, ui: &mut egui::Ui) {
        ui.label(RichText::new("--select").monospace().small());
        let hint = self.news.as_ref().map_or_else(String::new, |news| example(&news.columns));
        let edit = egui::TextEdit::singleline(&mut self.fields.select).hint_text(hint);
        let edit = ui.add(edit.desired_width(f32::INFINITY));
        if edit.lost_focus() {
            let text = self.fields.select.clone();
            self.set_or_remove("select", text.trim());
        }
        ui.horizontal(|ui| {
            self.switch(ui, "bonds", "bonds");
            self.switch(ui, "box", "box");
        });
    }

    fn file_section(&mut self, ui: &mut egui::Ui) {
        row(ui, "file", |ui| {
            ui.add(egui::TextEdit::singleline(&mut self.state.output).desired_width(150.0));
        });
        let mut is_own = self.state.size.is_some();
        let [width, height] = self.state.window;
        row(ui, "--size", |ui| {
            let mut changed = false;
            egui::ComboBox::from_id_salt("size")
                .selected_text(if is_own { "given" } else { "as the window" })
                .width(96.0)
                .show_ui(ui, |ui| {
                    changed |= ui.selectable_value(&mut is_own, false, "as the window").clicked();
                    changed |= ui.selectable_value(&mut is_own, true, "given").clicked();
                });
            if is_own {
                let (fields, range) = (&mut self.fields, 1..=32768);
                changed |=
                    ui.add(egui::DragValue::new(&mut fields.width).range(range.clone())).changed();
                ui.label("×");
                changed |= ui.add(egui::DragValue::new(&mut fields.height).range(range)).changed();
            } else {
                ui.label(RichText::new(format!("{width} × {height}")).weak());
            }
            if changed {
                self.state.size = is_own.then_some([self.fields.width, self.fields.height]);
            }
        });
        ui.horizontal(|ui| {
            let is_free = self.saving.is_none();
            let save = ui.add_enabled(is_free, egui::Button::new("Save PNG"));
            if save.on_hover_text("Renders as `pinhole render` does (Ctrl+S)").clicked() {
                self.save(&ui.ctx().clone());
            }
            if let Some(saving) = &self.saving {
                ui.spinner();
                ui.label(format!("saving, {:.0} s", saving.started.elapsed().as_secs_f64()));
                ui.ctx().request_repaint_after(std::time::Duration::from_millis(250));
            }
        });
    }

    fn others_section(&mut self, ui: &mut egui::Ui) {
        let edit = egui::TextEdit::singleline(&mut self.fields.others);
        let edit = ui.add(edit.hint_text("--fov=20 --outline=2").desired_width(f32::INFINITY));
        if edit.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) {
            let text = std::mem::take(&mut self.fields.others);
            self.add_flags(&text);
        }
        ui.label(RichText::new("any flag of `pinhole render`, then Enter").small().weak());
    }

    /// Adds flags as they stand on a command line.
    fn add_flags(&mut self, text: &str) {
        let words = self.state.flags.words().into_iter();
        let added = text.split_whitespace().map(str::to_owned);
        match pinhole_cli::viewing::RenderFlags::parse(words.chain(added)) {
            Ok(mut flags) => {
                if let Some(size) = flags.get("size").and_then(crate::state::sides) {
                    (self.fields.width, self.fields.height) = (size[0], size[1]);
                    self.state.size = Some(size);
                    flags.remove("size");
                }
                self.change(|old| *old = flags);
            }
            Err(error) => {
                (self.error, self.fields.others) = (Some(error.to_string()), text.to_owned())
            }
        }
    }

    /// A row with the values of a flag. `own` is what holds without it.
    fn choice(&mut self, ui: &mut egui::Ui, flag: &str, own: &str, values: &[&str]) {
        row(ui, &format!("--{flag}"), |ui| {
            let given = self.state.flags.get(flag).map(str::to_owned);
            let shown = given.clone().unwrap_or_else(|| own.to_owned());
            let mut wanted = None;
            egui::ComboBox::from_id_salt(flag).selected_text(shown).show_ui(ui, |ui| {
                if ui
                    .selectable_label(given.is_none(), RichText::new("without the flag").weak())
                    .clicked()
                {
                    wanted = Some(String::new());
                }
                for value in values {
                    if ui.selectable_label(given.as_deref() == Some(value), *value).clicked() {
                        wanted = Some((*value).to_owned());
                    }
                }
            });
            if let Some(wanted) = wanted {
                self.set_or_remove(flag, &wanted);
            }
        });
    }

    /// A box for a flag that is there or not.
    fn switch(&mut self, ui: &mut egui::Ui, flag: &str, text: &str) {
        let given = self.state.flags.get(flag);
        let own =
            flag == "denoise" && self.news.as_ref().is_some_and(|news| news.settings.is_denoised);
        let mut is_on = given.map_or(own, |value| value != "false");
        if ui.checkbox(&mut is_on, text).on_hover_text(format!("--{flag}")).changed() {
            self.change(|flags| match (is_on, flag) {
                (true, "denoise") => flags.set(flag, "true"),
                (false, "denoise") => flags.set(flag, "false"),
                (true, _) => flags.set(flag, ""),
                (false, _) => flags.remove(flag),
            });
        }
    }

    /// A small button that removes a flag, if it is there.
    fn reset(&mut self, ui: &mut egui::Ui, flag: &str) {
        if self.state.flags.get(flag).is_some()
            && ui.small_button("×").on_hover_text(format!("Remove --{flag}")).clicked()
        {
            self.change(|flags| flags.remove(flag));
        }
    }

    /// Sets a flag, or removes it if there is no value.
    fn set_or_remove(&mut self, flag: &str, value: &str) {
        self.change(|flags| {
            if value.is_empty() {
                flags.remove(flag);
                // What says how a column becomes colors needs a column.
                if flag == "color-by" {
                    for of_column in [
                        "cmap",
                        "cmap-reverse",
                        "range",
                        "log",
                        "missing-color",
                        "legend",
                        "legend-title",
                    ] {
                        flags.remove(of_column);
                    }
                }
            } else {
                flags.set(flag, value);
            }
        });
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
                                let only = ui
                                    .small_button("only")
                                    .on_hover_text(format!("--select '{expression}'"));
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
        let Some(line) = self.news.as_ref().and_then(|news| news.time_line.clone()) else { return };
        ui.horizontal(|ui| {
            let (text, hint) = if self.player.plays { ("⏸", "Pause") } else { ("▶", "Play") };
            let button = egui::Button::new(text).min_size(egui::vec2(30.0, 0.0));
            if ui.add(button).on_hover_text(format!("{hint} (space)")).clicked() {
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
            if copy
                .on_hover_text("The command that renders this picture, to the byte (Ctrl+C)")
                .clicked()
            {
                self.copy(&ui.ctx().clone());
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(RichText::new(self.status()).weak());
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let command = RichText::new(self.state.command()).monospace().small();
                    ui.add(egui::Label::new(command).truncate().selectable(true));
                });
            });
        });
    }

    /// What the window is doing, or has done.
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

    /// What lies over the picture: errors, and that a file is read.
    pub(crate) fn overlay(&mut self, ui: &mut egui::Ui, rect: egui::Rect) {
        let is_long = |since: &std::time::Instant| since.elapsed().as_millis() > 250;
        if self.busy.as_ref().is_some_and(is_long) {
            let what = match (&self.news, self.state.flags.get("frame")) {
                (Some(_), Some(frame)) if self.player.plays => format!("reading frame {frame} …"),
                _ => format!("loading {} …", self.state.flags.path()),
            };
            let middle =
                egui::Area::new(egui::Id::unique("loading")).order(egui::Order::Foreground);
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
        area.fixed_pos(rect.left_bottom() + egui::vec2(14.0, -14.0))
            .pivot(egui::Align2::LEFT_BOTTOM)
            .show(ui.ctx(), |ui| {
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
            });
    }
}

/// A part of the controls, with a title.
fn section(ui: &mut egui::Ui, title: &str, contents: impl FnOnce(&mut egui::Ui)) {
    let title = RichText::new(title).strong();
    egui::CollapsingHeader::new(title).default_open(true).show_unindented(ui, contents);
}

/// A row with a name on the left.
fn row(ui: &mut egui::Ui, name: &str, contents: impl FnOnce(&mut egui::Ui)) {
    ui.horizontal(|ui| {
        let label = egui::Label::new(RichText::new(name).monospace().small());
        ui.add_sized([88.0, 18.0], label);
        contents(ui);
    });
}

/// An expression that selects some of the spheres.
fn example(columns: &[Column]) -> String {
    let text = columns.iter().find_map(|column| match &column.values {
        ColumnValues::Labels(labels) => {
            Some(format!("{} == {}", column.name, labels.names.first()?))
        }
        _ => None,
    });
    text.unwrap_or_else(|| "z > 0 and radius < 2".to_owned())
}

/// Writes a number with a comma before each group of three digits.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
