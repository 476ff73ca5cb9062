//! Renders several pictures. Meanwhile the next one is read and the previous one is written.

use std::cell::RefCell;
use std::panic::resume_unwind;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;
use std::time::Instant;

use crate::flags::render::RenderArgs;
use crate::frames::args::numbered;
use crate::frames::movie::{Message, STOPPED_BETWEEN, Sink};
use crate::frames::numbers::{Notes, Overview, numbers, wanted_path};
use crate::frames::series::{Series, Start, frames, still, turntable};
use crate::frames::{Pictures, SeriesRequest};
use crate::output::picture::Outputs;
use crate::render::device::OpenDevice;
use crate::render::renderer::renderer;
use crate::render::stop_rule::StopRule;
use crate::render::views::{Shot, views_of};
use crate::render::{Job, render_joined};
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, tell};
use crate::terminal::threads;
use pinhole::image::encoding::Encoding;
use pinhole::image::{Image, LayerSet};

/// Several pictures, with everything that rendering them needs.
pub(crate) struct Ready {
    pub(crate) series: Series,
    pub(crate) opened: OpenDevice,
    pub(crate) stop_rule: StopRule,
    pub(crate) writing: Writing,
    /// Facts about all frames, if the pictures are frames.
    pub(crate) overview: Option<Overview>,
    /// The numbers of all pictures, including those that are not made now.
    pub(crate) all: Vec<usize>,
}

/// The form in which pictures are written.
pub(crate) struct Writing {
    pub(crate) encoding: Encoding,
    outputs: Outputs,
    pub(crate) layers: LayerSet,
    /// Width and height of a picture.
    size: [u32; 2],
}

/// Facts that may be known before the pictures are prepared.
#[derive(Default)]
pub(crate) struct ReadyOptions<'a> {
    /// Facts about all frames. If absent, the frames are read.
    pub(crate) overview: Option<Overview>,
    /// The numbers of the pictures to make, in order; by default all.
    pub(crate) only: Option<&'a [usize]>,
}

/// Reads the input of the first picture, and opens the device meanwhile. `None` if no picture is left to make.
pub(crate) fn ready(
    args: &RenderArgs,
    wanted: &SeriesRequest,
    mut job: Job,
    options: ReadyOptions<'_>,
) -> Result<Option<Ready>, Failure> {
    let quiet = args.report.quiet;
    if quiet {
        progress::close();
    }
    let mut notes = Notes::new(quiet);
    threads::start()?;
    let path = wanted_path(&job.source, wanted, &mut notes)?;
    let numbers = numbers(&mut job.source, wanted, path.as_ref(), &mut notes)?;
    let left = left(wanted, &job.outputs, &numbers.all, options.only, &mut notes);
    let Some(&first) = left.first() else { return Ok(None) };
    let mut overview = options.overview;
    let prepare = || match (&wanted.pictures, &path) {
        (Pictures::Turntable { .. }, _) => turntable(&job.source, numbers.all.len(), first),
        (Pictures::Frames { .. }, Some(path)) if numbers.is_still => {
            still(&job.source, path, wanted.fps, numbers.index_of(first), first)
        }
        (Pictures::Frames { .. }, path) => {
            let path = path.as_ref().map(|path| (path, wanted.fps));
            let found = match overview.take() {
                Some(overview) => overview,
                None => Overview::of(&mut job.source, &numbers)?,
            };
            frames(&mut job.source, overview.insert(found), &numbers, first, path)
        }
    };
    let (prepared, opened) = job.device.open_beside(prepare)?;
    let Start { mut input, camera } = prepared;
    for number in &left {
        job.outputs.renamed(|path| numbered(path, *number)).check_not_inputs(&input.files)?;
    }
    input.notes.drain(..).for_each(|note| notes.tell(note));
    let notes = RefCell::new(notes);
    let note = |text: &dyn std::fmt::Display| notes.borrow_mut().tell(text.to_string());
    let (encoding, annotations) = job.finish(&mut input, note)?;
    let outputs = Outputs { annotations, ..job.outputs };
    let layers = outputs.layers(&encoding);
    let eyes = if input.eyes.is_some() { 2 } else { 1 };
    if job.stereo.is_some() && eyes == 1 {
        return Err(Failure::usage(
            "--stereo applies only to a camera with two eyes; add --separation, or `stereo` to the scene's camera",
        ));
    }
    let size = [eyes * input.film.width(), input.film.height()];
    wanted.target.check(&encoding, size)?;
    let all = numbers.all.clone();
    let (source, notes) = (job.source, notes.into_inner());
    let series = Series { source, input, camera, numbers, left, notes };
    let writing = Writing { encoding, outputs, layers, size };
    Ok(Some(Ready { series, opened, stop_rule: job.stop_rule, writing, overview, all }))
}

