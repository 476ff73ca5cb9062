//! Small lit scenes that together use every material, light, sky and kernel.

use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::glam::DVec3;
use pinhole::light::{Ground, Light, LightFrame, LightKind, Sky, SkyLight};
use pinhole::render::{
    DepthCue, Integrator, LightSampling, Occlusion, PathTracing, Sampling, Studio,
};
use pinhole::{
    Environment, Film, LinearRgb, Material, PixelFilter, RenderSettings, Scene, Sphere, View,
};

/// A scene with its view and its render settings.
pub(crate) struct LitView {
    pub(crate) scene: Scene,
    pub(crate) camera: Box<dyn Camera>,
    pub(crate) film: Film,
    pub(crate) settings: RenderSettings,
}

impl LitView {
    /// The camera and the film.
    pub(crate) fn seen(&self) -> View<'_> {
        View::new(self.camera.as_ref(), self.film)
    }
}

pub(crate) const SAMPLES: u32 = 64;

/// All scenes, with their names.
pub(crate) fn all() -> Vec<(&'static str, LitView)> {
    let mut views = studios();
    views.extend(paths());
    views
}

pub(crate) fn studios() -> Vec<(&'static str, LitView)> {
    vec![
        ("studio_key_and_fill", view(&matt(), studio(Studio::default()))),
        ("studio_ambient_occlusion", view(&matt(), studio(occluded(None)))),
        ("studio_near_occlusion", view(&shiny(), on_ground(studio(occluded(Some(0.7)))))),
        ("studio_parallel_rays", parallel(&shiny(), on_ground(studio(occluded(Some(0.7)))))),
        ("studio_sphere_light", view(&shiny(), on_ground(soft_light()))),
        ("studio_opacity", view(&clear(), on_ground(studio(occluded(Some(1.0)))))),
        ("studio_opacity_of_equals", view(&equals(), on_ground(studio(occluded(Some(1.0)))))),
        ("studio_shadow_catcher", view(&matt(), catcher())),
        ("studio_depth_cue", view(&matt(), cued())),
        ("studio_without_light", view(&matt(), dark())),
        ("studio_inside_a_sphere", view(&inside(), studio(occluded(None)))),
        ("studio_far_and_small", moved(&shiny(), on_ground(soft_light()), 1e-4, 1e6)),
    ]
}

pub(crate) fn paths() -> Vec<(&'static str, LitView)> {
    let multiple = LightSampling::Multiple;
    vec![
        ("path_matt_under_a_sky", view(&matt(), path(multiple))),
        ("path_lobes_and_metals", view(&shiny(), on_ground(path(multiple)))),
        ("path_glass", view(&glass(), on_ground(path(multiple)))),
        ("path_emissive_by_chance", view(&lamps(), on_ground(night(LightSampling::Chance)))),
        ("path_emissive_directly", view(&lamps(), on_ground(night(LightSampling::Direct)))),
        ("path_emissive_both", view(&lamps(), on_ground(night(multiple)))),
        ("path_sun_and_lamps", view(&shiny(), on_ground(sunny()))),
        ("path_sky_image", view(&shiny(), on_ground(under_image()))),
        ("path_opacity", view(&clear(), on_ground(path(multiple)))),
        ("path_clear_glass", view(&clear_glass(), on_ground(path(multiple)))),
        ("path_opacity_of_equals", view(&equals(), on_ground(path(multiple)))),
        ("path_inside_a_sphere", view(&inside(), night(multiple))),
        ("path_tiny", moved(&shiny(), path(multiple), 1e-4, 0.0)),
        ("path_huge", moved(&shiny(), path(multiple), 1e6, 0.0)),
        ("path_far_away", moved(&lamps(), night(multiple), 1.0, 1e6)),
        ("path_through_a_lens", through_a_lens()),
    ]
}

fn rgb(r: f32, g: f32, b: f32) -> LinearRgb {
    LinearRgb::new([r, g, b]).unwrap()
}

fn gray(value: f32) -> LinearRgb {
    rgb(value, value, value)
}

/// Spheres that touch, overlap or are separate, on the plane y = −1.
fn matt() -> Vec<Sphere> {
    vec![
        Sphere::new([0.0, 0.0, 0.0], 1.0, rgb(0.8, 0.3, 0.2)),
        Sphere::new([1.6, -0.3, 0.6], 0.7, rgb(0.2, 0.6, 0.8)),
        Sphere::new([-1.5, -0.2, 0.4], 0.8, gray(0.7)),
        Sphere::new([-1.2, 0.6, 0.2], 0.5, rgb(0.9, 0.8, 0.1)),
        Sphere::new([0.4, -0.6, 1.4], 0.4, rgb(0.3, 0.8, 0.3)),
        Sphere::new([-0.5, -0.75, 1.5], 0.25, gray(0.9)),
    ]
}

