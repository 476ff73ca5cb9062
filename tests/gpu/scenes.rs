//! Scenes for which all back ends must render the same picture. Scenes without random spheres are files in
//! `tests/gpu/scenes/primary`.

use pinhole::camera::film::YAxis;
use pinhole::camera::{Camera, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::{Film, LinearRgb, RenderSettings, Scene, Shading, Sphere, glam};

use crate::lit_scenes::{names_of_files, text};
use crate::support::{View, shaded};

/// The names and views of all scenes.
pub(crate) fn all() -> Vec<(&'static str, View)> {
    let pinhole: Lens = |pose| Box::new(wide_pinhole(pose));
    let orthographic: Lens = |pose| Box::new(OrthographicCamera::new(pose, [3.2, 2.4]).unwrap());
    let thin: Lens = |pose| Box::new(ThinLensCamera::new(wide_pinhole(pose), 0.2, 5.0).unwrap());
    let panorama: Lens = |pose| Box::new(PanoramaCamera::new(pose));
    let fisheye_of_60: Lens = |pose| Box::new(fisheye(pose, 60.0, 160.0 / 120.0));
    let mut all = vec![
        ("three_spheres", View::three_spheres()),
        ("three_spheres_orthographic", View::three_spheres_orthographic()),
        ("coincident_spheres", coincident_spheres()),
        ("tiny_radii", tiny_radii()),
        ("huge_radius", huge_radius()),
        ("radii_over_four_decades", radii_over_four_decades()),
        ("far_from_the_origin", far_from_the_origin()),
        ("one_pixel", random_with_size(1, 1)),
        ("one_column", random_with_size(1, 5000)),
        ("one_row", random_with_size(333, 1)),
        ("no_multiple_of_eight", random_with_size(61, 43)),
        ("more_than_one_slice", more_than_one_slice()),
        ("random_pinhole_y_up", random_1000(YAxis::Up, pinhole)),
        ("random_pinhole_y_down", random_1000(YAxis::Down, pinhole)),
        ("random_orthographic_y_up", random_1000(YAxis::Up, orthographic)),
        ("random_orthographic_y_down", random_1000(YAxis::Down, orthographic)),
        ("thin_lens_y_up", random_1000(YAxis::Up, thin)),
        ("thin_lens_y_down", random_1000(YAxis::Down, thin)),
        ("left_eye", random_1000(YAxis::Up, |pose| Box::new(eyes(pose)[0]))),
        ("right_eye_y_down", random_1000(YAxis::Down, |pose| Box::new(eyes(pose)[1]))),
        ("panorama_from_outside", random_1000(YAxis::Up, panorama)),
        ("panorama_from_outside_y_down", random_1000(YAxis::Down, panorama)),
        ("panorama", all_around(|pose, _| PanoramaCamera::new(pose))),
        ("panorama_left_eye", all_around(|pose, _| around(pose)[0])),
        ("panorama_right_eye", all_around(|pose, _| around(pose)[1])),
        ("fisheye_from_outside", random_1000(YAxis::Up, fisheye_of_60)),
        ("fisheye_from_outside_y_down", random_1000(YAxis::Down, fisheye_of_60)),
        ("fisheye_180", all_around(|pose, aspect| fisheye(pose, 180.0, aspect))),
        ("fisheye_360", all_around(|pose, aspect| fisheye(pose, 360.0, aspect))),
        ("example_thin_lens", View::from_toml(include_str!("../../examples/thin-lens.toml"))),
        ("example_panorama", View::from_toml(include_str!("../../examples/panorama.toml"))),
        ("example_fisheye", View::from_toml(include_str!("../../examples/fisheye.toml"))),
        ("fisheye_higher_than_wide", random_fisheye_upright()),
    ];
    let files = names_of_files("primary", "");
    assert_eq!(files.len(), 13, "{files:?}");
    all.extend(files.into_iter().map(|name| {
        let view = View::from_toml(&text("primary", &name));
        (&*name.leak(), view)
    }));
    all
}

/// Makes a camera at a pose.
type Lens = fn(Pose) -> Box<dyn Camera>;

fn flat() -> RenderSettings {
    let background = LinearRgb::new([0.25, 0.5, 0.75]).unwrap();
    shaded(Shading::Flat, background)
}

fn headlight() -> RenderSettings {
    shaded(Shading::Headlight, flat().background)
}

pub(crate) fn view(spheres: &[Sphere], camera: impl Camera + 'static, size: [u32; 2]) -> View {
    View {
        scene: Scene::new(spheres).unwrap(),
        camera: Box::new(camera),
        film: Film::new(size[0], size[1]).unwrap(),
        settings: headlight(),
    }
}

fn sphere(center: [f64; 3], radius: f64) -> Sphere {
    // Spheres that are close to each other have different colours.
    let mix = |k: f64| (center[0] * k + center[1] * 1.7 + center[2] * 2.3 + radius).sin().abs();
    let color = [mix(1.0) as f32, mix(3.1) as f32, mix(7.7) as f32];
    Sphere::new(center, radius, LinearRgb::new(color).unwrap())
}

pub(crate) fn pinhole(eye: [f64; 3], look_at: [f64; 3], fov_degrees: f64, aspect: f64) -> PinholeCamera {
    let pose = Pose::looking_at(eye, look_at, [0.1, 1.0, 0.2]).unwrap();
    PinholeCamera::with_vertical_fov(pose, fov_degrees.to_radians(), aspect).unwrap()
}

fn coincident_spheres() -> View {
    let mut spheres: Vec<Sphere> =
        (0..40).map(|i| sphere([f64::from(i % 8) - 3.5, f64::from(i / 8) - 2.0, 0.0], 0.7)).collect();
    // Each sphere is repeated in reverse order and with another colour. The smaller id must win.
    let again: Vec<Sphere> = spheres.iter().rev().map(|s| Sphere::new(s.center, s.radius, LinearRgb::WHITE)).collect();
    spheres.extend(again);
    let view = view(&spheres, pinhole([1.0, 2.0, 9.0], [0.0; 3], 50.0, 1.5), [96, 64]);
    View { settings: flat(), ..view }
}

fn tiny_radii() -> View {
    let spheres: Vec<Sphere> =
        (0..100).map(|i| sphere([f64::from(i % 10) * 1e-5, f64::from(i / 10) * 1e-5, 0.0], 4e-6)).collect();
    let center = [4.5e-5, 4.5e-5, 0.0];
    let eye = [4.5e-5, 4.5e-5, 2e-4];
    view(&spheres, pinhole(eye, center, 30.0, 1.0), [96, 96])
}

/// Pebbles on a ground, which is a sphere of radius 10⁶.
fn huge_radius() -> View {
    let mut spheres = vec![sphere([0.0, -1e6, 0.0], 1e6)];
    spheres.extend((0..25).map(|i| sphere([f64::from(i % 5) - 2.0, 0.3, -f64::from(i / 5)], 0.3)));
    view(&spheres, pinhole([0.5, 1.5, 5.0], [0.0, 0.0, -2.0], 50.0, 1.5), [96, 64])
}

fn radii_over_four_decades() -> View {
    let mut random = fastrand::Rng::with_seed(4);
    let spheres: Vec<Sphere> = (0..800)
        .map(|_| {
            let radius = 10_f64.powf(random.f64() * 4.0 - 4.0);
            sphere([0; 3].map(|_| random.f64() * 6.0 - 3.0), radius * 0.5)
        })
        .collect();
    view(&spheres, pinhole([1.0, 2.0, 9.0], [0.0; 3], 40.0, 1.25), [120, 96])
}

fn far_from_the_origin() -> View {
    let mut random = fastrand::Rng::with_seed(6);
    let at = [1e6 + 0.3, -2e6 - 0.7, 3e6 + 0.1];
    let mut near = |size: f64| at.map(|x| x + (random.f64() - 0.5) * size);
    let spheres: Vec<Sphere> = (0..200).map(|_| sphere(near(4.0), 0.15)).collect();
    let eye = [at[0] + 2.0, at[1] + 1.0, at[2] + 7.0];
    view(&spheres, pinhole(eye, at, 40.0, 1.0), [96, 96])
}

fn random_spheres(seed: u64, count: usize, radius: f64) -> Vec<Sphere> {
    let mut random = fastrand::Rng::with_seed(seed);
    (0..count)
        .map(|_| {
            let center = [0; 3].map(|_| random.f64() * 4.0 - 2.0);
            sphere(center, radius * (0.5 + random.f64()))
        })
        .collect()
}

fn random_with_size(width: u32, height: u32) -> View {
    let camera = pinhole([0.2, 0.3, 6.0], [0.0; 3], 40.0, 1.0);
    view(&random_spheres(7, 60, 0.4), camera, [width, height])
}

/// A scene with more spheres than one dispatch tests. The nearest are among the last.
fn more_than_one_slice() -> View {
    let mut spheres = random_spheres(8, 120_000, 0.01);
    spheres.sort_by(|a, b| a.center[2].total_cmp(&b.center[2]));
    view(&spheres, pinhole([0.2, 0.3, 6.0], [0.0; 3], 40.0, 1.5), [24, 16])
}

fn random_1000(y_axis: YAxis, lens: Lens) -> View {
    let up = match y_axis {
        YAxis::Up => [0.1, 1.0, 0.2],
        YAxis::Down => [-0.1, -1.0, -0.2],
    };
    let pose = Pose::looking_at([3.0, 2.0, 6.0], [0.1, 0.2, 0.3], up).unwrap();
    View {
        scene: Scene::new(&random_spheres(9, 1000, 0.12)).unwrap(),
        camera: lens(pose),
        film: Film::new(160, 120).unwrap().with_y_axis(y_axis),
        settings: headlight(),
    }
}

fn wide_pinhole(pose: Pose) -> PinholeCamera {
    PinholeCamera::new(pose, 1.5, [0.8, 0.6]).unwrap()
}

/// A stereo pair. The distance between the eyes is unrealistically large, so that rays are shifted far.
fn eyes(pose: Pose) -> [PinholeCamera; 2] {
    wide_pinhole(pose).stereo_pair(1.0, 4.0).unwrap()
}

fn around(pose: Pose) -> [PanoramaCamera; 2] {
    PanoramaCamera::new(pose).stereo_pair(0.2, 2.0).unwrap()
}

fn fisheye(pose: Pose, degrees: f64, aspect: f64) -> FisheyeCamera {
    FisheyeCamera::new(pose, degrees.to_radians(), aspect).unwrap()
}

/// Spheres on all sides of the eye, and a few large ones that enclose all of them.
fn all_around<C: Camera + 'static>(camera: impl Fn(Pose, f64) -> C) -> View {
    let mut spheres = random_spheres(10, 300, 0.2);
    spheres.retain(|sphere| glam::DVec3::from(sphere.center).length() > 0.8);
    spheres.push(sphere([0.2, -0.1, 0.3], 5.0));
    let pose = Pose::looking_along([0.05, 0.1, -0.02], [0.3, -0.2, -1.0], [0.1, 1.0, 0.2]).unwrap();
    view(&spheres, camera(pose, 1.5), [150, 100])
}

fn random_fisheye_upright() -> View {
    let pose = Pose::looking_at([3.0, 2.0, 6.0], [0.1, 0.2, 0.3], [0.0, 1.0, 0.0]).unwrap();
    let camera = fisheye(pose, 50.0, 61.0 / 97.0);
    view(&random_spheres(9, 200, 0.2), camera, [61, 97])
}
