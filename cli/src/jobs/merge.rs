//! `pinhole job merge`: joins parts, and writes the files that `render` would have written.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow};

use super::files;
use super::folder::{Folder, PARTS};
use super::part::described;
use super::part_file::{self, Header, Pictures, Problem};
use crate::frames::{Ready, ReadyOptions, is_movie, ready};
use crate::jobs::args::{MergeArgs, Recipe, SplitArgs, check_same, split_args};
use crate::jobs::manifest::{layer_set, ranges};
use crate::output::picture::{Outputs, PictureFormat};
use crate::render::device::OpenDevice;
use crate::render::finish_joined;
use crate::render::renderer::renderer;
use crate::terminal::failure::Failure;
use crate::terminal::progress::tell;
use crate::terminal::threads;
use pinhole::image::{Image, LayerSet};
use pinhole::internals::text::{listed, one_line};
use pinhole::render::NearestPicture;

/// The time between two looks for parts that are not visible yet.
const PAUSE: Duration = Duration::from_millis(200);

/// The devices that rendered the parts.
struct Devices {
    /// Descriptions of the devices; there may be several if mixtures are allowed.
    described: Vec<String>,
    /// The name of the adapter for files of pictures.
    adapter: Option<String>,
    may_differ: bool,
}

pub(super) fn run(args: &MergeArgs) -> Result<(), Failure> {
    let started = Instant::now();
    let wait = Duration::try_from_secs_f64(args.wait)
        .map_err(|_| Failure::usage(format!("--wait {}: write a number of seconds that is at least 0", args.wait)))?;
    let folder = Folder::open(&args.job)?;
    let SplitArgs { mut render, exr, .. } = split_args(&folder.manifest.arguments)?;
    render.output = Some(absolute(&args.output)?);
    render.layers = args.layers.iter().map(|text| absolute_layer(text)).collect::<Result<_, _>>()?;
    render.report.quiet = args.quiet;
    (render.frames.fps, render.frames.raw) = (args.fps.or(render.frames.fps), args.raw);
    if folder.manifest.pictures.is_none() && is_movie(&args.output) {
        return Err(Failure::usage(format!(
            "{}: this job is a single picture; for a movie split it with --frames RANGE or --turntable N",
            args.output.display()
        )));
    }
    folder.enter()?;
    let recipe = Recipe::new(render)?;
    if exr != (recipe.job.outputs.format == PictureFormat::Exr) {
        let (made, other) = if exr { ("EXR", "without --exr") } else { ("PNG", "with --exr") };
        return Err(Failure::usage(format!(
            "{}: this job was split for {made} pictures; for others split it {other}",
            args.output.display()
        )));
    }
    threads::start()?;
    let headers = check_all(&folder, wait)?;
    let devices = Devices {
        described: device_of(&headers, args.allow_mixed_adapters)?,
        adapter: headers.first().and_then(|header| header.adapter.clone()),
        may_differ: args.allow_mixed_adapters,
    };
    folder.check_inputs()?;
    // Only denoising needs the device again.
    let needs_device = folder.manifest.denoised && devices.adapter.is_some();
    let recipe = if needs_device { recipe } else { recipe.without_device() };
    let count = write(&folder, recipe, &devices)?;
    if !args.quiet {
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        tell(format_args!(
            "{}: {count} picture{} from {} part{}; {:.1} s",
            args.output.display(),
            plural(count),
            headers.len(),
            plural(headers.len()),
            started.elapsed().as_secs_f64()
        ));
    }
    Ok(())
}

fn write(folder: &Folder, recipe: Recipe, devices: &Devices) -> Result<usize, Failure> {
    let Recipe { args, wanted, job } = recipe;
    let adapter = devices.adapter.as_deref();
    let quietly = |_: &dyn std::fmt::Display| {};
    let Some(wanted) = wanted else {
        let (mut input, opened) = job.device.open_beside(|| job.source.load())?;
        devices.check(&opened)?;
        let (encoding, annotations) = job.finish(&mut input, quietly)?;
        check_same(&folder.manifest, None, &input)?;
        let outputs = Outputs { annotations, ..job.outputs };
        outputs.check_not_inputs(&input.files)?;
        let layers = outputs.layers(&encoding);
        check_layers(folder, layers)?;
        let image = finish_joined(picture(folder, 0)?, &input.settings, layers, renderer(&opened, &input, true))?;
        outputs.write(&image, &encoding, adapter, None)?;
        return Ok(1);
    };
    let options = ReadyOptions { overview: folder.overview()?, only: None };
    let Some(Ready { series, opened, writing, all, .. }) = ready(&args, &wanted, job, options)? else {
        return Ok(0);
    };
    devices.check(&opened)?;
    check_same(&folder.manifest, Some(&all), &series.input)?;
    check_layers(folder, writing.layers)?;
    let mut places = 0..;
    writing.write(&wanted, all.len(), adapter, |written| {
        // Lines depend on the camera of each picture.
        series.for_each_look(|number, input| {
            written.begin();
            let joined = picture(folder, places.next().unwrap_or_default())?;
            let image = finish_joined(joined, &input.settings, writing.layers, renderer(&opened, input, true))?;
            Ok(written.send(number, image))
        })
    })
}

impl Devices {
    /// Refuses to remove noise with another device than that of the parts.
    fn check(&self, opened: &OpenDevice) -> Result<(), Failure> {
        let here = described(opened);
        let needs = self.adapter.is_some() && opened.adapter().is_some();
        if !needs || self.may_differ || self.described.contains(&here) {
            return Ok(());
        }
        Err(Failure::Job(anyhow!(
            "noise is removed where parts are merged, and they were rendered by {}, but this is {here}; merge on a \
             machine with that device, or add --allow-mixed-adapters",
            listed(self.described.iter().map(|device| one_line(device)), 8)
        )))
    }
}

