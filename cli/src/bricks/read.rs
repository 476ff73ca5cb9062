//! Reads files of bricks, and reports what a file contains.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, anyhow, bail};
use data_encoding::HEXLOWER;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::bricks::file::{
    BEFORE, DIGEST, Header, LONGEST_HEADER, NAME, PLACE, START, Section, StoredColors, corner, extent,
};
use crate::input::read_file;
use crate::terminal::memory::readable;
use crate::terminal::text;
use pinhole::LinearRgb;
use pinhole::geometry::bounds::Bounds;
use pinhole::scene::{Appearance, Colors, Scene, SceneExtent};

/// Number of bytes that are read at a time.
const PIECE: usize = 1 << 20;

/// A file of bricks whose header was read and checked.
#[derive(Debug)]
pub(crate) struct BrickFile {
    pub(super) path: PathBuf,
    pub(super) header: Header,
    pub(super) whole: SceneExtent,
}

/// A brick in memory.
pub(super) struct ReadBrick {
    pub(super) scene: Scene,
    /// The spheres' ids in the file that was sorted, ascending.
    pub(super) ids: Vec<u32>,
}

impl BrickFile {
    pub(crate) fn open(path: &Path) -> Result<Arc<Self>> {
        let named = || path.display().to_string();
        let cannot = || format!("{}: cannot be read", path.display());
        let mut file = read_file::open(path)?;
        let length = file.metadata().with_context(cannot)?.len();
        let mut start = [0; BEFORE as usize];
        let read = file.by_ref().take(BEFORE).read(&mut start).with_context(cannot)?;
        let header = parse(&mut file, &start[..read], length).with_context(named)?;
        let whole = header.whole.whole().ok_or_else(|| anyhow!("{DAMAGED}")).with_context(named)?;
        Ok(Arc::new(Self { path: path.to_path_buf(), header, whole }))
    }

    pub(crate) fn whole(&self) -> &SceneExtent {
        &self.whole
    }

    pub(crate) fn z_is_up(&self) -> bool {
        self.header.z_is_up
    }

    pub(crate) fn has_atoms(&self) -> bool {
        self.header.has_atoms
    }

    /// Whether the file has colours for the spheres.
    pub(crate) fn has_colors(&self) -> bool {
        self.header.colors != StoredColors::None
    }

    pub(crate) fn len(&self) -> usize {
        self.header.bricks.len()
    }

    pub(crate) fn largest(&self) -> u64 {
        self.header.bricks.iter().map(|brick| brick.section.count).max().unwrap_or(0)
    }

    /// Divides the bricks into groups of consecutive bricks, which lie together, with about equal numbers of spheres.
    /// Each group has its first brick and the one after its last. There must be at least as many bricks as groups.
    pub(crate) fn groups(&self, groups: usize) -> Vec<[usize; 2]> {
        let counts: Vec<u64> = (0..self.len()).map(|brick| self.count(brick)).collect();
        divided(&counts, groups)
    }

    #[cfg(feature = "gpu")]
    pub(crate) fn largest_scene(&self, color: LinearRgb) -> Result<Scene> {
        let bricks = 0..self.len();
        let largest = bricks.max_by_key(|brick| self.count(*brick)).unwrap_or(0);
        Ok(self.read(largest, color)?.scene)
    }

    pub(crate) fn count(&self, brick: usize) -> u64 {
        self.header.bricks.get(brick).map_or(0, |brick| brick.section.count)
    }

    /// The box of a brick in world space.
    pub(super) fn bounds(&self, brick: usize) -> Option<Bounds> {
        let brick = self.header.bricks.get(brick)?;
        let origin = self.whole.origin();
        extent(origin + corner(brick.min).as_dvec3(), origin + corner(brick.max).as_dvec3())
    }

    /// The spheres that determine what a camera frames, as a scene that stands for all spheres.
    pub(crate) fn stand_in(&self, color: LinearRgb) -> Result<Scene> {
        let mut digest = Sha256::new();
        let mut file = self.at(&self.header.outer)?;
        let spheres = self.spheres(&mut file, self.header.outer.count, &mut digest)?;
        self.check(&self.header.outer, digest)?;
        self.part(spheres, self.one_color(color).into())
    }

