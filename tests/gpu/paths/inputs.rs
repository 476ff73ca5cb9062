//! Faults of the inputs of a device, or of the recorded inputs.

use pinhole::glam::DVec3;
use pinhole::light::LightKind;
use pinhole::scene::material::Material;
use pinhole::verify::PathRecording;
use pinhole::{LinearRgb, Scene, Sphere};

use super::scenes;
use crate::light::scenes::LitView;

/// The time at which an input is changed.
#[derive(Clone, Copy)]
pub(crate) enum Spoil {
    /// Before the device renders the scene.
    Given(fn(&mut LitView)),
    /// After the recording.
    Said(fn(&mut PathRecording)),
}

/// A scene with all kinds of inputs that can be changed.
pub(crate) fn view() -> LitView {
    scenes::everything()
}

pub(crate) const ALL: &[(&str, Spoil)] = &[
    (
        "color_a_thousandth_off",
        Spoil::Given(|view| {
            on_spheres(view, |spheres| {
                let [r, g, b] = spheres[3].color.to_array();
                spheres[3].color = LinearRgb::new([r, g * 0.999, b]).unwrap();
            });
        }),
    ),
    (
        "opacity_off",
        Spoil::Given(|view| {
            on_spheres(view, |spheres| {
                spheres[6] = spheres[6].with_opacity(0.8);
            });
        }),
    ),
    (
        "roughness_a_thousandth_off",
        Spoil::Given(|view| {
            on_spheres(view, |spheres| {
                spheres[1] = spheres[1].with_material(Material::Conductor { roughness: 0.3003 });
            });
        }),
    ),
    (
        "emitter_a_thousandth_brighter",
        Spoil::Given(|view| {
            on_spheres(view, |spheres| {
                spheres[0] = spheres[0].with_material(Material::Emissive { strength: 1.001 });
            });
        }),
    ),
    ("two_spheres_swapped", Spoil::Given(|view| on_spheres(view, |spheres| spheres.swap(0, 3)))),
    (
        "light_moved",
        Spoil::Given(|view| {
            for light in &mut view.settings.lights {
                if let LightKind::Point { position, .. } = &mut light.kind {
                    *position += DVec3::new(1e-4, 0.0, 0.0);
                }
            }
        }),
    ),
    ("another_seed", Spoil::Given(|view| view.settings.sampling.seed += 1)),
    (
        "another_filter",
        Spoil::Given(|view| {
            view.settings.sampling.filter = pinhole::PixelFilter::Box;
        }),
    ),
    (
        "ground_moved",
        Spoil::Given(|view| {
            if let Some(ground) = &mut view.settings.ground {
                ground.point.y -= 1e-5;
            }
        }),
    ),
    ("sky_seen", Spoil::Given(|view| view.settings.sky.is_visible ^= true)),
    (
        "light_left_out",
        Spoil::Given(|view| {
            view.settings.lights.pop();
        }),
    ),
    (
        "another_number_of_sources",
        Spoil::Said(|recording| recording.given.lighting.source_count += 1),
    ),
    (
        "energy_of_a_lobe",
        Spoil::Said(|recording| {
            let last = recording.given.tables.len() - 3;
            recording.given.tables[last][1] ^= 1;
        }),
    ),
    (
        "opacity_of_a_material",
        Spoil::Said(|recording| {
            let at = recording.given.lighting.material_first as usize + 2 * 3 + 1;
            recording.given.tables[at][3] ^= 1 << 3;
        }),
    ),
    (
        "emitter_more_likely",
        Spoil::Said(|recording| {
            recording.given.emitters[1][1] += 1 << 20;
        }),
    ),
    (
        "one_surface_less",
        Spoil::Said(|recording| {
            recording.samples[0].surfaces.pop();
        }),
    ),
    ("a_sample_of_another_number", Spoil::Said(|recording| recording.samples[0].sample = 5)),
    (
        "a_pixel_less",
        Spoil::Said(|recording| {
            recording.samples[1].start.pop();
        }),
    ),
    (
        "a_bit_of_a_sum",
        Spoil::Said(|recording| {
            recording.samples[1].film.after[777][0][0] ^= 1 << 3;
        }),
    ),
    (
        "a_bit_of_an_ended_path",
        Spoil::Said(|recording| {
            let surfaces = &mut recording.samples[0].surfaces;
            let last = surfaces.len() - 1;
            surfaces[last].scattered[0].slots[4][1] ^= 1;
        }),
    ),
    ("a_camera_elsewhere", Spoil::Said(|recording| recording.given.uploaded.origin[1] += 1e-5)),
];

fn on_spheres(view: &mut LitView, change: impl FnOnce(&mut Vec<Sphere>)) {
    let mut spheres = scenes::mixed();
    change(&mut spheres);
    view.scene = Scene::new(&spheres).unwrap();
}
