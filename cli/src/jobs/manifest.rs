//! The description of a job, the file `job.json`, and its units. A unit's index means a tile of a picture.

use std::path::Path;

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::jobs::files::{self, InputFile};
use crate::terminal::failure::Failure;
use pinhole::image::{Layer, LayerSet};
use pinhole::internals::text::one_line;

/// The name of the file in the folder of a job.
pub(crate) const NAME: &str = "job.json";

/// The version of the format. Other versions are refused, because the bytes of parts depend on it.
const FORMAT: u32 = 1;

pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The most units of a job. Each unit is a file, and all files are looked at together.
pub(crate) const MOST_UNITS: usize = 1_000_000;

/// A job. Each unit of work is a tile of a picture, or a group of bricks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Manifest {
    pub(crate) pinhole_job: u32,
    pub(crate) version: String,
    /// The digest of this file, computed with an empty text in this field.
    pub(crate) sha256: String,
    pub(crate) unit: UnitKind,
    pub(crate) units: usize,
    /// The arguments of the program that split the job.
    pub(crate) arguments: Vec<String>,
    /// The folder to which paths are relative.
    pub(crate) folder: String,
    /// The files that were read, the scene or the data first.
    pub(crate) files: Vec<InputFile>,
    /// The numbers of the pictures; `None` for a single picture, which has no number.
    pub(crate) pictures: Option<Vec<usize>>,
    /// Width and height of the picture of one eye.
    pub(crate) size: [u32; 2],
    /// The number of eyes: 2 for a stereo camera, 1 for others.
    pub(crate) eyes: u32,
    /// The bricks of each unit that is a group of bricks: the first, and the one after the last. Empty for tiles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) groups: Vec<[usize; 2]>,
    pub(crate) tiles: [u32; 2],
    /// The layers of parts, which may be more than those of the pictures, because outlines and denoising need some.
    pub(crate) layers: Vec<String>,
    pub(crate) merged_layers: Vec<String>,
    pub(crate) integrator: String,
    pub(crate) samples: u32,
    pub(crate) seed: u32,
    /// Whether noise is removed when parts are merged.
    pub(crate) denoised: bool,
    /// Facts about all frames.
    pub(crate) overview: Option<StoredOverview>,
}

/// The kinds of units that this version knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum UnitKind {
    Tile,
    /// Some bricks. Every part has the nearest hit in these bricks for all pixels.
    Depth,
}

/// The contents of [`Overview`](crate::frames::Overview). Its numbers are in the file `overview.bin`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StoredOverview {
    pub(crate) sha256: String,
    /// The number of spheres, and the number of those that were added to the data.
    pub(crate) spheres: usize,
    pub(crate) added: usize,
    /// Whether two numbers before the spheres are the range of colours.
    pub(crate) has_range: bool,
    pub(crate) categories: Vec<String>,
    pub(crate) missing: Option<[u8; 3]>,
    /// The bits of the scale of arrows.
    pub(crate) arrow_scale: Option<u64>,
    pub(crate) kinds_from: Option<usize>,
}

impl Manifest {
    /// The text of the file, with the digest.
    pub(crate) fn sealed(mut self) -> Result<(Self, String)> {
        self.sha256 = self.digest()?;
        let text = serde_json::to_string_pretty(&self)? + "\n";
        Ok((self, text))
    }

    fn digest(&self) -> Result<String> {
        let unsealed = Self { sha256: String::new(), ..self.clone() };
        Ok(files::hex(serde_json::to_string(&unsealed)?.as_bytes()))
    }

    pub(crate) fn read(path: &Path) -> Result<Self> {
        let place = || path.display().to_string();
        let bytes = files::read(path).with_context(|| format!("{}: this is not the folder of a job", place()))?;
        Self::parse(&bytes).with_context(place)
    }