/// Returns the numbers of the pictures to make, without those that exist already.
fn left(
    wanted: &SeriesRequest,
    outputs: &Outputs,
    all: &[usize],
    only: Option<&[usize]>,
    notes: &mut Notes,
) -> Vec<usize> {
    if let Some(only) = only {
        return only.to_vec();
    }
    let is_done = |number: usize| {
        let outputs = outputs.renamed(|path| numbered(path, number));
        wanted.resume && outputs.paths().all(|path| path.is_file())
    };
    let left: Vec<usize> = all.iter().copied().filter(|number| !is_done(*number)).collect();
    if left.len() < all.len() {
        let (done, total) = (all.len() - left.len(), all.len());
        notes.tell(format!("{done} of {total} frames are there already and are not rendered again"));
    }
    left
}

pub(crate) fn run(args: &RenderArgs, wanted: &SeriesRequest, job: Job) -> Result<(), Failure> {
    let started = Instant::now();
    let Some(ready) = ready(args, wanted, job, ReadyOptions::default())? else { return Ok(()) };
    let Ready { series, opened, stop_rule, writing, .. } = ready;
    let (count, report, quiet) = (series.left.len(), series.input.report.clone(), args.report.quiet);
    let done = writing.write(wanted, count, renderer(&opened, &series.input, quiet).adapter(), |pictures| {
        series.for_each(|number, input| {
            pictures.begin();
            let (views, layers, opened) =
                (&views_of(input, input.film), writing.layers, renderer(&opened, input, quiet));
            let image = render_joined(&Shot::new(input, views, layers, stop_rule, opened))?;
            Ok(pictures.send(number, image))
        })
    })?;
    if !quiet {
        tell(report.line_of(done, started.elapsed()));
    }
    Ok(())
}

/// Sends pictures to the thread that writes them.
pub(crate) struct PictureSender<'a> {
    status: &'a mut Status,
    sender: SyncSender<Message>,
}

impl PictureSender<'_> {
    pub(crate) fn begin(&mut self) {
        self.status.show();
    }

    /// Sends a picture. Returns `false` if no more can be written; the writing thread reports why.
    pub(crate) fn send(&mut self, number: usize, image: Image) -> bool {
        let is_sent = self.sender.send(Message::Picture { number, image: Box::new(image) }).is_ok();
        if is_sent {
            self.status.done += 1;
        }
        is_sent
    }
}

impl Writing {
    /// Writes the pictures that `make` sends on a separate thread, and returns their number.
    pub(crate) fn write(
        &self,
        wanted: &SeriesRequest,
        count: usize,
        adapter: Option<&str>,
        make: impl FnOnce(&mut PictureSender<'_>) -> Result<(), Failure>,
    ) -> Result<usize, Failure> {
        let sink = Sink {
            target: &wanted.target,
            outputs: &self.outputs,
            encoding: &self.encoding,
            adapter,
            frames_per_second: wanted.fps,
            count,
            size: self.size,
        };
        let mut status = Status::new(count);
        let made = thread::scope(|scope| {
            let (sender, receiver) = sync_channel(1);
            let writing = scope.spawn({
                let sink = &sink;
                move || sink.write(&receiver)
            });
            let mut pictures = PictureSender { status: &mut status, sender };
            let made = make(&mut pictures);
            if made.is_ok() {
                // If this fails, the writing thread reports why.
                let _ = pictures.sender.send(Message::End);
            }
            drop(pictures);
            let written = writing.join().unwrap_or_else(|panic| resume_unwind(panic));
            made.and_then(|()| Ok(written?))
        });
        progress::clear();
        match made {
            Err(Failure::Stopped) if status.done > 0 && wanted.target.is_files() => {
                Err(Failure::StoppedBetween(STOPPED_BETWEEN))
            }
            Ok(()) => Ok(status.done),
            Err(failure) => Err(failure),
        }
    }
}

pub(crate) struct Status {
    total: usize,
    done: usize,
    started: Instant,
}

impl Status {
    pub(crate) fn new(total: usize) -> Self {
        Self { total, done: 0, started: Instant::now() }
    }

    /// Shows that work on the next frame has begun.
    pub(crate) fn show(&self) {
        progress::frames(self.text());
    }

    fn text(&self) -> String {
        let Self { total, done, started, .. } = self;
        let frame = format!("frame {} of {total}", (done + 1).min(*total));
        if *done == 0 {
            return frame;
        }
        let each = started.elapsed().as_secs_f64() / *done as f64;
        format!("{frame}, {each:.2} s each, {:.0} s left", each * (total - done) as f64)
    }
}
