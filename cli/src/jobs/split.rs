//! `pinhole job split`: divides pictures into units, and writes the description of the job.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};

use super::files::{self, InputFile};
use super::folder::{Folder, OVERVIEW, PARTS, packed};
use crate::bricks;
use crate::flags::common::Stereo;
use crate::frames::{Overview, Ready, ReadyOptions, ready};
use crate::input::Input;
use crate::jobs::args::{Recipe, SplitArgs};
use crate::jobs::manifest::{MOST_UNITS, Manifest, NAME, UnitKind, VERSION, layer_names, parse_tiles, units_of_tiles};
use crate::output::files::{name_all, unnamed};
use crate::render::ghosts;
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, tell};
use crate::terminal::text::in_quotes;
use crate::terminal::{threads, words};
use pinhole::image::{Layer, LayerSet};
use pinhole::internals::text::is_control;

/// Facts that are known once the first picture was read.
struct JobInput {
    input: Input,
    /// The layers that a PNG or an EXR file needs.
    layers: LayerSet,
    pictures: Option<Vec<usize>>,
    overview: Option<Overview>,
}

pub(super) fn run(args: &SplitArgs) -> Result<(), Failure> {
    refuse(args)?;
    let asked = asked_layers(&args.render.layers)?;
    // clap requires it.
    let job = args.render.output.clone().unwrap_or_default();
    let job: PathBuf = job.components().collect();
    let above = check_new(&job)?;
    let arguments = words().into_iter().map(|word| {
        word.into_string().map_err(|word| Failure::usage(format!("{}: this is not UTF-8 text", word.to_string_lossy())))
    });
    let arguments = arguments.collect::<Result<Vec<String>, _>>()?;
    let folder = std::env::current_dir().context("the current folder is not known")?;
    let folder = folder
        .into_os_string()
        .into_string()
        .map_err(|folder| Failure::usage(format!("{}: this folder has no name in UTF-8", folder.to_string_lossy())))?;
    let recipe = Recipe::of_parts(&arguments, &above, args.render.report.quiet)?.without_device();
    threads::start()?;
    let JobInput { input, layers, pictures, overview } = job_input(recipe)?;
    let size = [input.film.width(), input.film.height()];
    let tiles = parse_tiles(&args.tiles, size)?;
    let groups = groups(args.by_depth, &input, pictures.is_some())?;
    if let Some(file) = &input.bricks {
        bricks::check_without_light(file, &input.settings)?;
    }
    let merged = asked.iter().chain(layers.iter()).collect::<LayerSet>();
    let stored = overview.as_ref().map(packed);
    let sampling = input.settings.sampling;
    let units = match groups.len() {
        0 => units_of_tiles(pictures.as_ref().map_or(1, Vec::len), tiles),
        count => Some(count),
    };
    let Some(units) = units else {
        return Err(Failure::usage(format!("these are more than {MOST_UNITS} units; choose fewer tiles or frames")));
    };
    let manifest = Manifest {
        pinhole_job: 1,
        version: VERSION.to_owned(),
        sha256: String::new(),
        unit: if groups.is_empty() { UnitKind::Tile } else { UnitKind::Depth },
        units,
        arguments,
        folder,
        files: input_files(&input, args)?,
        pictures,
        size,
        eyes: if input.eyes.is_some() { 2 } else { 1 },
        groups,
        tiles,
        layers: layer_names(input.settings.layers_for(merged)),
        merged_layers: layer_names(merged),
        integrator: input.settings.integrator.name().to_owned(),
        samples: sampling.samples,
        seed: sampling.seed,
        denoised: input.settings.sampling.denoise,
        overview: stored.as_ref().map(|(stored, _)| stored.clone()),
    };
    let (manifest, text) = manifest.sealed()?;
    let made = Folder { path: job.clone(), manifest };
    create(&made, &text, stored.as_ref().map(|(_, bytes)| &bytes[..]))?;
    progress::clear();
    if !args.render.report.quiet {
        said(&made);
    }
    Ok(())
}

/// Refuses flags that have no meaning for parts.
fn refuse(args: &SplitArgs) -> Result<(), Failure> {
    let render = &args.render;
    if let Some(flag) = render.stop_rule.given() {
        return Err(Failure::usage(format!(
            "{flag}: all parts must have the same samples, so they cannot depend on time or noise; choose --samples N"
        )));
    }
    if let Some(flag) = render.frames.of_writing() {
        return Err(Failure::usage(format!("{flag} belongs to `pinhole job merge`; remove it")));
    }
    if render.stereo == Some(Stereo::TwoFiles) {
        return Err(Failure::usage("--stereo two-files: parts are merged into one picture; remove it"));
    }
    if render.certify {
        return Err(Failure::usage("--certify: merged pictures carry no certificate; remove it"));
    }
    if render.report.print_scene || render.report.save_scene.is_some() {
        return Err(Failure::usage("--print-scene and --save-scene belong to `pinhole render`; remove them"));
    }
    if render.input.path == Path::new("-") {
        return Err(Failure::usage("-: parts cannot read standard input again; name a file"));
    }
    Ok(())
}

/// The layers that the flags name. A file after `=` is ignored here and left to `merge`.
fn asked_layers(texts: &[String]) -> Result<LayerSet, Failure> {
    let parsed = texts.iter().map(|text| {
        let layer = text.parse::<Layer>();
        layer.map_err(|error| Failure::usage(format!("--layer {text}: {error}")))
    });
    parsed.collect()
}