    /// Reads a brick and checks every byte of it. Spheres without colours get `color`.
    pub(super) fn read(&self, brick: usize, color: LinearRgb) -> Result<ReadBrick> {
        let section = &self.header.bricks.get(brick).ok_or_else(|| self.damaged())?.section;
        let mut digest = Sha256::new();
        let mut file = self.at(section)?;
        let spheres = self.spheres(&mut file, section.count, &mut digest)?;
        let ids = self.words(&mut file, section.count, &mut digest)?;
        let colors = match &self.header.colors {
            StoredColors::None | StoredColors::One(_) => Colors::One(self.one_color(color)),
            StoredColors::Palette(palette) => {
                let palette = palette.iter().map(|bits| linear(*bits)).collect::<Option<_>>();
                let indices = self.words(&mut file, section.count, &mut digest)?;
                Colors::Palette { palette: palette.ok_or_else(|| self.damaged())?, indices }
            }
            StoredColors::Rgba8 => {
                let words = self.words(&mut file, section.count, &mut digest)?;
                Colors::Rgba8(words.into_iter().map(u32::to_le_bytes).collect())
            }
        };
        self.check(section, digest)?;
        let last = ids.last().copied().unwrap_or(0);
        if !ids.is_sorted_by(|a, b| a < b) || u64::from(last) >= self.whole.count {
            return Err(self.damaged());
        }
        Ok(ReadBrick { scene: self.part(spheres, Appearance::new(colors))?, ids })
    }

    fn one_color(&self, color: LinearRgb) -> LinearRgb {
        match self.header.colors {
            StoredColors::One(bits) => linear(bits).unwrap_or(color),
            _ => color,
        }
    }

    fn part(&self, spheres: Vec<[f32; 4]>, appearance: Appearance) -> Result<Scene> {
        Scene::part(self.whole, spheres, appearance).with_context(|| self.name())
    }

    fn name(&self) -> String {
        self.path.display().to_string()
    }

    fn damaged(&self) -> anyhow::Error {
        anyhow!("{}: {DAMAGED}", self.path.display())
    }

    /// Opens the file at the start of a section.
    fn at(&self, section: &Section) -> Result<File> {
        let cannot = || format!("{}: cannot be read", self.path.display());
        let mut file = read_file::open(&self.path)?;
        file.seek(SeekFrom::Start(section.offset)).with_context(cannot)?;
        Ok(file)
    }

    fn check(&self, section: &Section, digest: Sha256) -> Result<()> {
        let is_same = HEXLOWER.encode(&digest.finalize()) == section.sha256;
        is_same.then_some(()).ok_or_else(|| self.damaged())
    }

    fn spheres(&self, file: &mut File, count: u64, digest: &mut Sha256) -> Result<Vec<[f32; 4]>> {
        let sphere = |bytes: &[u8; 16]| {
            let mut numbers = bytes.as_chunks::<4>().0.iter().map(|word| f32::from_le_bytes(*word));
            std::array::from_fn(|_| numbers.next().unwrap_or(f32::NAN))
        };
        self.values(file, count, digest, sphere)
    }

    fn words(&self, file: &mut File, count: u64, digest: &mut Sha256) -> Result<Vec<u32>> {
        self.values(file, count, digest, |bytes: &[u8; 4]| u32::from_le_bytes(*bytes))
    }

    fn values<T, const N: usize>(
        &self,
        file: &mut File,
        count: u64,
        digest: &mut Sha256,
        value: impl Fn(&[u8; N]) -> T,
    ) -> Result<Vec<T>> {
        let mut values = Vec::new();
        let count = usize::try_from(count).map_err(|_| self.damaged())?;
        values
            .try_reserve_exact(count)
            .with_context(|| format!("{}: there is not enough memory for {count} spheres", self.path.display()))?;
        let mut piece = vec![0; PIECE];
        let mut own = Sha256::new();
        let mut left = count * N;
        while left > 0 {
            let piece = &mut piece[..left.min(PIECE)];
            file.read_exact(piece).with_context(|| format!("{}: cannot be read", self.path.display()))?;
            own.update(&*piece);
            values.extend(piece.as_chunks::<N>().0.iter().map(&value));
            left -= piece.len();
        }
        // The digest of a brick is the digest of the digests of its parts.
        digest.update(own.finalize());
        Ok(values)
    }
}

fn divided(counts: &[u64], groups: usize) -> Vec<[usize; 2]> {
    let total: u64 = counts.iter().sum();
    let (mut end, mut before) = (0, 0);
    let group = |number: usize| {
        let first = end;
        let wanted = u128::from(total) * (number as u128 + 1) / groups as u128;
        // At least one brick is left for each of the other groups.
        let most = counts.len() - (groups - 1 - number);
        while end < most {
            let with = before + counts[end];
            let is_nearer = u128::from(2 * before + counts[end]) < 2 * wanted;
            if end > first && !is_nearer && number + 1 < groups {
                break;
            }
            (before, end) = (with, end + 1);
        }
        [first, end]
    };
    (0..groups).map(group).collect()
}

const DAMAGED: &str = "this file of bricks is damaged or cut off; sort the data again";

fn linear(bits: [u32; 3]) -> Option<LinearRgb> {
    LinearRgb::new(bits.map(f32::from_bits)).ok()
}

