//! `pinhole job join`: puts parts of groups of bricks together into one part, so that parts can be merged in a tree.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use anyhow::anyhow;

use super::JoinArgs;
use super::files;
use super::folder::{Folder, PARTS};
use super::join::{device_of, unusable};
use super::manifest::VERSION;
use super::part::write;
use super::part_file::{self, Header, Pictures, Problem, payload};
use super::units::{parse_list, ranges};
use crate::failure::Failure;
use crate::speak::tell;
use crate::views::Views;
use pinhole::render::Nearest;

/// The place of a part that was joined from the parts of these units.
fn joined(folder: &Folder, units: &Range<usize>) -> PathBuf {
    let name = format!("{:06}-{:06}.part", units.start, units.end.saturating_sub(1));
    folder.path().join(PARTS).join(name)
}

/// The units of all joined parts that are seen, the longest first.
fn seen(folder: &Folder) -> Vec<Range<usize>> {
    if !folder.manifest.is_by_depth() {
        return Vec::new();
    }
    let units = |name: &String| {
        let (first, last) = name.strip_suffix(".part")?.split_once('-')?;
        let (first, last): (usize, usize) = (first.parse().ok()?, last.parse().ok()?);
        (first < last && last < folder.manifest.units).then_some(first..last + 1)
    };
    let names = files::names(&folder.path().join(PARTS));
    let mut all: Vec<Range<usize>> = names.iter().filter_map(units).collect();
    all.sort_by_key(|units| (std::cmp::Reverse(units.len()), units.start));
    all
}

/// Reads a joined part, and checks every byte of it.
fn read(folder: &Folder, units: &Range<usize>) -> Result<(Header, Pictures), Problem> {
    let path = joined(folder, units);
    let (header, pictures) = part_file::read(&path, &folder.manifest, units.start)?;
    is_of(&header, units).then_some((header, pictures)).ok_or(Problem::Foreign)
}

/// Whether a joined part was joined from these units.
fn is_of(header: &Header, units: &Range<usize>) -> bool {
    header.last == Some(units.end.saturating_sub(1))
}

/// The units that are in joined parts which are whole, with the headers of these.
pub(super) fn covered(folder: &Folder) -> BTreeMap<usize, Header> {
    let mut all = BTreeMap::new();
    for units in seen(folder) {
        let header = part_file::check(&joined(folder, &units), &folder.manifest, units.start);
        if let Some(header) = header.ok().filter(|header| is_of(header, &units)) {
            for unit in units {
                all.entry(unit).or_insert_with(|| Header { unit, ..header.clone() });
            }
        }
    }
    all
}

/// What is nearest in the parts of some units, and the headers of these parts.
pub(super) fn nearest(
    folder: &Folder,
    units: Range<usize>,
) -> Result<(Vec<Header>, Views<Nearest>), Failure> {
    let whole: Vec<Range<usize>> = seen(folder);
    let (mut headers, mut all): (Vec<Header>, Option<Views<Nearest>>) = (Vec::new(), None);
    let mut unit = units.start;
    while unit < units.end {
        let fits = |part: &&Range<usize>| part.start == unit && part.end <= units.end;
        let mut longer = whole.iter().filter(fits).filter(|part| **part != units);
        let joined = longer.find_map(|part| Some((part.end, read(folder, part).ok()?)));
        let (end, (header, pictures)) = match joined {
            Some(joined) => joined,
            None => {
                let path = folder.part(unit);
                let part = part_file::read(&path, &folder.manifest, unit);
                (unit + 1, part.map_err(|problem| unusable(&path, problem))?)
            }
        };
        unit = end;
        headers.push(header);
        let Pictures::Depth(part) = pictures else { continue };
        match &mut all {
            None => all = Some(part),
            Some(all) => {
                for (all, part) in all.as_mut_slice().iter_mut().zip(part.as_slice()) {
                    all.keep_nearer(part).map_err(|error| Failure::Job(error.into()))?;
                }
            }
        }
    }
    let all = all.ok_or_else(|| Failure::Job(anyhow!("there are no parts to put together")))?;
    Ok((headers, all))
}

pub(super) fn run(args: &JoinArgs) -> Result<(), Failure> {
    let folder = Folder::open(&args.job)?;
    if !folder.manifest.is_by_depth() {
        return Err(Failure::usage(format!(
            "{}: only parts of groups of bricks are joined; put tiles together with `pinhole job merge`",
            args.job.display()
        )));
    }
    let units = parse_list(&args.units, folder.manifest.units)?;
    let range = match (units.first(), units.last()) {
        (Some(first), Some(last)) if units.len() == last - first + 1 && first < last => {
            *first..*last + 1
        }
        _ => {
            return Err(Failure::usage(format!(
                "INDEX {}: name two or more units that follow each other, such as 0-3",
                args.units
            )));
        }
    };
    if read(&folder, &range).is_ok() {
        return Ok(());
    }
    let (headers, pictures) = nearest(&folder, range.clone())?;
    let device = device_of(&headers, false)?.concat();
    let header = Header {
        version: VERSION.to_owned(),
        job: folder.manifest.sha256.clone(),
        unit: range.start,
        last: Some(range.end - 1),
        device,
        adapter: headers.first().and_then(|header| header.adapter.clone()),
        milliseconds: headers.iter().map(|header| header.milliseconds).sum::<u64>()
            / headers.len().max(1) as u64,
        bytes: payload(&folder.manifest, range.start),
    };
    write(&joined(&folder, &range), &header, &Pictures::Depth(pictures))?;
    if !args.quiet {
        tell(format_args!(
            "{}: {} parts joined; the parts {} are not needed any more",
            args.job.display(),
            headers.len(),
            ranges(&units)
        ));
    }
    Ok(())
}
