//! Random lit scenes: all kinds of materials, lights, skies, grounds and cameras, coincident spheres, eyes inside
//! spheres, and in two of five scenes cones and cylinders. The same seed gives the same scene.

use std::f64::consts::TAU;
use std::sync::Arc;

use fastrand::Rng;
use pinhole::camera::{Camera, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::glam::DVec3;
use pinhole::light::environment::Environment;
use pinhole::light::{Ground, Light, LightFrame, LightKind, Sky, SkyLight};
use pinhole::render::{DepthCue, Integrator, LightSampling, Occlusion, PathTracing, Sampling, Studio};
use pinhole::scene::cone::{Caps, Cone};
use pinhole::{
    Appearance, ColorMap, Colors, Film, LinearRgb, Material, PixelFilter, RenderSettings, Scene, Sphere, SphereArray,
    SurfaceProperties,
};

/// A scene, its lighting and view, and a description of it in words.
pub(crate) struct RandomView {
    pub(crate) scene: Scene,
    pub(crate) camera: Box<dyn Camera>,
    pub(crate) film: Film,
    pub(crate) settings: RenderSettings,
    pub(crate) name: String,
}

/// The view of a seed, with the path integrator.
pub(crate) fn view(seed: u64) -> RandomView {
    view_with(seed, Random::settings)
}

/// The view of a seed, with the studio integrator.
pub(crate) fn studio(seed: u64) -> RandomView {
    view_with(seed, Random::studio)
}

fn view_with(seed: u64, settings: fn(&mut Random) -> RenderSettings) -> RandomView {
    let mut random = Random(Rng::with_seed(seed));
    let spheres = random.spheres();
    let (camera, camera_name) = random.camera(&spheres);
    let settings = settings(&mut random);
    let mut of_cones = Random(Rng::with_seed(!seed));
    let cones = if of_cones.chance(0.4) { of_cones.cones(&spheres) } else { Vec::new() };
    let name = format!(
        "{} spheres, {} cones, {camera_name}, {} lights, {}",
        spheres.len(),
        cones.len(),
        settings.lights.len(),
        match settings.sky.light {
            SkyLight::Constant(_) => "a constant sky",
            SkyLight::Gradient { .. } => "a gradient",
            SkyLight::Image { .. } => "an image",
            #[allow(unreachable_patterns, reason = "from inside of the crate there is no other")]
            _ => "another sky",
        }
    );
    let scene = random.scene(&spheres, &cones);
    RandomView { scene, camera, film: Film::new(24, 18).unwrap(), settings, name }
}

/// Half the side of the cube that contains all centres.
const SIDE: f64 = 2.0;

/// The colour and the surface of a shape.
#[derive(Clone, Copy)]
struct Look {
    color: LinearRgb,
    surface: SurfaceProperties,
}

struct Random(Rng);

impl Random {
    fn chance(&mut self, probability: f64) -> bool {
        self.0.f64() < probability
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.f64()
    }

    fn point(&mut self, half: f64) -> DVec3 {
        DVec3::from([0; 3].map(|_| self.between(-half, half)))
    }

    /// A random direction of random length, never zero.
    fn direction(&mut self) -> DVec3 {
        let [longitude, y] = [self.between(0.0, TAU), self.between(-0.95, 0.95)];
        let across = (1.0 - y * y).sqrt();
        let length = self.between(0.1, 3.0);
        DVec3::new(across * longitude.cos(), y, across * longitude.sin()) * length
    }

    /// A random colour with components up to `most`. Some of them are zero or `most`.
    fn color(&mut self, most: f32) -> LinearRgb {
        let component = |random: &mut Self| match random.0.u32(0..12) {
            0 => 0.0,
            1 => most,
            _ => random.0.f32() * most,
        };
        LinearRgb::new([0; 3].map(|_| component(self))).unwrap()
    }

    fn roughness(&mut self) -> f32 {
        if self.chance(0.2) { 0.02 } else { 0.02 + 0.98 * self.0.f32() }
    }

    fn material(&mut self, is_matt: bool) -> Material {
        if is_matt {
            let roughness = self.roughness();
            return if self.chance(0.2) {
                Material::Emissive { strength: 6.0 * self.0.f32() }
            } else {
                Material::Lambert { specular: 0.0, roughness }
            };
        }
        match self.0.u32(0..8) {
            0 => Material::default(),
            1 | 2 => Material::Lambert { specular: self.0.f32(), roughness: self.roughness() },
            3 => Material::Conductor { roughness: self.roughness() },
            4 => Material::Emissive { strength: 10.0 * self.0.f32() },
            _ => Material::Dielectric {
                ior: 1.0 + 1.5 * self.0.f32(),
                roughness: if self.chance(0.5) { 0.0 } else { self.roughness() },
                attenuation_distance: self.chance(0.6).then(|| 0.1 + 3.0 * self.0.f32()),
            },
        }
    }

    fn opacity(&mut self, share: f64) -> f32 {
        match (self.chance(share), self.0.u32(0..4)) {
            (false, _) => 1.0,
            (true, 0) => 0.0,
            (true, _) => self.0.f32(),
        }
    }

    /// A scene of the shapes with their own colours, with bytes and alpha instead, or with numbers and a colour map.
    fn scene(&mut self, spheres: &[Sphere], cones: &[(Cone, Look)]) -> Scene {
        let of_spheres = spheres.iter().map(|sphere| Look { color: sphere.color, surface: sphere.surface });
        let looks: Vec<Look> = of_spheres.chain(cones.iter().map(|(_, look)| *look)).collect();
        let colors = match self.0.u32(0..3) {
            0 if cones.is_empty() => return Scene::new(spheres).unwrap(),
            0 | 1 => {
                let share = if self.chance(0.5) { 0.4 } else { 0.0 };
                let color = |look: &Look| {
                    let [r, g, b] = look.color.to_srgb8();
                    [r, g, b, if self.chance(share) { self.0.u8(..) } else { 255 }]
                };
                Colors::Rgba8(looks.iter().map(color).collect())
            }
            _ => {
                let table = (0..self.0.usize(1..9)).map(|_| self.color(1.0)).collect();
                let map = ColorMap::new(table, [-1.0, 2.0]).unwrap();
                let values = looks.iter().map(|_| 4.0 * self.0.f32() - 1.5).collect();
                Colors::Scalars { values, map }
            }
        };
        let surfaces = looks.iter().map(|look| look.surface).collect();
        let appearance = Appearance::new(colors).with_surfaces(surfaces, (0..looks.len() as u32).collect());
        let points = spheres.iter().map(|s| [s.center[0], s.center[1], s.center[2], s.radius]);
        let cones: Vec<Cone> = cones.iter().map(|(cone, _)| *cone).collect();
        Scene::from_shapes(SphereArray::F64(points.collect()), &cones, appearance).unwrap()
    }

    /// Cones and cylinders with all kinds of ends: some equal to another or inside of it, some between two spheres, some
    /// along an axis, needles, discs and tips.
    fn cones(&mut self, spheres: &[Sphere]) -> Vec<(Cone, Look)> {
        let count = if self.chance(0.15) { self.0.usize(40..120) } else { self.0.usize(1..12) };
        let is_matt = self.chance(0.2);
        let translucent = if self.chance(0.6) { 0.5 } else { 0.0 };
        let largest = 1.0 / (count as f64).cbrt();
        let mut cones: Vec<(Cone, Look)> = Vec::new();
        while cones.len() < count {
            let start = self.point(SIDE);
            let (radius, away) = (self.between(0.05, 0.6) * largest, self.direction() * largest);
            let mut cone = Cone::new(start.to_array(), (start + away).to_array(), [radius, radius]);
            match self.0.u32(0..8) {
                0 => cone.radii[1] = 0.0,
                1 => cone.radii[1] = self.between(0.05, 0.6) * largest,
                2 => cone.radii = [1e-3 * away.length(); 2],
                3 => cone.end[self.0.usize(0..3)] += 3.0 * largest,
                4 => cone.end = (start + 1e-3 * away).to_array(),
                5 => {
                    let [one, other] = [0; 2].map(|_| spheres[self.0.usize(0..spheres.len())]);
                    if DVec3::from(one.center).distance(DVec3::from(other.center)) > 0.0 {
                        (cone.start, cone.end) = (one.center, other.center);
                    }
                }
                6 if !cones.is_empty() => {
                    cone = cones[self.0.usize(0..cones.len())].0;
                    if self.chance(0.5) {
                        cone.radii = cone.radii.map(|radius| 0.7 * radius);
                    }
                }
                _ => {}
            }
            let material = match self.material(is_matt) {
                Material::Emissive { .. } => Material::default(),
                material => material,
            };
            let surface = SurfaceProperties { material, opacity: self.opacity(translucent) };
            let caps = [Caps::Both, Caps::Both, Caps::None, Caps::First, Caps::Second][self.0.usize(0..5)];
            cones.push((cone.with_caps(caps), Look { color: self.color(1.0), surface }));
        }
        cones
    }

    fn spheres(&mut self) -> Vec<Sphere> {
        let is_matt = self.chance(0.2);
        // Either so many spheres that there is a structure, or few.
        let count = if self.chance(0.15) { self.0.usize(40..120) } else { self.0.usize(1..24) };
        let [translucent, coincident] = [0.5, 0.4].map(|share| {
            let is_any = self.chance(0.6);
            if is_any { share } else { 0.0 }
        });
        let largest = 1.6 / (count as f64).cbrt();
        let mut spheres: Vec<Sphere> = Vec::new();
        while spheres.len() < count {
            let mut sphere =
                Sphere::new(self.point(SIDE).to_array(), self.between(0.05, 1.0) * largest, self.color(1.0));
            if !spheres.is_empty() && self.chance(coincident) {
                // Coincides with another sphere: equal, with another surface, inside it, or around it.
                let other = spheres[self.0.usize(0..spheres.len())];
                match self.0.u32(0..4) {
                    0 => {
                        spheres.push(other);
                        continue;
                    }
                    1 | 2 => (sphere.center, sphere.radius) = (other.center, other.radius),
                    _ => sphere.center = other.center,
                }
            }
            let material = self.material(is_matt);
            spheres.push(sphere.with_material(material).with_opacity(self.opacity(translucent)));
        }
        if self.chance(0.12) {
            let around = Sphere::new([0.3, -0.2, 0.1], 9.0, self.color(1.0));
            let material = self.material(is_matt);
            spheres.push(around.with_material(material).with_opacity(self.opacity(translucent)));
        }
        spheres
    }

    fn camera(&mut self, spheres: &[Sphere]) -> (Box<dyn Camera>, String) {
        let sphere = spheres[self.0.usize(0..spheres.len())];
        let is_inside = self.chance(0.25);
        let eye = if is_inside {
            let within = self.direction().normalize_or_zero() * self.between(0.0, 0.9) * sphere.radius;
            DVec3::from(sphere.center) + within
        } else {
            let away = self.between(4.0, 9.0);
            self.direction().normalize_or_zero() * away
        };
        let pose = Pose::looking_at(eye, self.point(0.7), [0.1, 1.0, 0.2]).unwrap();
        let fov = self.between(0.4, 1.2);
        let pinhole = PinholeCamera::with_vertical_fov(pose, fov, 4.0 / 3.0).unwrap();
        let (camera, name): (Box<dyn Camera>, _) = match self.0.u32(0..6) {
            0 | 1 => (Box::new(pinhole), "pinhole"),
            2 => (Box::new(OrthographicCamera::new(pose, [2.4, 1.8]).unwrap()), "orthographic"),
            3 => {
                let focus = self.between(0.5, 8.0);
                let lens = ThinLensCamera::new(pinhole, self.between(0.0, 0.3), focus);
                (Box::new(lens.unwrap()), "thin lens")
            }
            4 => (Box::new(PanoramaCamera::new(pose)), "panorama"),
            _ => {
                let angle = self.between(1.0, 6.0);
                (Box::new(FisheyeCamera::new(pose, angle, 4.0 / 3.0).unwrap()), "fisheye")
            }
        };
        (camera, format!("{name}{}", if is_inside { " in a sphere" } else { "" }))
    }

    fn light(&mut self) -> Light {
        let color = self.color(2.0);
        let place = self.direction().normalize_or_zero() * self.between(1.0, 6.0);
        let kind = match self.0.u32(0..5) {
            0 => LightKind::Head { strength: color },
            1 => LightKind::Directional { toward: place, strength: color, angular_radius: 0.0 },
            2 => LightKind::Directional { toward: place, strength: color, angular_radius: self.between(0.001, 1.0) },
            3 => LightKind::Point { position: place, intensity: self.color(20.0) },
            _ => LightKind::Sphere { center: place, radius: self.between(0.05, 1.0), radiance: self.color(10.0) },
        };
        let frame = if self.chance(0.3) { LightFrame::Camera } else { LightFrame::World };
        Light { kind, frame }
    }

    fn sky(&mut self) -> Sky {
        let light = match self.0.u32(0..6) {
            0 => SkyLight::Constant(LinearRgb::BLACK),
            1 => SkyLight::Constant(self.color(1.5)),
            2 | 3 => SkyLight::Gradient { zenith: self.color(1.5), horizon: self.color(1.5), nadir: self.color(1.5) },
            _ => SkyLight::Image {
                environment: self.environment(),
                strength: if self.chance(0.1) { 0.0 } else { 2.0 * self.0.f32() },
                rotation: self.between(-7.0, 7.0),
            },
        };
        Sky { light, is_visible: self.0.bool() }
    }

    fn environment(&mut self) -> Arc<Environment> {
        let height = self.0.u32(1..12);
        let width = 2 * height;
        let is_dark = self.chance(0.1);
        let texels = (0..width * height)
            .map(|_| {
                let bright = if self.chance(0.03) { 30.0 } else { 1.0 };
                self.color(if is_dark { 0.0 } else { bright }).to_array()
            })
            .collect();
        Arc::new(Environment::new(width, height, texels).unwrap())
    }

    fn ground(&mut self) -> Ground {
        let height = if self.chance(0.7) { -2.0 } else { 0.3 };
        let normal = DVec3::Y + self.point(0.4);
        let point = self.point(0.2) + height * DVec3::Y;
        Ground { point, normal, color: self.color(1.0), is_shadow_catcher: false }
    }

    fn studio(&mut self) -> RenderSettings {
        // More lights and directions than a kernel takes at once, or fewer.
        let lights = if self.chance(0.05) { 40 } else { self.0.usize(0..5) };
        let directions = if self.chance(0.05) { 40 } else { self.0.u32(1..6) };
        let radius = self.chance(0.6).then(|| self.between(0.1, 3.0));
        let occlusion = Occlusion { radius, samples: directions };
        let near = self.between(0.0, 6.0);
        let cue = DepthCue { near, far: near + self.between(0.1, 8.0), color: self.color(1.0) };
        let mut ground = self.chance(0.5).then(|| self.ground());
        if let Some(ground) = &mut ground {
            ground.is_shadow_catcher = self.chance(0.5);
        }
        let studio = Studio {
            ambient: if self.chance(0.2) { LinearRgb::BLACK } else { self.color(1.0) },
            occlusion: self.chance(0.5).then_some(occlusion),
            shadows: self.chance(0.8),
            max_surfaces: self.0.u32(1..8),
            depth_cue: self.chance(0.4).then_some(cue),
            ..Studio::default()
        };
        let path = self.settings();
        RenderSettings {
            integrator: Integrator::Studio(studio),
            lights: (0..lights).map(|_| self.light()).collect(),
            sky: Sky::default(),
            ground,
            ..path
        }
    }

    fn settings(&mut self) -> RenderSettings {
        let lights = self.0.usize(0..4);
        let samplings = [LightSampling::Chance, LightSampling::Direct, LightSampling::Multiple];
        let filters = [PixelFilter::Box, PixelFilter::Gaussian, PixelFilter::BlackmanHarris];
        RenderSettings {
            integrator: Integrator::Path(PathTracing {
                max_depth: self.0.u32(1..8),
                roulette_from: self.0.u32(0..5),
                light_sampling: samplings[self.0.usize(0..3)],
            }),
            sampling: Sampling {
                samples: 2,
                seed: self.0.u32(..),
                filter: filters[self.0.usize(0..3)],
                denoise: false,
            },
            lights: (0..lights).map(|_| self.light()).collect(),
            sky: self.sky(),
            ground: self.chance(0.4).then(|| self.ground()),
            background: self.color(1.0),
            is_transparent: self.chance(0.3),
        }
    }
}
