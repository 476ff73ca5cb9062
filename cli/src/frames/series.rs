//! Several pictures of one input in sequence. The next picture is read while one is being rendered.

use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

use anyhow::Context;

use crate::frames::moving::{Axis, Course, MovingCamera, PathRequest, Stage, up_of};
use crate::frames::numbers::{Notes, Numbers, Overview, frame};
use crate::input::contents::Contents;
use crate::input::{FramedScene, Input, Look, Source};
use crate::terminal::failure::Failure;
use pinhole::glam::DVec3;
use pinhole_figure::framing::{Union, swept};

struct Change {
    contents: Option<Box<Contents>>,
    look: Option<Box<Look>>,
}

/// The start of a series: the input of the first picture, and the camera of all pictures, if it moves.
pub(crate) struct Start {
    pub(crate) input: Input,
    pub(crate) camera: Option<Box<MovingCamera>>,
}

/// Several pictures, the first of which was read.
pub(crate) struct Series {
    pub(super) source: Source,
    /// The input of the first picture.
    pub(crate) input: Input,
    pub(super) camera: Option<Box<MovingCamera>>,
    pub(super) numbers: Numbers,
    /// The numbers of the pictures to make, in order.
    pub(crate) left: Vec<usize>,
    pub(crate) notes: Notes,
}

impl Series {
    /// Calls `work` with the number and the input of each picture until it returns `false` or an error. The next
    /// picture is read meanwhile.
    pub(crate) fn for_each(
        self,
        mut work: impl FnMut(usize, &mut Input) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        let Self { source, mut input, camera, numbers, left, mut notes } = self;
        let Some(&first) = left.first() else { return Ok(()) };
        thread::scope(|scope| {
            let (send_next, next) = sync_channel(1);
            scope.spawn(move || read(source, camera.as_deref(), &numbers, &left, &send_next));
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

    /// Calls `work` with the number of each picture and an input that has its camera and settings, until it returns `false`
    /// or an error. The data stays that of the first picture, so that no other is read.
    pub(crate) fn for_each_look(
        self,
        mut work: impl FnMut(usize, &Input) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        let Self { source, mut input, camera, numbers, left, .. } = self;
        for (place, number) in left.into_iter().enumerate() {
            if let Some(camera) = camera.as_deref().filter(|_| place > 0) {
                see(&mut input, camera.view(&source, number, numbers.index_of(number))?);
            }
            if !work(number, &input)? {
                break;
            }
        }
        Ok(())
    }
}

/// Reads the first frame to render, and makes the camera and the colours of all frames.
pub(super) fn frames(
    source: &mut Source,
    overview: &Overview,
    numbers: &Numbers,
    first: usize,
    path: Option<(&PathRequest, u32)>,
) -> Result<Start, Failure> {
    let missing = overview.colors.missing();
    let chosen = overview.chosen(source)?;
    source.joined = overview.colors.clone();
    source.chosen = chosen;
    let framed = overview.scene().with_context(|| source.name())?;
    let mut contents = frame(source, first)?;
    // The legend describes all frames.
    if let Some(key) = contents.details.color_key.as_mut() {
        key.missing = key.missing.or(missing);
    }
    let sky = source.sky(&contents)?;
    let Some((path, fps)) = path else {
        let framed = FramedScene::new(&framed, contents.color_key());
        let look = source.look(&contents.file, framed, sky, None)?;
        return Ok(Start { input: source.input_with(contents, look)?, camera: None });
    };
    let (key, file) = (contents.color_key().cloned(), Arc::clone(&contents.file));
    let up = source.up(contents.details.chosen.as_ref());
    let camera = MovingCamera::on_path(source, path, fps, Stage { framed, key, file, sky }, up)?;
    prepared(source, contents, camera, first, numbers.index_of(first))
}

/// Reads the scene that a moving camera sees.
pub(super) fn still(
    source: &Source,
    path: &PathRequest,
    fps: u32,
    index: usize,
    first: usize,
) -> Result<Start, Failure> {
    let contents = source.contents()?;
    let sky = source.sky(&contents)?;
    let mut framed = Union::default();
    framed.add(&contents.scene);
    let framed = framed.scene().with_context(|| source.name())?;
    let (key, file) = (contents.color_key().cloned(), Arc::clone(&contents.file));
    let up = source.up(contents.details.chosen.as_ref());
    let camera = MovingCamera::on_path(source, path, fps, Stage { framed, key, file, sky }, up)?;
    prepared(source, contents, camera, first, index)
}

/// Reads the scene, and frames the body that it sweeps in a full turn.
pub(super) fn turntable(source: &Source, count: usize, first: usize) -> Result<Start, Failure> {
    let contents = source.contents()?;
    let sky = source.sky(&contents)?;
    let (key, file) = (contents.color_key().cloned(), Arc::clone(&contents.file));
    let direction = match source.up(contents.details.chosen.as_ref()) {
        Some(up) => up.normalize_or(DVec3::Y),
        None => {
            let framed = FramedScene::new(&contents.scene, key.as_ref());
            let look = source.look(&file, framed, sky.clone(), None)?;
            up_of(&look.parameters).unwrap_or(DVec3::Y)
        }
    };
    let axis = Axis { direction, center: contents.scene.subject().bounds().center() };
    let framed = swept(&contents.scene, axis.direction, axis.center);
    let framed = framed.with_context(|| source.name())?;
    let stage = Stage { framed, key, file, sky };
    let camera = MovingCamera { course: Course::Turn { count, axis }, stage };
    prepared(source, contents, camera, first, first)
}

/// Prepares the input of the first picture, as the moving camera sees it.
fn prepared(
    source: &Source,
    contents: Contents,
    camera: MovingCamera,
    first: usize,
    index: usize,
) -> Result<Start, Failure> {
    let look = camera.view(source, first, index)?;
    let input = source.input_with(contents, look)?;
    Ok(Start { input, camera: Some(Box::new(camera)) })
}

/// Reads or makes the pictures after the first, until the receiver is gone.
fn read(
    mut source: Source,
    camera: Option<&MovingCamera>,
    numbers: &Numbers,
    left: &[usize],
    next: &SyncSender<Result<(usize, Change), Failure>>,
) {
    let mut change = |number: usize| {
        let contents = (!numbers.is_still).then(|| frame(&mut source, number)).transpose()?;
        let view = |camera: &MovingCamera| camera.view(&source, number, numbers.index_of(number));
        let look = camera.map(view).transpose()?;
        Ok(Change { contents: contents.map(Box::new), look: look.map(Box::new) })
    };
    for &number in left.iter().skip(1) {
        let change = change(number);
        let is_last = change.is_err();
        if next.send(change.map(|change| (number, change))).is_err() || is_last {
            return;
        }
    }
}

/// Gives an input another camera, with the settings for it.
fn see(input: &mut Input, look: Look) {
    let is_transparent = input.settings.is_transparent;
    (input.camera, input.eyes, input.settings) = (look.camera, look.eyes, look.settings);
    input.settings.is_transparent = is_transparent;
}

/// Turns the input of one picture into that of the next.
fn apply(input: &mut Input, change: Change, notes: &mut Notes) -> Result<(), Failure> {
    if let Some(look) = change.look {
        see(input, *look);
    }
    if let Some(mut contents) = change.contents {
        contents.details.notes.drain(..).for_each(|note| notes.tell(note));
        input.scene = Arc::new(contents.scene);
        let checked = input.settings.check(&input.scene);
        checked.with_context(|| input.report.path.clone())?;
    }
    Ok(())
}
