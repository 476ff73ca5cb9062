//! The data of a lighting for kernels: one uniform record, one buffer of lights, materials and energies, and the table
//! of emitters.

use std::sync::Arc;

use bytemuck::Zeroable;
use glam::DVec3;

use crate::camera::Camera;
use crate::geometry::math::unit;
use crate::gpu::passes::emitter_table;
use crate::gpu::passes::lit::kernels::{Materials, Mode, OnePass, SkyKind, Sources};
use crate::gpu::passes::lit::records::{BITS, LightingParameters};
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::gpu::shader::records::NO_HIT;
use crate::image::color::LinearRgb;
use crate::light::codes::{self, lighting as flags};
use crate::light::emitters::Emitters;
use crate::light::energy::EnergyTables;
use crate::light::environment::Environment;
use crate::light::{LightKind, Sky, SkyLight};
use crate::render::{Integrator, LightSampling, RenderSettings};
use crate::scene::material::{Material, SurfaceProperties};

/// The data of a picture's lighting for its kernels.
#[derive(Debug)]
pub(crate) struct LightingData {
    pub(crate) mode: Mode,
    pub(crate) parameters: LightingParameters,
    /// The tables of lights, materials and energies, which are never empty.
    pub(crate) tables: Vec<[f32; 4]>,
    /// The table of emitters, which is empty unless light sampling chooses among them.
    pub(crate) emitters: Vec<[f32; 4]>,
    /// Maximum number of surfaces at which a path is scattered; it may end on one more. In a studio, the maximum number
    /// of surfaces that a ray passes through, which is 1 if every sphere is opaque.
    pub(crate) max_surfaces: u32,
    /// Whether all spheres are opaque.
    is_opaque: bool,
    /// Whether lights have no size, no place and no shadows, and all surfaces are matt.
    is_sharp: bool,
    /// Whether lights cast shadows in a studio.
    pub(super) shadows: bool,
    /// The image of the sky that illuminates paths.
    pub(super) sky: Option<Arc<Environment>>,
    /// For each light, whether shadow rays are traced towards it.
    pub(super) casts_shadow: Vec<bool>,
}

impl LightingData {
    /// Computes the data for settings that have been checked. Positions are in the scene's frame.
    pub(crate) fn new(settings: &RenderSettings, scene: &SceneSummary, camera: &dyn Camera) -> Self {
        let (mut tables, vectors) = (Vec::new(), camera.vectors());
        let lights: Vec<LightKind> = settings.lights.iter().filter_map(|light| light.in_view(&vectors)).collect();
        let emitters = &scene.emitters;
        let sources = SourceList::of(settings, &lights, emitters);
        for (index, light) in lights.iter().enumerate() {
            let source = sources.lamps.get(index).copied().unwrap_or(0);
            tables.extend(light_record(light, scene.origin, source));
        }
        let material_first = tables.len() as u32;
        let rows = scene.appearance.material_rows();
        let surfaces: Vec<SurfaceProperties> = rows.iter().map(|row| row.surface).collect();
        let energies = EnergyTables::of(&surfaces);
        let energy_first = material_first + 2 * (1 + rows.len()) as u32;
        tables.extend(material_record(LinearRgb::WHITE, &SurfaceProperties::default(), 0));
        for (row, start) in rows.iter().zip(&energies.starts) {
            let energy = energy_first + start.unwrap_or(0) / 4;
            tables.extend(material_record(row.color, &row.surface, energy));
        }
        tables.extend(energies.entries.chunks_exact(4).map(|e| [e[0], e[1], e[2], e[3]]));
        let mut parameters = parameters_of(settings, scene);
        parameters.light_count = lights.len() as u32;
        parameters.source_count = sources.count();
        parameters.lamp_sources = sources.lamps.len() as u32;
        parameters.emitter_count = if sources.emitters { emitters.ids().len() as u32 } else { 0 };
        parameters.material_first = material_first;
        Self {
            mode: mode_of(settings, scene, &sources),
            parameters,
            tables,
            emitters: if sources.emitters { emitter_table::records(scene).collect() } else { Vec::new() },
            max_surfaces: match &settings.integrator {
                Integrator::Studio(studio) if !scene.appearance.is_opaque() => studio.max_surfaces,
                Integrator::Primary(_) | Integrator::Studio(_) => 1,
                Integrator::Path(path) => path.max_depth,
            },
            is_opaque: scene.appearance.is_opaque(),
            is_sharp: is_sharp(settings, scene, &lights),
            shadows: settings.studio_parameters().is_some_and(|studio| studio.shadows),
            sky: match (&settings.sky.light, &settings.integrator) {
                (SkyLight::Image { environment, .. }, Integrator::Path(_)) => Some(Arc::clone(environment)),
                _ => None,
            },
            casts_shadow: lights.iter().map(|l| !matches!(l, LightKind::Head { .. })).collect(),
        }
    }
}

