//! Reads the tables `[studio]` with the tables inside it, `[sampling]` and `[path]`, and joins tables with those of a style.

use serde::Deserialize;
use toml::Spanned;

use crate::scene_file::span::{
    ColorValue, Keys, Lines, Number, SceneFileError, Span, WithSpan, whole,
};
use pinhole::camera::Camera;
use pinhole::camera::filter::PixelFilter;
use pinhole::geometry::math::{MAX_LENGTH, MIN_LENGTH};
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::Table;
use pinhole::range::RangeError;
use pinhole::render::{DepthCue, LightSampling, Occlusion, Outline, PathTracing, Sampling, Studio};
use pinhole::scene::Scene;

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StudioTable {
    ambient: Option<ColorValue>,
    shadows: Option<bool>,
    max_surfaces: Option<Spanned<u32>>,
    occlusion: Option<Spanned<Table<OcclusionTable>>>,
    depth_cue: Option<Spanned<Table<DepthCueTable>>>,
    outline: Option<Spanned<Table<OutlineTable>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OcclusionTable {
    radius: Option<Number>,
    samples: Option<Spanned<u32>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DepthCueTable {
    near: Option<Number>,
    far: Option<Number>,
    color: Option<ColorValue>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OutlineTable {
    width: Option<Number>,
    color: Option<ColorValue>,
    depth: Option<Number>,
    angle: Option<Number>,
}

impl StudioTable {
    /// Takes the keys of this table, and those of a style where there are none.
    pub(super) fn over(self, style: Self) -> Self {
        Self {
            ambient: self.ambient.or(style.ambient),
            shadows: self.shadows.or(style.shadows),
            max_surfaces: self.max_surfaces.or(style.max_surfaces),
            occlusion: either(self.occlusion, style.occlusion, |own, style| OcclusionTable {
                radius: own.radius.or(style.radius),
                samples: own.samples.or(style.samples),
            }),
            depth_cue: either(self.depth_cue, style.depth_cue, |own, style| DepthCueTable {
                near: own.near.or(style.near),
                far: own.far.or(style.far),
                color: own.color.or(style.color),
            }),
            outline: either(self.outline, style.outline, |own, style| OutlineTable {
                width: own.width.or(style.width),
                color: own.color.or(style.color),
                depth: own.depth.or(style.depth),
                angle: own.angle.or(style.angle),
            }),
        }
    }

    /// Returns whether the table gives the radius of the occlusion, an outline, and the depth of an outline.
    pub(super) fn given(&self) -> [bool; 3] {
        let occlusion = self.occlusion.as_ref().map(|table| &table.get_ref().0);
        let outline = self.outline.as_ref().map(|table| &table.get_ref().0);
        [
            occlusion.is_some_and(|occlusion| occlusion.radius.is_some()),
            outline.is_some(),
            outline.is_some_and(|outline| outline.depth.is_some()),
        ]
    }
}

/// The studio as the file gives it; missing values of the depth cue follow from the scene.
#[derive(Debug)]
pub(crate) struct StudioPlan {
    studio: Studio,
    depth_cue: Option<WithSpan<DepthCuePlan>>,
}

#[derive(Debug)]
struct DepthCuePlan {
    near: Option<f64>,
    far: Option<f64>,
    color: Option<LinearRgb>,
}

impl StudioPlan {
    pub(super) fn read(
        table: Option<Spanned<Table<StudioTable>>>,
        lines: &Lines<'_>,
    ) -> Result<Self, SceneFileError> {
        let span = table.as_ref().map_or(Span::START, |table| lines.span(table.span().start));
        let table = table.map(|table| table.into_inner().0).unwrap_or_default();
        let defaults = Studio::default();
        let max_surfaces = table.max_surfaces.as_ref().map(|most| *most.get_ref());
        let bare = Studio {
            ambient: table.ambient.map_or(defaults.ambient, |color| color.0),
            has_shadows: table.shadows.unwrap_or(defaults.has_shadows),
            max_surfaces: max_surfaces.unwrap_or(defaults.max_surfaces),
            ..defaults
        };
        let numbers = vec![("max_surfaces", whole(&table.max_surfaces))];
        check(&bare, &Keys { lines, numbers, table: span })?;
        let occlusion = table.occlusion.map(|table| read_occlusion(table, lines)).transpose()?;
        let outline = table.outline.map(|table| read_outline(table, lines)).transpose()?;
        let depth_cue = table.depth_cue.map(|table| read_depth_cue(table, lines)).transpose()?;
        Ok(Self { studio: Studio { occlusion, outline, ..bare }, depth_cue })
    }

    pub(crate) fn studio(
        &self,
        scene: &Scene,
        camera: &dyn Camera,
        background: LinearRgb,
    ) -> Result<Studio, SceneFileError> {
        let mut studio = self.studio.clone();
        if let Some(WithSpan { value: plan, span }) = &self.depth_cue {
            let [near, far] = reach(scene, camera);
            let near = plan.near.unwrap_or(plan.far.map_or(near, |far| near.min(far / 2.0)));
            let far = plan.far.unwrap_or(if far > near { far } else { near + 1.0 });
            let color = plan.color.unwrap_or(background);
            studio.depth_cue = Some(DepthCue { near, far, color });
            studio.check().map_err(|error| span.error(error))?;
        }
        Ok(studio)
    }
}

/// Returns bounds of the distances from the camera at which there are spheres.
fn reach(scene: &Scene, camera: &dyn Camera) -> [f64; 2] {
    let bounds = scene.bounds_to_frame();
    let distance = (bounds.center() - camera.vectors().origin).length();
    let radius = bounds.size().length() / 2.0;
    [(distance - radius).max(0.0), distance + radius].map(|length| length.min(MAX_LENGTH))
}

/// Checks a studio. An error points to the key that it names.
fn check(studio: &Studio, keys: &Keys<'_>) -> Result<(), SceneFileError> {
    studio.check().map_err(|error| keys.refused(&error))
}

fn read_occlusion(
    table: Spanned<Table<OcclusionTable>>,
    lines: &Lines<'_>,
) -> Result<Occlusion, SceneFileError> {
    let span = lines.span(table.span().start);
    let OcclusionTable { radius, samples } = table.into_inner().0;
    let defaults = Occlusion::default();
    let occlusion = Occlusion {
        radius: radius.as_ref().map(|radius| *radius.get_ref()),
        samples: samples.as_ref().map_or(defaults.samples, |samples| *samples.get_ref()),
    };
    let numbers = vec![("radius", radius), ("samples", whole(&samples))];
    let studio = Studio { occlusion: Some(occlusion), ..Studio::default() };
    check(&studio, &Keys { lines, numbers, table: span })?;
    Ok(occlusion)
}

fn read_outline(
    table: Spanned<Table<OutlineTable>>,
    lines: &Lines<'_>,
) -> Result<Outline, SceneFileError> {
    let span = lines.span(table.span().start);
    let OutlineTable { width, color, depth, angle } = table.into_inner().0;
    let keys = Keys {
        lines,
        numbers: vec![("width", width), ("depth", depth), ("angle", angle)],
        table: span,
    };
    let defaults = Outline::default();
    let any = [f64::NEG_INFINITY, f64::INFINITY];
    let number = |key, default: f32| {
        let given = keys.within(key, any, "a number")?;
        Ok(given.map_or(default, |number| number as f32))
    };
    let degrees = keys.within("angle", [0.0, 180.0], "from 0 to 180 degrees")?;
    let outline = Outline {
        width: number("width", defaults.width)?,
        color: color.map_or(defaults.color, |color| color.0),
        depth: number("depth", defaults.depth)?,
        angle: degrees.map_or(defaults.angle, |degrees| degrees.to_radians() as f32),
    };
    check(&Studio { outline: Some(outline), ..Studio::default() }, &keys)?;
    Ok(outline)
}

fn read_depth_cue(
    table: Spanned<Table<DepthCueTable>>,
    lines: &Lines<'_>,
) -> Result<WithSpan<DepthCuePlan>, SceneFileError> {
    let span = lines.span(table.span().start);
    let DepthCueTable { near, far, color } = table.into_inner().0;
    let keys = Keys { lines, numbers: vec![("near", near), ("far", far)], table: span };
    let near = keys.within("near", [0.0, MAX_LENGTH], "0 or more, and at most 2^56")?;
    let range = "more than `near`, and from 2^-56 to 2^56";
    let far = keys.within("far", [MIN_LENGTH, MAX_LENGTH], range)?;
    if let Some(far) = far.filter(|far| *far <= near.unwrap_or(0.0)) {
        let range = "more than `near`";
        return Err(keys.refused(&RangeError { parameter: "far", value: far, range }));
    }
    let value = DepthCuePlan { near, far, color: color.map(|color| color.0) };
    Ok(WithSpan { value, span })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SamplingTable {
    samples: Option<Spanned<u32>>,
    seed: Option<u32>,
    filter: Option<PixelFilter>,
    denoise: Option<bool>,
}

impl SamplingTable {
    /// Takes the keys of this table, and those of a style where there are none.
    pub(super) fn over(self, style: Self) -> Self {
        Self {
            samples: self.samples.or(style.samples),
            seed: self.seed.or(style.seed),
            filter: self.filter.or(style.filter),
            denoise: self.denoise.or(style.denoise),
        }
    }
}

pub(super) fn is_denoised(table: &Option<Spanned<Table<SamplingTable>>>) -> bool {
    table.as_ref().and_then(|table| table.get_ref().0.denoise).unwrap_or(false)
}

pub(super) fn read_sampling(
    table: Option<Spanned<Table<SamplingTable>>>,
    lines: &Lines<'_>,
) -> Result<Sampling, SceneFileError> {
    let defaults = Sampling::default();
    let Some(table) = table else {
        return Ok(defaults);
    };
    let start = table.span().start;
    let SamplingTable { samples, seed, filter, .. } = table.into_inner().0;
    let sampling = Sampling {
        samples: samples.as_ref().map_or(defaults.samples, |samples| *samples.get_ref()),
        seed: seed.unwrap_or(defaults.seed),
        filter: filter.unwrap_or(defaults.filter),
    };
    let numbers = vec![("samples", whole(&samples))];
    let keys = Keys { lines, numbers, table: lines.span(start) };
    sampling.check().map(|()| sampling).map_err(|error| keys.refused(&error))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PathTable {
    max_depth: Option<Spanned<u32>>,
    roulette_from: Option<u32>,
    light_sampling: Option<LightSampling>,
}

impl PathTable {
    /// Takes the keys of this table, and those of a style where there are none.
    pub(super) fn over(self, style: Self) -> Self {
        Self {
            max_depth: self.max_depth.or(style.max_depth),
            roulette_from: self.roulette_from.or(style.roulette_from),
            light_sampling: self.light_sampling.or(style.light_sampling),
        }
    }
}

pub(super) fn read_path(
    table: Option<Spanned<Table<PathTable>>>,
    lines: &Lines<'_>,
) -> Result<PathTracing, SceneFileError> {
    let defaults = PathTracing::default();
    let Some(table) = table else {
        return Ok(defaults);
    };
    let start = table.span().start;
    let PathTable { max_depth, roulette_from, light_sampling } = table.into_inner().0;
    let path = PathTracing {
        max_depth: max_depth.as_ref().map_or(defaults.max_depth, |depth| *depth.get_ref()),
        roulette_from: roulette_from.unwrap_or(defaults.roulette_from),
        light_sampling: light_sampling.unwrap_or(defaults.light_sampling),
    };
    let numbers = vec![("max_depth", whole(&max_depth))];
    let keys = Keys { lines, numbers, table: lines.span(start) };
    path.check().map(|()| path).map_err(|error| keys.refused(&error))
}

/// Joins a table of a file with that of its style.
pub(super) fn either<T>(
    own: Option<Spanned<Table<T>>>,
    style: Option<Spanned<Table<T>>>,
    over: impl FnOnce(T, T) -> T,
) -> Option<Spanned<Table<T>>> {
    match (own, style) {
        (Some(own), Some(style)) => {
            let (span, style) = (own.span(), style.into_inner().0);
            Some(Spanned::new(span, Table(over(own.into_inner().0, style))))
        }
        (own, style) => own.or(style),
    }
}
