//! Reads the tables `[sampling]` and `[path]`.

use serde::Deserialize;
use toml::Spanned;

use crate::camera::filter::PixelFilter;
use crate::exact::Table;
use crate::render::{LightSampling, PathTracing, Sampling};
use crate::scene_file::span::{Keys, Lines, SceneFileError, whole};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene_file) struct SamplingTable {
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
pub(in crate::scene_file) struct PathTable {
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