impl LightingData {
    /// Whether pictures with this light are the same as with another light, of the same scene.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let counts = |of: &Self| (of.mode, of.max_surfaces, of.is_opaque, of.shadows);
        counts(self) == counts(other)
            && self.has_same_images(other)
            && self.casts_shadow == other.casts_shadow
            && bytemuck::bytes_of(&self.parameters) == bytemuck::bytes_of(&other.parameters)
            && self.tables == other.tables
    }

    /// Whether shadows or ambient occlusion may differ from those of another light, apart from the positions of lamps.
    pub(crate) fn rays_differ(&self, other: &Self) -> bool {
        let hidden = |of: &Self| (of.parameters.flags, of.parameters.occlusion_samples, of.shadows);
        let radius = |of: &Self| of.parameters.occlusion_radius.to_bits();
        hidden(self) != hidden(other) || radius(self) != radius(other) || self.casts_shadow != other.casts_shadow
    }

    /// Whether the image of the sky and the table of emitters are the same as for another light, of the same scene.
    pub(crate) fn has_same_images(&self, other: &Self) -> bool {
        let is_same_sky = match (&self.sky, &other.sky) {
            (Some(sky), Some(other)) => Arc::ptr_eq(sky, other),
            (None, None) => true,
            _ => false,
        };
        is_same_sky && self.emitters.len() == other.emitters.len()
    }

    /// The kind of picture, if one pass can take whole samples of a scene with `bricks` bricks. `None` for a studio
    /// with more lamps or directions than several passes take at once, because they would be summed in another order.
    pub(super) fn one_pass(&self, bricks: usize) -> Option<OnePass> {
        if let Mode::Path(materials, sources, sky) = self.mode {
            let is_one = sky == SkyKind::Plain && bricks == 1;
            return is_one.then_some(OnePass::Paths(materials, sources));
        }
        let is_few = self.casts_shadow.len() <= BITS && self.parameters.occlusion_samples as usize <= BITS;
        let is_one = self.is_opaque && bricks == 1 && is_few;
        let has_ground = self.parameters.flags & flags::GROUND != 0;
        is_one.then_some(match (has_ground, self.is_sharp) {
            (true, _) => OnePass::Ground,
            (false, true) => OnePass::Sharp,
            (false, false) => OnePass::Lamps,
        })
    }

    /// Maximum number of loop iterations of a path apart from searching, as
    /// `shaders/path/whole_paths.wgsl` counts them; 0 in a studio.
    pub(super) fn loops_of_path(&self) -> u32 {
        match self.mode {
            Mode::Path(..) => {
                let of_surface = self.parameters.light_count.saturating_mul(2).saturating_add(65);
                (1 + self.max_surfaces).saturating_mul(of_surface)
            }
            Mode::Studio => 0,
        }
    }

    /// Maximum number of rays of a sample, in a studio of opaque spheres or along a path.
    pub(super) fn rays_of_sample(&self) -> u32 {
        if let Mode::Path(..) = self.mode {
            let of_light = u32::from(self.parameters.source_count > 0) * self.max_surfaces;
            return 1 + self.max_surfaces + of_light;
        }
        let shadows = self.casts_shadow.iter().filter(|casts| **casts && self.shadows).count();
        1 + shadows as u32 + self.parameters.occlusion_samples
    }

    /// Size of the tables on the device in bytes, without the table of emitters.
    pub(crate) fn table_bytes(&self) -> u64 {
        size_of_val(&self.tables[..]) as u64
    }
}

