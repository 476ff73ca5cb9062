//! The flags for several pictures and for movies: the choice of frames, and the names of their files.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::{Args, ValueEnum};

const HEADING: &str = "Frames and movies";

#[derive(Debug, Args)]
pub(crate) struct FramesArgs {
    /// Frames to render, as a range like those of Python, such as all, 0:100:2, 5:, :10 or -1, with a pattern such as
    /// -o f%04d.png, or a movie (.mp4, .webm, .mkv, .mov, .apng, .gif) [default for movies: all]
    #[arg(
        long, help_heading = HEADING, value_name = "RANGE", allow_hyphen_values = true,
        conflicts_with_all = ["frame", "turntable"]
    )]
    pub(crate) frames: Option<FrameRange>,
    /// Render this number of pictures while the camera turns once about the direction that is up
    #[arg(
        long, help_heading = HEADING, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000)
    )]
    pub(crate) turntable: Option<u32>,
    /// Let the camera move along the keyframes of this file, which holds what `camera_path` of a scene file does. Of one
    /// frame, pictures up to the last key are made; --frames chooses some of them
    #[arg(
        long, help_heading = HEADING, value_name = "PATH.toml",
        conflicts_with_all = ["turntable", "eye", "look-at", "direction", "view", "turn", "margin"]
    )]
    pub(crate) camera_path: Option<PathBuf>,
    /// Let the camera frame this frame, and choose light and colors for it [default: all frames that are asked for]
    #[arg(long, help_heading = HEADING, value_name = "FRAME", allow_hyphen_values = true, conflicts_with = "turntable")]
    pub(crate) camera_from: Option<i64>,
    /// Pictures of a movie for each second, from 1 to 240 [default: 25]
    #[arg(long, help_heading = HEADING, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=240))]
    pub(crate) fps: Option<u32>,
    /// Leave out frames whose files exist already
    #[arg(long, help_heading = HEADING)]
    pub(crate) resume: bool,
    /// Write a movie that is not compressed to standard output, with -o -
    #[arg(long, help_heading = HEADING, value_enum)]
    pub(crate) raw: Option<Raw>,
}

impl FramesArgs {
    /// Whether these flags ask for several pictures, regardless of the output.
    pub(crate) fn asks_for_several(&self) -> bool {
        self.frames.is_some() || self.turntable.is_some() || self.camera_path.is_some()
    }

    /// Returns a flag about the way in which pictures are written, if one is given.
    pub(crate) fn of_writing(&self) -> Option<&'static str> {
        let given = [("--resume", self.resume), ("--raw", self.raw.is_some())];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Raw {
    /// YUV4MPEG2 with full resolution of color (C444), which ffmpeg and most players read
    Y4m,
}

/// A choice of frames of a file: one of them, or a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FrameRange {
    /// One frame; a negative number counts from the end.
    One(i64),
    /// `START:END:STEP`, with the end excluded.
    Slice { start: Option<i64>, end: Option<i64>, step: i64 },
}

const WANTED: &str = "write START:END or START:END:STEP, such as 0:100:2, all, or one number; negative numbers \
                      count from the end, and END is excluded";

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<i64>().map_err(|_| WANTED.to_owned());
        let optional = |text: &str| match text.trim() {
            "" => Ok(None),
            text => number(text).map(Some),
        };
        match text.trim() {
            "all" => return Ok(Self::ALL),
            "last" => return Ok(Self::One(-1)),
            _ => {}
        }
        let parts: Vec<&str> = text.split(':').collect();
        let (start, end, step) = match parts[..] {
            [one] => return number(one).map(Self::One),
            [start, end] => (start, end, ""),
            [start, end, step] => (start, end, step),
            _ => return Err(WANTED.to_owned()),
        };
        let step = optional(step)?.unwrap_or(1);
        if step == 0 {
            return Err("the step must not be 0".to_owned());
        }
        Ok(Self::Slice { start: optional(start)?, end: optional(end)?, step })
    }
}

impl FrameRange {
    pub(crate) const ALL: Self = Self::Slice { start: None, end: None, step: 1 };

    /// Returns the numbers of the frames of a file that has `count` frames.
    pub(crate) fn of(self, count: usize) -> Result<Vec<usize>, String> {
        // A count is far below the limit of i64, because each frame has some bytes in the file.
        let count = count as i64;
        let from_end = |number: i64| if number < 0 { number.saturating_add(count) } else { number };
        let plural = if count == 1 { "" } else { "s" };
        let (start, end, step) = match self {
            Self::One(number) => {
                let index = from_end(number);
                if !(0..count).contains(&index) {
                    return Err(format!(
                        "there is no frame {number}; the file has {count} frame{plural}, 0 to {}",
                        count - 1
                    ));
                }
                return Ok(vec![index as usize]);
            }
            Self::Slice { start, end, step } => (start, end, step),
        };
        // The ends are clipped as in Python.
        let (low, high) = if step > 0 { (0, count) } else { (-1, count - 1) };
        let clip = |number: i64| from_end(number).clamp(low, high);
        let (first, last) = if step > 0 { (low, high) } else { (high, low) };
        let (start, end) = (start.map_or(first, clip), end.map_or(last, clip));
        let mut frames = Vec::new();
        let mut next = start;
        while if step > 0 { next < end } else { next > end } {
            frames.push(next as usize);
            next = next.saturating_add(step);
        }
        if frames.is_empty() {
            return Err(format!("no frame lies in this range; the file has {count} frame{plural}, 0 to {}", count - 1));
        }
        Ok(frames)
    }
}

