//! What describes a job: the file `job.json`.

use std::path::Path;

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::files::{self, InputFile};
use super::units::{Rectangle, tile};
use pinhole::image::{Layer, LayerSet};

/// The name of the file in the folder of a job.
pub(super) const NAME: &str = "job.json";

/// The version of the format. Another one is refused, because bytes depend on it.
const FORMAT: u32 = 1;

/// This version of the program.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The most units of a job. Each is a file, and all of them are looked at together.
pub(super) const MOST_UNITS: usize = 1_000_000;

/// A job. Each unit of work is a tile of a picture, or a group of bricks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Manifest {
    /// The version of this format.
    pub(super) pinhole_job: u32,
    /// The version of the program.
    pub(super) version: String,
    /// The digest of this file with an empty text here.
    pub(super) sha256: String,
    /// What a unit is.
    pub(super) unit: UnitKind,
    /// How many units there are.
    pub(super) units: usize,
    /// The arguments of the program that split the job.
    pub(super) arguments: Vec<String>,
    /// The folder in which relative paths begin.
    pub(super) folder: String,
    /// The files that were read, the scene or the data first.
    pub(super) files: Vec<InputFile>,
    /// The numbers of the pictures; `None` for a single picture, which has no number.
    pub(super) pictures: Option<Vec<usize>>,
    /// Width and height of the picture of one eye.
    pub(super) size: [u32; 2],
    /// 2 for a camera with two eyes.
    pub(super) eyes: u32,
    /// The bricks of each unit that is a group of them: the first, and the one after the last. Empty for tiles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) groups: Vec<[usize; 2]>,
    /// Columns and rows of tiles.
    pub(super) tiles: [u32; 2],
    /// The layers of parts, which may be more than those of the pictures: outlines and denoising are guided by them.
    pub(super) layers: Vec<String>,
    /// The layers that can be merged.
    pub(super) merged_layers: Vec<String>,
    pub(super) integrator: String,
    pub(super) samples: u32,
    pub(super) seed: u32,
    /// Whether noise is removed when parts are merged.
    pub(super) denoised: bool,
    /// What all frames are together.
    pub(super) overview: Option<StoredOverview>,
}

/// The kinds of units that this version knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum UnitKind {
    /// A tile of a picture.
    Tile,
    /// Some bricks, of which every part has what is nearest in all pixels.
    Depth,
}

/// What [`Overview`](crate::frames::Overview) holds; its numbers are in the file `overview.bin`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredOverview {
    /// The digest of the file.
    pub(super) sha256: String,
    /// How many spheres there are, and how many of them were added to the data.
    pub(super) spheres: usize,
    pub(super) added: usize,
    /// Whether two numbers before the spheres are the range of the colors.
    pub(super) has_range: bool,
    pub(super) categories: Vec<String>,
    pub(super) missing: Option<[u8; 3]>,
    pub(super) kinds_from: Option<usize>,
}

impl Manifest {
    /// The text of the file, with the digest.
    pub(super) fn sealed(mut self) -> Result<(Self, String)> {
        self.sha256 = self.digest()?;
        let text = serde_json::to_string_pretty(&self)? + "\n";
        Ok((self, text))
    }

    fn digest(&self) -> Result<String> {
        let unsealed = Self { sha256: String::new(), ..self.clone() };
        Ok(files::hex(serde_json::to_string(&unsealed)?.as_bytes()))
    }

    /// Reads the file of a job.
    pub(super) fn read(path: &Path) -> Result<Self> {
        let place = || path.display().to_string();
        let text = files::read_text(path)
            .with_context(|| format!("{}: this is not the folder of a job", place()))?;
        Self::parse(&text).with_context(place)
    }

    fn parse(text: &str) -> Result<Self> {
        let damaged = "this file is damaged; split the job again";
        let value: Value = serde_json::from_str(text).context(damaged)?;
        let known = |key: &str| value.get(key).map(Value::to_string).unwrap_or_default();
        let (format, version) = (known("pinhole_job"), known("version"));
        if format.is_empty() {
            bail!("this is not the file of a job");
        }
        if format != FORMAT.to_string() || version != format!("\"{VERSION}\"") {
            bail!(
                "this job is of pinhole {}, and this is pinhole {VERSION}, whose pixels may differ; use the same \
                 version, or split the job again",
                version.trim_matches('"')
            );
        }
        let manifest: Self = serde_json::from_value(value).context(damaged)?;
        if manifest.digest()? != manifest.sha256 || !manifest.is_consistent() {
            bail!("{damaged}");
        }
        Ok(manifest)
    }

    fn is_consistent(&self) -> bool {
        if self.unit == UnitKind::Depth {
            let follows = self.groups.windows(2).all(|pair| pair[0][1] == pair[1][0]);
            let are_some = self.groups.iter().all(|[first, end]| first < end);
            let is_one = self.pictures.is_none() && self.tiles == [1, 1] && self.units > 0;
            return follows && are_some && is_one && self.groups.len() == self.units;
        }
        let pictures = self.pictures.as_ref().map_or(1, Vec::len);
        let has_tiles = self.groups.is_empty()
            && (0..2).all(|axis| (1..=self.size[axis]).contains(&self.tiles[axis]));
        let units = units_of_tiles(pictures, self.tiles);
        has_tiles && units == Some(self.units) && self.units > 0
    }

    /// Whether units are groups of bricks.
    pub(super) fn is_by_depth(&self) -> bool {
        self.unit == UnitKind::Depth
    }

    /// How many units a picture has.
    pub(super) fn units_of_picture(&self) -> usize {
        if self.is_by_depth() {
            return self.units;
        }
        self.tiles[0] as usize * self.tiles[1] as usize
    }

    /// The place among all pictures, and the tile, of a unit.
    pub(super) fn unit(&self, index: usize) -> (usize, Rectangle) {
        if self.is_by_depth() {
            return (0, ([0, 0], self.size));
        }
        let tiles = self.units_of_picture();
        (index / tiles, tile(self.size, self.tiles, index % tiles))
    }

    /// The number of the picture of a unit; `None` for a single picture.
    pub(super) fn number(&self, index: usize) -> Option<usize> {
        self.pictures.as_ref()?.get(index / self.units_of_picture()).copied()
    }

    /// The layers of parts.
    pub(super) fn layer_set(&self) -> LayerSet {
        layer_set(&self.layers)
    }
}

/// How many units tiles of pictures are; `None` if that is more than [`MOST_UNITS`].
pub(super) fn units_of_tiles(pictures: usize, tiles: [u32; 2]) -> Option<usize> {
    let [columns, rows] = tiles.map(|side| side as usize);
    let units = pictures.checked_mul(columns * rows)?;
    (units <= MOST_UNITS).then_some(units)
}

/// The layers with these names; others are left out.
pub(super) fn layer_set(names: &[String]) -> LayerSet {
    names.iter().filter_map(|name| name.parse::<Layer>().ok()).collect()
}

/// The names of layers.
pub(super) fn layer_names(layers: LayerSet) -> Vec<String> {
    layers.iter().map(|layer| layer.name().to_owned()).collect()
}
