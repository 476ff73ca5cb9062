//! Makes scenes from spheres and the settings about data in a scene file.

use crate::fault::{Fault, Outcome};
use crate::look::SceneText;
use pinhole_data::kind::Traits;
use pinhole_data::load::Dataset;
use pinhole_figure::color_by::JoinedKeys;
use pinhole_figure::kind::KindSettings;
use pinhole_figure::scene_file::{Data, DataError, DataScene, OwnShapes};

/// Facts about data in addition to the loaded data.
#[derive(Default)]
pub(crate) struct DataExtras {
    /// The colours of spheres that have bytes for colours, and no settings.
    pub(crate) colors: Option<Vec<[u8; 4]>>,
    /// Whether the caller gave radii, so that bonds do not change them.
    pub(crate) radii: bool,
    /// The meaning of colours in all frames, if the data is one of several frames.
    pub(crate) keys: Option<JoinedKeys>,
    /// The traits of the first of these frames.
    pub(crate) traits: Option<Traits>,
    /// Returns true if the caller gave a colour to each sphere.
    pub(crate) is_colored: bool,
}

/// The settings that follow from the kind of data, with its traits.
pub(crate) fn kind_of(loaded: &Dataset, text: &SceneText, given: &DataExtras) -> Outcome<(Traits, KindSettings)> {
    let traits = match given.traits.clone() {
        Some(traits) => traits,
        None => {
            let file = text.parse()?;
            let select = file.data().and_then(|data| data.select.as_ref());
            Traits::of(loaded, select, text.kind())
        }
    };
    let settings = text.of_kind(&traits, |key| match key {
        "color" => given.is_colored,
        "radius" => given.radii,
        _ => false,
    });
    Ok((traits, settings))
}

/// Makes a scene from data.
pub(crate) fn scene_of(mut loaded: Dataset, text: &SceneText, given: DataExtras) -> Outcome<DataScene> {
    let file = text.parse()?;
    let mut data = file.data().cloned().unwrap_or_else(|| Data::of_file(""));
    if data.color.is_some() && loaded.colors.is_some() {
        return Err(Fault::Input(
            "color applies only to data without colors; use color_by, or elements={...}".to_owned(),
        ));
    }
    loaded.give_radius(data.radius);
    let kinds = data.color_by_kinds(&loaded, None);
    loaded.notes.extend(kinds.map(|by| by.note_of_kinds("color=...")));
    if let Some(keys) = &given.keys {
        data.mapping.color.iter_mut().for_each(|by| keys.apply_to(by));
        keys.apply_to_arrows(&mut data.additions);
    }
    data.additions.keeps_radii = given.radii;
    data.scene(loaded, &OwnShapes::default()).map_err(|error| match error {
        DataError::Select(error) => Fault::Input(format!("select: {error}")),
        error => Fault::input(error),
    })
}
