//! The look of the window.

use eframe::egui::{self, Color32};

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

/// The color beside a picture that does not fill its part of the window.
pub(crate) const BESIDE: Color32 = Color32::from_rgb(214, 216, 220);
