//! Small studios. Each contains something that makes one kind of fault visible.

use pinhole::camera::{PinholeCamera, Pose};
use pinhole::glam::DVec3;
use pinhole::light::{Ground, Light, LightFrame, LightKind};
use pinhole::render::{DepthCue, Integrator, Occlusion, RenderSettings, Sampling, Studio};
use pinhole::scene::material::Material;
use pinhole::{Film, LinearRgb, Scene, Sphere};

use crate::light::scenes::LitView;

type Named = (&'static str, fn() -> LitView);

pub(crate) const ALL: &[Named] = &[
    ("lamps_of_all_kinds", lamps),
    ("translucent", translucent),
    ("catcher", catcher),
    ("more_lights_than_bits", more_lights),
    ("more_directions_than_bits", more_directions),
    ("emitters_and_fog", fog),
    ("without_shadows", without_shadows),
    ("sharp_shadows", sharp),
    ("few_surfaces", few_surfaces),
    ("enclosed", enclosed),
];

fn rgb(r: f32, g: f32, b: f32) -> LinearRgb {
    LinearRgb::new([r, g, b]).unwrap()
}

fn world(kind: LightKind) -> Light {
    Light { kind, frame: LightFrame::World }
}

fn sun(angular_radius: f64) -> Light {
    let toward = DVec3::new(-0.5, 0.9, 0.4);
    world(LightKind::Directional { toward, strength: rgb(1.0, 0.9, 0.7), angular_radius })
}

fn point() -> Light {
    let position = DVec3::new(2.0, 3.0, 4.0);
    world(LightKind::Point { position, intensity: rgb(9.0, 8.0, 7.0) })
}

fn ball() -> Light {
    let center = DVec3::new(-2.0, 2.5, 2.0);
    world(LightKind::Sphere { center, radius: 0.6, radiance: rgb(4.0, 5.0, 6.0) })
}

/// A light below the ground, which hides it.
fn below() -> Light {
    let position = DVec3::new(0.5, -6.0, 3.0);
    world(LightKind::Point { position, intensity: rgb(9.0, 9.0, 9.0) })
}

fn head() -> Light {
    let kind = LightKind::Head { strength: rgb(0.2, 0.3, 0.1) };
    Light { kind, frame: LightFrame::Camera }
}

fn ground(is_shadow_catcher: bool) -> Ground {
    Ground {
        point: DVec3::new(0.3, -2.3, 0.1),
        normal: DVec3::new(0.05, 1.0, 0.02),
        color: rgb(0.6, 0.5, 0.4),
        is_shadow_catcher,
    }
}

/// Nine spheres in a square, of different colours, some of which have a lobe.
pub(crate) fn grid() -> Vec<Sphere> {
    (0..9)
        .map(|i| {
            let (x, y) = (i % 3, i / 3);
            let center = [x as f64 * 1.5 - 1.5, y as f64 * 1.5 - 1.5, (i % 2) as f64 * 0.4];
            let level = |k: usize| ((i * k) % 7 + 2) as f32 / 9.0;
            let specular = if i % 3 == 1 { 0.4 } else { 0.0 };
            Sphere::new(center, 0.7, rgb(level(1), level(3), level(5)))
                .with_material(Material::Lambert { specular, roughness: 0.5 })
        })
        .collect()
}

fn settings(studio: Studio, lights: Vec<Light>) -> RenderSettings {
    RenderSettings {
        integrator: Integrator::Studio(studio),
        sampling: Sampling { samples: 64, seed: 11, ..Sampling::default() },
        lights,
        ground: Some(ground(false)),
        background: rgb(0.1, 0.2, 0.3),
        is_transparent: false,
        ..RenderSettings::studio()
    }
}

fn view(spheres: &[Sphere], settings: RenderSettings) -> LitView {
    let pose = Pose::looking_at([0.5, 1.5, 7.0], [0.0; 3], [0.1, 1.0, 0.0]).unwrap();
    LitView {
        scene: Scene::new(spheres).unwrap(),
        camera: Box::new(PinholeCamera::with_vertical_fov(pose, 0.7, 1.2).unwrap()),
        film: Film::new(48, 40).unwrap(),
        settings,
    }
}

fn occluded(radius: f64, samples: u32) -> Studio {
    let occlusion = Some(Occlusion { radius: Some(radius), samples });
    Studio { occlusion, ..Studio::default() }
}

pub(crate) fn lamps() -> LitView {
    let lights = vec![head(), sun(0.0), sun(0.1), point(), ball()];
    view(&grid(), settings(occluded(1.2, 3), lights))
}

pub(crate) fn without_shadows() -> LitView {
    let studio = Studio { has_shadows: false, ..Studio::default() };
    view(&grid(), settings(studio, vec![sun(0.0), point()]))
}

/// Lights whose shadows are the only thing that is searched for.
pub(crate) fn sharp() -> LitView {
    view(&grid(), settings(Studio::default(), vec![sun(0.0), point(), ball(), below()]))
}

/// Half the spheres are translucent, and two of them hold others.
pub(crate) fn translucent_spheres() -> Vec<Sphere> {
    let spheres = grid().into_iter().zip([0.5, 1.0, 0.7, 1.0, 0.3]);
    let mut spheres: Vec<Sphere> =
        spheres.map(|(sphere, opacity)| sphere.with_opacity(opacity)).collect();
    spheres.extend(grid().into_iter().skip(5));
    spheres.push(Sphere::new([-1.5, -1.5, 0.0], 0.4, rgb(0.9, 0.3, 0.2)));
    spheres.push(Sphere::new([0.0, 0.0, 0.4], 1.1, rgb(0.2, 0.5, 0.9)).with_opacity(0.25));
    spheres
}

pub(crate) fn translucent() -> LitView {
    let cue = DepthCue { near: 5.0, far: 10.0, color: rgb(0.3, 0.1, 0.2) };
    let studio = Studio { max_surfaces: 5, depth_cue: Some(cue), ..occluded(0.8, 2) };
    view(&translucent_spheres(), settings(studio, vec![sun(0.05), point(), head()]))
}

/// Translucent spheres of which only the first two surfaces are seen.
pub(crate) fn few_surfaces() -> LitView {
    let studio = Studio { max_surfaces: 2, ..Studio::default() };
    view(&translucent_spheres(), settings(studio, vec![sun(0.0)]))
}

pub(crate) fn catcher() -> LitView {
    let lights = vec![sun(0.05), point(), ball(), head()];
    let mut settings = settings(occluded(2.5, 4), lights);
    settings.ground = Some(ground(true));
    view(&grid(), settings)
}

/// More lights than a word has bits, of which some are at the eye.
pub(crate) fn more_lights() -> LitView {
    let light = |i: usize| {
        if i % 5 == 3 {
            return head();
        }
        let angle = i as f64 * 0.7;
        let toward = DVec3::new(angle.cos(), 0.4 + 0.02 * i as f64, angle.sin());
        let strength = rgb(0.05, 0.04, 0.03 + 0.001 * i as f32);
        world(LightKind::Directional { toward, strength, angular_radius: 0.0 })
    };
    view(&grid(), settings(Studio::default(), (0..37).map(light).collect()))
}

pub(crate) fn more_directions() -> LitView {
    view(&grid(), settings(occluded(1.5, 37), vec![sun(0.0)]))
}

/// A sphere that shines, others in fog, and the eye in a large opaque one.
pub(crate) fn fog() -> LitView {
    let mut spheres = grid();
    spheres[4] = spheres[4].with_material(Material::Emissive { strength: 3.0 });
    spheres.push(Sphere::new([0.2, 0.1, -0.3], 12.0, rgb(0.5, 0.4, 0.6)));
    let cue = DepthCue { near: 4.0, far: 14.0, color: rgb(0.4, 0.5, 0.6) };
    let studio = Studio { depth_cue: Some(cue), ..occluded(1.0, 3) };
    let mut settings = settings(studio, vec![point(), ball(), head()]);
    settings.ground = None;
    view(&spheres, settings)
}

/// The eye, spheres and lights in a large opaque sphere.
pub(crate) fn enclosed() -> LitView {
    let mut spheres = grid();
    spheres.push(Sphere::new([0.2, 0.1, -0.3], 12.0, rgb(0.5, 0.4, 0.6)));
    let mut settings = settings(Studio::default(), vec![point(), ball(), sun(0.0)]);
    settings.ground = None;
    view(&spheres, settings)
}

/// So many spheres that there is a structure.
pub(crate) fn many() -> LitView {
    let spheres: Vec<Sphere> = (0..300)
        .map(|i| {
            let place = |k: u32| f64::from(i * k % 97) / 97.0 * 4.0 - 2.0;
            let color = rgb(0.2 + (i % 5) as f32 * 0.1, 0.5, 0.3 + (i % 7) as f32 * 0.1);
            Sphere::new([place(31), place(57), place(73)], 0.12 + f64::from(i % 4) * 0.03, color)
        })
        .collect();
    view(&spheres, settings(occluded(0.6, 2), vec![sun(0.0), point()]))
}
