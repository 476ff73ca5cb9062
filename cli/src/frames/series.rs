//! Several pictures of one input, one after the other: the next one is read while work on one is done.

use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

use anyhow::Context;

use super::frame::frame;
use super::moving::{Moving, WantedPath};
use super::notes::Notes;
use super::numbers::Numbers;
use super::overview::Overview;
use super::turn::{Axis, turned, up_of};
use super::union::{Union, swept};
use crate::failure::Failure;
use crate::input::contents::Contents;
use crate::input::{Framed, Input, Look, Source};
use pinhole::color_by::ColorKey;
use pinhole::glam::DVec3;
use pinhole::light::environment::Environment;
use pinhole::scene::Scene;
use pinhole::scene_file::SceneFile;

/// The pictures after the first, and how each of them differs from the one before.
pub(super) enum Rest {
    /// Frames of the file, which a moving camera may see.
    Frames(Option<Box<Moving>>),
    /// The same scene, which a moving camera sees.
    Moving(Box<Moving>),
    /// Views of the same scene.
    Turntable(Box<Turntable>),
}

/// Views of one scene.
pub(super) struct Turntable {
    count: usize,
    axis: Axis,
    /// What the camera frames.
    framed: Scene,
    /// What the legend shows.
    key: Option<ColorKey>,
    file: Arc<SceneFile>,
    sky: Option<Environment>,
}

/// What changes from one picture to the next.
enum Change {
    Frame(Box<Contents>, Option<Box<Look>>),
    View(Box<Look>),
}

/// The input of the first picture, and the rest.
pub(super) struct Prepared {
    pub(super) input: Input,
    pub(super) rest: Rest,
}

/// Several pictures, of which the first was read.
pub(crate) struct Series {
    pub(super) source: Source,
    /// The input of the first picture.
    pub(crate) input: Input,
    pub(super) rest: Rest,
    pub(super) numbers: Numbers,
    /// The numbers of the pictures that are made, in order.
    pub(crate) left: Vec<usize>,
    pub(crate) notes: Notes,
}

impl Series {
    /// Calls `work` with the number and the input of each picture, while the next is read, until it returns `false` or
    /// an error.
    pub(crate) fn for_each(
        self,
        mut work: impl FnMut(usize, &mut Input) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        let Self { source, mut input, rest, numbers, left, mut notes } = self;
        let Some(&first) = left.first() else { return Ok(()) };
        thread::scope(|scope| {
            let (send_next, next) = sync_channel(1);
            scope.spawn(move || read(source, &rest, &numbers, &left, &send_next));
            let mut number = first;
            while work(number, &mut input)? {
                let Ok(change) = next.recv() else { break };
                let (following, change) = change?;
                number = following;
                apply(&mut input, change, &mut notes)?;
            }
            Ok(())
        })
    }
}

/// Reads the first frame that is rendered, and makes the camera and the colors of all frames.
pub(super) fn frames(
    source: &mut Source,
    overview: &Overview,
    numbers: &Numbers,
    first: usize,
    path: Option<(&WantedPath, u32)>,
) -> Result<Prepared, Failure> {
    let missing = overview.colors.missing();
    let kinds = overview.kinds(source)?;
    source.set_colors(overview.colors.clone(), kinds);
    let framed = overview.scene().with_context(|| source.name())?;
    let mut contents = frame(source, first)?;
    // The legend is that of all frames.
    if let Some(key) = contents.color_key_mut() {
        key.missing = key.missing.or(missing);
    }
    let sky = source.sky(&contents)?;
    let Some((path, fps)) = path else {
        let framed = Framed::new(&framed, contents.color_key());
        let look = source.look(&contents.file, framed, sky, None)?;
        let input = source.input_with(contents, look)?;
        return Ok(Prepared { input, rest: Rest::Frames(None) });
    };
    let key = contents.color_key().cloned();
    let moving = Moving::new(source, path, fps, (framed, key), Arc::clone(&contents.file), sky)?;
    let look = moving.view(source, first, numbers.index_of(first))?;
    let input = source.input_with(contents, look)?;
    Ok(Prepared { input, rest: Rest::Frames(Some(Box::new(moving))) })
}

