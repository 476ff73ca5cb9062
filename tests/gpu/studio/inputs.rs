//! Faults of the inputs of a device, or of what it recorded.

use pinhole::LinearRgb;
use pinhole::light::LightKind;
use pinhole::render::{Integrator, Studio};
use pinhole::verify::StudioRecording;

use super::scenes;
use crate::light::scenes::LitView;

/// The time at which an input is changed.
#[derive(Clone, Copy)]
pub(crate) enum Spoil {
    /// Before the device renders the scene.
    Given(fn(&mut LitView)),
    /// After the recording.
    Said(fn(&mut StudioRecording)),
}

pub(crate) fn view() -> LitView {
    scenes::translucent()
}

fn studio(view: &mut LitView) -> &mut Studio {
    match &mut view.settings.integrator {
        Integrator::Studio(studio) => studio,
        _ => panic!("no studio"),
    }
}

pub(crate) const ALL: &[(&str, Spoil)] = &[
    (
        "ambient_light_a_thousandth_brighter",
        Spoil::Given(|view| studio(view).ambient = LinearRgb::new([0.25025; 3]).unwrap()),
    ),
    ("no_shadows", Spoil::Given(|view| studio(view).has_shadows = false)),
    ("a_surface_less", Spoil::Given(|view| studio(view).max_surfaces -= 1)),
    (
        "fog_a_thousandth_nearer",
        Spoil::Given(|view| {
            if let Some(cue) = &mut studio(view).depth_cue {
                cue.near *= 0.999;
            }
        }),
    ),
    (
        "another_radius_of_occlusion",
        Spoil::Given(|view| {
            if let Some(occlusion) = &mut studio(view).occlusion {
                occlusion.radius = Some(0.801);
            }
        }),
    ),
    (
        "light_moved",
        Spoil::Given(|view| {
            for light in &mut view.settings.lights {
                if let LightKind::Point { position, .. } = &mut light.kind {
                    position.x += 1e-4;
                }
            }
        }),
    ),
    (
        "a_catcher_for_a_ground",
        Spoil::Given(|view| {
            if let Some(ground) = &mut view.settings.ground {
                ground.is_shadow_catcher = true;
            }
        }),
    ),
    ("another_seed", Spoil::Given(|view| view.settings.sampling.seed += 1)),
    (
        "box_of_the_occluders_too_small",
        Spoil::Said(|recording| recording.given.occluders[1][0] -= 0.05),
    ),
    ("a_sample_of_another_number", Spoil::Said(|recording| recording.samples[1].sample = 5)),
    (
        "a_hidden_light",
        Spoil::Said(|recording| {
            recording.samples[2].surfaces[0].lights[0].hidden[900] ^= 1;
        }),
    ),
    (
        "a_bit_of_the_radiance",
        Spoil::Said(|recording| {
            recording.samples[0].surfaces[0].lights[0].radiance[900][1] ^= 1 << 4;
        }),
    ),
    (
        "a_bit_of_a_sum",
        Spoil::Said(|recording| recording.samples[2].film.after[900][0][2] ^= 1 << 3),
    ),
    (
        "a_bit_of_the_rest_of_a_sum",
        Spoil::Said(|recording| recording.samples[2].film.after[900][1][2] ^= 1 << 30),
    ),
    (
        "a_film_that_was_cleared",
        Spoil::Said(|recording| {
            let film = &mut recording.samples[1].film;
            film.before.iter_mut().for_each(|sums| *sums = [[0; 4]; 3]);
        }),
    ),
    (
        "a_surface_that_is_missing",
        Spoil::Said(|recording| {
            recording.samples[0].surfaces.pop();
        }),
    ),
    (
        "a_pixel_less",
        Spoil::Said(|recording| {
            recording.samples[1].surfaces[0].ambient[0].left.pop();
        }),
    ),
];
