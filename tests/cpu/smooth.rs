//! Smooth pictures: their openness against rays, that it belongs to the surface and not to the camera, parts, data of any
//! kind, and the judgement of the checker.

use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::geometry::math::unit;
use pinhole::glam::DVec3;
use pinhole::light::{Light, LightFrame, LightKind};
use pinhole::render::{Occlusion, Outline, Sampling, Studio};
use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::{Centers, SceneUpdate};
use pinhole::verify::finished::{FinishedRequest, PixelVerdict};
use pinhole::verify::written::{Samples, WrittenPicture};
use pinhole::verify::{Checker, Outcome};
use pinhole::{Encoding, Film, Image, Integrator, LayerSet, LinearRgb, RenderSettings, Scene, Sphere, View, cpu};

use crate::support::spheres::{self, Spheres};

/// Settings of white ambient light alone, so that a white sphere has the colour of its openness.
fn ambient(radius: Option<f64>, samples: u32) -> RenderSettings {
    let occlusion = Some(Occlusion { radius, ..Occlusion::default() });
    studio(&Studio { ambient: LinearRgb::WHITE, shadows: false, occlusion, ..Studio::default() }, samples)
}

/// Settings of a lamp alone, which casts shadows, so that a white sphere has the colour of its light.
fn lamp(toward: DVec3, angular_radius: f64, samples: u32) -> RenderSettings {
    let kind = LightKind::Directional { toward, strength: LinearRgb::WHITE, angular_radius };
    let dark = Studio { ambient: LinearRgb::BLACK, occlusion: None, ..Studio::default() };
    RenderSettings { lights: vec![Light { kind, frame: LightFrame::World }], ..studio(&dark, samples) }
}

fn studio(studio: &Studio, samples: u32) -> RenderSettings {
    RenderSettings {
        integrator: Integrator::Studio(Studio { is_smooth: true, ..studio.clone() }),
        sampling: Sampling { samples, ..Sampling::default() },
        background: LinearRgb::BLACK,
        ..RenderSettings::default()
    }
}

/// The settings with rays in all pixels.
fn dense(mut settings: RenderSettings) -> RenderSettings {
    if let Integrator::Studio(studio) = &mut settings.integrator {
        studio.is_dense = true;
    }
    settings
}

/// The settings in which spheres shine through each other.
fn stars(mut settings: RenderSettings) -> RenderSettings {
    if let Integrator::Studio(studio) = &mut settings.integrator {
        studio.added_light = true;
    }
    settings
}

fn white(spheres: &Spheres) -> Scene {
    Scene::from_f32(spheres.clone(), LinearRgb::WHITE).unwrap()
}

/// A camera that sees the whole scene from the side.
fn camera(scene: &Scene) -> PinholeCamera {
    let subject = scene.bounds_to_frame();
    let distance = 1.5 * subject.size().length();
    let toward = unit(DVec3::new(0.4, 0.3, 1.0)).unwrap();
    let pose = Pose::looking_at(subject.center() + distance * toward, subject.center(), DVec3::Y).unwrap();
    PinholeCamera::with_vertical_fov(pose, 0.6, 1.0).unwrap()
}

fn picture(scene: &Scene, camera: &dyn Camera, film: Film, settings: &RenderSettings) -> Image {
    assert!(settings.is_smooth(scene, camera));
    let search = cpu::SearchStructure::new(scene).unwrap();
    cpu::render(&search, &View::new(camera, film), settings, LayerSet::ALL).unwrap()
}

/// A point on a sphere in the scene's frame.
struct Point {
    own: u32,
    at: DVec3,
    normal: DVec3,
}

impl Point {
    /// Returns true if a ray to a direction meets no other sphere that is nearer than `radius`.
    fn is_open(&self, spheres: &Spheres, direction: DVec3, radius: f64) -> bool {
        !spheres.iter().enumerate().any(|(id, sphere)| {
            let [x, y, z, r] = sphere.map(f64::from);
            let to = DVec3::new(x, y, z) - self.at;
            let along = to.dot(direction);
            let half = (r * r - (to - along * direction).length_squared()).max(0.0).sqrt();
            id as u32 != self.own && half > 0.0 && along + half > 0.0 && along - half < radius
        })
    }

