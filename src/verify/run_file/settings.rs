//! Render settings as lists of numbers. Every number of the settings is exact in f64.

use std::sync::Arc;

use glam::DVec3;

use super::RunFileError;
use super::container::contradiction;
use crate::camera::filter::PixelFilter;
use crate::image::color::LinearRgb;
use crate::light::environment::Environment;
use crate::light::{Ground, Light, LightFrame, LightKind, Sky, SkyLight};
use crate::render::{
    DepthCue, Integrator, LightSampling, Occlusion, Outline, PathTracing, RenderSettings, Sampling,
    Studio,
};

/// The numbers of a light: kind, frame, three of a place or direction, colour, and size.
pub(super) type LightNumbers = [f64; 9];

const SAMPLINGS: [LightSampling; 3] =
    [LightSampling::Chance, LightSampling::Direct, LightSampling::Multiple];

const FRAMES: [LightFrame; 2] = [LightFrame::World, LightFrame::Camera];

/// The position of an element in a list.
fn place<T: PartialEq>(all: &[T], one: &T) -> f64 {
    all.iter().position(|of| of == one).unwrap_or(usize::MAX) as f64
}

/// The numbers of settings with light, without those of lights and of the sky's image.
pub(super) fn numbers(settings: &RenderSettings) -> Vec<f64> {
    let mut all = Vec::new();
    let RenderSettings {
        integrator,
        sampling,
        lights: _,
        sky,
        ground,
        background,
        is_transparent,
        is_denoised,
    } = settings;
    match integrator {
        Integrator::Primary(_) => all.push(0.0),
        Integrator::Studio(studio) => {
            all.push(1.0);
            studio_numbers(studio, &mut all);
        }
        Integrator::Path(PathTracing { max_depth, roulette_from, light_sampling }) => {
            let sampling = place(&SAMPLINGS, light_sampling);
            all.extend([2.0, f64::from(*max_depth), f64::from(*roulette_from), sampling]);
        }
    }
    let Sampling { samples, seed, filter } = sampling;
    all.extend([f64::from(*samples), f64::from(*seed), place(PixelFilter::ALL, filter)]);
    let Sky { light, is_visible } = sky;
    match light {
        SkyLight::Constant(color) => {
            all.push(0.0);
            all.extend(rgb(*color));
        }
        SkyLight::Gradient { zenith, horizon, nadir } => {
            all.push(1.0);
            all.extend([zenith, horizon, nadir].into_iter().flat_map(|color| rgb(*color)));
        }
        SkyLight::Image { environment: _, strength, rotation } => {
            all.extend([2.0, f64::from(*strength), *rotation]);
        }
    }
    all.push(f64::from(*is_visible));
    all.push(f64::from(ground.is_some()));
    if let Some(Ground { point, normal, color, is_shadow_catcher }) = ground {
        all.extend(point.to_array().into_iter().chain(normal.to_array()).chain(rgb(*color)));
        all.push(f64::from(*is_shadow_catcher));
    }
    all.extend(rgb(*background));
    all.extend([is_transparent, is_denoised].map(|is| f64::from(*is)));
    all
}

fn studio_numbers(studio: &Studio, all: &mut Vec<f64>) {
    let Studio { ambient, occlusion, has_shadows, max_surfaces, depth_cue, outline } = studio;
    all.extend(rgb(*ambient));
    all.push(f64::from(occlusion.is_some()));
    if let Some(Occlusion { radius, samples }) = occlusion {
        // No radius is zero.
        all.extend([radius.unwrap_or_default(), f64::from(*samples)]);
    }
    all.extend([f64::from(*has_shadows), f64::from(*max_surfaces)]);
    all.push(f64::from(depth_cue.is_some()));
    if let Some(DepthCue { near, far, color }) = depth_cue {
        all.extend([*near, *far].into_iter().chain(rgb(*color)));
    }
    all.push(f64::from(outline.is_some()));
    if let Some(Outline { width, color, depth, angle }) = outline {
        all.push(f64::from(*width));
        all.extend(rgb(*color).into_iter().chain([*depth, *angle].map(f64::from)));
    }
}

fn outline_of(all: &mut Numbers<'_>) -> Result<Outline, RunFileError> {
    Ok(Outline {
        width: all.narrow()?,
        color: all.color()?,
        depth: all.narrow()?,
        angle: all.narrow()?,
    })
}

pub(super) fn light_numbers(light: &Light) -> LightNumbers {
    let (kind, v, color, size) = match light.kind {
        LightKind::Head { strength } => (0.0, DVec3::ZERO, strength, 0.0),
        LightKind::Directional { toward, strength, angular_radius } => {
            (1.0, toward, strength, angular_radius)
        }
        LightKind::Point { position, intensity } => (2.0, position, intensity, 0.0),
        LightKind::Sphere { center, radius, radiance } => (3.0, center, radiance, radius),
    };
    let [r, g, b] = rgb(color);
    [kind, place(&FRAMES, &light.frame), v.x, v.y, v.z, r, g, b, size]
}

fn rgb(color: LinearRgb) -> [f64; 3] {
    color.to_array().map(f64::from)
}

/// Reads numbers one after the other.
struct Numbers<'a>(std::slice::Iter<'a, f64>);