/// Checks every byte of every part, and returns their headers. Waits for missing parts.
fn check_all(folder: &Folder, wait: Duration) -> Result<Vec<Header>, Failure> {
    let end = Instant::now() + wait;
    loop {
        // Listing the folder makes a network file system look for new files.
        let _ = files::names(&folder.path.join(PARTS));
        let mut seen = folder.glance().into_iter();
        if Instant::now() >= end || !seen.any(|found| matches!(found, Err(Problem::Missing))) {
            break;
        }
        std::thread::sleep(PAUSE);
    }
    let found = folder.check();
    refuse(folder, &found)?;
    Ok(found.into_iter().flatten().collect())
}

/// Refuses missing, damaged or foreign parts.
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
            folder.path.display()
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
        folder.path.display(),
        bad.len(),
        found.len(),
        words.join(", "),
        ranges(&bad)
    )))
}

/// Returns the devices that rendered the parts, with their units. Several are refused unless mixtures are allowed.
fn device_of(headers: &[Header], allows_mixed: bool) -> Result<Vec<String>, Failure> {
    let mut devices: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for header in headers {
        devices.entry(&header.device).or_default().push(header.unit);
    }
    if devices.len() > 1 && !allows_mixed {
        let words = devices.iter().map(|(device, units)| format!("{} {}", one_line(device), ranges(units)));
        return Err(Failure::Job(anyhow!(
            "parts were rendered by different devices, whose pixels may differ in the last bits: {}; render some of them \
             again, or add --allow-mixed-adapters",
            listed(words, 8)
        )));
    }
    Ok(devices.into_keys().map(str::to_owned).collect())
}

/// Joins the parts of one picture, by its index among all pictures, for all eyes.
fn picture(folder: &Folder, place: usize) -> Result<Vec<Image>, Failure> {
    let manifest = &folder.manifest;
    if manifest.is_by_depth() {
        return Ok(nearest(folder)?.into_iter().map(NearestPicture::into_image).collect());
    }
    let [width, height] = manifest.size;
    let empty = (0..manifest.eyes).map(|_| Image::new(width, height, manifest.layer_set()));
    let whole: Result<Vec<Image>, _> = empty.collect();
    let mut whole = whole.map_err(|error| Failure::Job(error.into()))?;
    let tiles = manifest.units_of_picture();
    for unit in place * tiles..(place + 1) * tiles {
        let (_, (origin, _)) = manifest.unit(unit);
        let Pictures::Tile(tile) = read_part(folder, unit)? else {
            return Err(unusable(folder, unit, Problem::Foreign));
        };
        for (whole, tile) in whole.iter_mut().zip(&tile) {
            whole.put(tile, origin).map_err(|error| Failure::Job(error.into()))?;
        }
    }
    Ok(whole)
}

/// The nearest hit of every pixel in the parts of all groups of bricks. One part is in memory at a time.
fn nearest(folder: &Folder) -> Result<Vec<NearestPicture>, Failure> {
    let mut all: Vec<NearestPicture> = Vec::new();
    for unit in 0..folder.manifest.units {
        let Pictures::Depth(part) = read_part(folder, unit)? else {
            return Err(unusable(folder, unit, Problem::Foreign));
        };
        if all.is_empty() {
            all = part;
            continue;
        }
        for (all, part) in all.iter_mut().zip(&part) {
            all.keep_nearer(part).map_err(|error| Failure::Job(error.into()))?;
        }
    }
    Ok(all)
}

/// Reads a part, which was checked but may have changed since.
fn read_part(folder: &Folder, unit: usize) -> Result<Pictures, Failure> {
    let part = part_file::read(&folder.part(unit), &folder.manifest, unit);
    part.map(|(_, pictures)| pictures).map_err(|problem| unusable(folder, unit, problem))
}

fn unusable(folder: &Folder, unit: usize, problem: Problem) -> Failure {
    Failure::Job(anyhow!("{}: this part is {}", folder.part(unit).display(), problem.words()))
}

/// Refuses layers that the parts lack.
fn check_layers(folder: &Folder, wanted: LayerSet) -> Result<(), Failure> {
    let there = layer_set(&folder.manifest.merged_layers);
    match wanted.iter().find(|layer| !there.contains(*layer)) {
        None => Ok(()),
        Some(layer) => Err(Failure::usage(format!(
            "--layer {layer}: the parts have no such layer; split the job with --layer {layer}"
        ))),
    }
}

/// Makes the path of an output absolute, before the folder in which the job was split is entered.
fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    if path == Path::new("-") {
        return Ok(path.to_path_buf());
    }
    let ends_with_separator = path.as_os_str().as_encoded_bytes().last() == Some(&b'/');
    let absolute =
        std::path::absolute(path).with_context(|| format!("{}: this path has no meaning", path.display()))?;
    Ok(if ends_with_separator { absolute.join("") } else { absolute })
}

/// Makes the path in a value of `--layer` absolute.
fn absolute_layer(text: &str) -> Result<String, Failure> {
    let Some((layer, path)) = text.split_once('=').filter(|(_, path)| !path.is_empty()) else {
        return Ok(text.to_owned());
    };
    let path = absolute(Path::new(path))?;
    let path = path.to_str().with_context(|| format!("{}: this is not UTF-8", path.display()))?;
    Ok(format!("{layer}={path}"))
}