/// Reads the scene that a moving camera sees.
pub(super) fn still(
    source: &Source,
    path: &WantedPath,
    fps: u32,
    index: usize,
    first: usize,
) -> Result<Prepared, Failure> {
    let contents = source.contents()?;
    let sky = source.sky(&contents)?;
    let mut framed = Union::default();
    framed.add(&contents.scene);
    let framed = framed.scene().with_context(|| source.name())?;
    let key = contents.color_key().cloned();
    let moving = Moving::new(source, path, fps, (framed, key), Arc::clone(&contents.file), sky)?;
    let look = moving.view(source, first, index)?;
    let input = source.input_with(contents, look)?;
    Ok(Prepared { input, rest: Rest::Moving(Box::new(moving)) })
}

/// Reads the scene, and frames the body that it sweeps while it turns.
pub(super) fn turntable(source: &Source, count: usize, first: usize) -> Result<Prepared, Failure> {
    let contents = source.contents()?;
    let sky = source.sky(&contents)?;
    let file = Arc::clone(&contents.file);
    let direction = match source.up() {
        Some(up) => up.normalize_or(DVec3::Y),
        None => {
            let framed = Framed::new(&contents.scene, contents.color_key());
            let look = source.look(&file, framed, sky.clone(), None)?;
            up_of(&look.parameters).unwrap_or(DVec3::Y)
        }
    };
    let axis = Axis { direction, center: contents.scene.bounds_to_frame().center() };
    let framed = swept(&contents.scene, axis.direction, axis.center);
    let framed = framed.with_context(|| source.name())?;
    let key = contents.color_key().cloned();
    let turntable = Turntable { count, axis, framed, key, file, sky };
    let look = turntable.view(source, first)?;
    let input = source.input_with(contents, look)?;
    Ok(Prepared { input, rest: Rest::Turntable(Box::new(turntable)) })
}

impl Turntable {
    /// Makes the camera and the light of one picture.
    fn view(&self, source: &Source, number: usize) -> Result<Look, Failure> {
        let part = number as f64 / self.count as f64;
        let turn = |camera: &_| turned(camera, self.axis, part);
        let framed = Framed::new(&self.framed, self.key.as_ref());
        source.look(&self.file, framed, self.sky.clone(), Some(&turn))
    }
}

/// Reads or makes what follows the first picture, until nobody waits for it.
fn read(
    mut source: Source,
    rest: &Rest,
    numbers: &Numbers,
    left: &[usize],
    next: &SyncSender<Result<(usize, Change), Failure>>,
) {
    for &number in left.iter().skip(1) {
        let change = match rest {
            Rest::Frames(moving) => frame(&mut source, number).and_then(|contents| {
                let view = |moving: &Moving| moving.view(&source, number, numbers.index_of(number));
                let look = moving.as_deref().map(view).transpose()?.map(Box::new);
                Ok(Change::Frame(Box::new(contents), look))
            }),
            Rest::Moving(moving) => {
                let look = moving.view(&source, number, numbers.index_of(number));
                look.map(Box::new).map(Change::View)
            }
            Rest::Turntable(turntable) => {
                turntable.view(&source, number).map(Box::new).map(Change::View)
            }
        };
        let is_last = change.is_err();
        if next.send(change.map(|change| (number, change))).is_err() || is_last {
            return;
        }
    }
}

/// Turns the input of one picture into that of the next.
fn apply(input: &mut Input, change: Change, notes: &mut Notes) -> Result<(), Failure> {
    match change {
        Change::Frame(mut contents, look) => {
            if let Some(look) = look {
                apply_look(input, *look);
            }
            contents.take_notes().into_iter().for_each(|note| notes.tell(note));
            input.scene = Arc::new(contents.scene);
            let checked = input.settings.check(&input.scene);
            checked.with_context(|| input.report.path.clone())?;
        }
        Change::View(look) => apply_look(input, *look),
    }
    Ok(())
}

fn apply_look(input: &mut Input, look: Look) {
    let is_transparent = input.settings.is_transparent;
    (input.camera, input.eyes, input.settings) = (look.camera, look.eyes, look.settings);
    input.settings.is_transparent = is_transparent;
}
