//! Lit pictures of the CPU reference, compared with answers on paper.

mod furnace;
mod lamps;
mod leaks;
mod pixels;

use pinhole::camera::filter::PixelFilter;
use pinhole::camera::{Camera, PinholeCamera, Pose};
use pinhole::cpu::SampledPicture;
use pinhole::geometry::ray::Ray;
use pinhole::glam::DVec3;
use pinhole::light::{Ground, Light, LightFrame, LightKind, Sky, SkyLight};
use pinhole::render::{Integrator, LightSampling, PathTracing, Sampling, Studio};
use pinhole::{Film, Image, LayerSet, LinearRgb, Material, RenderSettings, Scene, Sphere, View, cpu};

/// A colour from three numbers.
pub(crate) fn rgb(rgb: [f32; 3]) -> LinearRgb {
    LinearRgb::new(rgb).unwrap()
}

pub(crate) fn gray(value: f32) -> LinearRgb {
    rgb([value; 3])
}

/// A white sphere.
pub(crate) fn white(center: [f64; 3], radius: f64) -> Sphere {
    Sphere::new(center, radius, LinearRgb::WHITE)
}

/// The material of an emissive sphere.
pub(crate) fn emissive(strength: f32) -> Material {
    Material::Emissive { strength }
}

/// A light with its position in the world.
pub(crate) fn light(kind: LightKind) -> Light {
    Light { kind, frame: LightFrame::World }
}

pub(crate) fn sun(toward: DVec3, strength: LinearRgb, angular_radius: f64) -> LightKind {
    LightKind::Directional { toward, strength, angular_radius }
}

/// A visible ground plane.
pub(crate) fn ground(point: DVec3, normal: DVec3, color: LinearRgb) -> Ground {
    Ground { point, normal, color, is_shadow_catcher: false }
}

/// A studio with only the given lights, and shadows.
pub(crate) fn studio(samples: u32, lights: &[LightKind]) -> RenderSettings {
    let studio = Studio { ambient: LinearRgb::BLACK, ..Studio::default() };
    RenderSettings {
        lights: lights.iter().copied().map(light).collect(),
        ..by(Integrator::Studio(studio), &paths(samples, LightSampling::Multiple))
    }
}

/// Path tracing to the end of each path, over black, without a light.
pub(crate) fn paths(samples: u32, light_sampling: LightSampling) -> RenderSettings {
    let tracing = PathTracing { max_depth: 64, roulette_from: u32::MAX, light_sampling };
    RenderSettings {
        integrator: Integrator::Path(tracing),
        sampling: Sampling { samples, seed: 5, filter: PixelFilter::Box, denoise: false },
        lights: Vec::new(),
        sky: Sky { light: SkyLight::Constant(LinearRgb::BLACK), is_visible: true },
        ground: None,
        background: LinearRgb::BLACK,
        is_transparent: false,
    }
}

/// Path tracing in a furnace: light of radiance 1 comes from everywhere, so surfaces that lose none have radiance 1.
pub(crate) fn furnace(samples: u32) -> RenderSettings {
    let sky = Sky { light: SkyLight::Constant(LinearRgb::WHITE), is_visible: true };
    RenderSettings { sky, ..paths(samples, LightSampling::Multiple) }
}

/// The same settings with another integrator. The sky stays only for paths.
pub(crate) fn by(integrator: Integrator, settings: &RenderSettings) -> RenderSettings {
    let is_lit_by_sky = matches!(integrator, Integrator::Path(_));
    let sky = if is_lit_by_sky { settings.sky.clone() } else { Sky::default() };
    RenderSettings { integrator, sky, ..settings.clone() }
}

/// A scene with a view of it.
pub(crate) struct Shot {
    pub(crate) scene: Scene,
    pub(crate) camera: Box<dyn Camera>,
    pub(crate) film: Film,
}

impl Shot {
    /// A view along −z from far away, which reaches `reach` to each side of the target.
    pub(crate) fn new(spheres: &[Sphere], target: [f64; 3], reach: f64, side: u32) -> Self {
        Self::from(8.0 * reach, spheres, target, reach, side)
    }

    /// The same view from a given distance.
    pub(crate) fn from(distance: f64, spheres: &[Sphere], target: [f64; 3], reach: f64, side: u32) -> Self {
        let [x, y, z] = target;
        let pose = Pose::looking_at([x, y, z + distance], target, [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::new(pose, distance, [reach, reach]).unwrap();
        Self { scene: Scene::new(spheres).unwrap(), camera: Box::new(camera), film: Film::new(side, side).unwrap() }
    }

    /// The picture, to be rendered sample by sample.
    pub(crate) fn picture<'a>(&'a self, lighting: &'a RenderSettings) -> SampledPicture<'a> {
        SampledPicture::new(&self.scene, &View::new(self.camera.as_ref(), self.film), lighting).unwrap()
    }

    /// The ray through the centre of a pixel.
    pub(crate) fn ray(&self, [i, j]: [u32; 2]) -> Ray {
        let location = self.film.relative_location(f64::from(i) + 0.5, f64::from(j) + 0.5);
        self.camera.ray_in_world(location)
    }

    pub(crate) fn render(&self, lighting: &RenderSettings) -> Image {
        let Self { scene, camera, film } = self;
        cpu::render(scene, &View::new(camera.as_ref(), *film), lighting, LayerSet::ALL).unwrap()
    }
}

/// Sums of the pixels' numbers over each of `count`² blocks of a square picture.
fn sums<const N: usize>(image: &Image, count: usize, of: impl Fn(usize) -> [f64; N]) -> impl Iterator<Item = [f64; N]> {
    let width = image.width() as usize;
    let side = width / count;
    (0..count * count).map(move |block| {
        let (left, top) = (block % count * side, block / count * side);
        let pixels = (0..side * side).map(|k| (top + k / side) * width + left + k % side);
        pixels.map(&of).fold([0.0; N], |a, b| std::array::from_fn(|k| a[k] + b[k]))
    })
}

/// The number of pixels of a block.
fn area(image: &Image, count: usize) -> f64 {
    (f64::from(image.width()) / count as f64).powi(2)
}

/// Means of the colour components over each of `count`² blocks of a square picture.
pub(crate) fn blocks(image: &Image, count: usize) -> Vec<[f64; 3]> {
    let sums = sums(image, count, |pixel| image.color()[pixel].map(f64::from));
    sums.map(|sum| sum.map(|sum| sum / area(image, count))).collect()
}

/// The standard error of each block's luminance, from the variances of its pixels.
pub(crate) fn standard_errors(image: &Image, count: usize) -> Vec<f64> {
    let sums = sums(image, count, |pixel| [f64::from(image.variance().unwrap()[pixel])]);
    sums.map(|[sum]| sum.sqrt() / area(image, count)).collect()
}
