//! Compares pictures with a structure to those of testing every sphere, to the bit.

use fastrand::Rng;
use pinhole::camera::{Camera, PanoramaCamera, PinholeCamera, Pose};
use pinhole::cpu::{self, SearchStructure};
use pinhole::glam::DVec3;
use pinhole::image::NO_ID;
use pinhole::light::{Ground, Light};
use pinhole::render::{DepthCue, Occlusion, Studio};
use pinhole::{Film, Image, Integrator, LayerSet, LinearRgb, Material, RenderSettings, Scene, Sphere, View};

use crate::support::random_light;
use crate::support::spheres_of;

/// Compares all layers. Images compare every number.
fn assert_same(scene: &Scene, view: &View<'_>, settings: &RenderSettings, name: &str) -> Image {
    let tree = SearchStructure::new(scene).unwrap();
    let wanted = cpu::render(scene, view, settings, LayerSet::ALL).unwrap();
    let found = cpu::render(&tree, view, settings, LayerSet::ALL).unwrap();
    assert!(wanted == found, "{name}");
    found
}

fn color(random: &mut Rng) -> LinearRgb {
    LinearRgb::new([0; 3].map(|_| random.f32())).unwrap()
}

fn point(random: &mut Rng) -> DVec3 {
    DVec3::from([0; 3].map(|_| 2.0 * random.f64() - 1.0))
}

/// The scene with so many more spheres that it gets a structure.
fn with_more(scene: &Scene, random: &mut Rng) -> Scene {
    let mut spheres = spheres_of(scene);
    // A grid needs many opaque spheres.
    let is_opaque = random.bool();
    let more = if is_opaque { 300 } else { 20 };
    for _ in 0..more {
        let radius = 10_f64.powf(-2.5 * random.f64()) * 0.3;
        let other = spheres[random.usize(0..spheres.len())];
        let opacity = if is_opaque || random.bool() { 1.0 } else { random.f32() };
        let center = (2.0 * point(random)).to_array();
        let mut sphere = Sphere::new(center, radius, color(random));
        // Some are inside others, and some coincide.
        match random.u32(0..4) {
            0 => sphere.center = other.center,
            1 => sphere = Sphere::new(other.center, other.radius, color(random)),
            _ => sphere = sphere.with_opacity(opacity),
        }
        spheres.insert(random.usize(0..=spheres.len()), sphere);
    }
    Scene::new(&spheres).unwrap()
}

/// Random pictures with paths, studios and primary rays, and every kind of light.
#[test]
fn random_pictures() {
    let mut random = Rng::with_seed(41);
    for seed in 0..24 {
        for view in [random_light::view(seed), random_light::studio(seed)] {
            let scene = with_more(&view.scene, &mut random);
            let seen = View::new(view.camera.as_ref(), view.film);
            let name = format!("seed {seed}: {}", view.name);
            assert_same(&scene, &seen, &view.settings, &name);
            assert_same(&scene, &seen, &view.settings.by_primary_rays(), &name);
        }
    }
}

fn studio(random: &mut Rng, size: f64) -> RenderSettings {
    let occlusion = Occlusion { radius: random.bool().then(|| size * random.f64()), samples: random.u32(1..4) };
    let cue = DepthCue { near: size, far: 4.0 * size, color: color(random) };
    let studio = Studio {
        occlusion: random.bool().then_some(occlusion),
        shadows: random.bool(),
        max_surfaces: random.u32(1..6),
        depth_cue: random.bool().then_some(cue),
        ..Studio::default()
    };
    let ground =
        Ground { point: -size * DVec3::Y, normal: DVec3::Y, color: color(random), is_shadow_catcher: random.bool() };
    let mut settings = RenderSettings {
        integrator: Integrator::Studio(studio),
        lights: Light::key_and_fill().to_vec(),
        ground: random.bool().then_some(ground),
        background: color(random),
        is_transparent: random.bool(),
        ..RenderSettings::default()
    };
    settings.sampling.samples = 2;
    settings
}