    fn parse(text: &[u8]) -> Result<Self> {
        let damaged = "this file is damaged; split the job again";
        let value: Value = serde_json::from_slice(text).context(damaged)?;
        let known = |key: &str| value.get(key).map(Value::to_string).unwrap_or_default();
        let (format, version) = (known("pinhole_job"), known("version"));
        if format.is_empty() {
            bail!("this is not the file of a job");
        }
        if format != FORMAT.to_string() || version != format!("\"{VERSION}\"") {
            bail!(
                "this job is of pinhole {}, and this is pinhole {VERSION}, whose pixels may differ; use the same \
                 version, or split the job again",
                one_line(version.trim_matches('"'))
            );
        }
        let manifest: Self = serde_json::from_value(value).context(damaged)?;
        if manifest.digest()? != manifest.sha256 || !manifest.is_consistent() {
            bail!("{damaged}");
        }
        Ok(manifest)
    }

    fn is_consistent(&self) -> bool {
        if !(1..=2).contains(&self.eyes) {
            return false;
        }
        if self.unit == UnitKind::Depth {
            let follows = self.groups.windows(2).all(|pair| pair[0][1] == pair[1][0]);
            let are_some = self.groups.iter().all(|[first, end]| first < end);
            let is_one = self.pictures.is_none() && self.tiles == [1, 1] && self.units > 0;
            return follows && are_some && is_one && self.groups.len() == self.units;
        }
        let pictures = self.pictures.as_ref().map_or(1, Vec::len);
        let has_tiles = self.groups.is_empty() && (0..2).all(|axis| (1..=self.size[axis]).contains(&self.tiles[axis]));
        let units = units_of_tiles(pictures, self.tiles);
        has_tiles && units == Some(self.units) && self.units > 0
    }

    pub(crate) fn is_by_depth(&self) -> bool {
        self.unit == UnitKind::Depth
    }

    pub(crate) fn units_of_picture(&self) -> usize {
        if self.is_by_depth() {
            return self.units;
        }
        self.tiles[0] as usize * self.tiles[1] as usize
    }

    /// The index of a unit's picture among all pictures, and the unit's tile.
    pub(crate) fn unit(&self, index: usize) -> (usize, Rectangle) {
        if self.is_by_depth() {
            return (0, ([0, 0], self.size));
        }
        let tiles = self.units_of_picture();
        (index / tiles, tile(self.size, self.tiles, index % tiles))
    }

    /// The number of the picture of a unit; `None` for a single picture.
    pub(crate) fn number(&self, index: usize) -> Option<usize> {
        self.pictures.as_ref()?.get(index / self.units_of_picture()).copied()
    }

    pub(crate) fn layer_set(&self) -> LayerSet {
        layer_set(&self.layers)
    }
}

/// The number of units for tiles of pictures; `None` if it is more than [`MOST_UNITS`].
pub(crate) fn units_of_tiles(pictures: usize, tiles: [u32; 2]) -> Option<usize> {
    let [columns, rows] = tiles.map(|side| side as usize);
    let units = pictures.checked_mul(columns * rows)?;
    (units <= MOST_UNITS).then_some(units)
}

/// The layers with these names. Other names are ignored.
pub(crate) fn layer_set(names: &[String]) -> LayerSet {
    names.iter().filter_map(|name| name.parse::<Layer>().ok()).collect()
}

pub(crate) fn layer_names(layers: LayerSet) -> Vec<String> {
    layers.iter().map(|layer| layer.name().to_owned()).collect()
}

/// A rectangle of a picture: column and row of the first pixel, then width and height.
pub(crate) type Rectangle = ([u32; 2], [u32; 2]);

/// A tile by its number, counted row by row, of a picture of `size` pixels that is divided into columns and rows.
pub(crate) fn tile(size: [u32; 2], tiles: [u32; 2], number: usize) -> Rectangle {
    let columns = tiles[0] as usize;
    let place = [number % columns, number / columns];
    let edge = |axis: usize, at: usize| {
        // The result is at most the side, so it fits.
        (u64::from(size[axis]) * at as u64 / u64::from(tiles[axis])) as u32
    };
    let origin = [0, 1].map(|axis| edge(axis, place[axis]));
    let end = [0, 1].map(|axis| edge(axis, place[axis] + 1));
    (origin, [end[0] - origin[0], end[1] - origin[1]])
}

