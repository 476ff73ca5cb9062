//! The numbers of the pictures, which are frames of a file or moments of a moving camera, and facts about all of them.

use std::collections::HashSet;

use crate::frames::args::FrameRange;
use crate::frames::moving::{PathRequest, in_frame};
use crate::frames::target::Target;
use crate::frames::{Pictures, SeriesRequest};
use crate::input::contents::Contents;
use crate::input::kinds::Chosen;
use crate::input::{FoundFrames, Source};
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, tell};
use pinhole::scene::{Scene, SceneError};
use pinhole_figure::color_by::JoinedKeys;
use pinhole_figure::framing::{Union, scene_of};

#[derive(Default)]
pub(crate) struct Numbers {
    /// The pictures that the camera frames, if not all.
    pub(crate) framed: Option<Vec<usize>>,
    pub(crate) all: Vec<usize>,
    /// Whether all pictures show one scene.
    pub(crate) is_still: bool,
}

impl Numbers {
    /// The index of a number among all pictures, from 0.
    pub(crate) fn index_of(&self, number: usize) -> usize {
        self.all.iter().position(|one| *one == number).unwrap_or(0)
    }
}

/// The path of the camera: that of a flag, or else that of the scene, unless other flags replace it.
pub(crate) fn wanted_path(
    source: &Source,
    wanted: &SeriesRequest,
    notes: &mut Notes,
) -> Result<Option<PathRequest>, Failure> {
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
    Ok(Some(PathRequest { path, file: source.path.clone() }))
}

fn replaced(scene: &str, by: &str) -> String {
    format!("{scene}: {by} replaced `camera_path`, which is not used")
}

pub(crate) fn numbers(
    source: &mut Source,
    wanted: &SeriesRequest,
    path: Option<&PathRequest>,
    notes: &mut Notes,
) -> Result<Numbers, Failure> {
    let Pictures::Frames { range, camera_from, .. } = wanted.pictures else {
        let Pictures::Turntable { count } = wanted.pictures else { return Ok(Numbers::default()) };
        return Ok(Numbers { framed: None, all: (0..count as usize).collect(), is_still: true });
    };
    let still_of = |path: &PathRequest| {
        if camera_from.is_some() {
            return Err(Failure::usage("--camera-from applies only to several frames of a file; remove it"));
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

/// Finds the frames of the file; `None` if it has none and the camera moves.
fn open_frames(source: &mut Source, wanted: &SeriesRequest, moves: bool) -> Result<Option<FoundFrames>, Failure> {
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
                "choose a name without %, and remove --frames"
            };
            Err(Failure::usage(format!("{name}: {reason}; {remedy}")))
        }
    }
}

fn in_range(range: FrameRange, count: usize, flag: &str) -> Result<Vec<usize>, Failure> {
    range.of(count).map_err(|error| Failure::usage(format!("{flag}: {error}")))
}

/// Facts about all frames. They are stored in the folder of a job, so that its parts need not read all frames again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Overview {
    /// Spheres that extend as far as those of all frames, each x, y, z, radius.
    pub(crate) spheres: Vec<[f64; 4]>,
    /// The number of these spheres, at the end, that were added to the data.
    pub(crate) added: usize,
    pub(crate) colors: JoinedKeys,
    /// The frame from which comes what is chosen for its kind.
    pub(crate) kinds_from: Option<usize>,
    /// This choice, if it is known.
    chosen: Option<Chosen>,
}

impl Overview {
    /// Restores facts that were stored. What was chosen is read again from its frame.
    pub(crate) fn stored(spheres: Vec<[f64; 4]>, added: usize, colors: JoinedKeys, kinds_from: Option<usize>) -> Self {
        Self { spheres, added, colors, kinds_from, chosen: None }
    }

    /// Reads all frames that the camera frames, and gathers the facts.
    pub(crate) fn of(source: &mut Source, numbers: &Numbers) -> Result<Self, Failure> {
        let framed = numbers.framed.as_ref().unwrap_or(&numbers.all);
        let (mut union, mut overview) = (Union::default(), Self::default());
        for (index, &number) in framed.iter().enumerate() {
            progress::frames(format!("looking at frame {} of {}", index + 1, framed.len()));
            let contents = frame(source, number)?;
            contents.color_key().into_iter().for_each(|key| overview.colors.add(key));
            contents.details.arrow_key.iter().for_each(|key| overview.colors.add_arrows(key));
            // Colours by kinds of spheres may begin in a later frame.
            if let Some(chosen) = &contents.details.chosen
                && overview.chosen.as_ref().is_none_or(|first| first.colors.is_none() && chosen.colors.is_some())
            {
                (overview.chosen, overview.kinds_from) = (Some(chosen.clone()), Some(number));
                source.chosen = overview.chosen.clone();
            }
            union.add(&contents.scene);
        }
        (overview.spheres, overview.added) = union.into_spheres();
        Ok(overview)
    }

    /// Returns what was chosen because no flag said it.
    pub(crate) fn chosen(&self, source: &mut Source) -> Result<Option<Chosen>, Failure> {
        match (&self.chosen, self.kinds_from) {
            (None, Some(number)) => Ok(frame(source, number)?.details.chosen),
            (chosen, _) => Ok(chosen.clone()),
        }
    }

    /// The spheres as a scene, which the camera frames.
    pub(crate) fn scene(&self) -> Result<Scene, SceneError> {
        scene_of(&self.spheres, self.added)
    }
}

/// Notes that were printed. Each is printed only once.
pub(crate) struct Notes {
    told: HashSet<String>,
    quiet: bool,
}

impl Notes {
    pub(crate) fn new(quiet: bool) -> Self {
        Self { told: HashSet::new(), quiet }
    }

    pub(crate) fn tell(&mut self, note: String) {
        if !self.quiet && !self.told.contains(&note) {
            tell(format_args!("note: {note}"));
            self.told.insert(note);
        }
    }
}

pub(crate) fn frame(source: &mut Source, number: usize) -> Result<Contents, Failure> {
    source.frame = Some(number);
    source.contents().map_err(|failure| in_frame(failure, number))
}
