//! `pinhole job part`: renders units, each into a file that appears whole or not at all.

use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::Context;

use super::folder::{Folder, PARTS};
use super::part_file::{self, Header, Pictures, payload};
use crate::bricks::nearest_of;
use crate::frames::{Ready, ReadyOptions, ready};
use crate::input::Input;
use crate::jobs::args::{PartArgs, Recipe, check_same};
use crate::jobs::manifest::{VERSION, parse_list};
use crate::output::files::replace;
use crate::render::device::OpenDevice;
use crate::render::renderer::renderer;
use crate::render::stop_rule::StopRule;
use crate::render::views::{Shot, views_of};
use crate::render::{check_device, render_part};
use crate::terminal::failure::Failure;
use crate::terminal::interrupt::{self, Deadline};
use crate::terminal::progress::{self, tell};
use crate::terminal::threads;

/// The message if the program is stopped.
const STOPPED: &str = "stopped; the parts that were written are complete, and the others can be rendered again";

/// The units of a job to render now.
struct Work<'a> {
    folder: &'a Folder,
    units: Vec<usize>,
    limit: Option<Duration>,
    quiet: bool,
}

pub(super) fn run(args: &PartArgs) -> Result<(), Failure> {
    let started = Instant::now();
    let folder = Folder::open(&args.job)?;
    let asked = parse_list(&args.units, folder.manifest.units)?;
    let limit = args.timeout.map(|seconds| {
        let limit = Duration::try_from_secs_f64(seconds).ok().filter(|limit| !limit.is_zero());
        limit.ok_or_else(|| Failure::usage(format!("--timeout {seconds}: write a number of seconds greater than 0")))
    });
    let limit = limit.transpose()?;
    let is_missing = |unit: &usize| part_file::check(&folder.part(*unit), &folder.manifest, *unit).is_err();
    let units: Vec<usize> = asked.iter().copied().filter(is_missing).collect();
    if units.is_empty() {
        return Ok(());
    }
    #[cfg(feature = "gpu")]
    if let Some(limit) = limit {
        crate::terminal::interrupt::limit_opening(limit);
    }
    threads::start()?;
    folder.enter()?;
    folder.check_inputs()?;
    interrupt::set_message(STOPPED);
    folder.sweep();
    let (count, quiet) = (units.len(), args.quiet);
    Work { folder: &folder, units, limit, quiet }.run()?;
    if !quiet {
        let plural = if count == 1 { "" } else { "s" };
        let seconds = started.elapsed().as_secs_f64();
        tell(format_args!("{}: {count} part{plural}; {seconds:.1} s", args.job.display()));
    }
    Ok(())
}

impl Work<'_> {
    fn run(&self) -> Result<(), Failure> {
        let manifest = &self.folder.manifest;
        let recipe = Recipe::of_parts(&manifest.arguments, &self.folder.path.join(PARTS), true)?;
        let Recipe { args, wanted, job } = recipe;
        let Some(wanted) = wanted else {
            let (mut input, opened) = job.device.open_beside(|| job.source.load())?;
            let (_, _) = job.finish(&mut input, progress::notes(self.quiet))?;
            check_same(manifest, None, &input)?;
            return self.units.iter().try_for_each(|unit| self.render(*unit, &mut input, &opened));
        };
        let mut numbers: Vec<usize> = self.units.iter().filter_map(|unit| manifest.number(*unit)).collect();
        numbers.dedup();
        let options = ReadyOptions { overview: self.folder.overview()?, only: Some(&numbers) };
        let Some(Ready { series, opened, all, .. }) = ready(&args, &wanted, job, options)? else {
            return Ok(());
        };
        check_same(manifest, Some(&all), &series.input)?;
        series.for_each(|number, input| {
            let of_picture = |unit: &&usize| manifest.number(**unit) == Some(number);
            let mut units = self.units.iter().filter(of_picture);
            units.try_for_each(|unit| self.render(*unit, input, &opened))?;
            Ok(true)
        })
    }

    fn render(&self, unit: usize, input: &mut Input, opened: &OpenDevice) -> Result<(), Failure> {
        let unit_did_not_end = format!("unit {unit} did not end");
        let _deadline = self.limit.map(|limit| Deadline::new(limit, unit_did_not_end));
        let (manifest, opened) = (&self.folder.manifest, renderer(opened, input, self.quiet));
        let started = Instant::now();
        let (_, (origin, size)) = manifest.unit(unit);
        // The job already has the layers that outlines and denoising need.
        let layers = manifest.layer_set();
        let pictures = if let Some([first, end]) = manifest.groups.get(unit) {
            let bricks = input.bricks.clone().context("the input is not a file of bricks")?;
            let (views, stop_rule) = (&views_of(input, input.film), StopRule::default());
            let shot = Shot::new(input, views, layers, stop_rule, opened);
            check_device(&shot)?;
            Pictures::Depth(nearest_of(&bricks, *first..*end, &shot)?)
        } else {
            let tile = input.film.part(origin, size).map_err(|error| Failure::Job(error.into()))?;
            Pictures::Tile(render_part(input, tile, layers, opened)?)
        };
        let header = Header {
            version: VERSION.to_owned(),
            job: manifest.sha256.clone(),
            unit,
            device: described(opened),
            adapter: opened.adapter().map(str::to_owned),
            milliseconds: started.elapsed().as_millis() as u64,
            bytes: payload(manifest, unit),
        };
        write(&self.folder.part(unit), &header, &pictures)
    }
}

/// Writes the file of a part, which appears whole or not at all. A link in its place is replaced, not followed.
fn write(path: &Path, header: &Header, pictures: &Pictures) -> Result<(), Failure> {
    Ok(replace(path, |file| {
        let mut out = BufWriter::new(file);
        part_file::write(header, pictures, &mut out)?;
        // The data need not reach the disk: the digest shows whether a crash of the machine cut off a part.
        out.flush()
    })?)
}

/// Describes the renderer such that equal texts mean equal bits: an adapter with its driver, or the CPU.
pub(super) fn described(opened: &OpenDevice) -> String {
    match opened {
        #[cfg(feature = "gpu")]
        OpenDevice::Device { headless, .. } => {
            let info = headless.adapter_info();
            format!("{} ({} {})", info.name, info.driver, info.driver_info)
        }
        _ => format!("CPU ({} {})", std::env::consts::ARCH, std::env::consts::OS),
    }
}