/// Reads columns and rows of tiles, such as `4x4`, for a picture of `size` pixels.
pub(crate) fn parse_tiles(text: &str, size: [u32; 2]) -> Result<[u32; 2], Failure> {
    let sides = text
        .split_once('x')
        .and_then(|(columns, rows)| Some([columns.trim().parse::<u32>().ok()?, rows.trim().parse::<u32>().ok()?]));
    let Some(tiles) = sides.filter(|sides| !sides.contains(&0)) else {
        return Err(Failure::usage(format!("--tiles {text}: write columns and rows that are at least 1, such as 4x4")));
    };
    if tiles[0] > size[0] || tiles[1] > size[1] {
        return Err(Failure::usage(format!(
            "--tiles {text}: a picture of {}x{} pixels has no room for so many tiles; choose fewer",
            size[0], size[1]
        )));
    }
    Ok(tiles)
}

/// Reads indices and ranges of indices below `count`, such as `0-15,20`.
pub(crate) fn parse_list(text: &str, count: usize) -> Result<Vec<usize>, Failure> {
    let wrong = || Failure::usage(format!("INDEX {text}: write an index, or indices and ranges such as 0-15,20"));
    let mut all = Vec::new();
    for range in text.split(',') {
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| wrong());
        let (first, last) = match range.split_once('-') {
            Some((first, last)) => (number(first)?, number(last)?),
            None => (number(range)?, number(range)?),
        };
        if last < first {
            return Err(wrong());
        }
        if last >= count {
            return Err(Failure::usage(format!(
                "INDEX {last}: this job has {count} unit{}, 0 to {}",
                if count == 1 { "" } else { "s" },
                count.saturating_sub(1)
            )));
        }
        all.extend(first..=last);
    }
    all.sort_unstable();
    all.dedup();
    Ok(all)
}

/// Writes ascending indices in the form that `sbatch --array` and [`parse_list`] read.
pub(crate) fn ranges(indices: &[usize]) -> String {
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for &index in indices {
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == index => *last = index,
            _ => ranges.push((index, index)),
        }
    }
    let words = ranges.into_iter().map(|(first, last)| match last - first {
        0 => first.to_string(),
        _ => format!("{first}-{last}"),
    });
    words.collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        for (size, tiles) in [([7, 5], [3, 2]), ([1, 1], [1, 1]), ([100, 3], [100, 3]), ([64, 48], [4, 4])] {
            let mut covered = vec![0; (size[0] * size[1]) as usize];
            for number in 0..(tiles[0] * tiles[1]) as usize {
                let ([x, y], [width, height]) = tile(size, tiles, number);
                assert!(width > 0 && height > 0);
                for row in y..y + height {
                    (x..x + width).for_each(|column| covered[(row * size[0] + column) as usize] += 1);
                }
            }
            assert!(covered.iter().all(|times| *times == 1), "{size:?} {tiles:?}");
        }
        let largest = 1 << 23;
        assert_eq!(tile([largest; 2], [largest; 2], 0), ([0, 0], [1, 1]));
    }

    #[test]
    fn lists_are_read_as_they_are_written() {
        for list in [vec![], vec![0], vec![0, 1, 2, 5, 7, 8], (0..1000).collect::<Vec<_>>()] {
            let text = ranges(&list);
            if !list.is_empty() {
                assert_eq!(parse_list(&text, 1000).unwrap(), list, "{text}");
            }
        }
        assert_eq!(ranges(&[0, 1, 2, 5, 7, 8]), "0-2,5,7-8");
        assert_eq!(parse_list("3, 1-2 ,1", 4).unwrap(), [1, 2, 3]);
        for wrong in ["", "a", "-1", "2-1", "1,", "1-", "4", "0-4", "1:2", "99999999999999999999999"] {
            assert!(parse_list(wrong, 4).is_err(), "{wrong}");
        }
    }

    #[test]
    fn tiles_have_columns_and_rows() {
        assert_eq!(parse_tiles("4x3", [4, 3]).unwrap(), [4, 3]);
        for wrong in ["", "4", "4x", "0x1", "1x0", "-1x1", "5x1", "1x4", "4x3x2"] {
            assert!(parse_tiles(wrong, [4, 3]).is_err(), "{wrong}");
        }
    }
}
