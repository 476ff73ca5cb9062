//! The choices of the program for a data file, which follow from the kind of data.

use crate::flags::settings::Given;
use pinhole_data::kind::{Kind, Traits};
use pinhole_data::load::Dataset;
use pinhole_data::select::Selection;
use pinhole_figure::color_by::ColorBy;
use pinhole_figure::kind::KindSettings;
use pinhole_figure::settings::Layer;

/// The flag that stands for settings of a kind.
pub(super) const KIND: &str = "--kind";

/// The choices for a data file that no flag made.
#[derive(Clone, Debug)]
pub(crate) struct Chosen {
    /// The settings of the kind.
    pub(super) layer: Layer,
    /// The colours by kinds of spheres.
    pub(crate) colors: Option<ColorBy>,
    /// The name of the kind, if it decides anything.
    pub(super) name: Option<&'static str>,
    /// Notes for the user.
    pub(super) notes: Vec<&'static str>,
}

impl Chosen {
    /// The choices for data that was read with these flags, of which `select` keeps a part. In a movie spheres may move
    /// anywhere, so that all of them are framed.
    pub(crate) fn of(data: &Dataset, select: Option<&Selection>, given: &Given, is_movie: bool) -> Self {
        let named = given.get("kind").and_then(Kind::of_name);
        if named == Some(Kind::Plain) {
            // Nothing follows, so large data need not be looked at.
            return Self {
                layer: Layer { flag: KIND, text: String::new() },
                colors: None,
                name: None,
                notes: Vec::new(),
            };
        }
        let mut traits = match select {
            None => Traits::of(data),
            Some(select) => {
                let mut part = data.clone();
                // An error shows when the scene is made.
                drop(select.apply(&mut part));
                Traits::of(&part)
            }
        };
        traits.bulk = traits.bulk.filter(|_| !is_movie);
        traits.kind = named.unwrap_or(traits.kind);
        let has_camera = given.get("camera").is_some() || given.has_key("camera");
        let camera = has_camera.then(|| given.get("camera").unwrap_or("pinhole"));
        let settings = match traits.kind {
            Kind::Plain => KindSettings::default(),
            _ => KindSettings::new(&traits, camera, |key| match key {
                // What is hidden or faint is so in what the kind draws.
                "show" => given.get("show").is_some(),
                key => given.has_key(key),
            }),
        };
        let name = (!settings.text.is_empty()).then(|| traits.kind.name());
        let KindSettings { text, notes, .. } = settings;
        Self { layer: Layer { flag: KIND, text }, colors: None, name, notes }
    }
}