    /// The share of 400 directions, spread by the cosine, in which no sphere is near.
    fn openness(&self, spheres: &Spheres, radius: f64) -> f64 {
        let open = |(x, y): &(f64, f64)| {
            let (right, up) = self.normal.any_orthonormal_pair();
            let direction = *x * right + *y * up + (1.0 - x * x - y * y).sqrt() * self.normal;
            self.is_open(spheres, direction, radius)
        };
        on_disk().filter(open).count() as f64 / 400.0
    }

    /// The light of a lamp, as a share of what arrives where a surface faces it, by 400 rays to its disk.
    fn light(&self, spheres: &Spheres, toward: DVec3, angular_radius: f64) -> f64 {
        let (right, up) = toward.any_orthonormal_pair();
        let (mut light, mut most) = (0.0, 0.0);
        for (x, y) in on_disk() {
            // Even in solid angle, as (1 - cos) is even.
            let versine = (x * x + y * y) * (1.0 - angular_radius.cos());
            let across = (versine * (2.0 - versine)).sqrt() / x.hypot(y);
            let direction = across * (x * right + y * up) + (1.0 - versine) * toward;
            most += 1.0 - versine;
            if self.is_open(spheres, direction, f64::INFINITY) {
                light += direction.dot(self.normal).max(0.0);
            }
        }
        light / most
    }
}

/// 400 points that are spread evenly over a disk of radius 1.
fn on_disk() -> impl Iterator<Item = (f64, f64)> {
    (0..400).map(|k| {
        let across = ((f64::from(k) + 0.5) / 400.0).sqrt();
        let (sin, cos) = (2.399_963 * f64::from(k)).sin_cos();
        (across * cos, across * sin)
    })
}

/// The points that pixels of a picture by one ray each show, every other one, with their colours.
fn points(scene: &Scene, image: &Image) -> Vec<(Point, f64)> {
    let hits = image.id().unwrap().iter().zip(image.position().unwrap()).zip(image.normal().unwrap());
    (hits.zip(image.color()))
        .filter(|(((id, _), _), _)| **id != pinhole::image::NO_ID)
        .step_by(2)
        .map(|(((own, at), normal), color)| {
            let [at, normal] = [at, normal].map(|v| DVec3::from(v.map(f64::from)));
            (Point { own: *own, at: at - scene.origin(), normal }, f64::from(color[0]))
        })
        .collect()
}

/// The root mean square of errors, and the magnitude below which 95 of 100 are.
fn spread(mut errors: Vec<f64>) -> (f64, f64) {
    assert!(errors.len() > 150, "{}", errors.len());
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    errors.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    (rms, errors[errors.len() * 95 / 100].abs())
}