/// The light sources among which light sampling chooses.
#[derive(Debug)]
struct SourceList {
    /// Indices of the lights that can be sampled.
    lamps: Vec<u32>,
    emitters: bool,
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
        let image = match &settings.sky.light {
            SkyLight::Image { environment, strength, .. } => environment.has_light() && *strength > 0.0,
            _ => false,
        };
        Self {
            lamps: lamps.map(|(_, index)| index).collect(),
            emitters: is_sampled && !emitters.ids().is_empty(),
            image: is_sampled && image,
        }
    }

    fn count(&self) -> u32 {
        self.lamps.len() as u32 + u32::from(self.emitters) + u32::from(self.image)
    }
}

/// Whether lights have no size, no place and no shadows, and all surfaces are matt.
fn is_sharp(settings: &RenderSettings, scene: &SceneSummary, lights: &[LightKind]) -> bool {
    let shadows = settings.studio_parameters().is_some_and(|studio| studio.shadows);
    let is_sharp = |light: &LightKind| match light {
        LightKind::Head { .. } => true,
        LightKind::Directional { angular_radius, .. } => *angular_radius == 0.0 && !shadows,
        LightKind::Point { .. } | LightKind::Sphere { .. } => false,
    };
    lights.iter().all(is_sharp) && scene.appearance.surfaces().iter().all(is_matt)
}

fn mode_of(settings: &RenderSettings, scene: &SceneSummary, sources: &SourceList) -> Mode {
    if settings.studio_parameters().is_some() {
        return Mode::Studio;
    }
    Mode::Path(
        if scene.appearance.surfaces().iter().all(is_matt) { Materials::Matt } else { Materials::Any },
        if sources.count() == 0 { Sources::None } else { Sources::Any },
        match settings.sky.light {
            SkyLight::Image { .. } => SkyKind::Image,
            _ => SkyKind::Plain,
        },
    )
}

fn is_matt(surface: &SurfaceProperties) -> bool {
    match surface.material {
        Material::Lambert { specular, .. } => specular == 0.0,
        Material::Emissive { .. } => true,
        Material::Conductor { .. } | Material::Dielectric { .. } => false,
    }
}

fn parameters_of(settings: &RenderSettings, scene: &SceneSummary) -> LightingParameters {
    let mut parameters = LightingParameters { seed: settings.sampling.seed, ..LightingParameters::zeroed() };
    parameters.background = settings.background.to_array();
    let flag = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
    parameters.flags =
        flag(settings.is_transparent, flags::TRANSPARENT) | flag(settings.sky.is_visible, flags::SKY_SEEN);
    if let Some(ground) = &settings.ground {
        parameters.flags |= flags::GROUND | flag(ground.is_shadow_catcher, flags::CATCHER);
        parameters.ground_point = (ground.point - scene.origin).as_vec3().to_array();
        parameters.ground_normal = unit(ground.normal).unwrap_or(DVec3::Y).as_vec3().to_array();
        parameters.ground_color = ground.color.to_array();
    }
    sky(&settings.sky, &mut parameters);
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
    let table = settings.sampling.filter.offset_table();
    for (index, offset) in table.iter().enumerate() {
        parameters.filter_table[index / 4][index % 4] = *offset;
    }
    parameters
}

fn sky(sky: &Sky, parameters: &mut LightingParameters) {
    match &sky.light {
        SkyLight::Constant(radiance) => {
            let radiance = radiance.to_array();
            (parameters.zenith, parameters.horizon, parameters.nadir) = (radiance, radiance, radiance);
        }
        SkyLight::Gradient { zenith, horizon, nadir } => {
            parameters.zenith = zenith.to_array();
            parameters.horizon = horizon.to_array();
            parameters.nadir = nadir.to_array();
        }
        SkyLight::Image { environment, strength, rotation } => {
            parameters.environment_size = [environment.width(), environment.height()];
            parameters.environment_rotation = crate::light::environment::Environment::rotation(*rotation);
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
