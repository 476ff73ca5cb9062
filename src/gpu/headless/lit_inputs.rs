//! The numbers that a device is given for a recorded lit picture.

use crate::camera::View;
use crate::gpu::headless::recording::requested_view;
use crate::gpu::passes::lit::records::LightingParameters;
use crate::gpu::passes::lit::{LightingData, LitScene};
use crate::gpu::passes::tiles::Tile;
use crate::gpu::shader::records::SceneSpace;
use crate::light::SkyLight;
use crate::render::RenderSettings;
use crate::verify::{LitInputs, UploadedLighting, UploadedSky};

/// Collects the numbers that the device is given for a tile.
pub(super) fn inputs(
    scenes: &LitScene<'_>,
    lighting: &LightingData,
    Tile { origin, size, .. }: Tile,
) -> LitInputs {
    let LitScene { all, occluders, view, settings } = *scenes;
    inputs_in([&all.space, &occluders.space], view, settings, lighting, [origin, size])
}

/// The numbers for scenes in these spaces: that of all spheres, and that of those that cast shadows.
fn inputs_in(
    [space, occluders]: [&SceneSpace; 2],
    view: &View<'_>,
    settings: &RenderSettings,
    lighting: &LightingData,
    [origin, size]: [[u32; 2]; 2],
) -> LitInputs {
    let (camera, uploaded) = requested_view(space, view.camera);
    LitInputs {
        camera,
        uploaded,
        occluders: [occluders.min, occluders.max].map(|corner| corner.to_array()),
        film: view.film,
        origin,
        size,
        settings: settings.clone(),
        max_surfaces: lighting.max_surfaces,
        lighting: uploaded_lighting(&lighting.parameters),
        tables: lighting.tables.iter().map(|four| four.map(f32::to_bits)).collect(),
        emitters: lighting.emitters.iter().map(|four| four.map(f32::to_bits)).collect(),
        sky: uploaded_sky(settings),
    }
}

fn uploaded_lighting(lighting: &LightingParameters) -> UploadedLighting {
    let mut filter_table: Vec<f32> = lighting.filter_table.iter().flatten().copied().collect();
    // The table has rows of four numbers; the last row has a single one.
    filter_table.truncate(257);
    UploadedLighting {
        background: lighting.background,
        flags: lighting.flags,
        light_count: lighting.light_count,
        zenith: lighting.zenith,
        horizon: lighting.horizon,
        nadir: lighting.nadir,
        roulette_from: lighting.roulette_from,
        source_count: lighting.source_count,
        light_sampling: lighting.light_sampling,
        ground_normal: lighting.ground_normal,
        ground_point: lighting.ground_point,
        ground_color: lighting.ground_color,
        seed: lighting.seed,
        emitter_count: lighting.emitter_count,
        material_first: lighting.material_first,
        ambient: lighting.ambient,
        cue_color: lighting.cue_color,
        cue_near: lighting.cue_near,
        cue_scale: lighting.cue_scale,
        occlusion_radius: lighting.occlusion_radius,
        occlusion_samples: lighting.occlusion_samples,
        environment_size: lighting.environment_size,
        environment_rotation: lighting.environment_rotation,
        environment_strength: lighting.environment_strength,
        lamp_sources: lighting.lamp_sources,
        filter_table,
    }
}

fn uploaded_sky(settings: &RenderSettings) -> Option<UploadedSky> {
    match &settings.sky.light {
        SkyLight::Image { environment, .. } => Some(UploadedSky {
            texels: environment.texels().to_vec(),
            shares: environment.rows().iter().chain(environment.columns()).copied().collect(),
        }),
        SkyLight::Constant(_) | SkyLight::Gradient { .. } => None,
    }
}

#[cfg(test)]
#[path = "../../../tests/support/random_light.rs"]
#[allow(dead_code, reason = "tests of devices use all of it")]
mod random_light;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::{AccelChoice, AccelPlan};
    use crate::gpu::scene::scene_summary::SceneSummary;
    use crate::verify::{Checker, PathRecording};

    /// The checker accepts the numbers that the host computes for a device from random scenes.
    #[test]
    fn uploaded_numbers_match_the_settings() {
        // The computation of energy tables takes most of the time.
        for seed in 1000..1016 {
            let random = random_light::view(seed);
            let view = View::new(random.camera.as_ref(), random.film);
            random.settings.check(&random.scene).unwrap();
            let checker = Checker::new(&random.scene).unwrap();
            let spheres = random.scene.spheres();
            let plan = AccelPlan::new(spheres, AccelChoice::List, 1 << 27);
            let (min, max) = plan.build(spheres).bounds();
            let space = SceneSpace { origin: random.scene.origin(), min, max };
            let summary = SceneSummary::of(&random.scene);
            let lighting = LightingData::new(&random.settings, &summary, view.camera);
            let part = [[0; 2], [view.film.width(), view.film.height()]];
            let given = inputs_in([&space; 2], &view, &random.settings, &lighting, part);
            let mut recording = PathRecording { given, samples: Vec::new() };
            let certificate = checker.certify_paths(&recording);
            assert_eq!(certificate.upload, None, "seed {seed}: {}", random.name);
            // The checker rejects a roughness of more than 1, which shows that it can fail.
            if seed % 8 == 0 {
                let material = recording.given.lighting.material_first as usize;
                recording.given.tables[material][2] = 1.001_f32.to_bits();
                let certificate = checker.certify_paths(&recording);
                assert!(certificate.upload.is_some(), "seed {seed}: {}", random.name);
            }
        }
    }
}
