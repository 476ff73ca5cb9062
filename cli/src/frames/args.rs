//! The flags for several pictures and for movies.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::range::FrameRange;

const HEADING: &str = "Frames and movies";

#[derive(Debug, Args)]
pub(crate) struct FramesArgs {
    /// Frames to render, as a range like those of Python, such as : for all, 0:100:2, 5:, :10 or -1, with a pattern such
    /// as -o f%04d.png, or a movie (.mp4, .webm, .mkv, .mov, .apng, .gif) [default for movies: all]
    #[arg(
        long, help_heading = HEADING, value_name = "RANGE", allow_hyphen_values = true,
        conflicts_with_all = ["frame", "turntable"]
    )]
    pub(super) frames: Option<FrameRange>,
    /// Render this number of pictures while the camera turns once about the direction that is up
    #[arg(
        long, help_heading = HEADING, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000)
    )]
    pub(super) turntable: Option<u32>,
    /// Let the camera move along the keyframes of this file, which holds what `camera_path` of a scene file does. Of one
    /// frame, pictures up to the last key are made; --frames chooses some of them
    #[arg(
        long, help_heading = HEADING, value_name = "PATH.toml",
        conflicts_with_all = ["turntable", "eye", "look_at", "direction", "view", "turn", "margin"]
    )]
    pub(super) camera_path: Option<PathBuf>,
    /// Let the camera frame this frame, and choose light and colors for it [default: all frames that are asked for]
    #[arg(long, help_heading = HEADING, value_name = "FRAME", allow_hyphen_values = true, conflicts_with = "turntable")]
    pub(super) camera_from: Option<i64>,
    /// Pictures of a movie for each second, from 1 to 240 [default: 25]
    #[arg(long, help_heading = HEADING, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=240))]
    pub(super) fps: Option<u32>,
    /// Leave out frames whose files exist already
    #[arg(long, help_heading = HEADING)]
    pub(super) resume: bool,
    /// Write a movie that is not compressed to standard output, with -o -
    #[arg(long, help_heading = HEADING, value_enum)]
    pub(super) raw: Option<Raw>,
}

impl FramesArgs {
    /// Whether these flags ask for several pictures, whatever the output is.
    pub(crate) fn asks_for_several(&self) -> bool {
        self.frames.is_some() || self.turntable.is_some() || self.camera_path.is_some()
    }

    /// The file of a camera path.
    pub(crate) fn camera_path(&self) -> Option<&Path> {
        self.camera_path.as_deref()
    }

    /// A flag that says how pictures are written, and not which.
    pub(crate) fn of_writing(&self) -> Option<&'static str> {
        let given = [("--resume", self.resume), ("--raw", self.raw.is_some())];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
    }

    /// Replaces what says how pictures are written.
    pub(crate) fn set_writing(&mut self, fps: Option<u32>, raw: Option<Raw>) {
        self.fps = fps.or(self.fps);
        self.raw = raw;
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Raw {
    /// YUV4MPEG2 with full resolution of color (C444), which ffmpeg and most players read
    Y4m,
}
