//! Tests that the plan of a picture matches the memory that is then allocated.

use libtest_mimic::Trial;
use pinhole::accel::AccelChoice;
use pinhole::camera::PinholeCamera;
use pinhole::generate::Kind;
use pinhole::gpu::Headless;
use pinhole::{Film, LayerSet, LinearRgb, RenderSettings, Scene, View};

use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![trial("plan::it_bounds_what_is_built", bounds)]
}

fn bounds(headless: &'static Headless) {
    let grey = LinearRgb::from_srgb8([128, 128, 128]);
    let film = Film::new(64, 48).unwrap();
    for kind in [Kind::Random, Kind::Clusters] {
        let scene = Scene::from_f32(kind.spheres(5000, 1).unwrap(), grey).unwrap();
        let camera =
            PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), film.aspect()).unwrap();
        let view = View::new(&camera, film);
        for choice in [AccelChoice::Grid, AccelChoice::Tree, AccelChoice::List] {
            let settings = RenderSettings::default();
            let plan = headless.plan(&scene, &view, &settings, LayerSet::DATA, choice, 0);
            let structures = plan.build(&scene);
            let buffers = headless.upload(&scene, &structures).unwrap();
            // The plan does not count the record of a brick, and the single appearance word.
            let small = 200 * structures.accel.bricks().len() as u64;
            let planned: u64 = plan.scene_buffers.iter().map(|buffer| buffer.bytes).sum();
            assert!(buffers.bytes() <= planned + small, "{kind:?}, {choice}");
            assert!(plan.check(&headless.device().limits(), None).is_ok());
        }
    }
}
