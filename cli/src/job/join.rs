//! Puts the parts of a picture together.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use rayon::prelude::*;

use super::depth::{self, covered};
use super::files;
use super::folder::{Folder, PARTS};
use super::part_file::{self, Header, Pictures, Problem};
use super::units::ranges;
use crate::failure::Failure;
use crate::views::Views;
use pinhole::image::Image;
use pinhole::render::Nearest;

/// The time between two looks for parts that are not seen yet.
const PAUSE: Duration = Duration::from_millis(200);

/// Checks every byte of every part, and returns their headers. Waits for parts that are missing.
pub(super) fn check_all(folder: &Folder, wait: Duration) -> Result<Vec<Header>, Failure> {
    let end = Instant::now() + wait;
    loop {
        // Reading the folder makes a network file system look for new files.
        let _ = files::names(&folder.path().join(PARTS));
        let is_missing = |found: &Result<Header, Problem>| matches!(found, Err(Problem::Missing));
        let joined = covered(folder);
        let mut seen = folder.glance().into_iter().enumerate();
        if Instant::now() >= end
            || !seen.any(|(unit, found)| is_missing(&found) && !joined.contains_key(&unit))
        {
            break;
        }
        std::thread::sleep(PAUSE);
    }
    let manifest = &folder.manifest;
    let units = (0..manifest.units).into_par_iter();
    let mut found: Vec<Result<Header, Problem>> =
        units.map(|unit| part_file::check(&folder.part(unit), manifest, unit)).collect();
    for (unit, header) in covered(folder) {
        found[unit] = Ok(header);
    }
    refuse(folder, &found)?;
    Ok(found.into_iter().flatten().collect())
}

/// Refuses parts that are not there, damaged or foreign.
fn refuse(folder: &Folder, found: &[Result<Header, Problem>]) -> Result<(), Failure> {
    let of = |problem: Problem| -> Vec<usize> {
        let has = |unit: &usize| found[*unit].as_ref().err() == Some(&problem);
        (0..found.len()).filter(has).collect()
    };
    let mut problems = found.iter().filter_map(|found| found.as_ref().err().copied());
    if let Some(problem) = problems.find(|problem| matches!(problem, Problem::Unreadable(_))) {
        let parts = ranges(&of(problem));
        let words = problem.words();
        return Err(Failure::Job(anyhow!(
            "{}: parts {parts} are {words}; merge again where they can be read",
            folder.path().display()
        )));
    }
    let problems = [Problem::Missing, Problem::Damaged, Problem::Foreign];
    let words: Vec<String> = problems
        .into_iter()
        .map(|problem| (problem, of(problem)))
        .filter(|(_, units)| !units.is_empty())
        .map(|(problem, units)| format!("{} {}", problem.words(), ranges(&units)))
        .collect();
    if words.is_empty() {
        return Ok(());
    }
    let bad: Vec<usize> = (0..found.len()).filter(|unit| found[*unit].is_err()).collect();
    Err(Failure::Job(anyhow!(
        "{}: {} of {} parts cannot be merged: {}; render them again with --array={}",
        folder.path().display(),
        bad.len(),
        found.len(),
        words.join(", "),
        ranges(&bad)
    )))
}

/// What rendered the parts, and which units each rendered. Refuses more than one unless mixtures are allowed.
pub(super) fn device_of(headers: &[Header], allows_mixed: bool) -> Result<Vec<String>, Failure> {
    let mut devices: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for header in headers {
        devices.entry(&header.device).or_default().push(header.unit);
    }
    if devices.len() > 1 && !allows_mixed {
        let words: Vec<String> =
            devices.iter().map(|(device, units)| format!("{device} {}", ranges(units))).collect();
        return Err(Failure::Job(anyhow!(
            "parts were rendered by different devices, whose pixels may differ in the last bits: {}; render some of them \
             again, or add --allow-mixed-adapters",
            words.join(", ")
        )));
    }
    Ok(devices.into_keys().map(str::to_owned).collect())
}

/// Why a part cannot be used.
pub(super) fn unusable(path: &Path, problem: Problem) -> Failure {
    Failure::Job(anyhow!("{}: this part is {}", path.display(), problem.words()))
}

/// The pictures of all eyes at a place among all pictures, from their parts.
pub(super) fn picture(folder: &Folder, place: usize) -> Result<Views<Image>, Failure> {
    let manifest = &folder.manifest;
    if manifest.is_by_depth() {
        return Ok(depth::nearest(folder, 0..manifest.units)?.1.map(Nearest::into_image));
    }
    let [width, height] = manifest.size;
    let empty = || {
        let image = Image::new(width, height, manifest.layer_set());
        image.map_err(|error| Failure::Job(error.into()))
    };
    let mut whole = match manifest.eyes {
        2 => Views::Two([empty()?, empty()?]),
        _ => Views::One(empty()?),
    };
    let tiles = manifest.units_of_picture();
    for unit in place * tiles..(place + 1) * tiles {
        let (_, (origin, _)) = manifest.unit(unit);
        let tile = tile(folder, unit)?;
        for (whole, part) in whole.as_mut_slice().iter_mut().zip(tile.as_slice()) {
            whole.put(part, origin).map_err(|error| Failure::Job(error.into()))?;
        }
    }
    Ok(whole)
}

/// The pictures of a unit that is a tile.
fn tile(folder: &Folder, unit: usize) -> Result<Views<Image>, Failure> {
    let path = folder.part(unit);
    // It was checked, but may have changed since.
    match part_file::read(&path, &folder.manifest, unit) {
        Ok((_, Pictures::Tile(images))) => Ok(images),
        Ok((_, Pictures::Depth(_))) => Err(unusable(&path, Problem::Foreign)),
        Err(problem) => Err(unusable(&path, problem)),
    }
}