/// A path whose file name contains `%d` or `%04d` once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pattern {
    folder: PathBuf,
    before: String,
    /// The least number of digits, with leading zeros.
    digits: usize,
    after: String,
}

/// Whether a path contains a per cent sign, as patterns do.
pub(crate) fn has_sign(path: &Path) -> bool {
    path.to_string_lossy().contains('%')
}

impl Pattern {
    pub(crate) fn new(path: &Path) -> Result<Self, String> {
        let wanted = |problem: &str| {
            format!("{}: {problem}; write one %d or %04d into the name, such as f%04d.png", path.display())
        };
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| wanted("this is not the name of a file in UTF-8"))?;
        if path.parent().is_some_and(has_sign) {
            return Err(wanted("the names of folders are the same for all frames"));
        }
        let Some((before, rest)) = name.split_once('%') else {
            return Err(wanted("every frame needs a name of its own"));
        };
        let Some((width, after)) = rest.split_once('d') else {
            return Err(wanted("the % in this name is not that of a number"));
        };
        let digits = match width.strip_prefix('0') {
            _ if width.is_empty() => Some(1),
            Some(digits) => digits.parse().ok().filter(|digits| (1..=20).contains(digits)),
            None => None,
        };
        let Some(digits) = digits else {
            return Err(wanted("the % in this name is not that of a number"));
        };
        if after.contains('%') {
            return Err(wanted("a name has the number of its frame once"));
        }
        let (before, after) = (before.to_owned(), after.to_owned());
        Ok(Self { folder: path.with_file_name(""), before, digits, after })
    }

    pub(crate) fn path(&self, number: usize) -> PathBuf {
        let Self { folder, before, digits, after } = self;
        folder.join(format!("{before}{number:0digits$}{after}"))
    }
}

/// Returns a path with a number in place of its `%d`; a path without one is returned as it is.
pub(crate) fn numbered(path: &Path, number: usize) -> PathBuf {
    Pattern::new(path).map_or_else(|_| path.to_path_buf(), |pattern| pattern.path(number))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str, count: usize) -> Result<Vec<usize>, String> {
        text.parse::<FrameRange>()?.of(count)
    }

    /// The expected frames are those of `list(range(5))[text]` in Python.
    #[test]
    fn ranges_are_those_of_python() {
        for (text, expected) in [
            (":", &[0, 1, 2, 3, 4][..]),
            ("::", &[0, 1, 2, 3, 4]),
            ("1:", &[1, 2, 3, 4]),
            (":2", &[0, 1]),
            ("0:100:2", &[0, 2, 4]),
            ("-2:", &[3, 4]),
            (":-2", &[0, 1, 2]),
            ("-99:2", &[0, 1]),
            ("::-1", &[4, 3, 2, 1, 0]),
            ("3:0:-2", &[3, 1]),
            ("9::-4", &[4, 0]),
            (":-3:-1", &[4, 3]),
            ("::9223372036854775807", &[0]),
            ("::-9223372036854775808", &[4]),
        ] {
            assert_eq!(frames(text, 5).as_deref(), Ok(expected), "{text}");
        }
        assert_eq!(frames("-1", 5), Ok(vec![4]));
        assert_eq!(frames(" 3 ", 5), Ok(vec![3]));
        assert_eq!(frames("last", 5), Ok(vec![4]));
        assert_eq!(frames("all", 2), Ok(vec![0, 1]));
    }

    #[test]
    fn what_has_no_frame_is_refused() {
        for text in ["5", "-6", "3:3", "4:2", "7:", "2:4:-1"] {
            let error = frames(text, 5).unwrap_err();
            assert!(error.ends_with("the file has 5 frames, 0 to 4"), "{text}: {error}");
        }
        for text in ["", "a", "1:2:3:4", "1.5", "1:b", "0::x"] {
            assert_eq!(frames(text, 5).unwrap_err(), WANTED, "{text}");
        }
        assert_eq!(frames("::0", 5).unwrap_err(), "the step must not be 0");
    }

    #[test]
    fn numbers_have_digits() {
        let name =
            |pattern: &str, number| Pattern::new(Path::new(pattern)).unwrap().path(number).to_str().unwrap().to_owned();
        assert_eq!(name("f%d.png", 7), "f7.png");
        assert_eq!(name("out/f%04d.png", 7), "out/f0007.png");
        assert_eq!(name("/a/%03d-b.exr", 12345), "/a/12345-b.exr");
    }

    #[test]
    fn other_patterns_are_refused() {
        for text in ["f.png", "f%.png", "f%4d.png", "f%0d.png", "f%s.png", "%d/f.png", "%d%d.png"] {
            assert!(Pattern::new(Path::new(text)).is_err(), "{text}");
        }
        assert!(Pattern::new(Path::new("f%021d.png")).is_err());
    }
}
