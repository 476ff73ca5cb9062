//! The parameters and tables of a lighting as the host computes them for kernels.

use glam::DVec3;

use crate::camera::CameraVectors;
use crate::geometry::math::unit;
use crate::image::Averages;
use crate::image::color::{LinearRgb, luminance};
use crate::light::codes::{self, lighting as flags};
use crate::light::emitters::{EmissiveSphere, Emitters};
use crate::light::energy::EnergyTables;
use crate::light::environment::Environment;
use crate::light::{LightKind, Sky, SkyLight};
use crate::recording::NO_HIT;
use crate::recording::lit::{UploadedLighting, UploadedSky};
use crate::render::{Integrator, LightSampling, RenderSettings};
use crate::scene::SceneAppearance;
use crate::scene::material::{Material, SurfaceProperties};

/// The parameters and tables of a lighting.
#[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "the renderer reads all fields"))]
pub(crate) struct HostLighting {
    pub(crate) lighting: UploadedLighting,
    /// The tables of lights, materials and energies, which are never empty.
    pub(crate) tables: Vec<[f32; 4]>,
    /// The lights of the view.
    pub(crate) lights: Vec<LightKind>,
    pub(crate) sources: SourceList,
}

impl HostLighting {
    /// Computes the data for settings that have been checked. Positions are in the frame of a scene with this origin.
    pub(crate) fn new(
        settings: &RenderSettings,
        origin: DVec3,
        appearance: &SceneAppearance,
        emitters: &Emitters,
        vectors: &CameraVectors,
    ) -> Self {
        let mut tables = Vec::new();
        let lights: Vec<LightKind> = settings.lights.iter().filter_map(|light| light.in_view(vectors)).collect();
        let sources = SourceList::of(settings, &lights, emitters);
        for (index, light) in lights.iter().enumerate() {
            let source = sources.lamps.get(index).copied().unwrap_or(0);
            tables.extend(light_record(light, origin, source));
        }
        let material_first = tables.len() as u32;
        let rows = appearance.material_rows();
        let surfaces: Vec<SurfaceProperties> = rows.iter().map(|row| row.surface).collect();
        let energies = EnergyTables::of(&surfaces);
        let energy_first = material_first + 2 * (1 + rows.len()) as u32;
        tables.extend(material_record(LinearRgb::WHITE, &SurfaceProperties::default(), 0));
        for (row, start) in rows.iter().zip(&energies.starts) {
            let energy = energy_first + start.unwrap_or(0) / 4;
            tables.extend(material_record(row.color, &row.surface, energy));
        }
        tables.extend(energies.entries.chunks_exact(4).map(|e| [e[0], e[1], e[2], e[3]]));
        let mut lighting = parameters_of(settings, origin);
        lighting.light_count = lights.len() as u32;
        lighting.source_count = sources.count();
        lighting.lamp_sources = sources.lamps.len() as u32;
        lighting.emitter_count = if sources.emitters { emitters.ids().len() as u32 } else { 0 };
        lighting.material_first = material_first;
        Self { lighting, tables, lights, sources }
    }
}

/// Maximum number of surfaces at which a path is scattered; it may end on one more. In a studio, the maximum number of
/// surfaces that a ray passes through, which is 1 if every sphere is opaque.
pub(crate) fn max_surfaces(settings: &RenderSettings, is_opaque: bool) -> u32 {
    match &settings.integrator {
        Integrator::Studio(studio) if !is_opaque => studio.max_surfaces,
        Integrator::Primary(_) | Integrator::Studio(_) => 1,
        Integrator::Path(path) => path.max_depth,
    }
}

/// The light sources among which light sampling chooses.
#[derive(Debug)]
pub(crate) struct SourceList {
    /// Indices of the lights that can be sampled.
    pub(crate) lamps: Vec<u32>,
    /// Whether emissive spheres are sampled.
    pub(crate) emitters: bool,
    image: bool,
}

