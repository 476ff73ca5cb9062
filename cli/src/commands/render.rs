//! `pinhole render`: renders a scene file or a data file.

use std::path::Path;
use std::time::Instant;

use anyhow::{Result, anyhow};

use crate::flags::common::Stereo;
use crate::flags::render::RenderArgs;
use crate::frames;
use crate::input::Input;
use crate::output::picture::Outputs;
use crate::proof::render_certified;
use crate::render::views::{Shot, views_of};
use crate::render::{Job, render_joined, render_views};
use crate::terminal::failure::Failure;
#[cfg(feature = "gpu")]
use crate::terminal::profile;
use crate::terminal::progress::{self, answer, tell};
use crate::terminal::threads;
use pinhole::internals::text::one_line;
use pinhole_figure::scene_file::{Contents, write};

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
        if args.certify {
            return Err(Failure::usage(
                "--certify: only single pictures are certified; render the frames one by one",
            ));
        }
        let mut job = Job::new(args, wanted.picture())?;
        job.source = job.source.without_bricks("a series of pictures")?;
        return frames::run(args, &wanted, job);
    }
    let started = Instant::now();
    let quiet = args.report.quiet;
    let mut job = Job::new(args, args.output.as_deref().unwrap_or(Path::new("-")))?;
    if quiet {
        progress::close();
    }
    let note = progress::notes(quiet);
    threads::start()?;
    if args.certify || args.report.print_scene {
        let flag = if args.certify { "--certify" } else { "--print-scene" };
        job.source = job.source.without_bricks(flag)?;
    }
    if args.report.print_scene {
        let input = job.source.load()?;
        input.notes.iter().for_each(|text| note(text));
        return Ok(print(&input)?);
    }
    // The driver is loaded while the file is read, to save time.
    let (mut input, opened) = job.device.open_beside(|| job.source.load())?;
    job.outputs.check_not_inputs(&input.files)?;
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
    let adapter = opened.adapter();
    let (stop_rule, opened) = (job.stop_rule, &opened);
    if args.certify {
        let verdict = render_certified::run(&mut input, stop_rule, outputs, &encoding, opened)?;
        said(quiet, &input, started);
        return verdict;
    }
    let shot = Shot { input: &input, views, layers, stop_rule, opened };
    if job.stereo == Some(Stereo::TwoFiles) {
        let outputs = outputs.of_eyes()?;
        outputs.iter().try_for_each(|outputs| outputs.check_not_inputs(&input.files))?;
        Outputs::write_both(&outputs, &render_views(&shot)?, &encoding, adapter)?;
        said(quiet, &input, started);
        return Ok(());
    }
    let image = render_joined(&shot)?;
    outputs.write(&image, &encoding, adapter, None)?;
    said(quiet, &input, started);
    Ok(())
}

/// Prints one line with the input, the look and the time.
fn said(quiet: bool, input: &Input, started: Instant) {
    if !quiet {
        tell(input.report.line(started.elapsed()));
    }
}

/// Writes the scene file to standard output. `encoding` and `annotations` include the flags about the picture's file
/// and about annotations.
pub(crate) fn print(input: &Input) -> Result<()> {
    let contents = Contents {
        film: input.film,
        encoding: input.encoding,
        annotations: input.annotations.clone(),
        camera: input.parameters,
        settings: &input.settings,
        sky_image: input.sky_image.as_deref().map(named).transpose()?,
        data: input.data.clone(),
        spheres: input.own_spheres.clone(),
    };
    input.files.iter().try_for_each(|path| named(path).map(drop))?;
    let title = one_line(&input.report.path);
    let text = format!(
        "# The scene that `pinhole render` made of {title}, with every value that it chose.\n\
         # Paths are relative to the folder in which it was written: keep it there.\n\n{}",
        write(&contents)
    );
    answer(text.as_bytes())
}

/// Returns a path as text, because a scene file can only name paths that are text.
fn named(path: &Path) -> Result<String> {
    let text = path.to_str().ok_or_else(|| {
        anyhow!(
            "{}: a scene file cannot name this path, because it is not UTF-8; rename it",
            path.display()
        )
    })?;
    Ok(text.to_owned())
}