fn with(materials: &[Material]) -> Vec<Sphere> {
    let chosen = matt().into_iter().zip(materials.iter().cycle());
    chosen.map(|(sphere, material)| sphere.with_material(*material)).collect()
}

fn shiny() -> Vec<Sphere> {
    with(&[
        Material::Lambert { specular: 0.3, roughness: 0.4 },
        Material::Conductor { roughness: 0.3 },
        Material::Lambert { specular: 0.0, roughness: 0.3 },
        Material::Conductor { roughness: 0.7 },
    ])
}

fn glass() -> Vec<Sphere> {
    with(&[
        Material::Dielectric { ior: 1.5, roughness: 0.0, attenuation_distance: Some(2.0) },
        Material::Dielectric { ior: 1.33, roughness: 0.3, attenuation_distance: None },
        Material::default(),
    ])
}

/// Glass that is not opaque, so that some paths pass through its surface unchanged on the way in and out.
fn clear_glass() -> Vec<Sphere> {
    let tint = |ior| Material::Dielectric { ior, roughness: 0.0, attenuation_distance: Some(0.5) };
    let spheres = with(&[tint(1.5), Material::default(), tint(1.2)]);
    spheres.into_iter().map(|sphere| sphere.with_opacity(0.6)).collect()
}

fn lamps() -> Vec<Sphere> {
    let mut spheres = matt();
    spheres[4] = spheres[4].with_material(Material::Emissive { strength: 3.0 });
    spheres[5] = spheres[5].with_material(Material::Emissive { strength: 1.0 });
    spheres
}

fn clear() -> Vec<Sphere> {
    let mut spheres = matt();
    for (sphere, opacity) in spheres.iter_mut().zip([0.4, 1.0, 0.6, 1.0, 0.2]) {
        *sphere = sphere.with_opacity(opacity);
    }
    spheres
}

/// Every sphere twice: if the first copy, which is the visible one, is opaque, the second is not, and vice versa.
fn equals() -> Vec<Sphere> {
    let opposite = |sphere: &Sphere| {
        let opacity = if sphere.surface.opacity < 1.0 { 1.0 } else { 0.3 };
        Sphere::new(sphere.center, sphere.radius, gray(0.1)).with_opacity(opacity)
    };
    let mut spheres = clear();
    spheres.extend(clear().iter().map(opposite));
    spheres
}

fn inside() -> Vec<Sphere> {
    let mut spheres = lamps();
    spheres.push(Sphere::new([0.0; 3], 20.0, gray(0.5)));
    spheres
}

