//! Light for the molecule.

use pinhole::glam::DVec3;
use pinhole::light::{Light, LightFrame, LightKind};
use pinhole::render::{Occlusion, Sampling, Studio};
use pinhole::{Integrator, LinearRgb, RenderSettings};

/// The colour behind the spheres.
pub fn background() -> LinearRgb {
    LinearRgb::from_srgb8([0xf3, 0xf4, 0xf6])
}

/// A studio: one light with shadows, fixed to the camera at an angle in radians about it, and ambient light that does
/// not reach into pockets.
pub fn studio(angle: f64, samples: u32) -> RenderSettings {
    let studio = Studio {
        ambient: LinearRgb::from_srgb8([188; 3]),
        occlusion: Some(Occlusion { radius: Some(1.5), samples: 1 }),
        ..Studio::default()
    };
    let (x, y) = angle.sin_cos();
    let key = Light {
        kind: LightKind::Directional {
            toward: DVec3::new(x, y, 1.0),
            strength: LinearRgb::from_srgb8([203; 3]),
            angular_radius: 0.05,
        },
        frame: LightFrame::Camera,
    };
    RenderSettings {
        integrator: Integrator::Studio(studio),
        sampling: Sampling { samples, ..Sampling::default() },
        lights: vec![key],
        background: background(),
        ..RenderSettings::default()
    }
}

/// Path tracing under the same light and a soft sky.
pub fn paths(angle: f64, samples: u32) -> RenderSettings {
    let RenderSettings { lights, sampling, .. } = studio(angle, samples);
    RenderSettings { lights, sampling, background: background(), ..RenderSettings::path() }
}
