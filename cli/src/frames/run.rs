//! Renders several pictures, while the next one is read and the one before is written.

use std::cell::RefCell;
use std::collections::HashSet;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;
use std::time::Instant;

use anyhow::Context;

use super::moving::{Moving, WantedPath};
use super::names::numbered;
use super::numbers::{Numbers, numbers, wanted_path};
use super::sink::{Message, STOPPED_BETWEEN, Sink};
use super::status::Status;
use super::turn::{Axis, turned, up_of};
use super::union::{Union, swept};
use super::{Pictures, Wanted};
use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::input::contents::Contents;
use crate::input::{Framed, Input, Look, Source};
use crate::render::{Job, render_joined};
use crate::speak::tell;
use crate::views::Views;
use crate::{progress, threads};
use pinhole::color_by::{ColorKey, JoinedKeys};
use pinhole::glam::DVec3;
use pinhole::light::environment::Environment;
use pinhole::scene::Scene;
use pinhole::scene_file::SceneFile;

/// Notes that were told, each of them once.
pub(super) struct Notes {
    told: HashSet<String>,
    quiet: bool,
}

impl Notes {
    pub(super) fn tell(&mut self, note: String) {
        if !self.quiet && !self.told.contains(&note) {
            tell(format_args!("note: {note}"));
            self.told.insert(note);
        }
    }
}

/// The pictures after the first, and how each of them differs from the one before.
enum Rest {
    /// Frames of the file, which a moving camera may see.
    Frames(Option<Box<Moving>>),
    /// The same scene, which a moving camera sees.
    Moving(Box<Moving>),
    /// Views of the same scene.
    Turntable(Box<Turntable>),
}

