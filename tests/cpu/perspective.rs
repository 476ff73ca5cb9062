//! Three properties that a perspective picture must have, and a parallel one must not.

use glam::{DVec2, DVec3};
use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::image::NO_ID;
use pinhole::{Film, LayerSet, LinearRgb, RenderSettings, Scene, Sphere, View, cpu, glam};

use crate::camera::project;

fn pose() -> Pose {
    Pose::looking_at([0.0, 0.0, 10.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap()
}

fn perspective() -> PinholeCamera {
    PinholeCamera::new(pose(), 1.0, [1.0, 1.0]).unwrap()
}

fn parallel() -> OrthographicCamera {
    OrthographicCamera::new(pose(), [5.0, 5.0]).unwrap()
}

/// How many pixels a sphere at depth z covers.
fn area(camera: &dyn Camera, z: f64) -> usize {
    let scene = Scene::new(&[Sphere::new([0.0, 0.0, z], 1.0, LinearRgb::WHITE)]).unwrap();
    let film = Film::new(200, 200).unwrap();
    let image =
        cpu::render(&scene, &View::new(camera, film), &RenderSettings::default(), LayerSet::DATA)
            .unwrap();
    image.id().unwrap().iter().filter(|id| **id != NO_ID).count()
}

#[test]
fn things_shrink_with_distance() {
    let depths = [5.0, 0.0, -10.0, -50.0];
    let areas = depths.map(|z| area(&perspective(), z));
    assert!(areas.is_sorted_by(|near, far| near > far), "{areas:?}");
    // Twice as far, a quarter of the area, but for pixels and the sphere's own depth.
    let ratio = areas[1] as f64 / areas[2] as f64;
    assert!((ratio - 4.0).abs() < 0.1, "{ratio}");

    let areas = depths.map(|z| area(&parallel(), z));
    assert!(areas.iter().all(|a| *a == areas[0] && *a > 0), "{areas:?}");
}

/// Picture points, from near to far, of a line through `start` along `direction`.
fn line(camera: &dyn Camera, start: DVec3, direction: DVec3) -> Vec<DVec2> {
    (0..40).map(|i| project(camera, start + direction * 1.5_f64.powi(i)).unwrap()).collect()
}

const STARTS: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, -1.0, 1.0], [-3.0, 2.0, -2.0]];

#[test]
fn parallel_lines_into_the_picture_meet_in_one_point() {
    let direction = DVec3::new(0.3, -0.2, -1.0);
    let vanishing_point = DVec2::new(0.3, -0.2);
    for start in STARTS {
        let end = *line(&perspective(), start.into(), direction).last().unwrap();
        assert!((end - vanishing_point).length() < 1e-5, "{end}");
    }
    // Seen in parallel, they keep their distance.
    let ends = STARTS.map(|start| *line(&parallel(), start.into(), direction).last().unwrap());
    let expected = DVec2::new(2.0, -1.0) / 5.0;
    assert!((ends[1] - ends[0] - expected).length() < 1e-5);
}

#[test]
fn parallel_lines_along_the_view_plane_stay_parallel() {
    let direction = DVec3::new(1.0, 0.4, 0.0);
    let cameras: [&dyn Camera; 2] = [&perspective(), &parallel()];
    for camera in cameras {
        for start in STARTS {
            let points = line(camera, start.into(), direction);
            for pair in points.windows(2) {
                let step = (pair[1] - pair[0]).normalize();
                assert!(step.perp_dot(DVec2::new(1.0, 0.4).normalize()).abs() < 1e-9);
            }
        }
    }
}

/// The projection that these tests use is the inverse of the rays.
#[test]
fn a_point_on_a_ray_is_seen_where_the_ray_comes_from() {
    let cameras: [&dyn Camera; 2] = [&perspective(), &parallel()];
    let mut random = fastrand::Rng::with_seed(11);
    for camera in cameras {
        for _ in 0..1000 {
            let location = DVec2::new(random.f64(), random.f64()) * 2.0 - 1.0;
            let point = camera.ray_in_world(location).at(random.f64() * 100.0 + 0.1);
            assert!((project(camera, point).unwrap() - location).length() < 1e-12);
        }
    }
}