impl Numbers<'_> {
    fn next(&mut self) -> Result<f64, RunFileError> {
        self.0.next().copied().ok_or_else(|| contradiction("the array `settings` is too short"))
    }

    fn several<const N: usize>(&mut self) -> Result<[f64; N], RunFileError> {
        let mut all = [0.0; N];
        for number in &mut all {
            *number = self.next()?;
        }
        Ok(all)
    }

    fn whole(&mut self) -> Result<u32, RunFileError> {
        let number = self.next()?;
        let whole = number as u32;
        let is_whole = number.to_bits() == f64::from(whole).to_bits();
        is_whole.then_some(whole).ok_or_else(|| wrong("is not a whole number of 32 bits", number))
    }

    fn is(&mut self) -> Result<bool, RunFileError> {
        self.one_of(&[false, true])
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> Result<T, RunFileError> {
        let index = self.whole()?;
        let one = all.get(index as usize).copied();
        one.ok_or_else(|| wrong("has no meaning", index.into()))
    }

    fn narrow(&mut self) -> Result<f32, RunFileError> {
        narrow(self.next()?)
    }

    fn color(&mut self) -> Result<LinearRgb, RunFileError> {
        color(self.several()?)
    }
}

fn wrong(what: &str, number: f64) -> RunFileError {
    contradiction(format!("the number {number:?} in `settings` or `lights` {what}"))
}

fn narrow(number: f64) -> Result<f32, RunFileError> {
    let narrow = number as f32;
    let is_f32 = f64::from(narrow).to_bits() == number.to_bits();
    is_f32.then_some(narrow).ok_or_else(|| wrong("is not a number of 32 bits", number))
}

fn color([r, g, b]: [f64; 3]) -> Result<LinearRgb, RunFileError> {
    LinearRgb::new([narrow(r)?, narrow(g)?, narrow(b)?])
        .map_err(|error| contradiction(format!("the settings: {error}")))
}

/// Settings from their numbers. `sky` reads the image of the sky, if there is one.
pub(super) fn settings(
    numbers: &[f64],
    lights: &[LightNumbers],
    sky: impl FnOnce() -> Result<Arc<Environment>, RunFileError>,
) -> Result<RenderSettings, RunFileError> {
    let mut all = Numbers(numbers.iter());
    let all = &mut all;
    let integrator = match all.whole()? {
        1 => Integrator::Studio(studio(all)?),
        2 => Integrator::Path(PathTracing {
            max_depth: all.whole()?,
            roulette_from: all.whole()?,
            light_sampling: all.one_of(&SAMPLINGS)?,
        }),
        other => return Err(wrong("is not an integrator with light", other.into())),
    };
    let sampling = Sampling {
        samples: all.whole()?,
        seed: all.whole()?,
        filter: all.one_of(PixelFilter::ALL)?,
    };
    let light = match all.whole()? {
        0 => SkyLight::Constant(all.color()?),
        1 => {
            SkyLight::Gradient { zenith: all.color()?, horizon: all.color()?, nadir: all.color()? }
        }
        2 => {
            SkyLight::Image { environment: sky()?, strength: all.narrow()?, rotation: all.next()? }
        }
        other => return Err(wrong("is not a sky", other.into())),
    };
    let sky = Sky { light, is_visible: all.is()? };
    let ground = match all.is()? {
        false => None,
        true => Some(Ground {
            point: all.several()?.into(),
            normal: all.several()?.into(),
            color: all.color()?,
            is_shadow_catcher: all.is()?,
        }),
    };
    let settings = RenderSettings {
        integrator,
        sampling,
        lights: lights.iter().map(light_of).collect::<Result<_, _>>()?,
        sky,
        ground,
        background: all.color()?,
        is_transparent: all.is()?,
        is_denoised: all.is()?,
    };
    match all.0.next() {
        None => Ok(settings),
        Some(_) => Err(contradiction("the array `settings` is too long")),
    }
}

fn studio(all: &mut Numbers<'_>) -> Result<Studio, RunFileError> {
    let ambient = all.color()?;
    let occlusion = match all.is()? {
        false => None,
        true => Some(Occlusion {
            radius: Some(all.next()?).filter(|radius| *radius != 0.0),
            samples: all.whole()?,
        }),
    };
    let (has_shadows, max_surfaces) = (all.is()?, all.whole()?);
    let depth_cue = match all.is()? {
        false => None,
        true => Some(DepthCue { near: all.next()?, far: all.next()?, color: all.color()? }),
    };
    let outline = match all.is()? {
        false => None,
        true => Some(outline_of(all)?),
    };
    Ok(Studio { ambient, occlusion, has_shadows, max_surfaces, depth_cue, outline })
}

fn light_of(numbers: &LightNumbers) -> Result<Light, RunFileError> {
    let [kind, frame, x, y, z, r, g, b, size] = *numbers;
    let (v, color) = (DVec3::new(x, y, z), color([r, g, b])?);
    let whole = |number| Numbers([number].iter()).whole();
    let kind = match whole(kind)? {
        0 => LightKind::Head { strength: color },
        1 => LightKind::Directional { toward: v, strength: color, angular_radius: size },
        2 => LightKind::Point { position: v, intensity: color },
        3 => LightKind::Sphere { center: v, radius: size, radiance: color },
        other => return Err(wrong("is not a light", other.into())),
    };
    Ok(Light { kind, frame: Numbers([frame].iter()).one_of(&FRAMES)? })
}