impl SourceList {
    fn of(settings: &RenderSettings, lights: &[LightKind], emitters: &Emitters) -> Self {
        let Integrator::Path(path) = &settings.integrator else {
            return Self { lamps: Vec::new(), emitters: false, image: false };
        };
        let is_sampled = path.light_sampling != LightSampling::Chance;
        let lamps = lights.iter().zip(0..).filter(|(light, _)| match light {
            LightKind::Head { .. } => false,
            LightKind::Directional { angular_radius, .. } => *angular_radius == 0.0 || is_sampled,
            LightKind::Point { .. } | LightKind::Sphere { .. } => true,
        });
        Self {
            lamps: lamps.map(|(_, index)| index).collect(),
            emitters: is_sampled && !emitters.ids().is_empty(),
            image: is_sampled && settings.sky.light.has_lit_image(),
        }
    }

    pub(crate) fn count(&self) -> u32 {
        self.lamps.len() as u32 + u32::from(self.emitters) + u32::from(self.image)
    }
}

fn parameters_of(settings: &RenderSettings, origin: DVec3) -> UploadedLighting {
    let mut parameters = UploadedLighting { seed: settings.sampling.seed, ..UploadedLighting::default() };
    parameters.background = settings.background.to_array();
    let flag = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
    parameters.flags =
        flag(settings.is_transparent, flags::TRANSPARENT) | flag(settings.sky.is_visible, flags::SKY_SEEN);
    if let Some(ground) = &settings.ground {
        parameters.flags |= flags::GROUND | flag(ground.is_shadow_catcher, flags::CATCHER);
        parameters.ground_point = (ground.point - origin).as_vec3().to_array();
        parameters.ground_normal = unit(ground.normal).unwrap_or(DVec3::Y).as_vec3().to_array();
        parameters.ground_color = ground.color.to_array();
    }
    add_sky(&settings.sky, &mut parameters);
    match &settings.integrator {
        Integrator::Primary(_) => {}
        Integrator::Path(path) => {
            parameters.roulette_from = path.roulette_from;
            parameters.light_sampling = path.light_sampling.code();
        }
        Integrator::Studio(studio) => {
            parameters.ambient = studio.ambient.to_array();
            parameters.flags |= flag(studio.shadows, flags::SHADOWS);
            if let Some(occlusion) = &studio.occlusion {
                parameters.occlusion_samples = occlusion.samples;
                parameters.occlusion_radius = occlusion.radius.map_or(NO_HIT, |radius| radius as f32);
            }
            if let Some(cue) = &studio.depth_cue {
                parameters.cue_color = cue.color.to_array();
                parameters.cue_near = cue.near as f32;
                parameters.cue_scale = (1.0 / (cue.far - cue.near)) as f32;
            }
        }
    }
    parameters.filter_table = settings.sampling.filter.offset_table().to_vec();
    parameters
}

fn add_sky(sky: &Sky, parameters: &mut UploadedLighting) {
    match &sky.light {
        SkyLight::Constant(radiance) => {
            [parameters.zenith, parameters.horizon, parameters.nadir] = [radiance.to_array(); 3];
        }
        SkyLight::Gradient { zenith, horizon, nadir } => {
            let ends = [zenith, horizon, nadir];
            [parameters.zenith, parameters.horizon, parameters.nadir] = ends.map(|end| end.to_array());
        }
        SkyLight::Image { environment, strength, rotation } => {
            parameters.environment_size = [environment.width(), environment.height()];
            parameters.environment_rotation = Environment::rotation(*rotation);
            parameters.environment_strength = *strength;
        }
    }
}

fn four([x, y, z]: [f32; 3], w: f32) -> [f32; 4] {
    [x, y, z, w]
}

