//! Which pictures there are: the frames of a file, or the moments of a moving camera.

use super::moving::WantedPath;
use super::notes::Notes;
use super::range::FrameRange;
use super::target::Target;
use super::{Pictures, Wanted};
use crate::failure::Failure;
use crate::input::{FoundFrames, Source};

/// The numbers of pictures.
#[derive(Default)]
pub(super) struct Numbers {
    /// Those that the camera frames, if these are not all.
    pub(super) framed: Option<Vec<usize>>,
    pub(super) all: Vec<usize>,
    /// Whether the pictures are those of one scene.
    pub(super) is_still: bool,
}

impl Numbers {
    /// The place of a number among all pictures, from 0.
    pub(super) fn index_of(&self, number: usize) -> usize {
        self.all.iter().position(|one| *one == number).unwrap_or(0)
    }
}

/// The path of the camera: that of a flag, or else that of the scene, unless other flags replace it.
pub(super) fn wanted_path(
    source: &Source,
    wanted: &Wanted,
    notes: &mut Notes,
) -> Result<Option<WantedPath>, Failure> {
    let of_scene = source.camera_path()?;
    let by = match &wanted.pictures {
        Pictures::Frames { path: Some(path), .. } => {
            if of_scene.is_some() {
                notes.tell(replaced(&source.name(), "--camera-path"));
            }
            return Ok(Some(path.clone()));
        }
        Pictures::Frames { .. } => "the flags for the camera",
        Pictures::Turntable { .. } => "--turntable",
    };
    let Some((path, is_replaced)) = of_scene else { return Ok(None) };
    if is_replaced || matches!(wanted.pictures, Pictures::Turntable { .. }) {
        notes.tell(replaced(&source.name(), by));
        return Ok(None);
    }
    Ok(Some(WantedPath { path, file: source.path().to_path_buf() }))
}

fn replaced(scene: &str, by: &str) -> String {
    format!("{scene}: {by} replaced `camera_path`, which is not used")
}

/// Finds which pictures there are.
pub(super) fn numbers(
    source: &mut Source,
    wanted: &Wanted,
    path: Option<&WantedPath>,
    notes: &mut Notes,
) -> Result<Numbers, Failure> {
    let &Wanted { pictures: Pictures::Frames { range, camera_from, .. }, .. } = wanted else {
        let Pictures::Turntable { count } = wanted.pictures else { return Ok(Numbers::default()) };
        return Ok(Numbers { framed: None, all: (0..count as usize).collect(), is_still: true });
    };
    let still_of = |path: &WantedPath| {
        if camera_from.is_some() {
            return Err(Failure::usage(
                "--camera-from applies only to several frames of a file; remove it",
            ));
        }
        let all = in_range(range, path.count(wanted.fps)?, "--frames")?;
        Ok(Numbers { framed: None, all, is_still: true })
    };
    if let Some(path) = path.filter(|_| source.has_frame()) {
        return still_of(path);
    }
    let FoundFrames { count, note } = match (open_frames(source, wanted, path.is_some())?, path) {
        (None, Some(path)) => return still_of(path),
        (Some(found), Some(path)) if found.count == 1 => {
            found.note.into_iter().for_each(|note| notes.tell(note));
            return still_of(path);
        }
        (found, _) => found.unwrap_or(FoundFrames { count: 0, note: None }),
    };
    note.into_iter().for_each(|note| notes.tell(note));
    let all = in_range(range, count, "--frames")?;
    let framed = camera_from.map(|frame| in_range(frame, count, "--camera-from"));
    Ok(Numbers { framed: framed.transpose()?, all, is_still: false })
}

/// Finds the frames of the file. `None` if it has none, and the camera moves.
fn open_frames(
    source: &mut Source,
    wanted: &Wanted,
    moves: bool,
) -> Result<Option<FoundFrames>, Failure> {
    let name = source.name();
    if source.has_frame() {
        return Err(Failure::usage(format!(
            "{}: --frame names one frame, but a movie needs several; write --frames RANGE, or add --turntable N or \
             --camera-path PATH.toml",
            wanted.picture_name
        )));
    }
    match source.open_frames()? {
        Ok(found) => Ok(Some(found)),
        Err(_) if moves => Ok(None),
        Err(reason) => {
            let is_movie = !matches!(wanted.target, Target::Files { .. });
            let remedy = if is_movie {
                "--turntable N and --camera-path PATH.toml make a movie of one frame"
            } else {
                "remove --frames"
            };
            Err(Failure::usage(format!("{name}: {reason}; {remedy}")))
        }
    }
}

fn in_range(range: FrameRange, count: usize, flag: &str) -> Result<Vec<usize>, Failure> {
    range.of(count).map_err(|error| Failure::usage(format!("{flag}: {error}")))
}
