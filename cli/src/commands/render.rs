//! `pinhole render`: renders a scene file or a data file.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::flags::common::Stereo;
use crate::flags::render::RenderArgs;
use crate::frames;
use crate::input::Input;
use crate::input::read_file::is_standard_input;
use crate::output::picture::Outputs;
use crate::output::scene;
use crate::proof::{certified, render_certified};
use crate::render::renderer::renderer;
use crate::render::views::{Shot, views_of};
use crate::render::{Job, render_joined, with_ghosts};
use crate::terminal::failure::Failure;
#[cfg(feature = "gpu")]
use crate::terminal::profile;
use crate::terminal::progress::{self, answer, tell};
use crate::terminal::threads;
use pinhole::image::LayerSet;
use pinhole_data::load::{FileSet, without_ending};

/// Renders into the file that the flags name, or else into one with the name of the input.
pub(crate) fn run_named(mut args: RenderArgs) -> Result<(), Failure> {
    if args.output.is_some() || args.report.print_scene {
        return run(&args);
    }
    let path = default_output(&args)?;
    args.output = Some(path.clone());
    run(&args)?;
    if !args.report.quiet {
        tell(format_args!("wrote {}", path.display()));
    }
    Ok(())
}

/// The picture of a command that names none: the name of the input with .png, in the current folder.
fn default_output(args: &RenderArgs) -> Result<PathBuf, Failure> {
    let input = &args.input.path;
    let no_name = |what: &str| Failure::usage(format!("{}: {what}", input.display()));
    if args.frames.asks_for_several() || args.frames.of_writing().is_some() || args.stereo == Some(Stereo::TwoFiles) {
        return Err(no_name("several pictures need a name; add -o f%04d.png, or -o movie.mp4"));
    }
    let together = FileSet::together(input);
    let named = together.as_ref().and_then(|set| set.files().first()).unwrap_or(input);
    let plain = without_ending(named);
    let name = plain.file_stem().filter(|_| !is_standard_input(input));
    let of_set = name.and_then(OsStr::to_str).filter(|_| FileSet::is_one(named));
    // The numbers of several files are left out.
    let of_set = of_set.and_then(|name| name.split(['*', '{']).next());
    let of_set = of_set.map(|name| name.trim_end_matches(['.', '-', '_'])).map(OsStr::new);
    let name = of_set.or(name).filter(|name| !name.is_empty());
    let mut path = name.ok_or_else(|| no_name("the picture needs a name; add -o OUT.png"))?.to_os_string();
    path.push(".png");
    let path = PathBuf::from(path);
    if path.exists() && (input.exists() || FileSet::is_one(input)) {
        let path = path.display();
        return Err(Failure::usage(format!("{path}: this file exists; add -o {path} to replace it, or -o OTHER.png")));
    }
    Ok(path)
}

pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    #[cfg(feature = "gpu")]
    profile::start(&args.profile);
    run_measured(args)?;
    #[cfg(feature = "gpu")]
    profile::finish();
    Ok(())
}

fn run_measured(args: &RenderArgs) -> Result<(), Failure> {
    if let Some(wanted) = frames::SeriesRequest::new(args)? {
        if args.report.save_scene.is_some() {
            return Err(Failure::usage(
                "--save-scene: a scene makes one picture; choose one with --frame, or remove it",
            ));
        }
        if args.certify {
            return Err(Failure::usage("--certify: only single pictures are certified; render the frames one by one"));
        }
        let mut job = Job::new(args, wanted.picture())?;
        job.source = job.source.without_bricks("a series of pictures")?;
        return frames::run(args, &wanted, job);
    }
    let started = Instant::now();
    let quiet = args.report.quiet;
    let mut job = Job::new(args, args.output.as_deref().unwrap_or(Path::new("-")))?;
    if args.certify {
        certified::check(&job.source.given)?;
    }
    if quiet {
        progress::close();
    }
    if args.certify && job.outputs.inside != LayerSet::COLOR {
        return Err(Failure::usage(
            "--certify: layers in the file of the picture are not judged; write them to files of their own, such as \
             --layer depth=depth.npy",
        ));
    }
    let note = progress::notes(quiet);
    threads::start()?;
    for (flag, is_given) in [
        ("--certify", args.certify),
        ("--print-scene", args.report.print_scene),
        ("--save-scene", args.report.save_scene.is_some()),
    ] {
        if is_given {
            job.source = job.source.without_bricks(flag)?;
        }
    }
    if args.report.print_scene {
        let input = job.source.load()?;
        input.notes.iter().for_each(|text| note(text));
        return Ok(answer(scene::text(&input, None)?.as_bytes())?);
    }
    // The driver is loaded while the file is read, to save time.
    let (mut input, opened) = job.device.open_beside(|| job.source.load())?;
    job.outputs.check_not_inputs(&input.files)?;
    let scene_path = args.report.save_scene.as_ref();
    scene_path.map(|path| scene::check(path, &input.files)).transpose()?;
    input.notes.iter().for_each(|text| note(text));
    let (encoding, annotations) = job.finish(&mut input, note)?;
    let outputs = Outputs { annotations, ..job.outputs };
    let layers = outputs.layers(&encoding);
    let views = &views_of(&input, input.film);
    if job.stereo.is_some() && views.len() == 1 {
        return Err(Failure::usage(
            "--stereo applies only to a camera with two eyes; add --separation, or `stereo` to the scene's camera",
        ));
    }
    let (stop_rule, opened) = (job.stop_rule, renderer(&opened, &input, quiet));
    let adapter = opened.adapter();
    if args.certify {
        let verdict = render_certified::run(&mut input, &job.source.given, stop_rule, outputs, &encoding, opened)?;
        said(quiet, &input, started);
        return verdict;
    }
    let text = |path: &PathBuf| Ok((path.clone(), scene::text(&input, path.parent())?));
    let saved = scene_path.map(text).transpose().map_err(Failure::Job)?;
    let shot = Shot::new(&input, views, layers, stop_rule, opened);
    if job.stereo == Some(Stereo::TwoFiles) {
        let outputs = outputs.of_eyes()?;
        outputs.iter().try_for_each(|outputs| outputs.check_not_inputs(&input.files))?;
        let images = with_ghosts(&shot)?;
        Outputs::write_both(&outputs, &images, &encoding, adapter, saved.as_ref())?;
        said(quiet, &input, started);
        return Ok(());
    }
    let image = render_joined(&shot)?;
    outputs.write(&image, &encoding, adapter, saved.as_ref())?;
    said(quiet, &input, started);
    Ok(())
}

/// Prints one line with the input, the look and the time.
fn said(quiet: bool, input: &Input, started: Instant) {
    if !quiet {
        tell(input.report.line(started.elapsed()));
    }
}