fn parse(file: &mut File, start: &[u8], length: u64) -> Result<Header> {
    if !start.starts_with(NAME) {
        bail!("this is not a file of bricks; make one with `pinhole sort DATA -o FILE.bricks`");
    }
    if !start.starts_with(START) && start.len() >= START.len() {
        bail!("this file of bricks is of another version of its format; sort the data again");
    }
    let word = |at: usize| {
        let word = start.get(at..at + 8).and_then(|word| word.first_chunk::<8>());
        word.map(|word| u64::from_le_bytes(*word)).ok_or_else(|| anyhow!("{DAMAGED}"))
    };
    let (place, bytes) = (word(PLACE)?, word(PLACE + 8)?);
    let end = place.checked_add(bytes).and_then(|end| end.checked_add(DIGEST as u64));
    if bytes > LONGEST_HEADER || end != Some(length) {
        bail!("{DAMAGED}");
    }
    let mut rest = Vec::new();
    file.seek(SeekFrom::Start(place))?;
    file.take(bytes + DIGEST as u64).read_to_end(&mut rest)?;
    let (text, digest) = rest.split_last_chunk::<DIGEST>().ok_or_else(|| anyhow!("{DAMAGED}"))?;
    let found = Sha256::new().chain_update(start).chain_update(text).finalize();
    if found.as_slice() != digest {
        bail!("{DAMAGED}");
    }
    let header: Header = serde_json::from_slice(text).map_err(|_| anyhow!("{DAMAGED}"))?;
    if header.version != env!("CARGO_PKG_VERSION") {
        bail!(
            "this file is of pinhole {}, and this is pinhole {}; sort the data again",
            header.version,
            env!("CARGO_PKG_VERSION")
        );
    }
    if !header.is_consistent(place) {
        bail!("{DAMAGED}");
    }
    Ok(header)
}

/// The contents of a file of bricks.
#[derive(Serialize)]
pub(crate) struct Report {
    version: &'static str,
    file: String,
    bytes: u64,
    kind: &'static str,
    source: String,
    spheres: u64,
    min: [f64; 3],
    max: [f64; 3],
    radius_min: f32,
    radius_max: f32,
    bricks: usize,
    largest_brick_spheres: u64,
    largest_brick_bytes: u64,
    outer_spheres: u64,
    colors: &'static str,
}

impl Report {
    fn new(path: &Path) -> Result<Self> {
        let file = BrickFile::open(path)?;
        let (header, whole) = (&file.header, file.whole());
        Ok(Self {
            version: env!("CARGO_PKG_VERSION"),
            file: path.display().to_string(),
            bytes: path.metadata().map_or(0, |metadata| metadata.len()),
            kind: "bricks",
            source: header.source.clone(),
            spheres: whole.count,
            min: whole.bounds.min().to_array(),
            max: whole.bounds.max().to_array(),
            radius_min: whole.radius_min,
            radius_max: whole.radius_max,
            bricks: file.len(),
            largest_brick_spheres: file.largest(),
            largest_brick_bytes: header.largest(),
            outer_spheres: header.outer.count,
            colors: match header.colors {
                StoredColors::None => "none",
                StoredColors::One(_) => "one",
                StoredColors::Palette(_) => "palette",
                StoredColors::Rgba8 => "rgba8",
            },
        })
    }
}

/// Returns the text of the report, as JSON or for people.
pub(crate) fn lines(path: &Path, json: bool) -> Result<String> {
    let report = Report::new(path)?;
    if json {
        return text::json(&report);
    }
    let corner = |corner: [f64; 3]| corner.map(|x| x.to_string()).join(" ");
    Ok(format!(
        "file: {}\nformat: bricks, sorted from {}\nsize: {} bytes\nspheres: {}\nbox: {} to {}\nradii: {} to {}\n\
         bricks: {}, the largest with {} spheres in {}\nspheres that a camera frames: {}\ncolors: {}\n",
        report.file,
        report.source,
        report.bytes,
        report.spheres,
        corner(report.min),
        corner(report.max),
        report.radius_min,
        report.radius_max,
        report.bricks,
        report.largest_brick_spheres,
        readable(report.largest_brick_bytes),
        report.outer_spheres,
        report.colors
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_have_all_bricks_and_about_equal_numbers() {
        for counts in [vec![5; 24], vec![1; 7], (1..40).collect::<Vec<u64>>(), vec![100, 1, 1, 1]] {
            for groups in 1..=counts.len() {
                let divided = divided(&counts, groups);
                let ends = divided.iter().flatten().copied().collect::<Vec<_>>();
                assert_eq!((ends[0], ends[ends.len() - 1]), (0, counts.len()));
                assert!(ends[1..ends.len() - 1].chunks(2).all(|pair| pair[0] == pair[1]));
                let sum = |[first, end]: &[usize; 2]| counts[*first..*end].iter().sum::<u64>();
                let largest = counts.iter().max().unwrap();
                let even = counts.iter().sum::<u64>() / groups as u64;
                for group in &divided {
                    assert!(group[0] < group[1], "{divided:?}");
                    assert!(sum(group) <= even + 2 * largest, "{counts:?} {divided:?}");
                }
            }
        }
    }
}
