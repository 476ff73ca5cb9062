//! `pinhole job merge`: puts parts together and writes what `render` would have written.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow};

use super::folder::Folder;
use super::join::{check_all, device_of, picture};
use super::manifest::layer_set;
use super::part::described;
use super::recipe::{Recipe, check_same, split_args};
use super::{MergeArgs, SplitArgs};
use crate::device::Opened;
use crate::failure::Failure;
use crate::frames::{Known, Ready, is_movie, ready};
use crate::picture::PictureFormat;
use crate::render::finish_joined;
use crate::speak::tell;
use crate::threads;
use pinhole::image::LayerSet;

/// What the parts say about who rendered them.
struct Devices {
    /// In words; there may be several if mixtures are allowed.
    described: Vec<String>,
    /// The name of the adapter, as files of pictures have it.
    adapter: Option<String>,
    may_differ: bool,
}

pub(super) fn run(args: &MergeArgs) -> Result<(), Failure> {
    let started = Instant::now();
    let wait = Duration::try_from_secs_f64(args.wait).map_err(|_| {
        Failure::usage(format!(
            "--wait {}: write a number of seconds that is at least 0",
            args.wait
        ))
    })?;
    let folder = Folder::open(&args.job)?;
    let SplitArgs { mut render, exr, .. } = split_args(&folder.manifest.arguments)?;
    render.output = Some(absolute(&args.output)?);
    render.layers =
        args.layers.iter().map(|text| absolute_layer(text)).collect::<Result<_, _>>()?;
    render.report.quiet = args.quiet;
    render.frames.set_writing(args.fps, args.raw);
    check_kind(&folder, &args.output)?;
    folder.enter()?;
    let recipe = Recipe::new(render)?;
    if exr != (recipe.job.outputs.format() == PictureFormat::Exr) {
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

/// Writes all pictures, and returns their number.
fn write(folder: &Folder, recipe: Recipe, devices: &Devices) -> Result<usize, Failure> {
    let Recipe { args, wanted, job } = recipe;
    let adapter = devices.adapter.as_deref();
    let quietly = |_: &dyn std::fmt::Display| {};
    let Some(wanted) = wanted else {
        let (mut input, opened) = job.device.open_beside(|| job.source.load())?;
        devices.check(&opened)?;
        let (encoding, annotations) = job.finish(&mut input, quietly)?;
        check_same(&folder.manifest, None, &input)?;
        let outputs = job.outputs.with_annotations(annotations);
        outputs.check_not_inputs(&input.files)?;
        let layers = outputs.layers(&encoding);
        check_layers(folder, layers)?;
        let image = finish_joined(picture(folder, 0)?, &input.settings, layers, &opened)?;
        outputs.write(&image, &encoding, adapter, None)?;
        return Ok(1);
    };
    let known = Known { overview: folder.overview()?, only: None };
    let Some(Ready { series, opened, writing, all, .. }) = ready(&args, &wanted, job, known)?
    else {
        return Ok(0);
    };
    devices.check(&opened)?;
    let input = &series.input;
    check_same(&folder.manifest, Some(&all), input)?;
    check_layers(folder, writing.layers)?;
    writing.write(&wanted, all.len(), adapter, |written| {
        for (place, number) in all.iter().enumerate() {
            written.begin();
            let parts = picture(folder, place)?;
            let image = finish_joined(parts, &input.settings, writing.layers, &opened)?;
            if !written.send(*number, image) {
                break;
            }
        }
        Ok(())
    })
}

impl Devices {
    /// Refuses to remove noise by another device than that of the parts.
    fn check(&self, opened: &Opened) -> Result<(), Failure> {
        let here = described(opened);
        let needs = self.adapter.is_some() && opened.adapter().is_some();
        if !needs || self.may_differ || self.described.contains(&here) {
            return Ok(());
        }
        Err(Failure::Job(anyhow!(
            "noise is removed where parts are merged, and they were rendered by {}, but this is {here}; merge on a \
             machine with that device, or add --allow-mixed-adapters",
            self.described.join(", ")
        )))
    }
}

/// Refuses an output of another kind than that of the job.
fn check_kind(folder: &Folder, output: &Path) -> Result<(), Failure> {
    let has_numbers = folder.manifest.pictures.is_some();
    if !has_numbers && is_movie(output) {
        return Err(Failure::usage(format!(
            "{}: this job is a single picture; for a movie split it with --frames RANGE or --turntable N",
            output.display()
        )));
    }
    Ok(())
}

/// Refuses layers that the parts have not.
fn check_layers(folder: &Folder, wanted: LayerSet) -> Result<(), Failure> {
    let there = layer_set(&folder.manifest.merged_layers);
    match wanted.iter().find(|layer| !there.contains(*layer)) {
        None => Ok(()),
        Some(layer) => Err(Failure::usage(format!(
            "--layer {layer}: the parts have no such layer; split the job with --layer {layer}"
        ))),
    }
}

/// The path of an output, seen from the folder in which the job was split.
fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    if path == Path::new("-") {
        return Ok(path.to_path_buf());
    }
    let ends_with_separator = path.as_os_str().as_encoded_bytes().last() == Some(&b'/');
    let absolute = std::path::absolute(path)
        .with_context(|| format!("{}: this path has no meaning", path.display()))?;
    Ok(if ends_with_separator { absolute.join("") } else { absolute })
}

/// The value of `--layer`, with an absolute path.
pub(super) fn absolute_layer(text: &str) -> Result<String, Failure> {
    let Some((layer, path)) = text.split_once('=').filter(|(_, path)| !path.is_empty()) else {
        return Ok(text.to_owned());
    };
    let path = absolute(Path::new(path))?;
    let path = path.to_str().with_context(|| format!("{}: this is not UTF-8", path.display()))?;
    Ok(format!("{layer}={path}"))
}
