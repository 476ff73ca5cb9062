//! The choices of the program for a data file, which follow from the kind of data.

use crate::flags::settings::Given;
use pinhole::glam::DVec3;
use pinhole_data::kind::{Kind, Traits};
use pinhole_data::load::Dataset;
use pinhole_data::select::Selection;
use pinhole_figure::color_by::ColorBy;
use pinhole_figure::kind::KindSettings;
use pinhole_figure::settings::Layer;
use pinhole_figure::style::Style;

/// The flag that stands for settings of a kind.
pub(super) const KIND: &str = "--kind";

/// The choices for a data file that no flag made.
#[derive(Clone, Debug)]
pub(crate) struct Chosen {
    /// The settings of the kind.
    layer: Layer,
    /// The style, if it is not the usual one of data.
    pub(super) style: Option<Style>,
    /// The kind of the camera that its flags are about.
    camera: Option<String>,
    /// The direction that is up, if it is not the usual one.
    pub(crate) up: Option<DVec3>,
    /// The colours by kinds of spheres.
    pub(crate) colors: Option<ColorBy>,
    /// The name of the kind, if it decides anything.
    pub(super) name: Option<&'static str>,
    /// Notes for the user.
    pub(super) notes: Vec<String>,
}

impl Chosen {
    /// The layers of all settings, of which `flags` take precedence. Flags of a camera without a name are about the one that
    /// was chosen.
    pub(super) fn layers(&self, flags: &[Layer]) -> Vec<Layer> {
        let renamed = |layer: &Layer| match (&self.camera, layer.text.strip_prefix("camera.pinhole.")) {
            (Some(camera), Some(rest)) => Layer { flag: layer.flag, text: format!("camera.{camera}.{rest}") },
            _ => layer.clone(),
        };
        [self.layer.clone()].into_iter().chain(flags.iter().map(renamed)).collect()
    }

    /// The choices for data that was read with these flags, of which `select` keeps a part. In a movie spheres may move
    /// anywhere, so that all of them are framed.
    pub(crate) fn of(data: &Dataset, select: Option<&Selection>, given: &Given, is_movie: bool) -> Self {
        let named = given.get("kind").and_then(Kind::of_name);
        let mut traits = Traits::of(data, select, named);
        traits.bulk = traits.bulk.filter(|_| !is_movie);
        Self::of_traits(&traits, given)
    }

    /// The choices for data with these traits.
    pub(super) fn of_traits(traits: &Traits, given: &Given) -> Self {
        let settings = KindSettings::new(traits, given.get("camera"), |key| match key {
            // What is hidden or faint is so in what the kind draws.
            "show" => given.get("show").is_some(),
            key => given.has_key(key),
        });
        let text = settings.text();
        let name = (!text.is_empty()).then(|| traits.kind.name());
        let mut notes: Vec<String> =
            settings.notes.iter().map(|note| format!("{}; {}", note.what, note.remedies[0])).collect();
        let has_rules = ["show", "hide", "ghost"].iter().any(|flag| given.get(flag).is_some());
        let focus = given.get("focus").filter(|focus| *focus != "all" && !has_rules);
        if let (Kind::Biomolecule, Some(focus)) = (traits.kind, focus) {
            notes.push(format!("others may hide what is in focus; --ghost 'not ({focus})' draws them faintly"));
        }
        let (camera, up) = settings.view.map(|view| (view.camera, view.up)).unzip();
        Self { layer: Layer { flag: KIND, text }, style: settings.style, camera, up, colors: None, name, notes }
    }
}
