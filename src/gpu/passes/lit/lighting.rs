//! The data of a lighting for kernels: one uniform record, one buffer of lights, materials and energies, and the table
//! of emitters.

use std::sync::Arc;

use crate::camera::Camera;
use crate::gpu::passes::lit::kernels::{Materials, Mode, OnePass, SkyKind, Sources};
use crate::gpu::passes::lit::records::{BITS, LightingParameters};
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::light::codes::lighting as flags;
use crate::light::environment::Environment;
use crate::light::{LightKind, SkyLight};
use crate::recording::lighting::{HostLighting, SourceList, emitter_records, max_surfaces};
use crate::recording::lit::UploadedLighting;
use crate::render::{Integrator, RenderSettings};
use crate::scene::material::{Material, SurfaceProperties};

/// The data of a picture's lighting for its kernels.
#[derive(Debug)]
pub(crate) struct LightingData {
    pub(crate) mode: Mode,
    pub(crate) parameters: LightingParameters,
    /// The parameters as recordings have them.
    pub(crate) lighting: UploadedLighting,
    /// The tables of lights, materials and energies, which are never empty.
    pub(crate) tables: Vec<[f32; 4]>,
    /// The table of emitters, which is empty unless light sampling chooses among them.
    pub(crate) emitters: Vec<[f32; 4]>,
    /// Maximum number of surfaces at which a path is scattered; it may end on one more. In a studio, the maximum number
    /// of surfaces that a ray passes through, which is 1 if every sphere is opaque.
    pub(crate) max_surfaces: u32,
    /// Whether all spheres are opaque.
    is_opaque: bool,
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
        let inputs = HostLighting::new(settings, scene.origin, &scene.appearance, &scene.emitters, &camera.vectors());
        let HostLighting { lighting, tables, lights, sources } = inputs;
        Self {
            mode: mode_of(settings, scene, &sources),
            parameters: LightingParameters::of(&lighting),
            lighting,
            tables,
            emitters: if sources.emitters { emitter_records(&scene.emitters, &scene.emissive) } else { Vec::new() },
            max_surfaces: max_surfaces(settings, scene.appearance.is_opaque()),
            is_opaque: scene.appearance.is_opaque(),
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
        is_one.then_some(if has_ground { OnePass::Ground } else { OnePass::Lamps })
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

impl LightingParameters {
    fn of(lighting: &UploadedLighting) -> Self {
        let mut filter_table = [[0.0; 4]; 65];
        for (index, offset) in lighting.filter_table.iter().enumerate() {
            filter_table[index / 4][index % 4] = *offset;
        }
        Self {
            background: lighting.background,
            flags: lighting.flags,
            ambient: lighting.ambient,
            light_count: lighting.light_count,
            zenith: lighting.zenith,
            roulette_from: lighting.roulette_from,
            horizon: lighting.horizon,
            source_count: lighting.source_count,
            nadir: lighting.nadir,
            light_sampling: lighting.light_sampling,
            cue_color: lighting.cue_color,
            cue_near: lighting.cue_near,
            ground_normal: lighting.ground_normal,
            cue_scale: lighting.cue_scale,
            ground_point: lighting.ground_point,
            occlusion_radius: lighting.occlusion_radius,
            ground_color: lighting.ground_color,
            occlusion_samples: lighting.occlusion_samples,
            seed: lighting.seed,
            emitter_count: lighting.emitter_count,
            material_first: lighting.material_first,
            lamp_sources: lighting.lamp_sources,
            environment_size: lighting.environment_size,
            environment_rotation: lighting.environment_rotation,
            environment_strength: lighting.environment_strength,
            _pad: [0; 3],
            filter_table,
        }
    }
}
