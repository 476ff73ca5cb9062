//! The check of uploaded data for lit pictures: whether the numbers on the device are those of the requested scene and
//! settings.

use super::near::{are_near, is_near};
use super::recording::{LitInputs, UploadedLighting, flag};
use super::tables;
use super::upload_error::LitUploadError;
use crate::geometry::math::{unit, wide};
use crate::image::color::LinearRgb;
use crate::light::SkyLight;
use crate::light::environment::Environment;
use crate::render::{DepthCue, Integrator, Occlusion, PathTracing, RenderSettings, Studio};
use crate::scene::Scene;
use crate::verify::candidates::Candidates;
use crate::verify::recording::NO_HIT;
use crate::verify::rounding::{FLUSH, U};
use crate::verify::upload::{LEAST_MARGIN, check_view};

/// Compares the recording with the scene and the settings.
pub(in crate::verify) fn check(
    scene: &Scene,
    candidates: &Candidates,
    inputs: &LitInputs,
) -> Result<(), LitUploadError> {
    check_view(scene, candidates, &inputs.camera, &inputs.uploaded)?;
    check_lighting(scene, inputs)?;
    tables::check(scene, inputs)
}

fn check_lighting(scene: &Scene, inputs: &LitInputs) -> Result<(), LitUploadError> {
    let LitInputs { settings, lighting, .. } = inputs;
    match &settings.integrator {
        Integrator::Primary(_) => {
            return Err(LitUploadError::Lighting { what: "the integrator" });
        }
        Integrator::Path(path) => check_path(path, inputs)?,
        Integrator::Studio(studio) => {
            check_studio(studio, scene, inputs)?;
            check_occluders(scene, inputs)?;
        }
    }
    let flags = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
    let expected_flags = flags(settings.is_transparent, flag::TRANSPARENT)
        | flags(settings.sky.is_visible, flag::SKY_SEEN)
        | flags(settings.ground.is_some(), flag::GROUND)
        | flags(settings.ground.is_some_and(|ground| ground.is_shadow_catcher), flag::CATCHER)
        | flags(
            settings.studio_parameters().is_some_and(|studio| studio.has_shadows),
            flag::SHADOWS,
        );
    let is_ground = settings.ground.as_ref().is_none_or(|ground| {
        let point = (ground.point - scene.origin()).to_array();
        let normal = unit(ground.normal).unwrap_or_default().to_array();
        let moved = (ground.point.abs() + scene.origin().abs()) * f64::EPSILON * 4.0;
        let is_point = (0..3).all(|axis| {
            let off = f64::from(lighting.ground_point[axis]) - point[axis];
            off.abs() <= 2.0 * U * point[axis].abs() + moved[axis] + FLUSH
        });
        is_point
            && are_near(lighting.ground_normal, normal)
            && are_near(lighting.ground_color, ground.color.to_array().map(f64::from))
    });
    let filter = settings.sampling.filter.offset_table();
    let all = [
        (
            "the background",
            are_near(lighting.background, settings.background.to_array().map(f64::from)),
        ),
        ("the set of flags", lighting.flags == expected_flags),
        ("the seed", lighting.seed == settings.sampling.seed),
        ("the ground", is_ground),
        ("the pixel filter", lighting.filter_table[..] == filter[..]),
        ("the sky", is_sky(settings, lighting, inputs)),
    ];
    first_wrong(&all)
}

/// The first parameter that is wrong, of those with their names and whether they are right.
fn first_wrong(all: &[(&'static str, bool)]) -> Result<(), LitUploadError> {
    match all.iter().find(|(_, is_right)| !is_right) {
        None => Ok(()),
        Some((what, _)) => Err(LitUploadError::Lighting { what }),
    }
}

fn check_path(path: &PathTracing, inputs: &LitInputs) -> Result<(), LitUploadError> {
    let LitInputs { lighting, .. } = inputs;
    first_wrong(&[
        ("the start of roulette", lighting.roulette_from == path.roulette_from),
        ("how lights are sampled", lighting.light_sampling == path.light_sampling.code()),
        ("the depth of paths", inputs.max_surfaces == path.max_depth),
    ])
}

fn check_studio(studio: &Studio, scene: &Scene, inputs: &LitInputs) -> Result<(), LitUploadError> {
    let LitInputs { lighting, .. } = inputs;
    let is_color =
        |found: [f32; 3], asked: LinearRgb| are_near(found, asked.to_array().map(f64::from));
    let is_occlusion = match &studio.occlusion {
        None => lighting.occlusion_samples == 0,
        Some(Occlusion { radius, samples }) => {
            lighting.occlusion_samples == *samples
                && is_near(lighting.occlusion_radius, radius.unwrap_or(NO_HIT.into()))
        }
    };
    let is_cue = match &studio.depth_cue {
        None => lighting.cue_scale == 0.0,
        Some(DepthCue { near, far, color }) => {
            is_color(lighting.cue_color, *color)
                && is_near(lighting.cue_near, *near)
                && is_near(lighting.cue_scale, 1.0 / (far - near))
        }
    };
    // Behind an opaque surface nothing is seen.
    let max_surfaces = if scene.is_opaque() { 1 } else { studio.max_surfaces };
    first_wrong(&[
        ("the ambient light", is_color(lighting.ambient, studio.ambient)),
        ("the ambient occlusion", is_occlusion),
        ("the depth cue", is_cue),
        ("the number of surfaces behind each other", inputs.max_surfaces == max_surfaces),
    ])
}

/// Checks that the box to which the origins of shadow rays are moved contains the spheres that cast shadows.
fn check_occluders(scene: &Scene, inputs: &LitInputs) -> Result<(), LitUploadError> {
    let [low, high] = inputs.occluders.map(wide);
    let margin = LEAST_MARGIN * (high - low).length();
    let holds = |[x, y, z, radius]: [f32; 4]| {
        let (center, radius) = (wide([x, y, z]), f64::from(radius.abs()));
        (low + margin).cmple(center - radius).all() && (high - margin).cmpge(center + radius).all()
    };
    first_wrong(&[(
        "the box of the spheres that cast shadows",
        scene.opaque_ids().all(|id| holds(scene.spheres()[id as usize])),
    )])
}

fn is_sky(settings: &RenderSettings, lighting: &UploadedLighting, inputs: &LitInputs) -> bool {
    let ends = [lighting.zenith, lighting.horizon, lighting.nadir];
    let are = |colors: [[f32; 3]; 3]| {
        ends.into_iter().zip(colors).all(|(a, b)| are_near(a, b.map(f64::from)))
    };
    match &settings.sky.light {
        SkyLight::Constant(radiance) => inputs.sky.is_none() && are([radiance.to_array(); 3]),
        SkyLight::Gradient { zenith, horizon, nadir } => {
            inputs.sky.is_none() && are([zenith, horizon, nadir].map(|end| end.to_array()))
        }
        SkyLight::Image { environment, strength, rotation } => {
            let shares = environment.rows().iter().chain(environment.columns());
            lighting.environment_size == [environment.width(), environment.height()]
                && are_near(
                    lighting.environment_rotation,
                    Environment::rotation(*rotation).map(f64::from),
                )
                && is_near(lighting.environment_strength, (*strength).into())
                && inputs.sky.as_ref().is_some_and(|sky| {
                    sky.texels == environment.texels() && sky.shares.iter().eq(shares)
                })
        }
    }
}