/// The record of a light in the layout of `shaders/scene/lamp.wgsl`.
fn light_record(light: &LightKind, origin: DVec3, source: u32) -> [[f32; 4]; 3] {
    let kind = f32::from_bits(codes::of_light(light));
    let near = |position: DVec3| (position - origin).as_vec3().to_array();
    let [position, power] = match *light {
        LightKind::Head { strength } => [four([0.0; 3], kind), four(strength.to_array(), 0.0)],
        LightKind::Directional { toward, strength, angular_radius } => {
            // 1 minus the cosine of the angle, computed without cancellation.
            let k = 2.0 * (0.5 * angular_radius).sin().powi(2);
            [four(toward.as_vec3().to_array(), kind), four(strength.to_array(), k as f32)]
        }
        LightKind::Point { position, intensity } => [four(near(position), kind), four(intensity.to_array(), 0.0)],
        LightKind::Sphere { center, radius, radiance } => {
            [four(near(center), kind), four(radiance.to_array(), radius as f32)]
        }
    };
    [position, power, [f32::from_bits(source), 0.0, 0.0, 0.0]]
}

/// The record of a material in the layout of `shaders/scene/material.wgsl`.
fn material_record(color: LinearRgb, surface: &SurfaceProperties, energies: u32) -> [[f32; 4]; 2] {
    let kind = codes::of_material(&surface.material);
    let record = |parameter: f32, roughness: f32, absorption: [f32; 3]| {
        let (kind, energies) = (f32::from_bits(kind), f32::from_bits(energies));
        [[kind, parameter, roughness * roughness, energies], four(absorption, surface.opacity)]
    };
    match surface.material {
        Material::Lambert { specular, roughness } => record(specular, roughness, [0.0; 3]),
        Material::Conductor { roughness } => record(1.0, roughness, [0.0; 3]),
        Material::Dielectric { ior, roughness, attenuation_distance } => {
            let absorption = attenuation_distance.map_or([0.0; 3], |distance| {
                color.to_array().map(|c| {
                    let share = f64::from(c).max(1e-4);
                    (-share.ln() / f64::from(distance)) as f32
                })
            });
            record(ior, roughness, absorption)
        }
        Material::Emissive { strength } => record(strength, 0.0, [0.0; 3]),
    }
}

/// The records of the emitters in the layout of `shaders/scene/emitter.wgsl`.
pub(crate) fn emitter_records(emitters: &Emitters, emissive: &[EmissiveSphere]) -> Vec<[f32; 4]> {
    let records = emitters.ids().iter().zip(emissive).enumerate().flat_map(|(index, (id, emissive))| {
        let EmissiveSphere { sphere, color, surface } = *emissive;
        // A surface that is not opaque emits the fraction of light that its opacity gives.
        let strength = match surface.material {
            Material::Emissive { strength } => strength * surface.opacity,
            _ => 0.0,
        };
        let probability = emitters.probability(*id) as f32;
        let [r, g, b] = color.to_array().map(|c| c * strength);
        [sphere, [f32::from_bits(*id), f32::from_bits(emitters.last_picks()[index]), probability, 0.0], [r, g, b, 0.0]]
    });
    records.collect()
}

/// The image of a sky, as a device gets it.
pub(crate) fn uploaded_sky(settings: &RenderSettings) -> Option<UploadedSky> {
    let SkyLight::Image { environment, .. } = &settings.sky.light else { return None };
    let shares = environment.rows().iter().chain(environment.columns()).copied().collect();
    Some(UploadedSky { texels: environment.texels().to_vec(), shares })
}

/// The means of a pixel, its luminance, and the variance of its mean luminance.
pub(crate) fn means(pixel: &[[f32; 4]; 3], samples: u32) -> (Averages, f64, f64) {
    let [[r, g, b, alpha], rest, [red, green, blue, square]] = pixel.map(|v| v.map(f64::from));
    let count = f64::from(samples.max(1));
    let sum = [r + rest[0], g + rest[1], b + rest[2]];
    let light = luminance(sum) / count;
    let spread = ((square + rest[3]) / count - light * light).max(0.0);
    let variance = if samples > 1 { spread / (count - 1.0) } else { 0.0 };
    let narrow = |sum: f64| (sum / count) as f32;
    let averages = Averages {
        color: sum.map(narrow),
        alpha: narrow(alpha).clamp(0.0, 1.0),
        albedo: [red, green, blue].map(narrow),
        samples,
        variance: variance as f32,
    };
    (averages, light, variance)
}