/// Refuses a folder that exists, and returns its parent.
fn check_new(job: &Path) -> Result<PathBuf, Failure> {
    if job.to_string_lossy().contains(is_control) {
        return Err(Failure::usage(format!(
            "{}: this name has control characters, which a script may take for commands; choose another",
            job.display()
        )));
    }
    if job.symlink_metadata().is_ok() {
        return Err(Failure::usage(format!("{}: this exists already; name a new folder for the job", job.display())));
    }
    match job.parent() {
        None => Err(Failure::usage("-o: name a new folder for the job")),
        Some(above) if above == Path::new("") => Ok(PathBuf::from(".")),
        Some(above) => Ok(above.to_path_buf()),
    }
}

/// Reads the input of the first picture.
fn job_input(recipe: Recipe) -> Result<JobInput, Failure> {
    let Recipe { args, wanted, mut job } = recipe;
    if wanted.is_some() {
        job.source = job.source.without_bricks("a series of pictures")?;
    }
    let note = progress::notes(args.report.quiet);
    let Some(wanted) = wanted else {
        let mut input = job.source.load()?;
        input.notes.iter().for_each(|text| note(text));
        ghosts::refuse(&input, "a picture in parts")?;
        let (encoding, _) = job.finish(&mut input, note)?;
        let layers = job.outputs.layers(&encoding);
        return Ok(JobInput { input, layers, pictures: None, overview: None });
    };
    let none = || anyhow!("no picture is asked for");
    let Ready { series, writing, overview, all, .. } =
        ready(&args, &wanted, job, ReadyOptions::default())?.ok_or_else(none)?;
    ghosts::refuse(&series.input, "pictures in parts")?;
    Ok(JobInput { input: series.input, layers: writing.layers, pictures: Some(all), overview })
}

/// The bricks of each unit; empty if units are tiles.
fn groups(by_depth: Option<u32>, input: &Input, are_several: bool) -> Result<Vec<[usize; 2]>, Failure> {
    let Some(groups) = by_depth else { return Ok(Vec::new()) };
    let refused = |why: String| Err(Failure::usage(format!("--by-depth {groups}: {why}")));
    let Some(bricks) = &input.bricks else {
        return refused("this divides files of bricks; make one with `pinhole sort`".to_owned());
    };
    if are_several {
        return refused("a file of bricks makes one picture; remove the flags of frames".to_owned());
    }
    if !input.settings.integrator.is_primary() {
        return refused(
            "with light and with several samples, what one group adds depends on the others; choose --style fast \
             without --samples"
                .to_owned(),
        );
    }
    if groups as usize > bricks.len() {
        return refused(format!(
            "the file has {} bricks; choose as many or fewer groups, or sort it into more bricks",
            bricks.len()
        ));
    }
    Ok(bricks.groups(groups as usize))
}

/// The files that parts will read, with their digests.
fn input_files(input: &Input, args: &SplitArgs) -> Result<Vec<InputFile>, Failure> {
    let mut paths: Vec<&Path> = input.files.iter().map(PathBuf::as_path).collect();
    paths.extend(args.render.frames.camera_path.as_deref());
    let mut files: Vec<InputFile> = Vec::new();
    for path in paths {
        let cannot = || format!("{}: cannot be read", path.display());
        let name = path.to_str().ok_or_else(|| anyhow!("{}: this is not UTF-8", path.display()))?;
        if files.iter().any(|file| file.path == name) {
            continue;
        }
        let (bytes, sha256) = files::digest(path).with_context(cannot)?;
        files.push(InputFile { path: name.to_owned(), bytes, sha256 });
    }
    Ok(files)
}

/// Creates the folder with all its files, the description last. If that fails, nothing is left behind.
fn create(folder: &Folder, text: &str, overview: Option<&[u8]>) -> Result<(), Failure> {
    let path = &folder.path;
    let cannot = || format!("{}: cannot be created", path.display());
    files::create_dir(path).with_context(cannot)?;
    let fill = || {
        files::create_dir(path.join(PARTS)).with_context(cannot)?;
        if let Some(bytes) = overview {
            let file = path.join(OVERVIEW);
            name_all(vec![(&file, unnamed(&file, bytes)?)])?;
        }
        let file = path.join(NAME);
        name_all(vec![(&file, unnamed(&file, text.as_bytes())?)])
    };
    Ok(fill().inspect_err(|_| drop(files::remove_dir_all(path)))?)
}

fn said(folder: &Folder) {
    let manifest = &folder.manifest;
    let pictures = manifest.pictures.as_ref().map_or(1, Vec::len);
    let plural = |count: usize| if count == 1 { "" } else { "s" };
    let [columns, rows] = manifest.tiles;
    let what = match manifest.is_by_depth() {
        true => "1 picture of groups of bricks".to_owned(),
        false => format!("{pictures} picture{} of {columns}x{rows} tiles", plural(pictures)),
    };
    tell(format_args!(
        "{}: {} unit{}, {what}; render them with `pinhole job part {} 0-{}`",
        folder.path.display(),
        manifest.units,
        plural(manifest.units),
        in_quotes(&folder.path.to_string_lossy()),
        manifest.units.saturating_sub(1)
    ));
}
