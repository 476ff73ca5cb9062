//! Several pictures at once: frames of a file, or views from all sides, as files or as a movie.

use std::path::Path;

use self::target::Target;
use crate::flags::common::Stereo;
use crate::flags::render::RenderArgs;
use crate::frames::args::{FrameRange, FramesArgs};
use crate::frames::moving::PathRequest;
pub(crate) use crate::frames::numbers::Overview;
pub(super) use crate::frames::run::run;
pub(crate) use crate::frames::run::{Ready, ReadyOptions, ready};
use crate::terminal::failure::Failure;

pub(super) mod args;
mod movie;
mod moving;
mod numbers;
mod run;
mod series;
mod target;

pub(super) fn is_movie(path: &Path) -> bool {
    target::movie_of(path).is_some()
}

#[derive(Clone, Debug)]
enum Pictures {
    Frames { range: FrameRange, camera_from: Option<FrameRange>, path: Option<PathRequest> },
    Turntable { count: u32 },
}

/// A job of several pictures, checked as far as is possible before the input is read.
#[derive(Debug)]
pub(super) struct SeriesRequest {
    pictures: Pictures,
    /// The output, for messages.
    picture_name: String,
    target: Target,
    fps: u32,
    resume: bool,
}

impl SeriesRequest {
    /// Returns the job that the flags ask for; `None` if they ask for one picture.
    pub(super) fn new(args: &RenderArgs) -> Result<Option<Self>, Failure> {
        let FramesArgs { frames, turntable, camera_from, fps, resume, raw, .. } = args.frames;
        let path = args.frames.camera_path.as_deref();
        let Some(output) = args.output.as_deref() else { return Ok(None) };
        let name = output.display().to_string();
        let movie = target::movie_of(output);
        let is_asked = frames.is_some() || turntable.is_some() || path.is_some();
        if !is_asked && movie.is_none() && raw.is_none() && !args::has_sign(output) {
            let given = [("--camera-from", camera_from.is_some()), ("--fps", fps.is_some()), ("--resume", resume)];
            return match given.into_iter().find(|(_, is_given)| *is_given) {
                Some((flag, _)) => Err(Failure::usage(format!(
                    "{flag} applies only to several pictures; add --frames RANGE (: for all) or --turntable N"
                ))),
                None => Ok(None),
            };
        }
        let target = Target::new(output, movie, raw.is_some(), &args.layers)?;
        let is_files = matches!(target, Target::Files { .. });
        if is_files && fps.is_some() && path.is_none() {
            return Err(Failure::usage("--fps applies only to movies; remove it"));
        }
        if !is_files && resume {
            return Err(Failure::usage(
                "--resume applies only to a file for each frame, such as -o f%04d.png; a movie is written at once",
            ));
        }
        if args.stereo == Some(Stereo::TwoFiles) {
            return Err(Failure::usage(
                "--stereo two-files does not apply to several pictures; use --stereo side-by-side",
            ));
        }
        if args.stop_rule.keep_partial {
            return Err(Failure::usage("--keep-partial applies to one picture, but several are asked for; remove it"));
        }
        let pictures = match turntable {
            Some(count) => Pictures::Turntable { count },
            None => Pictures::Frames {
                range: frames.unwrap_or(FrameRange::ALL),
                camera_from: camera_from.map(FrameRange::One),
                path: path.map(PathRequest::read).transpose()?,
            },
        };
        Ok(Some(Self { pictures, picture_name: name, target, fps: fps.unwrap_or(25), resume }))
    }

    /// The path that determines the format and the layers of the pictures.
    pub(super) fn picture(&self) -> &Path {
        match &self.target {
            Target::Files { path, .. } => path,
            // The pictures of a movie may hold the same as a PNG on standard output.
            _ => Path::new("-"),
        }
    }
}
