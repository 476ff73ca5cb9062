//! The destination of several pictures, from the name of the output.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::frames::args::{Pattern, has_sign};
use crate::input::extension;
use crate::output::files::check_writable;
use crate::terminal::failure::Failure;
use pinhole::image::encoding::{Bits, Encoding};

#[derive(Debug)]
pub(super) enum Target {
    Files {
        path: PathBuf,
    },
    Movie {
        path: PathBuf,
        kind: Movie,
    },
    /// YUV4MPEG2 on standard output.
    Raw,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Movie {
    Apng,
    Gif,
    /// A container that ffmpeg writes, with its name.
    Video(&'static str),
}

/// Returns the format of a movie, by the extension of its path.
pub(super) fn movie_of(path: &Path) -> Option<Movie> {
    Some(match extension(path)?.as_str() {
        "apng" => Movie::Apng,
        "gif" => Movie::Gif,
        "mp4" => Movie::Video("mp4"),
        "webm" => Movie::Video("webm"),
        "mkv" => Movie::Video("matroska"),
        "mov" => Movie::Video("mov"),
        _ => return None,
    })
}

impl Target {
    /// Checks the name of the output and the layers beside it.
    pub(super) fn new(output: &Path, movie: Option<Movie>, is_raw: bool, layers: &[String]) -> Result<Self, Failure> {
        let name = output.display();
        let is_standard_output = output == Path::new("-");
        if let (true, Some(layer)) = (movie.is_some() || is_raw, layers.first()) {
            return Err(Failure::usage(format!(
                "--layer {layer}: a movie has no layers; write a file for each frame, such as -o f%04d.png with \
                 --layer depth=depth%04d.npy"
            )));
        }
        match (movie, is_raw) {
            (_, true) if !is_standard_output => {
                Err(Failure::usage(format!("--raw y4m writes to standard output; replace -o {name} by -o -")))
            }
            (_, true) => Ok(Self::Raw),
            (Some(kind), _) => {
                if has_sign(output) {
                    return Err(Failure::usage(format!("{name}: a movie is one file; choose a name without %")));
                }
                check_writable(output)?;
                if matches!(kind, Movie::Video(_)) {
                    check_ffmpeg(output)?;
                }
                Ok(Self::Movie { path: output.to_path_buf(), kind })
            }
            _ if is_standard_output => Err(Failure::usage(
                "-o -: standard output takes only one picture; add --raw y4m for a movie, or name files such as \
                 -o f%04d.png",
            )),
            _ => {
                let of_layers = layers.iter().filter_map(|layer| layer.split_once('='));
                let of_layers = of_layers.map(|(_, path)| Path::new(path));
                for path in [output].into_iter().chain(of_layers) {
                    Pattern::new(path).map_err(Failure::usage)?;
                }
                Ok(Self::Files { path: output.to_path_buf() })
            }
        }
    }

    pub(super) fn is_files(&self) -> bool {
        matches!(self, Self::Files { .. })
    }

    /// Refuses an encoding that this kind of movie cannot have.
    pub(super) fn check(&self, encoding: &Encoding, size: [u32; 2]) -> Result<(), Failure> {
        let kind = match self {
            Self::Files { .. } => return Ok(()),
            Self::Raw => None,
            Self::Movie { kind, .. } => Some(*kind),
        };
        if kind != Some(Movie::Apng) {
            if encoding.transparent {
                return Err(Failure::usage(
                    "--transparent: of all movies only .apng may be transparent; use it, or a file for each frame",
                ));
            }
            if encoding.bits != Bits::Eight {
                return Err(Failure::usage(
                    "--bits 16: of all movies only .apng has 16 bits; use it, or a file for each frame",
                ));
            }
        }
        let most = u32::from(u16::MAX);
        if kind == Some(Movie::Gif) && size.into_iter().any(|side| side > most) {
            return Err(Failure::usage(format!(
                "a GIF has at most {most} pixels on each side; choose a smaller --size"
            )));
        }
        Ok(())
    }
}

/// Refuses a movie that needs ffmpeg if ffmpeg is missing.
fn check_ffmpeg(output: &Path) -> Result<(), Failure> {
    let mut command = Command::new("ffmpeg");
    command.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        _ => Err(Failure::usage(format!(
            "{}: this movie needs the program ffmpeg, which is not on PATH; install it, or write .apng, .gif or \
             f%04d.png, which need no other program",
            output.display()
        ))),
    }
}