fn view(spheres: &[Sphere], settings: RenderSettings) -> LitView {
    let film = Film::new(48, 36).unwrap();
    let pose = Pose::looking_at([1.0, 1.5, 7.0], [0.0, -0.2, 0.3], [0.05, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::with_vertical_fov(pose, 0.6, film.aspect()).unwrap();
    LitView { scene: Scene::new(spheres).unwrap(), camera: Box::new(camera), film, settings }
}

/// The same view with parallel rays.
fn parallel(spheres: &[Sphere], settings: RenderSettings) -> LitView {
    let pose = Pose::looking_at([1.0, 1.5, 7.0], [0.0, -0.2, 0.3], [0.05, 1.0, 0.0]).unwrap();
    let camera = OrthographicCamera::new(pose, [2.8, 2.1]).unwrap();
    LitView { camera: Box::new(camera), ..view(spheres, settings) }
}

/// The same scene, scaled and moved.
fn moved(spheres: &[Sphere], mut settings: RenderSettings, scale: f64, offset: f64) -> LitView {
    let place = |[x, y, z]: [f64; 3]| [x * scale + offset, y * scale - offset, z * scale + offset];
    let spheres: Vec<Sphere> = spheres
        .iter()
        .map(|s| {
            let Sphere { center, radius, color, surface, .. } = *s;
            Sphere::new(place(center), radius * scale, color)
                .with_material(surface.material)
                .with_opacity(surface.opacity)
        })
        .collect();
    let film = Film::new(48, 36).unwrap();
    let (eye, look_at) = (place([1.0, 1.5, 7.0]), place([0.0, -0.2, 0.3]));
    let pose = Pose::looking_at(eye, look_at, [0.05, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::with_vertical_fov(pose, 0.6, film.aspect()).unwrap();
    if let Some(ground) = &mut settings.ground {
        ground.point = DVec3::from(place([0.0, -1.0, 0.0]));
    }
    for light in &mut settings.lights {
        if let LightKind::Sphere { center, radius, .. } = &mut light.kind {
            *center = DVec3::from(place(center.to_array()));
            *radius *= scale;
        }
    }
    LitView { scene: Scene::new(&spheres).unwrap(), camera: Box::new(camera), film, settings }
}

fn through_a_lens() -> LitView {
    let LitView { scene, film, settings, .. } = view(&shiny(), path(LightSampling::Multiple));
    let pose = Pose::looking_at([1.0, 1.5, 7.0], [0.0, -0.2, 0.3], [0.05, 1.0, 0.0]).unwrap();
    let pinhole = PinholeCamera::with_vertical_fov(pose, 0.6, film.aspect()).unwrap();
    let camera = ThinLensCamera::new(pinhole, 0.2, 7.0).unwrap();
    LitView { scene, camera: Box::new(camera), film, settings }
}

fn lit(integrator: Integrator, lights: Vec<Light>) -> RenderSettings {
    RenderSettings {
        integrator,
        lights,
        sampling: Sampling { samples: SAMPLES, seed: 7, filter: PixelFilter::default() },
        background: rgb(0.2, 0.3, 0.4),
        ..RenderSettings::studio()
    }
}

fn studio(studio: Studio) -> RenderSettings {
    lit(Integrator::Studio(studio), Light::key_and_fill().to_vec())
}

fn occluded(radius: Option<f64>) -> Studio {
    Studio { occlusion: Some(Occlusion { radius, samples: 3 }), ..Studio::default() }
}

fn world(kind: LightKind) -> Light {
    Light { kind, frame: LightFrame::World }
}

fn sphere_light() -> Light {
    let radiance = gray(9.0);
    world(LightKind::Sphere { center: DVec3::new(2.0, 4.0, 3.0), radius: 0.8, radiance })
}

fn soft_light() -> RenderSettings {
    let head = Light { kind: LightKind::Head { strength: gray(0.2) }, frame: LightFrame::Camera };
    lit(Integrator::Studio(Studio::default()), vec![sphere_light(), head])
}

fn on_ground(mut lighting: RenderSettings) -> RenderSettings {
    let point = DVec3::new(0.0, -1.0, 0.0);
    let color = rgb(0.6, 0.55, 0.5);
    lighting.ground = Some(Ground { point, normal: DVec3::Y, color, is_shadow_catcher: false });
    lighting
}

fn catcher() -> RenderSettings {
    let mut lighting = on_ground(studio(occluded(Some(1.0))));
    lighting.ground.as_mut().unwrap().is_shadow_catcher = true;
    lighting.is_transparent = true;
    lighting
}

fn cued() -> RenderSettings {
    let cue = DepthCue { near: 5.5, far: 8.5, color: rgb(0.2, 0.3, 0.4) };
    studio(Studio { depth_cue: Some(cue), ..Studio::default() })
}

fn dark() -> RenderSettings {
    lit(Integrator::Studio(Studio { ambient: LinearRgb::BLACK, ..Studio::default() }), Vec::new())
}

fn path(light_sampling: LightSampling) -> RenderSettings {
    let tracing = PathTracing { max_depth: 6, roulette_from: 2, light_sampling };
    lit(Integrator::Path(tracing), Vec::new())
}

/// A scene in which only spheres emit light.
fn night(light_sampling: LightSampling) -> RenderSettings {
    let mut lighting = path(light_sampling);
    lighting.sky = Sky { light: SkyLight::Constant(LinearRgb::BLACK), is_visible: true };
    lighting
}

fn sunny() -> RenderSettings {
    let mut lighting = path(LightSampling::Multiple);
    let sun = LightKind::Directional {
        toward: DVec3::new(0.5, 1.0, 0.7),
        strength: rgb(1.0, 0.9, 0.7),
        angular_radius: 0.2,
    };
    let sharp = LightKind::Directional {
        toward: DVec3::new(-1.0, 0.6, 0.5),
        strength: rgb(0.1, 0.2, 0.4),
        angular_radius: 0.0,
    };
    let point = LightKind::Point { position: DVec3::new(-2.0, 2.0, 2.0), intensity: gray(2.0) };
    let head = LightKind::Head { strength: gray(0.1) };
    lighting.lights = [sun, sharp, point, head].map(world).to_vec();
    lighting.lights.push(sphere_light());
    lighting.sky.is_visible = true;
    lighting
}

fn under_image() -> RenderSettings {
    let mut lighting = path(LightSampling::Multiple);
    // The sky is bright on one side and dim elsewhere.
    let texel = |index: usize| {
        let (i, j) = (index % 16, index / 16);
        if (9..11).contains(&i) && j == 2 {
            [12.0, 10.0, 8.0]
        } else {
            [0.1, 0.15, 0.1 + 0.02 * j as f32]
        }
    };
    let environment = Environment::new(16, 8, (0..128).map(texel).collect()).unwrap();
    let light = SkyLight::Image { environment: environment.into(), strength: 1.5, rotation: 0.4 };
    lighting.sky = Sky { light, is_visible: true };
    lighting
}
