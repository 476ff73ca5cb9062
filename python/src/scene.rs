//! Makes a scene from spheres and the settings about data in a scene file.

use crate::fault::{Fault, Outcome};
use crate::look::SceneText;
use pinhole::scene::material::SurfaceProperties;
use pinhole::{Appearance, Colors, LinearRgb, Scene};
use pinhole_data::load::Dataset;
use pinhole_figure::color_by::{ColorBy, ColorKey, JoinedKeys};
use pinhole_figure::scene_file::{DEFAULT_COLOR, Data, SceneFile};

/// A scene, with facts about its spheres.
pub(crate) struct DataScene {
    pub(crate) scene: Scene,
    /// The meaning of colours, if a column gives them.
    pub(crate) key: Option<ColorKey>,
    pub(crate) notes: Vec<String>,
}

/// Facts about data in addition to the loaded data.
#[derive(Default)]
pub(crate) struct DataExtras {
    /// The colours of spheres that have bytes for colours, if nothing else gives colours.
    pub(crate) colors: Option<Vec<[u8; 4]>>,
    /// Whether the caller gave radii, so that bonds do not change them.
    pub(crate) radii: bool,
    /// The meaning of colours in all frames, if the data is one of several frames.
    pub(crate) keys: Option<JoinedKeys>,
}

/// Makes a scene from data.
pub(crate) fn scene_of(loaded: Dataset, text: &SceneText, given: DataExtras) -> Outcome<DataScene> {
    let file = text.parse()?;
    let mut data = file.data().cloned().unwrap_or_else(|| Data::of_file(""));
    if data.color.is_some() && loaded.colors.is_some() {
        return Err(Fault::Input(
            "color applies only to data without colors; use color_by, or elements={...}".to_owned(),
        ));
    }
    let mut by_kind = None;
    if given.colors.is_none() && data.color.is_none() && data.mapping.color.is_none() {
        by_kind = ColorBy::of_kinds(&loaded);
        data.mapping.color.clone_from(&by_kind);
    }
    if let (Some(keys), Some(by)) = (&given.keys, &mut data.mapping.color) {
        keys.apply_to(by);
    }
    data.additions.keeps_radii = given.radii;
    let mut made = match is_plain(&data) {
        true => dressed(loaded, &data, given.colors)?,
        false => applied(loaded, &file, &data, text)?,
    };
    made.notes.extend(by_kind.map(|by| {
        let column = &by.column;
        format!(
            "there are no colors; the spheres are colored by {column}; color=... gives all one color"
        )
    }));
    Ok(made)
}

/// Makes a scene as the program does for a data file with flags.
fn dressed(mut loaded: Dataset, data: &Data, colors: Option<Vec<[u8; 4]>>) -> Outcome<DataScene> {
    let kept = data.select.as_ref().map(|select| select.apply(&mut loaded)).transpose();
    let kept = kept.map_err(|error| Fault::Input(format!("select: {error}")))?;
    loaded.correct_notes(data.mapping.color.is_some(), data.mapping.radius.is_some(), |_| false);
    let mut notes = std::mem::take(&mut loaded.notes);
    notes.extend(kept.iter().flat_map(|kept| kept.notes.clone()));
    if let Some(colors) = colors.filter(|_| data.mapping.is_empty() && is_simple(data)) {
        // Such colours need no list of distinct colours, which takes long to make.
        let appearance = Appearance::new(Colors::Rgba8(colors));
        let scene = Scene::from_parts(loaded.spheres, appearance).map_err(Fault::input)?;
        return Ok(DataScene { scene, key: None, notes });
    }
    let color = data.color.unwrap_or(LinearRgb::from_srgb8(DEFAULT_COLOR));
    let made = data.mapping.scene_with(loaded, color, &data.additions);
    let (scene, mapped, added) = made.map_err(Fault::input)?;
    notes.extend_from_slice(mapped.notes());
    notes.extend_from_slice(added.notes());
    Ok(DataScene { scene, key: mapped.key().cloned(), notes })
}

/// Makes a scene as the program does for a scene file with data.
fn applied(loaded: Dataset, file: &SceneFile, data: &Data, text: &SceneText) -> Outcome<DataScene> {
    let color = data.color.unwrap_or(LinearRgb::from_srgb8(DEFAULT_COLOR));
    let applied = data.apply(loaded).map_err(Fault::input)?;
    let scene = file.scene_of(applied.spheres, color);
    let scene = scene.map_err(|error| text.fault(&error))?.with_added(applied.added.len());
    Ok(DataScene { scene, key: applied.color_key, notes: applied.notes })
}

/// Whether the keys about the data could also be given by flags of the program.
fn is_plain(data: &Data) -> bool {
    data.surface == SurfaceProperties::default()
        && data.elements.is_empty()
        && data.elements_by.is_empty()
        && data.leave_out.is_empty()
        && data.radius_scale.to_bits() == 1.0_f64.to_bits()
}

/// Whether nothing is selected or added.
fn is_simple(data: &Data) -> bool {
    data.select.is_none() && data.additions.is_empty()
}
