//! Faults of the inputs of a device, or of what it recorded.

use pinhole::light::{Ground, LightKind};
use pinhole::render::{Integrator, Studio};
use pinhole::scene::material::Material;
use pinhole::verify::{PathRecording, StudioRecording};
use pinhole::{LinearRgb, Scene, Sphere};

use crate::lit_scenes;
use crate::support::View;

#[derive(Clone, Copy)]
pub(crate) enum Change {
    /// Before the device renders the scene.
    View(fn(&mut View)),
    /// After the recording.
    Paths(fn(&mut PathRecording)),
    Studio(fn(&mut StudioRecording)),
}

/// The suite, the name and the change of a fault.
type Input = (&'static str, &'static str, Change);

fn given(suite: &'static str, name: &'static str, change: fn(&mut View)) -> Input {
    (suite, name, Change::View(change))
}

fn paths(name: &'static str, change: fn(&mut PathRecording)) -> Input {
    ("paths", name, Change::Paths(change))
}

fn studio(name: &'static str, change: fn(&mut StudioRecording)) -> Input {
    ("studio", name, Change::Studio(change))
}

/// A scene with all kinds of inputs that can be changed.
pub(crate) fn view(suite: &str) -> View {
    lit_scenes::view(suite, if suite == "paths" { "everything" } else { "translucent" })
}

fn on_spheres(view: &mut View, change: impl FnOnce(&mut [Sphere])) {
    let (mut spheres, _) = lit_scenes::read("paths", "everything");
    change(&mut spheres);
    view.scene = Scene::new(&spheres).unwrap();
}

fn in_studio(view: &mut View) -> &mut Studio {
    match &mut view.settings.integrator {
        Integrator::Studio(studio) => studio,
        _ => panic!("no studio"),
    }
}

/// Moves the lights at points.
fn move_lights(view: &mut View) {
    for light in &mut view.settings.lights {
        if let LightKind::Point { position, .. } = &mut light.kind {
            position.x += 1e-4;
        }
    }
}

fn ground(view: &mut View) -> &mut Ground {
    view.settings.ground.as_mut().unwrap()
}

pub(crate) fn all() -> Vec<Input> {
    vec![
        given("paths", "color_a_thousandth_off", |view| {
            on_spheres(view, |spheres| {
                let [r, g, b] = spheres[3].color.to_array();
                spheres[3].color = LinearRgb::new([r, g * 0.999, b]).unwrap();
            });
        }),
        given("paths", "opacity_off", |view| {
            on_spheres(view, |spheres| {
                spheres[6] = spheres[6].with_opacity(0.8);
            });
        }),
        given("paths", "roughness_a_thousandth_off", |view| {
            on_spheres(view, |spheres| {
                spheres[1] = spheres[1].with_material(Material::Conductor { roughness: 0.3003 });
            });
        }),
        given("paths", "emitter_a_thousandth_brighter", |view| {
            on_spheres(view, |spheres| {
                spheres[0] = spheres[0].with_material(Material::Emissive { strength: 1.001 });
            });
        }),
        given("paths", "two_spheres_swapped", |view| {
            on_spheres(view, |spheres| spheres.swap(0, 3));
        }),
        given("paths", "light_moved", move_lights),
        given("paths", "another_seed", |view| view.settings.sampling.seed += 1),
        given("paths", "another_filter", |view| {
            view.settings.sampling.filter = pinhole::PixelFilter::Box;
        }),
        given("paths", "ground_moved", |view| ground(view).point.y -= 1e-5),
        given("paths", "sky_seen", |view| view.settings.sky.is_visible ^= true),
        given("paths", "light_left_out", |view| {
            view.settings.lights.pop();
        }),
        paths("another_number_of_sources", |recording| recording.given.lighting.source_count += 1),
        paths("energy_of_a_lobe", |recording| {
            let last = recording.given.tables.len() - 3;
            recording.given.tables[last][1] ^= 1;
        }),
        paths("opacity_of_a_material", |recording| {
            let at = recording.given.lighting.material_first as usize + 2 * 3 + 1;
            recording.given.tables[at][3] ^= 1 << 3;
        }),
        paths("emitter_more_likely", |recording| recording.given.emitters[1][1] += 1 << 20),
        paths("one_surface_less", |recording| {
            recording.samples[0].surfaces.pop();
        }),
        paths("a_sample_of_another_number", |recording| recording.samples[0].sample = 5),
        paths("a_pixel_less", |recording| {
            recording.samples[1].start.pop();
        }),
        paths("a_bit_of_a_sum", |recording| recording.samples[1].film.after[777][0][0] ^= 1 << 3),
        paths("a_bit_of_an_ended_path", |recording| {
            let surfaces = &mut recording.samples[0].surfaces;
            let last = surfaces.len() - 1;
            surfaces[last].scattered[0].slots[4][1] ^= 1;
        }),
        paths("a_camera_elsewhere", |recording| recording.given.uploaded.origin[1] += 1e-5),
        given("studio", "ambient_light_a_thousandth_brighter", |view| {
            in_studio(view).ambient = LinearRgb::new([0.25025; 3]).unwrap();
        }),
        given("studio", "no_shadows", |view| in_studio(view).has_shadows = false),
        given("studio", "a_surface_less", |view| in_studio(view).max_surfaces -= 1),
        given("studio", "fog_a_thousandth_nearer", |view| {
            in_studio(view).depth_cue.as_mut().unwrap().near *= 0.999;
        }),
        given("studio", "another_radius_of_occlusion", |view| {
            in_studio(view).occlusion.as_mut().unwrap().radius = Some(0.801);
        }),
        given("studio", "light_moved", move_lights),
        given("studio", "a_catcher_for_a_ground", |view| ground(view).is_shadow_catcher = true),
        given("studio", "another_seed", |view| view.settings.sampling.seed += 1),
        studio("box_of_the_occluders_too_small", |recording| {
            recording.given.occluders[1][0] -= 0.05;
        }),
        studio("a_sample_of_another_number", |recording| recording.samples[1].sample = 5),
        studio("a_hidden_light", |recording| {
            recording.samples[2].surfaces[0].lights[0].hidden[900] ^= 1;
        }),
        studio("a_bit_of_the_radiance", |recording| {
            recording.samples[0].surfaces[0].lights[0].radiance[900][1] ^= 1 << 4;
        }),
        studio("a_bit_of_a_sum", |recording| recording.samples[2].film.after[900][0][2] ^= 1 << 3),
        studio("a_bit_of_the_rest_of_a_sum", |recording| {
            recording.samples[2].film.after[900][1][2] ^= 1 << 30;
        }),
        studio("a_film_that_was_cleared", |recording| {
            let film = &mut recording.samples[1].film;
            film.before.iter_mut().for_each(|sums| *sums = [[0; 4]; 3]);
        }),
        studio("a_surface_that_is_missing", |recording| {
            recording.samples[0].surfaces.pop();
        }),
        studio("a_pixel_less", |recording| {
            recording.samples[1].surfaces[0].ambient[0].left.pop();
        }),
    ]
}