/// Scenes at any scale, at the world's origin or far from it. Their spheres have many sizes, and some are equal or
/// nested. They are seen from near, from far and from inside a sphere.
#[test]
fn pictures_at_any_scale() {
    const ROUNDS: usize = 50;
    let mut random = Rng::with_seed(42);
    let film = Film::new(20, 15).unwrap();
    let mut shown = 0;
    for round in 0..ROUNDS {
        let size = 10_f64.powi([0, 0, 0, -5, 5][round % 5]);
        let middle = [0.0, 1e3, 1e9][round % 3] * size * DVec3::new(1.0, -0.7, 0.3);
        let decades = 5.0 * random.f64();
        let mut spheres: Vec<Sphere> = (0..random.usize(17..200))
            .map(|_| {
                let radius = size * 0.5 * 10_f64.powf(-decades * random.f64());
                let center = (middle + size * point(&mut random)).to_array();
                let opacity = if random.u32(0..3) > 0 { 1.0 } else { random.f32() };
                let sphere = Sphere::new(center, radius, color(&mut random)).with_opacity(opacity);
                match random.u32(0..6) {
                    0 => sphere.with_material(Material::Emissive { strength: 1.0 }),
                    1 => sphere.with_material(Material::Conductor { roughness: 0.3 }),
                    _ => sphere,
                }
            })
            .collect();
        for _ in 0..10 {
            let mut copy = spheres[random.usize(0..spheres.len())];
            copy.color = color(&mut random);
            copy.radius *= [1.0, 1.0, 0.5][random.usize(0..3)];
            spheres.push(copy);
        }
        if random.u32(0..4) == 0 {
            spheres.push(Sphere::new(middle.to_array(), size * 1e4, color(&mut random)));
        }
        let within = spheres[random.usize(0..spheres.len())];
        let eye = match random.u32(0..3) {
            0 => DVec3::from(within.center) + 0.5 * within.radius * point(&mut random),
            1 => middle + size * 1e6 * point(&mut random),
            _ => middle + size * 4.0 * point(&mut random),
        };
        let pose = Pose::looking_at(eye, middle, [0.1, 1.0, 0.2]).unwrap();
        let fov = if eye.distance(middle) > 1e3 * size { 2e-6 } else { 0.8 };
        let camera: Box<dyn Camera> = match random.u32(0..4) {
            0 => Box::new(PanoramaCamera::new(pose)),
            _ => Box::new(PinholeCamera::with_vertical_fov(pose, fov, 4.0 / 3.0).unwrap()),
        };
        let scene = Scene::new(&spheres).unwrap();
        let view = View::new(camera.as_ref(), film);
        let name = format!("round {round}, {} spheres", spheres.len());
        let image = assert_same(&scene, &view, &RenderSettings::default(), &name);
        shown += image.id().unwrap().iter().filter(|id| **id != NO_ID).count();
        assert_same(&scene, &view, &studio(&mut random, size), &name);
    }
    assert!(shown > ROUNDS * 60, "{shown}");
}

/// Only some of many equal spheres hide light, in any order. Many opaque ones get a grid.
#[test]
fn many_equal_spheres_hide_light_by_their_own_opacity() {
    let mut random = Rng::with_seed(43);
    for opaque_from in [0, 1, 60] {
        let mut spheres: Vec<Sphere> = (0..60)
            .map(|i| {
                let opacity = if i < opaque_from { 0.5 } else { 1.0 };
                Sphere::new([0.0, 0.4, 0.0], 0.3, color(&mut random)).with_opacity(opacity)
            })
            .collect();
        spheres.extend((0..400).map(|_| Sphere::new(point(&mut random).to_array(), 0.05, color(&mut random))));
        let scene = Scene::new(&spheres).unwrap();
        let pose = Pose::looking_at([0.2, 2.5, 3.0], DVec3::ZERO, DVec3::Y).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.8, 4.0 / 3.0).unwrap();
        let view = View::new(&camera, Film::new(40, 30).unwrap());
        let mut settings = RenderSettings {
            integrator: Integrator::Studio(Studio {
                shadows: true,
                occlusion: Some(Occlusion { radius: None, samples: 4 }),
                ..Studio::default()
            }),
            lights: Light::key_and_fill().to_vec(),
            ..RenderSettings::default()
        };
        settings.sampling.samples = 2;
        assert_same(&scene, &view, &settings, &format!("opaque from {opaque_from}"));
    }
}
