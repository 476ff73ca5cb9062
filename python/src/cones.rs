//! Scenes of cylinders and cones, and scenes joined from several.

use numpy::ndarray::ArrayView2;

use crate::fault::{Fault, Outcome};
use crate::look::SceneText;
use pinhole::glam::DVec3;
use pinhole::internals::ConeInFrame;
use pinhole::scene::Appearance;
use pinhole::scene::cone::{Caps, Cone};
use pinhole::{LinearRgb, Scene, SphereArray};
use pinhole_figure::scene_file::{DEFAULT_COLOR, Data, OwnCones, OwnShapes};

/// The closed ends with this name, as in scene files.
pub(crate) fn caps_of_name(name: &str) -> Outcome<Caps> {
    match name {
        "none" => Ok(Caps::None),
        "first" => Ok(Caps::First),
        "second" => Ok(Caps::Second),
        "both" => Ok(Caps::Both),
        _ => Err(Fault::Internal(format!("there are no caps {name}"))),
    }
}

/// Makes cones of their starts, ends and pairs of radii, arrays whose shapes Python has checked.
pub(crate) fn cones([start, end, radii]: [ArrayView2<'_, f64>; 3], caps: Caps) -> Vec<Cone> {
    let place = |array: &ArrayView2<'_, f64>, row: usize| [0, 1, 2].map(|axis| array[[row, axis]]);
    let radii = |row: usize| [radii[[row, 0]], radii[[row, 1]]];
    let cone = |row: usize| Cone::new(place(&start, row), place(&end, row), radii(row)).with_caps(caps);
    (0..start.nrows()).map(cone).collect()
}

/// A scene of cones with the look that the text gives to data.
pub(crate) fn scene_of_cones(
    cones: Vec<Cone>,
    colors: Option<Vec<LinearRgb>>,
    is_round: bool,
    text: &SceneText,
) -> Outcome<Scene> {
    let data = text.parse()?.data().cloned().unwrap_or_else(|| Data::of_file(""));
    for (index, cone) in cones.iter().enumerate() {
        cone.check().map_err(|error| Fault::Input(format!("shape {index}: {error}")))?;
    }
    let color = data.color.unwrap_or(LinearRgb::from_srgb8(DEFAULT_COLOR));
    let mut own = OwnCones::new(cones, colors.unwrap_or_else(|| vec![color]), data.surface);
    if is_round {
        own = own.rounded().map_err(|(index, error)| Fault::Input(format!("shape {index}: {error}")))?;
    }
    OwnShapes { spheres: Vec::new(), cones: vec![own] }.scene().map_err(Fault::input)
}

/// A scene of the shapes of both: spheres, those that were added to data, and then cones.
pub(crate) fn joined(scenes: [&Scene; 2]) -> Outcome<Scene> {
    let mut spheres = Vec::new();
    let mut looks = Vec::new();
    let mut cones = Vec::new();
    let look = |scene: &Scene, id: usize| (scene.color(id as u32), scene.surface(id as u32));
    for is_added in [false, true] {
        for scene in scenes {
            let of_data = scene.len() - scene.added();
            let origin = scene.origin().to_array();
            let wanted = if is_added { of_data..scene.len() } else { 0..of_data };
            looks.extend(wanted.clone().map(|id| look(scene, id)));
            spheres.extend(scene.spheres()[wanted].iter().map(|sphere| {
                let [x, y, z, radius] = sphere.map(f64::from);
                [origin[0] + x, origin[1] + y, origin[2] + z, radius]
            }));
        }
    }
    for scene in scenes {
        cones.extend(scene.cones().iter().map(|cone| in_world(cone, scene.origin())));
        looks.extend((scene.len()..scene.shape_count()).map(|id| look(scene, id)));
    }
    let added = scenes.iter().map(|scene| scene.added()).sum();
    let scene = Scene::from_shapes(SphereArray::F64(spheres), &cones, Appearance::distinct(&looks));
    Ok(scene.map_err(Fault::input)?.with_added(added))
}

/// A cone of a scene's frame in world space.
fn in_world(cone: &ConeInFrame, origin: DVec3) -> Cone {
    let place = |place: [f32; 3]| (origin + DVec3::from(place.map(f64::from))).to_array();
    // Open ends have negative radii.
    let caps = match [cone.first_radius, cone.second_radius].map(f32::is_sign_negative) {
        [true, true] => Caps::None,
        [false, true] => Caps::First,
        [true, false] => Caps::Second,
        [false, false] => Caps::Both,
    };
    let radii = [cone.first_radius, cone.second_radius].map(|radius| f64::from(radius.abs()));
    Cone::new(place(cone.start), place(cone.end), radii).with_caps(caps)
}
