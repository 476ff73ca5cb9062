//! Parts of a film have on a device the pixels of the whole, to the bit.

use libtest_mimic::Trial;
use pinhole::camera::PinholeCamera;
use pinhole::gpu::{GpuError, Headless};
use pinhole::render::{Integrator, Outline, Sampling};
use pinhole::{Film, Image, LayerSet, LinearRgb, RenderSettings, Scene, Sphere, View};

use crate::light::scenes;
use crate::support;
use crate::{headless, trial};

pub(crate) fn trials() -> Vec<Trial> {
    let lit = scenes::all().into_iter().map(|(name, view)| {
        Trial::test(format!("film_parts::{name}"), move || {
            let mut settings = RenderSettings {
                sampling: Sampling { samples: 5, ..view.settings.sampling },
                is_denoised: true,
                ..view.settings.clone()
            };
            if let Integrator::Studio(studio) = &mut settings.integrator {
                studio.outline = Some(Outline::thin());
            }
            check(headless()?, &view.scene, &view.seen(), &settings);
            check(headless()?, &view.scene, &view.seen(), &settings.by_primary_rays());
            Ok(())
        })
    });
    let others = [
        trial("film_parts::a_scene_that_fills_no_part", beside),
        trial("film_parts::what_needs_the_whole_film_refuses_parts", refused),
    ];
    lit.chain(others).collect()
}

/// Compares the whole with parts that are no multiples of workgroups.
fn check(device: &Headless, scene: &Scene, view: &View<'_>, settings: &RenderSettings) {
    let wanted = LayerSet::ALL;
    let whole = device.render(scene, view, settings, wanted).unwrap();
    let (unfinished, layers) = (settings.unfinished(), settings.layers_for(wanted));
    let [width, height] = [whole.width(), whole.height()];
    let mut joined = Image::new(width, height, layers).unwrap();
    let (left, top) = (width / 3 + 1, height / 2 + 1);
    for (x, w) in [(0, left), (left, width - left)] {
        for (y, h) in [(0, top), (top, height - top)] {
            let film = view.film.part([x, y], [w, h]).unwrap();
            let part = View::new(view.camera, film);
            let part = device.render(scene, &part, &unfinished, layers).unwrap();
            joined.put(&part, [x, y]).unwrap();
        }
    }
    let joined = device.finish(joined, settings, wanted).unwrap();
    assert!(joined.to_le_bytes() == whole.to_le_bytes());
}

/// Small spheres in a corner, so that most parts show nothing.
fn beside(device: &'static Headless) {
    let view = support::View::from_toml(
        "[film]\nwidth = 90\nheight = 50\n[camera.pinhole]\neye = [0, 0, 9]\ndirection = [0, 0, -1]\n\
         vertical_fov = 50\n[[spheres]]\ncenter = [6, 3, 0]\nradius = 0.6\n[[spheres]]\ncenter = [5, 3, 1]\nradius = 0.1\n",
    );
    check(device, &view.scene, &view.seen(), &view.settings);
    check(device, &view.scene, &view.seen(), &RenderSettings::studio());
}

fn refused(device: &'static Headless) {
    let scene = Scene::new(&[Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE)]).unwrap();
    let film = Film::new(40, 30).unwrap();
    let camera = PinholeCamera::framing_from_the_front(scene.subject(), film.aspect()).unwrap();
    let view = View::new(&camera, film.part([8, 0], [16, 16]).unwrap());
    let refused = device.verify(&scene, &view, &RenderSettings::default());
    assert_eq!(refused.unwrap_err(), GpuError::PartOfFilm);
}
