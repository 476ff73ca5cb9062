//! Tests of spheres among the triangles of a host program.
#![allow(clippy::float_cmp, reason = "depths to which a host clears are exact")]

mod blended;
mod depth;
mod limit;
mod lit;
mod live;
mod overlay;
mod stage;
mod triangle;

use libtest_mimic::Trial;
use pinhole::camera::{Camera, HostCamera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::glam::DVec3;
use pinhole::gpu::{Headless, Wait};
use pinhole::{Film, LayerSet, LinearRgb, Scene, Shading};

use crate::support::hosts::{Convention, changes, view};
use crate::support::{shaded, spheres};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    let own = vec![
        trial("host::same_picture::as_our_own_cameras", as_our_own),
        trial("host::same_picture::legal_where_there_is_no_camera_of_our_own", legal),
    ];
    [
        own,
        depth::trials(),
        overlay::trials(),
        triangle::trials(),
        limit::trials(),
        blended::trials(),
        lit::trials(),
        live::trials(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn scene() -> Scene {
    Scene::from_f32(spheres::random(600, 8, |_| 0.05), LinearRgb::WHITE).unwrap()
}

fn random_pose(random: &mut fastrand::Rng) -> Pose {
    let mut any = || 2.0 * random.f64() - 1.0;
    let toward = DVec3::new(any(), any(), any());
    let toward = toward / toward.length();
    let up = DVec3::new(any(), any(), any());
    Pose::looking_at(DVec3::splat(0.5) - 2.5 * toward, DVec3::splat(0.5), up).unwrap()
}

/// Tests that all layers have the same bits.
fn as_our_own(headless: &'static Headless) {
    let (scene, film) = (scene(), Film::new(61, 43).unwrap());
    let settings = shaded(Shading::Headlight, LinearRgb::BLACK);
    let mut random = fastrand::Rng::with_seed(6);
    for case in 0..24 {
        let pose = random_pose(&mut random);
        let convention = Convention::ALL[case % 6];
        let size = if convention.is_orthographic() { 0.8 } else { 0.35 };
        let half = [size * film.aspect(), size];
        let edges = [-half[0], half[0], -half[1], half[1]];
        let own: Box<dyn Camera> = if convention.is_orthographic() {
            Box::new(OrthographicCamera::new(pose, half).unwrap())
        } else {
            Box::new(PinholeCamera::new(pose, 1.0, half).unwrap())
        };
        let near = if convention.is_orthographic() { 0.0 } else { 0.1 };
        let into = if case % 4 < 2 { 1.0 } else { -1.0 };
        let projection = convention.projection(edges, [near, 9.0], into);
        let host = HostCamera::new(view(&pose, into), projection, convention.order()).unwrap();
        let [a, b] = [own.as_ref(), &host].map(|camera| {
            let seen = pinhole::View::new(camera, film);
            headless.render(&scene, &seen, &settings, LayerSet::ALL).wait().unwrap()
        });
        let hits = a.id().unwrap().iter().filter(|id| **id != u32::MAX).count();
        assert!(hits > 300, "{hits}");
        assert!(a == b, "case {case}, {convention:?}");
    }
}

/// The checker accepts the kernels' results for vectors that are not at right angles, and the reference agrees.
fn legal(headless: &'static Headless) {
    let (scene, film) = (scene(), Film::new(61, 43).unwrap());
    let settings = shaded(Shading::Headlight, LinearRgb::BLACK);
    let mut random = fastrand::Rng::with_seed(7);
    for (case, change) in changes().into_iter().enumerate() {
        for (i, convention) in Convention::ALL.into_iter().enumerate() {
            let pose = random_pose(&mut random);
            let size = if convention.is_orthographic() { 0.8 } else { 0.35 };
            let edges = [-0.6, 1.0, -1.2, 0.8].map(|edge| size * edge);
            let into = if i % 2 == 0 { 1.0 } else { -1.0 };
            let projection = convention.projection(edges, [0.1, 9.0], into);
            let to_view = view(&pose, into) * change;
            // Matrices in f32, as most hosts have them.
            let (to_view, projection) = (to_view.as_mat4(), projection.as_mat4());
            let camera = HostCamera::new(to_view, projection, convention.order()).unwrap();
            let seen = pinhole::View::new(&camera, film);
            let certificate = headless.verify(&scene, &seen, &settings).wait().unwrap();
            assert!(certificate.is_legal(), "{case}, {convention:?}: {certificate}");
            let picture = headless.render(&scene, &seen, &settings, LayerSet::ALL).wait().unwrap();
            let reference = pinhole::cpu::render(&scene, &seen, &settings, LayerSet::ALL).unwrap();
            let pairs = picture.id().unwrap().iter().zip(reference.id().unwrap());
            let different = pairs.filter(|(a, b)| a != b).count();
            assert!(different <= 3, "{case}, {convention:?}: {different} pixels differ");
        }
    }
}