/// Scenes with shadows and pockets of any kind.
fn crowds() -> [(&'static str, Spheres); 4] {
    let packed = spheres::scaled(&spheres::random(700, 5, |rng| 0.04 + 0.02 * rng.f32()), 10.0);
    let slab = spheres::lattice(14).into_iter().filter(|[_, _, z, _]| *z < 4.0).collect();
    let even = spheres::scaled(&spheres::random(400, 6, |_| 0.05), 8.0);
    [("packed", packed), ("slab", slab), ("even", even), ("chains", chains())]
}

/// Chains of balls with rows of smaller balls between them, as sticks are drawn.
fn chains() -> Spheres {
    let mut rng = fastrand::Rng::with_seed(3);
    let mut all = Vec::new();
    for _ in 0..12 {
        let mut at = [0; 3].map(|_| 6.0 * rng.f32());
        for _ in 0..8 {
            let next = at.map(|x| (x + 1.6 * (rng.f32() - 0.5)).clamp(0.0, 6.0));
            all.push([at[0], at[1], at[2], 0.4]);
            for step in 1..4 {
                let [x, y, z] = [0, 1, 2].map(|axis| at[axis] + 0.25 * step as f32 * (next[axis] - at[axis]));
                all.push([x, y, z, 0.2]);
            }
            at = next;
        }
    }
    all
}

#[test]
fn openness_is_close_to_rays() {
    for (name, spheres) in crowds() {
        let scene = white(&spheres);
        let radius = 0.2 * scene.bounds_to_frame().size().length();
        let image = picture(&scene, &camera(&scene), Film::new(40, 40).unwrap(), &ambient(Some(radius), 1));
        let errors = points(&scene, &image).into_iter().map(|(point, color)| color - point.openness(&spheres, radius));
        let (rms, most) = spread(errors.collect());
        assert!(rms < 0.055 && most < 0.11, "{name}: {rms} rms, 95 % below {most}");
    }
}

#[test]
fn shadows_are_close_to_rays() {
    let toward = unit(DVec3::new(-0.5, 0.8, 0.6)).unwrap();
    for (name, spheres) in crowds() {
        let scene = white(&spheres);
        // A border is as wide as a pixel, or as directions are apart, where rays are stopped or not.
        for (angular_radius, most_rms, most) in
            [(0.0, 0.1, 0.28), (0.01, 0.09, 0.25), (0.05, 0.07, 0.2), (0.12, 0.05, 0.15), (0.25, 0.035, 0.09)]
        {
            let settings = lamp(toward, angular_radius, 1);
            let image = picture(&scene, &camera(&scene), Film::new(40, 40).unwrap(), &settings);
            let errors = points(&scene, &image)
                .iter()
                .map(|(point, color)| color - point.light(&spheres, toward, angular_radius))
                .collect();
            let (rms, worst) = spread(errors);
            assert!(rms < most_rms && worst < most, "{name}, {angular_radius}: {rms} rms, 95 % below {worst}");
        }
    }
}

/// Spheres farther away than the radius do not occlude.
#[test]
fn a_small_radius_leaves_light() {
    let spheres = spheres::scaled(&spheres::random(700, 5, |_| 0.05), 10.0);
    let scene = white(&spheres);
    let mean = |radius: f64| {
        let image = picture(&scene, &camera(&scene), Film::new(40, 40).unwrap(), &ambient(Some(radius), 1));
        let hits = image.color().iter().zip(image.id().unwrap()).filter(|(_, id)| **id != pinhole::image::NO_ID);
        let colors: Vec<f32> = hits.map(|(color, _)| color[0]).collect();
        colors.iter().sum::<f32>() / colors.len() as f32
    };
    let means = [1e-3, 0.1, 0.5, 1.0, 3.0].map(mean);
    assert!(means.is_sorted_by(|a, b| a > b) && means[0] > 0.98, "{means:?}");
}

/// The centres of some pixels are those of a picture with three times as many.
#[test]
fn openness_belongs_to_a_surface_and_not_to_a_camera() {
    let scene = white(&spheres::scaled(&spheres::random(500, 7, |_| 0.06), 4.0));
    let middle = scene.bounds_to_frame().center();
    let looking = |from: DVec3| Pose::looking_at(middle + from, middle, DVec3::Y).unwrap();
    let camera = |pose| OrthographicCamera::new(pose, [3.0, 3.0]).unwrap();
    let settings = ambient(None, 1);
    let of =
        |side: u32, from: DVec3| picture(&scene, &camera(looking(from)), Film::new(side, side).unwrap(), &settings);
    let [small, large] = [of(21, DVec3::Z * 9.0), of(63, DVec3::Z * 20.0)];
    let mut compared = 0;
    for (index, (color, id)) in small.color().iter().zip(small.id().unwrap()).enumerate() {
        let [i, j] = [index % 21, index / 21];
        let other = (3 * j + 1) * 63 + 3 * i + 1;
        assert_eq!(large.id().unwrap()[other], *id);
        assert!((large.color()[other][0] - color[0]).abs() < 1e-5, "{color:?} {:?}", large.color()[other]);
        compared += usize::from(*id != pinhole::image::NO_ID);
    }
    assert!(compared > 100, "{compared}");
}

/// Pictures of a scene that was drawn before, with other settings, from elsewhere, and with other spheres, are those of a
/// new scene.
#[test]
fn what_earlier_pictures_left_changes_none() {
    let mut all = spheres::random(300, 12, |_| 0.07);
    let mut scene = white(&all);
    let (front, film) = (camera(&scene), Film::new(24, 18).unwrap());
    let middle = scene.bounds_to_frame().center();
    let above = Pose::looking_at(middle + 4.0 * DVec3::Y, middle, DVec3::X).unwrap();
    let above = OrthographicCamera::new(above, [0.8, 0.6]).unwrap();
    let views: [&dyn Camera; 2] = [&front, &above];
    let settings = [ambient(None, 4), ambient(Some(0.2), 4), lamp(DVec3::Y, 0.1, 4)];
    let all_as_new = |scene: &Scene, all: &Spheres| {
        for (k, (view, look)) in [(0, 0), (1, 0), (1, 1), (0, 1), (0, 2), (1, 2), (0, 0)].into_iter().enumerate() {
            let of = |scene: &Scene| picture(scene, views[view], film, &settings[look]).to_le_bytes();
            assert!(of(scene) == of(&white(all)), "picture {k}");
        }
    };
    all_as_new(&scene, &all);
    for sphere in &mut all[10..20] {
        sphere[1] += 0.1;
    }
    let centers: Vec<_> = all[10..20].iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
    let update = SceneUpdate { first: 10, centers: Some(Centers::F32(&centers)), ..SceneUpdate::default() };
    scene.apply(&update).unwrap();
    all_as_new(&scene, &all);
}

#[test]
fn parts_of_a_film_are_as_the_whole() {
    let scene = white(&spheres::random(300, 8, |_| 0.07));
    let (camera, film) = (camera(&scene), Film::new(24, 18).unwrap());
    let mut settings = lamp(DVec3::Y, 0.1, 4);
    if let Integrator::Studio(studio) = &mut settings.integrator {
        *studio = Studio { outline: Some(Outline::thin()), is_smooth: true, ..Studio::default() };
    }
    for settings in [settings.clone(), dense(settings.clone()), stars(settings)] {
        let whole = picture(&scene, &camera, film, &settings);
        let (unfinished, layers) = (settings.unfinished(), settings.layers_for(LayerSet::ALL));
        let mut joined = Image::new(24, 18, layers).unwrap();
        for (origin, size) in [([0, 0], [11, 7]), ([11, 0], [13, 7]), ([0, 7], [23, 11]), ([23, 7], [1, 11])] {
            let part = cpu::render(&scene, &View::new(&camera, film.part(origin, size).unwrap()), &unfinished, layers);
            joined.put(&part.unwrap(), origin).unwrap();
        }
        let joined = cpu::finish(joined, &settings, LayerSet::ALL);
        assert!(joined.to_le_bytes() == whole.to_le_bytes());
    }
}

/// A pixel of a dense picture is the mean of a square of pixels of a larger one, and has the hit of its centre. The number
/// of its rays is the nearest odd square.
#[test]
fn dense_pictures_are_means_of_larger_ones() {
    let spheres = spheres::random(3000, 8, |_| 0.01).into_iter().zip(0_u32..).map(|(sphere, k)| {
        let [x, y, z, radius] = sphere.map(f64::from);
        let color = LinearRgb::from_srgb8([50, 120, 200].map(|c| (c + 7 * k) as u8));
        Sphere::new([x, y, z], radius, color)
    });
    let scene = Scene::new(&spheres.collect::<Vec<_>>()).unwrap();
    let (camera, [width, height]) = (camera(&scene), [24, 18]);
    let film = Film::new(width, height).unwrap();
    let flat = |samples| studio(&Studio { ambient: LinearRgb::WHITE, shadows: false, ..Studio::default() }, samples);
    let of_centers = picture(&scene, &camera, film, &flat(1));
    for (samples, side) in [(1, 1), (4, 3), (8, 3), (9, 3), (16, 5), (1000, 15)] {
        let image = picture(&scene, &camera, film, &dense(flat(samples)));
        let larger = picture(&scene, &camera, Film::new(side * width, side * height).unwrap(), &flat(1));
        let rays = (side * side) as f32;
        for pixel in 0..(width * height) as usize {
            let [i, j] = [pixel as u32 % width, pixel as u32 / width];
            let of_ray = |k: u32| ((j * side + k / side) * side * width + i * side + k % side) as usize;
            let sum = (0..side * side).fold([0.0; 3], |sum: [f32; 3], k| {
                let color = larger.color()[of_ray(k)];
                [0, 1, 2].map(|c| sum[c] + color[c])
            });
            let differences = [0, 1, 2].map(|c| (image.color()[pixel][c] - sum[c] / rays).abs());
            assert!(differences.iter().all(|difference| *difference < 1e-5), "{samples}: {differences:?}");
        }
        assert_eq!(image.samples().unwrap()[0], side * side);
        assert!(image.id() == of_centers.id() && image.depth() == of_centers.depth());
        assert!(image.normal() == of_centers.normal() && image.position() == of_centers.position());
    }
}

/// Spheres that coincide, contain others, are of very different sizes or far apart: every colour is an openness.
#[test]
fn any_spheres_can_be_drawn() {
    let mut with_a_giant = spheres::random(200, 9, |_| 1e-3);
    with_a_giant.push([0.0, 0.0, -2e3, 1e3]);
    for (name, spheres) in [
        ("coincident", spheres::coincident(3000)),
        ("concentric", spheres::concentric(300)),
        ("four decades", spheres::four_decades(300)),
        ("one around all", spheres::one_around_all(300)),
        ("clusters", spheres::clusters(5, 60)),
        ("far", spheres::far(200)),
        ("flat", spheres::flat(300)),
        ("needle", spheres::needle(100)),
        ("outlier", spheres::outlier(300)),
        ("geometric", spheres::geometric(50)),
        ("distant sheet", spheres::distant_sheet(100)),
        ("a giant", with_a_giant),
        ("one", vec![[1.0, 2.0, 3.0, 0.5]]),
        ("nothing", Vec::new()),
    ] {
        let scene = white(&spheres);
        let all = [ambient(None, 4), ambient(Some(1e-6), 4), ambient(Some(1e9), 4), stars(ambient(None, 4))];
        for settings in all {
            let image = picture(&scene, &camera(&scene), Film::new(16, 16).unwrap(), &settings);
            let is_share = |color: &[f32; 3]| color.iter().all(|c| (0.0..=1.0 + 1e-6).contains(c));
            assert!(image.color().iter().all(is_share), "{name}");
        }
    }
}

/// Every sphere that the ray through a pixel meets shines there, in whatever order they lie, and faint ones less.
#[test]
fn stars_shine_through_each_other() {
    let row = |count: usize| (0..count).map(|k| [0.0, 0.0, k as f32, 0.2]).collect::<Spheres>();
    let beside = [1.0, 0.0, 0.0, 0.2];
    let film = Film::new(90, 30).unwrap();
    let pose = Pose::looking_along(DVec3::new(0.0, 0.0, 50.0), DVec3::NEG_Z, DVec3::Y).unwrap();
    let camera = OrthographicCamera::new(pose, [3.0, 1.0]).unwrap();
    // x / (1 + x) is turned back into x.
    let light = |image: &Image, column: usize| {
        let light = f64::from(image.color()[15 * 90 + column][0]);
        light / (1.0 - light)
    };
    for count in 1..7 {
        let scene = white(&row(count).into_iter().chain([beside]).collect());
        let image = picture(&scene, &camera, film, &stars(ambient(None, 1)));
        let ratio = light(&image, 45) / light(&image, 60);
        assert!((ratio / count as f64 - 1.0).abs() < 1e-5, "{count}: {ratio}");
    }
    let half = SurfaceProperties { opacity: 0.5, ..SurfaceProperties::default() };
    let [mut faint, bright] = [0.0, 1.0].map(|x| Sphere::new([x, 0.0, 0.0], 0.2, LinearRgb::WHITE));
    faint.surface = half;
    let image = picture(&Scene::new(&[faint, bright]).unwrap(), &camera, film, &stars(ambient(None, 1)));
    let ratio = light(&image, 45) / light(&image, 60);
    assert!((ratio - 0.5).abs() < 0.01, "{ratio}");
}

#[test]
fn pictures_with_chance_are_not_smooth() {
    let scene = white(&spheres::random(20, 1, |_| 0.1));
    let camera = camera(&scene);
    let plain = ambient(None, 2);
    assert!(plain.is_smooth(&scene, &camera));
    let mut sun = plain.clone();
    let kind = LightKind::Directional { toward: DVec3::Y, strength: LinearRgb::WHITE, angular_radius: 0.3 };
    sun.lights.push(Light { kind, frame: LightFrame::World });
    assert!(!sun.is_smooth(&scene, &camera));
    assert!(!plain.with_denoise(true).is_smooth(&scene, &camera));
    assert!(!plain.by_primary_rays().is_smooth(&scene, &camera));
    let clear = SurfaceProperties { opacity: 0.5, ..SurfaceProperties::default() };
    let glossy = Material::Lambert { specular: 0.1, roughness: 0.2 };
    for surface in [clear, SurfaceProperties { material: glossy, ..SurfaceProperties::default() }] {
        assert!(!plain.is_smooth(&scene.clone().with_surface(surface), &camera));
    }
}

/// The reference's own picture is exact; a pixel that was changed, or drawn without openness or shadows, is a violation.
#[test]
fn forged_pixels_are_violations() {
    let scene = white(&spheres::random(400, 10, |_| 0.06));
    let (camera, film) = (camera(&scene), Film::new(40, 40).unwrap());
    let view = View::new(&camera, film);
    let plain = ambient(Some(0.4), 4);
    let mut lined = plain.clone();
    if let Integrator::Studio(studio) = &mut lined.integrator {
        studio.outline = Some(Outline::thin());
    }
    for (name, settings) in [
        ("plain", plain.clone()),
        ("lined", lined),
        ("shadows", lamp(DVec3::Y, 0.1, 4)),
        ("stars", stars(plain.clone())),
        ("dense", dense(plain)),
        ("dense shadows", dense(lamp(DVec3::Y, 0.1, 9))),
    ] {
        let image = picture(&scene, &camera, film, &settings);
        let encoding = Encoding::default();
        let exact: Vec<[f32; 4]> = image.color().iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
        let checker = Checker::new(&scene).unwrap();
        let judged = |pixels: &[[f32; 4]]| {
            let [picture, exact] = [pixels, &exact].map(|pixels| WrittenPicture {
                size: [40, 40],
                samples: Samples::Linear(pixels),
                encoding: &encoding,
            });
            let request = FinishedRequest {
                views: &[view],
                settings: &settings,
                picture: &picture,
                exact: &exact,
                annotate: None,
            };
            checker.certify_finished(request).unwrap()
        };
        assert_eq!(judged(&exact).outcome(), Outcome::Proved);
        let mut forged = exact.clone();
        for [i, j] in [[20, 20], [0, 0], [17, 23]] {
            forged[j * 40 + i][1] += 0.02;
        }
        let found = judged(&forged);
        assert_eq!(found.count(PixelVerdict::Violated), 3, "{name}");
        let bright: Vec<[f32; 4]> = exact.iter().map(|pixel| pixel.map(|c| c.min(1.0).sqrt())).collect();
        assert_eq!(judged(&bright).outcome(), Outcome::Violated);
    }
}
