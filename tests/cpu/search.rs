//! Pictures with a structure against those of testing every sphere: equal to the bit.

use fastrand::Rng;
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::cpu::{self, SearchStructure};
use pinhole::glam::DVec3;
use pinhole::light::Light;
use pinhole::render::{Occlusion, Studio};
use pinhole::{Film, Integrator, LayerSet, LinearRgb, RenderSettings, Scene, Sphere, View};

use crate::scene::spheres_of;
use crate::support::random_light;

/// Compares all layers, of which an image compares every number.
fn assert_same(scene: &Scene, view: &View<'_>, settings: &RenderSettings, name: &str) {
    let tree = SearchStructure::new(scene).unwrap();
    let wanted = cpu::render(scene, view, settings, LayerSet::ALL).unwrap();
    let found = cpu::render(&tree, view, settings, LayerSet::ALL).unwrap();
    assert!(wanted == found, "{name}");
}

fn color(random: &mut Rng) -> LinearRgb {
    LinearRgb::new([0; 3].map(|_| random.f32())).unwrap()
}

fn point(random: &mut Rng) -> DVec3 {
    DVec3::from([0; 3].map(|_| 2.0 * random.f64() - 1.0))
}

/// The scene with so many more spheres that there is a structure.
fn with_more(scene: &Scene, random: &mut Rng) -> Scene {
    let mut spheres = spheres_of(scene);
    // A grid is for many opaque spheres.
    let is_opaque = random.bool();
    let more = if is_opaque { 300 } else { 20 };
    for _ in 0..more {
        let radius = 10_f64.powf(-2.5 * random.f64()) * 0.3;
        let other = spheres[random.usize(0..spheres.len())];
        let opacity = if is_opaque || random.bool() { 1.0 } else { random.f32() };
        let center = (2.0 * point(random)).to_array();
        let mut sphere = Sphere::new(center, radius, color(random));
        // Some are within others, some in the same place.
        match random.u32(0..4) {
            0 => sphere.center = other.center,
            1 => sphere = Sphere::new(other.center, other.radius, color(random)),
            _ => sphere = sphere.with_opacity(opacity),
        }
        spheres.insert(random.usize(0..=spheres.len()), sphere);
    }
    Scene::new(&spheres).unwrap()
}

/// Paths, studios and primary rays; `src/cpu/search_tests.rs` has rays at any scale, from near, far and within.
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

/// Of many equal spheres only some hide light, whichever comes first; and many opaque ones, for which there is a grid.
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
        spheres.extend(
            (0..400).map(|_| Sphere::new(point(&mut random).to_array(), 0.05, color(&mut random))),
        );
        let scene = Scene::new(&spheres).unwrap();
        let pose = Pose::looking_at([0.2, 2.5, 3.0], DVec3::ZERO, DVec3::Y).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.8, 4.0 / 3.0).unwrap();
        let view = View::new(&camera, Film::new(40, 30).unwrap());
        let mut settings = RenderSettings {
            integrator: Integrator::Studio(Studio {
                has_shadows: true,
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