/// Views of one scene.
struct Turntable {
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
struct Prepared {
    input: Input,
    rest: Rest,
}

/// Renders all pictures and writes them.
pub(crate) fn run(args: &RenderArgs, wanted: &Wanted, job: Job) -> Result<(), Failure> {
    let started = Instant::now();
    let quiet = args.report.quiet;
    let Job { mut source, outputs, encoding, annotation, stop_rule, device, stereo } = job;
    if quiet {
        progress::close();
    }
    let mut notes = Notes { told: HashSet::new(), quiet };
    threads::start()?;
    let path = wanted_path(&source, wanted, &mut notes)?;
    let numbers = numbers(&mut source, wanted, path.as_ref(), &mut notes)?;
    let is_done = |number: usize| {
        let outputs = outputs.renamed(|path| numbered(path, number));
        wanted.resume && outputs.paths().all(|path| path.is_file())
    };
    let total = numbers.all.len();
    let left: Vec<usize> = numbers.all.iter().copied().filter(|number| !is_done(*number)).collect();
    if left.len() < total {
        let done = total - left.len();
        notes
            .tell(format!("{done} of {total} frames are there already and are not rendered again"));
    }
    let Some(&first) = left.first() else { return Ok(()) };
    let prepare = || match (&wanted.pictures, &path) {
        (Pictures::Turntable { .. }, _) => turntable(&source, total, first),
        (Pictures::Frames { .. }, Some(path)) if numbers.is_still => {
            still(&source, path, wanted.fps, numbers.index_of(first), first)
        }
        (Pictures::Frames { .. }, path) => {
            let path = path.as_ref().map(|path| (path, wanted.fps));
            frames(&mut source, &numbers, first, path)
        }
    };
    let (prepared, opened) = device.open_beside(prepare)?;
    let Prepared { mut input, rest } = prepared;
    for number in &left {
        outputs.renamed(|path| numbered(path, *number)).check_not_inputs(&input.files)?;
    }
    input.notes.drain(..).for_each(|note| notes.tell(note));
    opened.note().iter().for_each(|note| notes.tell((*note).to_owned()));
    let encoding = annotation.apply_to(encoding.apply_to(input.encoding));
    let encoding = encoding.with_background(input.settings.visible_background());
    input.settings.is_transparent = encoding.transparent();
    if input.settings.integrator.is_primary() {
        stop_rule.check_without_light()?;
    }
    input.settings.notes(&input.scene).iter().for_each(|note| notes.tell(note.to_string()));
    let found = RefCell::new(Vec::new());
    let annotations =
        annotation.for_input(&input, |text| found.borrow_mut().push(text.to_string()))?;
    found.into_inner().into_iter().for_each(|note| notes.tell(note));
    let outputs = outputs.with_annotations(annotations.clone());
    let layers = outputs.layers(&encoding);
    let eyes = if input.eyes.is_some() { 2 } else { 1 };
    if stereo.is_some() && eyes == 1 {
        return Err(Failure::usage(
            "--stereo applies only to a camera with two eyes; add --separation, or `stereo` to the scene's camera",
        ));
    }
    let size = [eyes * input.film.width(), input.film.height()];
    wanted.target.check(&encoding, size)?;
    let sink = Sink {
        target: &wanted.target,
        outputs: &outputs,
        encoding: &encoding,
        annotations: &annotations,
        adapter: opened.adapter(),
        frames_per_second: wanted.fps,
        count: left.len(),
        size,
    };
    let mut status = Status::new(left.len(), quiet);
    let rendered = thread::scope(|scope| {
        let (send_next, next) = sync_channel(1);
        let (pictures, receiver) = sync_channel(1);
        let (left, numbers) = (&left, &numbers);
        scope.spawn(move || read(source, &rest, numbers, left, &send_next));
        let writing = scope.spawn({
            let sink = &sink;
            move || sink.write(&receiver)
        });
        let mut render = || {
            let mut number = first;
            loop {
                status.show();
                let image = {
                    let views = Views::of(&input);
                    render_joined(&input, &stop_rule, &views, layers, &opened)?
                };
                if pictures.send(Message::Picture { number, image: Box::new(image) }).is_err() {
                    // The thread that writes says why.
                    return Ok(());
                }
                status.count();
                let Ok(change) = next.recv() else { break };
                let (following, change) = change?;
                number = following;
                apply(&mut input, change, &mut notes)?;
            }
            // If this fails, the thread that writes says why.
            let _ = pictures.send(Message::End);
            Ok(())
        };
        let rendered: Result<(), Failure> = render();
        drop((pictures, next));
        let written = writing.join().unwrap_or_else(|panic| resume_unwind(panic));
        rendered.and_then(|()| Ok(written?))
    });
    progress::clear();
    match rendered {
        Err(Failure::Stopped) if status.done() > 0 && wanted.target.is_files() => {
            Err(Failure::StoppedBetween(STOPPED_BETWEEN))
        }
        Ok(()) if !quiet => {
            tell(input.report.line_of(status.done(), started.elapsed()));
            Ok(())
        }
        result => result,
    }
}

/// Reads all frames for the camera and the colors, and then the first that is rendered.
fn frames(
    source: &mut Source,
    numbers: &Numbers,
    first: usize,
    path: Option<(&WantedPath, u32)>,
) -> Result<Prepared, Failure> {
    let framed = numbers.framed.as_ref().unwrap_or(&numbers.all);
    let (mut union, mut colors, mut kinds) = (Union::default(), JoinedKeys::default(), None);
    for (index, &number) in framed.iter().enumerate() {
        progress::frames(format!("looking at frame {} of {}", index + 1, framed.len()));
        let contents = frame(source, number)?;
        contents.color_key().into_iter().for_each(|key| colors.add(key));
        kinds = kinds.or_else(|| contents.kinds().cloned());
        union.add(&contents.scene);
    }
    let missing = colors.missing();
    source.set_colors(colors, kinds);
    let framed = union.scene().with_context(|| source.name())?;
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
fn still(
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

/// Reads one frame.
fn frame(source: &mut Source, number: usize) -> Result<Contents, Failure> {
    source.set_frame(number);
    source.contents().map_err(|failure| match failure {
        Failure::Job(error) => Failure::Job(error.context(format!("frame {number}"))),
        other => other,
    })
}

/// Reads the scene, and frames the body that it sweeps while it turns.
fn turntable(source: &Source, count: usize, first: usize) -> Result<Prepared, Failure> {
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
