//! The controls. Each shows a flag of `pinhole render`, under its own name.

use eframe::egui::{self, Align, Layout, RichText};

use crate::app::App;
use crate::state::Fields;
use pinhole::render::Integrator;
use pinhole_data::load::{Column, ColumnValues};
use pinhole_figure::color_by::MapName;
use pinhole_figure::style::Style;

/// The columns that all spheres have.
const BUILT_IN: [&str; 5] = ["index", "radius", "x", "y", "z"];

impl App {
    pub(crate) fn view_section(&mut self, ui: &mut egui::Ui) {
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
                    let [direction, up] = ["direction", "up"].map(|name| flags.get(name).map(str::to_owned));
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
                .size(11.0)
                .weak(),
        );
    }

    pub(crate) fn style_section(&mut self, ui: &mut egui::Ui) {
        let own = self.news.as_ref().and_then(|news| news.facts.style).unwrap_or("of the file");
        let styles: Vec<&str> = Style::ALL.iter().map(|style| style.name()).collect();
        self.choice(ui, "style", own, &styles);
        let integrator = self.news.as_ref().map(|news| match news.facts.settings.integrator {
            Integrator::Primary(_) => "primary",
            Integrator::Path(_) => "path",
            _ => "studio",
        });
        self.choice(ui, "integrator", integrator.unwrap_or("studio"), &["primary", "studio", "path"]);
        row(ui, "--samples", |ui| {
            let own = self.news.as_ref().map_or(1, |news| news.facts.settings.sampling.samples);
            let given = self.state.flags.get("samples").and_then(|text| text.parse().ok());
            let mut samples: u32 = given.unwrap_or(own);
            let drag = egui::DragValue::new(&mut samples).range(1..=65536).speed(0.2);
            if ui.add(drag).changed() {
                self.change(|flags| flags.set("samples", &samples.to_string()));
            }
            self.reset(ui, "samples");
        });
        self.typed(ui, "background", "white, #f3f4f6 …", |fields| &mut fields.background);
        ui.horizontal(|ui| {
            self.switch(ui, "transparent", "transparent");
            self.switch(ui, "scale-bar", "scale bar");
            self.switch(ui, "denoise", "denoise");
        });
    }

    pub(crate) fn color_section(&mut self, ui: &mut egui::Ui) {
        let Some(news) = &self.news else { return };
        let own = news.facts.own_color_by.clone();
        let mut columns: Vec<String> = news.facts.columns.iter().map(|column| column.name.clone()).collect();
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
        self.typed(ui, "range", "LO,HI or 2%,98%", |fields| &mut fields.range);
        ui.horizontal(|ui| {
            self.switch(ui, "legend", "legend");
            self.switch(ui, "cmap-reverse", "reverse");
            self.switch(ui, "log", "logarithm");
        });
    }

    pub(crate) fn structure_section(&mut self, ui: &mut egui::Ui) {
        ui.label(RichText::new("--select").monospace().size(11.0));
        let hint = self.news.as_ref().map_or_else(String::new, |news| example(&news.facts.columns));
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

    pub(crate) fn file_section(&mut self, ui: &mut egui::Ui) {
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
                changed |= ui.add(egui::DragValue::new(&mut fields.width).range(range.clone())).changed();
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
            if self.saving.is_none() && std::path::Path::new(&self.state.output).exists() {
                ui.label(RichText::new("replaces the file that is there").size(11.0).weak());
            }
            if let Some(saving) = &self.saving {
                ui.spinner();
                ui.label(format!("saving, {:.0} s", saving.started.elapsed().as_secs_f64()));
                ui.ctx().request_repaint_after(std::time::Duration::from_millis(250));
            }
        });
    }

    pub(crate) fn others_section(&mut self, ui: &mut egui::Ui) {
        let edit = egui::TextEdit::singleline(&mut self.fields.others);
        let edit = ui.add(edit.hint_text("--fov=20 --outline=2").desired_width(f32::INFINITY));
        if edit.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) {
            let text = std::mem::take(&mut self.fields.others);
            self.add_flags(&text);
        }
        ui.label(RichText::new("any flag of `pinhole render`, then Enter").size(11.0).weak());
    }

    /// Adds flags, written as on a command line.
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
                (self.error, self.fields.others) = (Some(error.to_string()), text.to_owned());
            }
        }
    }

    /// A row with the values of a flag. `own` is the label for the default.
    fn choice(&mut self, ui: &mut egui::Ui, flag: &str, own: &str, values: &[&str]) {
        row(ui, &format!("--{flag}"), |ui| {
            let given = self.state.flags.get(flag).map(str::to_owned);
            let shown = given.clone().unwrap_or_else(|| own.to_owned());
            let mut wanted = None;
            egui::ComboBox::from_id_salt(flag).selected_text(shown).show_ui(ui, |ui| {
                if ui.selectable_label(given.is_none(), RichText::new("without the flag").weak()).clicked() {
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

    /// A row with a text field for the value of a flag.
    fn typed(&mut self, ui: &mut egui::Ui, flag: &str, hint: &str, field: fn(&mut Fields) -> &mut String) {
        row(ui, &format!("--{flag}"), |ui| {
            let edit = egui::TextEdit::singleline(field(&mut self.fields)).hint_text(hint);
            if ui.add(edit.desired_width(120.0)).lost_focus() {
                let text = field(&mut self.fields).clone();
                self.set_or_remove(flag, &text);
            }
        });
    }

    /// A check box for a flag without a value.
    fn switch(&mut self, ui: &mut egui::Ui, flag: &str, text: &str) {
        let given = self.state.flags.get(flag);
        let own = flag == "denoise" && self.news.as_ref().is_some_and(|news| news.facts.settings.sampling.denoise);
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

    /// A small button that removes a flag, if it is set.
    fn reset(&mut self, ui: &mut egui::Ui, flag: &str) {
        if self.state.flags.get(flag).is_some()
            && ui.small_button("×").on_hover_text(format!("Remove --{flag}")).clicked()
        {
            self.change(|flags| flags.remove(flag));
        }
    }

    /// Sets a flag, or removes it if there is no value.
    pub(crate) fn set_or_remove(&mut self, flag: &str, value: &str) {
        self.change(|flags| {
            if value.is_empty() {
                flags.remove(flag);
                // Flags that turn a column into colours need a column.
                if flag == "color-by" {
                    let of_map = ["cmap", "cmap-reverse", "range", "log", "missing-color"];
                    let of_legend = ["legend", "legend-title"];
                    of_map.iter().chain(&of_legend).for_each(|flag| flags.remove(flag));
                }
            } else {
                flags.set(flag, value);
            }
        });
    }
}

/// A row with a name at the left.
fn row(ui: &mut egui::Ui, name: &str, contents: impl FnOnce(&mut egui::Ui)) {
    ui.horizontal(|ui| {
        let label = egui::Label::new(RichText::new(name).monospace().size(11.0));
        ui.allocate_ui_with_layout([92.0, 20.0].into(), Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(92.0);
            ui.add(label);
        });
        contents(ui);
    });
}

/// An example of an expression that selects some spheres.
fn example(columns: &[Column]) -> String {
    let text = columns.iter().find_map(|column| match &column.values {
        ColumnValues::Labels(labels) => Some(format!("{} == {}", column.name, labels.names.first()?)),
        _ => None,
    });
    text.unwrap_or_else(|| "z > 0 and radius < 2".to_owned())
}
