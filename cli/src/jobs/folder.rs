//! The folder of a job: its files and their places.

use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, anyhow};
use rayon::prelude::*;

use super::files;
use super::part_file::{self, Header, Problem};
use crate::frames::Overview;
use crate::jobs::manifest::{Manifest, NAME, StoredOverview};
use crate::terminal::failure::Failure;
use pinhole::internals::text::one_line;
use pinhole_figure::color_by::JoinedKeys;

/// A job and its folder.
pub(super) struct Folder {
    /// The path of the folder, which is absolute.
    pub(super) path: PathBuf,
    pub(super) manifest: Manifest,
}

/// The folder of the parts, and the file of the overview.
pub(super) const PARTS: &str = "parts";
pub(super) const OVERVIEW: &str = "overview.bin";

/// Files that a killed process left behind are removed after this time.
const LEFT: Duration = Duration::from_secs(3600);

impl Folder {
    pub(super) fn open(path: &Path) -> Result<Self, Failure> {
        let absolute =
            std::path::absolute(path).with_context(|| format!("{}: this path has no meaning", path.display()))?;
        let manifest = Manifest::read(&path.join(NAME))?;
        files::check_no_links(&path.join(PARTS))?;
        Ok(Self { path: absolute, manifest })
    }

    pub(super) fn part(&self, unit: usize) -> PathBuf {
        self.path.join(PARTS).join(format!("{unit:06}.part"))
    }

    /// Reads the headers of all parts.
    pub(super) fn glance(&self) -> Vec<Result<Header, Problem>> {
        let all = (0..self.manifest.units).into_par_iter();
        all.map(|unit| part_file::glance(&self.part(unit), &self.manifest, unit)).collect()
    }

    /// Checks every byte of all parts.
    pub(super) fn check(&self) -> Vec<Result<Header, Problem>> {
        let all = (0..self.manifest.units).into_par_iter();
        all.map(|unit| part_file::check(&self.part(unit), &self.manifest, unit)).collect()
    }

    /// Removes temporary files of processes that were killed before they named them.
    pub(super) fn sweep(&self) {
        let parts = self.path.join(PARTS);
        let names = files::names(&parts);
        let unnamed: Vec<_> = names.iter().filter(|name| name.starts_with(".pinhole-")).collect();
        if unnamed.is_empty() {
            return;
        }
        // The file system's time is used, which may be that of a machine with another clock.
        let Ok(now) = tempfile::NamedTempFile::new_in(&parts) else { return };
        let Some(now) = files::modified(now.path()) else { return };
        for path in unnamed.into_iter().map(|name| parts.join(name)) {
            let age = files::modified(&path).and_then(|time| now.duration_since(time).ok());
            if age.is_some_and(|age| age > LEFT) {
                let _ = files::remove_file(&path);
            }
        }
    }

    /// Enters the folder in which the job was split, so that its relative paths mean the same files.
    pub(super) fn enter(&self) -> Result<(), Failure> {
        let folder = &self.manifest.folder;
        let shown = one_line(folder);
        Ok(std::env::set_current_dir(folder).with_context(|| {
            format!("{shown}: the folder in which the job was split cannot be entered; split it again here")
        })?)
    }

    /// Refuses inputs other than those that were split. The current folder must be that of [`Folder::enter`].
    pub(super) fn check_inputs(&self) -> Result<(), Failure> {
        for file in &self.manifest.files {
            let path = one_line(&file.path);
            let found = files::digest(Path::new(&file.path)).with_context(|| format!("{path}: cannot be read"))?;
            if found != (file.bytes, file.sha256.clone()) {
                return Err(Failure::Job(anyhow!(
                    "{path}: this file has changed since the job was split; split it again"
                )));
            }
        }
        Ok(())
    }

    /// Reads the facts about all frames, if the pictures are frames.
    pub(super) fn overview(&self) -> Result<Option<Overview>, Failure> {
        let Some(stored) = &self.manifest.overview else { return Ok(None) };
        let path = self.path.join(OVERVIEW);
        let bytes =
            files::read(&path).with_context(|| format!("{}: cannot be read; split the job again", path.display()))?;
        let overview = (files::hex(&bytes) == stored.sha256).then(|| unpacked(stored, &bytes));
        let damaged = || anyhow!("{}: this file is damaged; split the job again", path.display());
        Ok(Some(overview.flatten().ok_or_else(damaged)?))
    }
}

/// Splits the facts about all frames into their numbers, as bytes, and the description of the rest.
pub(super) fn packed(overview: &Overview) -> (StoredOverview, Vec<u8>) {
    let range = overview.colors.range();
    let numbers = range.iter().flatten().chain(overview.spheres.as_flattened());
    let bytes: Vec<u8> = numbers.flat_map(|number| number.to_bits().to_le_bytes()).collect();
    let stored = StoredOverview {
        sha256: files::hex(&bytes),
        spheres: overview.spheres.len(),
        added: overview.added,
        has_range: range.is_some(),
        categories: overview.colors.names().to_vec(),
        missing: overview.colors.missing(),
        arrow_scale: overview.colors.arrow_scale().map(f64::to_bits),
        kinds_from: overview.kinds_from,
    };
    (stored, bytes)
}

fn unpacked(stored: &StoredOverview, bytes: &[u8]) -> Option<Overview> {
    let (words, rest) = bytes.as_chunks::<8>();
    let numbers: Vec<f64> = words.iter().map(|word| f64::from_bits(u64::from_le_bytes(*word))).collect();
    let (range, numbers) = match stored.has_range {
        true => numbers.split_first_chunk::<2>().map(|(range, rest)| (Some(*range), rest))?,
        false => (None, &numbers[..]),
    };
    let (spheres, more) = numbers.as_chunks::<4>();
    let fits = rest.is_empty() && more.is_empty();
    if !fits || spheres.len() != stored.spheres || stored.added > spheres.len() {
        return None;
    }
    let colors = JoinedKeys::new(range, stored.categories.clone(), stored.missing);
    let colors = colors.with_arrow_scale(stored.arrow_scale.map(f64::from_bits));
    Some(Overview::stored(spheres.to_vec(), stored.added, colors, stored.kinds_from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_overview_is_read_back_to_the_bit() {
        for range in [None, Some([f64::MIN_POSITIVE, 0.1 + 0.2])] {
            let colors = JoinedKeys::new(range, vec!["a".to_owned()], Some([1, 2, 3]));
            let colors = colors.with_arrow_scale(range.map(|[low, _]| low));
            let overview = Overview::stored(vec![[0.1, -0.0, 1e300, 3.0]; 3], 1, colors, Some(7));
            let (stored, bytes) = packed(&overview);
            let read = unpacked(&stored, &bytes).unwrap();
            assert_eq!(format!("{read:?}"), format!("{overview:?}"));
            assert!(unpacked(&stored, &bytes[8..]).is_none());
            assert!(unpacked(&stored, &bytes[1..]).is_none());
        }
    }
}
