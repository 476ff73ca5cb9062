//! Small lit scenes. Each contains something that makes one kind of fault visible.

use std::sync::Arc;

use pinhole::camera::{PanoramaCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::glam::DVec3;
use pinhole::light::environment::Environment;
use pinhole::light::{Ground, Light, LightFrame, LightKind, Sky, SkyLight};
use pinhole::render::{Integrator, LightSampling, PathTracing, RenderSettings, Sampling};
use pinhole::scene::material::Material;
use pinhole::{Appearance, Film, LinearRgb, Scene, Sphere, SphereArray, SurfaceProperties};

use crate::light::scenes::LitView;

type Named = (&'static str, fn() -> LitView);

pub(crate) fn all() -> Vec<Named> {
    vec![
        ("matt", matt),
        ("lobes", lobes),
        ("metals", metals),
        ("glass", glass),
        ("emitters", emitters),
        ("emitters_directly", emitters_directly),
        ("emitters_by_chance", emitters_by_chance),
        ("sun", sun),
        ("image", image),
        ("opacity", opacity),
        ("translucent_glass", translucent_glass),
        ("coincident_emitters", coincident_emitters),
        ("own_colors", own_colors),
        ("from_inside", from_inside),
        ("many", many),
        ("tiny", || scaled(1e-4, DVec3::ZERO)),
        ("huge", || scaled(1e6, DVec3::ZERO)),
        ("far_from_the_origin", || scaled(1.0, DVec3::new(3e5, -2e5, 1e5))),
        ("small_spheres_far_away", small_and_far),
        ("a_planet", planet),
    ]
}

/// All, and one more in which faults are visible.
pub(crate) fn of_faults() -> Vec<Named> {
    [all(), vec![("image_over_ground", image_over_ground)]].concat()
}

pub(crate) fn gray(level: f32) -> LinearRgb {
    LinearRgb::new([level; 3]).unwrap()
}

fn rgb(r: f32, g: f32, b: f32) -> LinearRgb {
    LinearRgb::new([r, g, b]).unwrap()
}

fn ball(center: [f64; 3], radius: f64, color: LinearRgb) -> Sphere {
    Sphere::new(center, radius, color)
}

fn lobe(specular: f32, roughness: f32) -> Material {
    Material::Lambert { specular, roughness }
}

fn metal(roughness: f32) -> Material {
    Material::Conductor { roughness }
}

fn glass_of(ior: f32, roughness: f32, attenuation_distance: Option<f32>) -> Material {
    Material::Dielectric { ior, roughness, attenuation_distance }
}

fn light(kind: LightKind) -> Light {
    Light { kind, frame: LightFrame::World }
}

fn directional(angular_radius: f64) -> LightKind {
    let toward = DVec3::new(-0.5, 0.9, 0.4);
    LightKind::Directional { toward, strength: rgb(1.0, 0.9, 0.7), angular_radius }
}

fn sky() -> Sky {
    let gradient = SkyLight::Gradient {
        zenith: rgb(0.3, 0.5, 0.9),
        horizon: gray(0.8),
        nadir: rgb(0.2, 0.15, 0.1),
    };
    Sky { light: gradient, is_visible: true }
}

fn no_sky() -> Sky {
    Sky { light: SkyLight::Constant(LinearRgb::BLACK), is_visible: false }
}

fn ground(y: f64) -> Ground {
    Ground {
        point: DVec3::new(0.3, y, 0.1),
        normal: DVec3::new(0.05, 1.0, 0.02),
        color: rgb(0.6, 0.5, 0.4),
        is_shadow_catcher: false,
    }
}

fn lighting(lights: Vec<Light>, sky: Sky, light_sampling: LightSampling) -> RenderSettings {
    RenderSettings {
        integrator: Integrator::Path(PathTracing {
            max_depth: 6,
            roulette_from: 2,
            light_sampling,
        }),
        sampling: Sampling { samples: 2, seed: 7, ..Sampling::default() },
        lights,
        sky,
        ground: None,
        background: rgb(0.1, 0.2, 0.3),
        is_transparent: false,
        ..RenderSettings::studio()
    }
}

fn camera(eye: [f64; 3], look_at: [f64; 3]) -> PinholeCamera {
    let pose = Pose::looking_at(eye, look_at, [0.1, 1.0, 0.0]).unwrap();
    PinholeCamera::with_vertical_fov(pose, f64::to_radians(40.0), 1.2).unwrap()
}

fn view(spheres: &[Sphere], settings: RenderSettings) -> LitView {
    LitView {
        scene: Scene::new(spheres).unwrap(),
        camera: Box::new(camera([0.5, 1.5, 7.0], [0.0, 0.0, 0.0])),
        film: Film::new(48, 40).unwrap(),
        settings,
    }
}

/// Nine spheres in a square, with the material of each.
fn grid(material: impl Fn(usize) -> Material) -> Vec<Sphere> {
    (0..9)
        .map(|i| {
            let (x, y) = (i % 3, i / 3);
            let center = [x as f64 * 1.5 - 1.5, y as f64 * 1.5 - 1.5, (i % 2) as f64 * 0.4];
            let level = |k: usize| ((i * k) % 7 + 2) as f32 / 9.0;
            ball(center, 0.7, rgb(level(1), level(3), level(5))).with_material(material(i))
        })
        .collect()
}

pub(crate) fn matt() -> LitView {
    let lights = vec![
        light(directional(0.0)),
        light(LightKind::Point {
            position: DVec3::new(2.0, 3.0, 4.0),
            intensity: rgb(9.0, 8.0, 7.0),
        }),
    ];
    let lit = lighting(lights, sky(), LightSampling::Multiple);
    view(&grid(|_| Material::default()), RenderSettings { ground: Some(ground(-2.4)), ..lit })
}

pub(crate) fn lobes() -> LitView {
    let lights = vec![
        light(LightKind::Head { strength: gray(0.4) }),
        light(LightKind::Sphere {
            center: DVec3::new(-3.0, 4.0, 3.0),
            radius: 0.8,
            radiance: rgb(12.0, 11.0, 9.0),
        }),
    ];
    let lit = lighting(lights, sky(), LightSampling::Multiple);
    let material = |i| lobe(0.1 + 0.1 * i as f32, 0.05 + 0.1 * i as f32);
    let pinhole = camera([0.5, 1.5, 7.0], [0.0, 0.0, 0.0]);
    let lens = ThinLensCamera::new(pinhole, 0.05, 7.0).unwrap();
    LitView { camera: Box::new(lens), ..view(&grid(material), lit) }
}

pub(crate) fn metals() -> LitView {
    let lit = lighting(vec![light(directional(0.02))], sky(), LightSampling::Multiple);
    let material = |i| metal(if i == 0 { 0.02 } else { 0.11 * i as f32 });
    view(&grid(material), RenderSettings { ground: Some(ground(-2.4)), ..lit })
}

pub(crate) fn glass() -> LitView {
    let lit = lighting(vec![light(directional(0.0))], sky(), LightSampling::Multiple);
    let material = |i| match i % 3 {
        0 => glass_of(1.5, 0.0, Some(0.8)),
        1 => glass_of(1.33, 0.1 * i as f32, Some(2.0)),
        _ => glass_of(2.2, 0.02, None),
    };
    let mut spheres = grid(material);
    // One more sphere is inside another, and one is behind all others.
    spheres.push(ball([-1.5, -1.5, 0.0], 0.3, rgb(0.9, 0.3, 0.2)));
    spheres.push(ball([0.0, 0.0, -4.0], 2.5, rgb(0.7, 0.7, 0.2)));
    view(&spheres, lit)
}

fn lamps() -> Vec<Sphere> {
    let mut spheres = grid(|i| match i {
        0 | 4 => Material::Emissive { strength: 1.0 + i as f32 },
        1 => metal(0.3),
        2 => lobe(0.5, 0.2),
        3 => glass_of(1.5, 0.0, None),
        _ => Material::default(),
    });
    spheres[8] = spheres[8].with_material(Material::Emissive { strength: 30.0 });
    spheres[8].radius = 0.05;
    spheres
}

fn with_lamps(sampling: LightSampling) -> LitView {
    let lit = lighting(Vec::new(), no_sky(), sampling);
    view(&lamps(), RenderSettings { ground: Some(ground(-2.4)), ..lit })
}

pub(crate) fn emitters() -> LitView {
    with_lamps(LightSampling::Multiple)
}

pub(crate) fn emitters_directly() -> LitView {
    with_lamps(LightSampling::Direct)
}

fn emitters_by_chance() -> LitView {
    with_lamps(LightSampling::Chance)
}

pub(crate) fn sun() -> LitView {
    let lit = lighting(vec![light(directional(0.3))], sky(), LightSampling::Multiple);
    let lit = RenderSettings { ground: Some(ground(-2.4)), ..lit };
    view(&grid(|i| if i % 2 == 0 { metal(0.2) } else { lobe(0.3, 0.3) }), lit)
}

fn map() -> Arc<Environment> {
    let texels = (0..16 * 8)
        .map(|i| {
            let level = |k: usize| ((i * k) % 11) as f32 / 11.0;
            let bright = if i == 37 { 20.0 } else { 0.0 };
            [level(3) + bright, level(5) + bright, level(7)]
        })
        .collect();
    Arc::new(Environment::new(16, 8, texels).unwrap())
}

pub(crate) fn image() -> LitView {
    let image = SkyLight::Image { environment: map(), strength: 0.7, rotation: 0.6 };
    let sky = Sky { light: image, is_visible: true };
    let lit = lighting(Vec::new(), sky, LightSampling::Multiple);
    view(&grid(|i| if i % 2 == 0 { metal(0.4) } else { Material::default() }), lit)
}

pub(crate) fn image_over_ground() -> LitView {
    let view = image();
    LitView { settings: RenderSettings { ground: Some(ground(-2.4)), ..view.settings }, ..view }
}

pub(crate) fn opacity() -> LitView {
    let lit = lighting(vec![light(directional(0.0))], sky(), LightSampling::Multiple);
    let spheres: Vec<_> = grid(|i| if i == 4 { glass_of(1.5, 0.0, None) } else { lobe(0.2, 0.4) })
        .into_iter()
        .enumerate()
        .map(|(i, sphere)| sphere.with_opacity(i as f32 / 8.0))
        .collect();
    view(&spheres, RenderSettings { is_transparent: true, ground: Some(ground(-2.4)), ..lit })
}

/// Tinted glass that some paths pass through as if it were not there, with spheres inside.
pub(crate) fn translucent_glass() -> LitView {
    let view = glass();
    let spheres: Vec<_> = grid(|i| glass_of(1.5, 0.2 * (i % 2) as f32, Some(0.7)))
        .into_iter()
        .chain([ball([0.0, 0.0, 0.0], 0.3, rgb(0.9, 0.3, 0.2))])
        .map(|sphere| sphere.with_opacity(0.6))
        .collect();
    LitView { scene: Scene::new(&spheres).unwrap(), ..view }
}

/// Emitters at the same position as other spheres. If the other sphere comes first, the emitter is never hit and never
/// sampled.
pub(crate) fn coincident_emitters() -> LitView {
    let mut spheres = lamps();
    let emissive = |strength| Material::Emissive { strength };
    let twin = |i: usize| ball(spheres[i].center, spheres[i].radius, rgb(0.3, 0.9, 0.5));
    let copies = [
        // Copies of a matt sphere and of an emitter.
        twin(3).with_material(emissive(4.0)),
        twin(4).with_material(emissive(7.0)),
        // A matt sphere at the position of an emitter.
        twin(0),
    ];
    spheres.splice(0..0, [twin(7).with_material(emissive(2.0)), twin(2).with_opacity(0.0)]);
    spheres.extend(copies);
    LitView { scene: Scene::new(&spheres).unwrap(), ..emitters() }
}

/// Spheres with individual colours and alphas, and one of several surfaces each.
pub(crate) fn own_colors() -> LitView {
    let spheres = mixed();
    let colors: Vec<[u8; 4]> = (0..spheres.len() as u8)
        .map(|i| [60 + 20 * i, 200 - 15 * i, 30 + 9 * i, if i % 4 == 2 { 100 + i } else { 255 }])
        .collect();
    let tinted = glass_of(1.5, 0.0, Some(0.8));
    let surfaces = spheres.iter().map(|sphere| match sphere.surface.material {
        Material::Dielectric { .. } => SurfaceProperties { material: tinted, ..sphere.surface },
        _ => sphere.surface,
    });
    let indices = (0..spheres.len() as u32).collect();
    let appearance = Appearance::from(colors).with_surfaces(surfaces.collect(), indices);
    let points = spheres.iter().map(|s| [s.center[0], s.center[1], s.center[2], s.radius]);
    let scene = Scene::from_parts(SphereArray::F64(points.collect()), appearance).unwrap();
    LitView { scene, ..everything() }
}

pub(crate) fn from_inside() -> LitView {
    // The light of the sun does not reach the inside.
    let sun = vec![light(directional(0.0))];
    let lit = lighting(sun, no_sky(), LightSampling::Multiple);
    let mut spheres = lamps();
    spheres.push(ball([0.0, 0.0, 0.0], 9.0, gray(0.8)));
    let pose = Pose::looking_at([0.5, 1.5, 5.0], [0.0; 3], [0.1, 1.0, 0.0]).unwrap();
    LitView { camera: Box::new(PanoramaCamera::new(pose)), ..view(&spheres, lit) }
}

/// So many spheres that a structure is built.
pub(crate) fn many() -> LitView {
    let mut random = fastrand::Rng::with_seed(5);
    let spheres: Vec<_> = (0..300)
        .map(|i| {
            let center = [0; 3].map(|_| random.f64() * 4.0 - 2.0);
            let color = rgb(random.f32() * 0.9, random.f32() * 0.9, random.f32() * 0.9);
            let material = match i % 6 {
                0 => metal(0.3),
                1 => lobe(0.4, 0.2),
                2 => glass_of(1.5, 0.0, Some(0.5)),
                3 => Material::Emissive { strength: 2.0 },
                _ => Material::default(),
            };
            ball(center, 0.08 + 0.12 * random.f64(), color).with_material(material)
        })
        .collect();
    let lit = lighting(vec![light(directional(0.1))], sky(), LightSampling::Multiple);
    view(&spheres, RenderSettings { ground: Some(ground(-2.4)), ..lit })
}

/// Many spheres with three copies of each, which have different appearances.
pub(crate) fn thrice() -> LitView {
    let LitView { scene, .. } = many();
    let count = scene.len() as u32;
    let origin = scene.origin();
    let of = |id: u32, moved: u32| {
        let [x, y, z, radius] = scene.spheres()[id as usize].map(f64::from);
        let surface = scene.surface((id + moved) % count);
        let center = (DVec3::new(x, y, z) + origin).to_array();
        ball(center, radius, scene.color((id + moved) % count))
            .with_material(surface.material)
            .with_opacity(surface.opacity)
    };
    let spheres: Vec<Sphere> = (0..3)
        .flat_map(|copy| (0..count).map(move |id| (id, copy)))
        .map(|(id, copy)| of(id, copy))
        .collect();
    LitView { scene: Scene::new(&spheres).unwrap(), ..many() }
}

pub(crate) fn mixed() -> Vec<Sphere> {
    let mut spheres = lamps();
    spheres[5] = spheres[5].with_material(glass_of(1.4, 0.2, None));
    spheres[6] = spheres[6].with_opacity(0.5);
    spheres
}

/// All materials, a light, a sky and ground.
pub(crate) fn everything() -> LitView {
    scaled(1.0, DVec3::ZERO)
}

fn scaled(scale: f64, moved: DVec3) -> LitView {
    let place = |v: DVec3| scale * v + moved;
    let spheres: Vec<_> = mixed()
        .into_iter()
        .map(|mut sphere| {
            sphere.center = place(DVec3::from(sphere.center)).to_array();
            sphere.radius *= scale;
            sphere
        })
        .collect();
    let lights = vec![light(LightKind::Point {
        position: place(DVec3::new(2.0, 3.0, 4.0)),
        intensity: gray(9.0 * (scale * scale) as f32),
    })];
    let lit = lighting(lights, sky(), LightSampling::Multiple);
    let below = Ground { point: place(ground(-2.4).point), ..ground(0.0) };
    let eye = place(DVec3::new(0.5, 1.5, 7.0)).to_array();
    LitView {
        camera: Box::new(camera(eye, place(DVec3::ZERO).to_array())),
        ..view(&spheres, RenderSettings { ground: Some(below), ..lit })
    }
}

fn small_and_far() -> LitView {
    let mut spheres = mixed();
    for (i, sphere) in spheres.iter_mut().enumerate() {
        sphere.radius *= [1.0, 1e-1, 1e-2][i % 3];
    }
    let small = ball([0.0, 0.0, 1.0], 1e-4, gray(0.9));
    spheres.push(small);
    let lit = lighting(vec![light(directional(0.0))], sky(), LightSampling::Multiple);
    let pose = Pose::looking_at([50.0, 150.0, 700.0], [0.0; 3], [0.1, 1.0, 0.0]).unwrap();
    let far = PinholeCamera::with_vertical_fov(pose, f64::to_radians(0.4), 1.2).unwrap();
    LitView { camera: Box::new(far), ..view(&spheres, lit) }
}

/// A sphere so large that its rounding errors exceed the size of the spheres on it.
fn planet() -> LitView {
    let mut spheres = mixed();
    spheres.push(ball([0.0, -1e4 - 2.3, 0.0], 1e4, rgb(0.5, 0.6, 0.4)));
    view(&spheres, lighting(vec![light(directional(0.0))], sky(), LightSampling::Multiple))
}
