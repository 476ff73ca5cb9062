//! The check of uploaded data for paths: whether the numbers on the device are those of the requested scene and
//! settings.

use super::recording::{PathRecording, UploadedLighting, flag};
use super::tables;
use crate::geometry::math::unit;
use crate::light::SkyLight;
use crate::light::environment::Environment;
use crate::render::{Integrator, RenderSettings};
use crate::scene::Scene;
use crate::verify::candidates::Candidates;
use crate::verify::rounding::{FLUSH, U};
use crate::verify::upload::{UploadError, check_view};

/// Why the data on the device are not those that were requested.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PathUploadError {
    /// The camera or the scene's box is wrong.
    #[error(transparent)]
    View(#[from] UploadError),
    /// A list of pixels does not have the size of the rectangle.
    #[error(
        "the recording has a list that does not have {pixels} pixels, the size of its rectangle"
    )]
    Size {
        /// The number of pixels in the rectangle.
        pixels: u64,
    },
    /// A parameter of the lighting is wrong.
    #[error("{what} on the device differs from the settings")]
    Lighting {
        /// The name of the parameter.
        what: &'static str,
    },
    /// An entry of the tables is wrong.
    #[error("{what} {index} on the device differs from the scene and the settings")]
    Table {
        /// The kind of entry.
        what: &'static str,
        /// Index of the entry, from 0.
        index: usize,
    },
}

/// Whether a number is within two roundings of another.
pub(super) fn is_near(found: f32, asked: f64) -> bool {
    (f64::from(found) - asked).abs() <= 2.0 * U * asked.abs() + FLUSH
}

pub(super) fn are_near<const N: usize>(found: [f32; N], asked: [f64; N]) -> bool {
    found.into_iter().zip(asked).all(|(found, asked)| is_near(found, asked))
}

/// Compares the recording with the scene and the settings.
pub(super) fn check(
    scene: &Scene,
    candidates: &Candidates,
    recording: &PathRecording,
) -> Result<(), PathUploadError> {
    check_view(scene, candidates, &recording.camera, &recording.uploaded)?;
    check_size(recording)?;
    check_lighting(scene, recording)?;
    tables::check(scene, recording)
}

fn check_size(recording: &PathRecording) -> Result<(), PathUploadError> {
    let pixels = u64::from(recording.size[0]) * u64::from(recording.size[1]);
    let is_whole = |length: usize| length as u64 == pixels;
    let are_whole = recording.samples.iter().all(|sample| {
        is_whole(sample.start.len())
            && is_whole(sample.sums.len())
            && sample.surfaces.iter().all(|surface| {
                is_whole(surface.hits.len())
                    && is_whole(surface.scattered.len())
                    && is_whole(surface.open.len())
            })
    });
    if are_whole { Ok(()) } else { Err(PathUploadError::Size { pixels }) }
}

fn check_lighting(scene: &Scene, recording: &PathRecording) -> Result<(), PathUploadError> {
    let PathRecording { settings, lighting, .. } = recording;
    let Integrator::Path(path) = &settings.integrator else {
        return Err(PathUploadError::Lighting { what: "the integrator" });
    };
    let flags = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
    let expected_flags = flags(settings.is_transparent, flag::TRANSPARENT)
        | flags(settings.sky.is_visible, flag::SKY_SEEN)
        | flags(settings.ground.is_some(), flag::GROUND);
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
        ("the start of roulette", lighting.roulette_from == path.roulette_from),
        ("how lights are sampled", lighting.light_sampling == path.light_sampling.code()),
        ("the depth of paths", recording.max_depth == path.max_depth),
        ("the ground", is_ground),
        ("the pixel filter", lighting.filter_table[..] == filter[..]),
        ("the sky", is_sky(settings, lighting, recording)),
    ];
    match all.into_iter().find(|(_, is_right)| !is_right) {
        None => Ok(()),
        Some((what, _)) => Err(PathUploadError::Lighting { what }),
    }
}

fn is_sky(
    settings: &RenderSettings,
    lighting: &UploadedLighting,
    recording: &PathRecording,
) -> bool {
    let ends = [lighting.zenith, lighting.horizon, lighting.nadir];
    let are = |colors: [[f32; 3]; 3]| {
        ends.into_iter().zip(colors).all(|(a, b)| are_near(a, b.map(f64::from)))
    };
    match &settings.sky.light {
        SkyLight::Constant(radiance) => recording.sky.is_none() && are([radiance.to_array(); 3]),
        SkyLight::Gradient { zenith, horizon, nadir } => {
            recording.sky.is_none() && are([zenith, horizon, nadir].map(|end| end.to_array()))
        }
        SkyLight::Image { environment, strength, rotation } => {
            let shares = environment.rows().iter().chain(environment.columns());
            lighting.environment_size == [environment.width(), environment.height()]
                && are_near(
                    lighting.environment_rotation,
                    Environment::rotation(*rotation).map(f64::from),
                )
                && is_near(lighting.environment_strength, (*strength).into())
                && recording.sky.as_ref().is_some_and(|sky| {
                    sky.texels == environment.texels() && sky.shares.iter().eq(shares)
                })
        }
    }
}
