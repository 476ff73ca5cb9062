//! Writes pictures as they are made, on a thread of their own.

use std::io;
use std::sync::mpsc::Receiver;

use anyhow::{Context, Result};

use super::names::numbered;
use super::target::{Movie, Target};
use super::{apng, gif, video, y4m};
use crate::interrupt;
use crate::output::{name_all, unnamed_with};
use crate::picture::Outputs;
use pinhole::annotate::Annotations;
use pinhole::image::Image;
use pinhole::image::encoding::Encoding;
use pinhole::write::png;

/// The message if the program is stopped when some frames are complete.
pub(super) const STOPPED_BETWEEN: &str =
    "stopped; the frames that were written are complete, and --resume goes on after them";

/// What is sent to the thread that writes.
pub(super) enum Message {
    Picture {
        number: usize,
        image: Box<Image>,
    },
    /// There are no more pictures. Without it, a movie is not complete.
    End,
}

/// How the pictures are written.
pub(super) struct Sink<'a> {
    pub(super) target: &'a Target,
    pub(super) outputs: &'a Outputs,
    pub(super) encoding: &'a Encoding,
    pub(super) annotations: &'a Annotations,
    pub(super) adapter: Option<&'a str>,
    pub(super) frames_per_second: u32,
    /// How many pictures there will be.
    pub(super) count: usize,
    pub(super) size: [u32; 2],
}

/// The samples of the pictures of a movie, one after the other.
pub(super) struct Samples<'a> {
    pictures: &'a Receiver<Message>,
    sink: &'a Sink<'a>,
}

impl Samples<'_> {
    /// Returns the samples of the next picture; `None` after the last. An error means that the movie is not complete.
    pub(super) fn next(&self) -> io::Result<Option<Vec<u8>>> {
        match self.pictures.recv() {
            Ok(Message::Picture { image, .. }) => {
                let Sink { encoding, annotations, .. } = self.sink;
                let samples = png::samples_annotated(&image, encoding, annotations);
                samples.map(Some).map_err(io::Error::other)
            }
            Ok(Message::End) => Ok(None),
            Err(_) => Err(io::Error::other("not all pictures were rendered")),
        }
    }
}

impl Sink<'_> {
    /// Writes all pictures that are received.
    pub(super) fn write(&self, pictures: &Receiver<Message>) -> Result<()> {
        let samples = Samples { pictures, sink: self };
        match self.target {
            Target::Files { .. } => self.write_files(pictures),
            Target::Raw => {
                interrupt::set_message("stopped; the movie on standard output is not complete");
                y4m::write(self, &samples).context("standard output: cannot be written")
            }
            Target::Movie { path, kind } => {
                let file = unnamed_with(path, |file| match kind {
                    Movie::Apng => apng::write(self, &samples, file),
                    Movie::Gif => gif::write(self, &samples, file),
                    Movie::Video(container) => video::write(self, &samples, container, file.path()),
                })?;
                name_all(vec![(path, file)])
            }
        }
    }

    fn write_files(&self, pictures: &Receiver<Message>) -> Result<()> {
        while let Ok(Message::Picture { number, image }) = pictures.recv() {
            let outputs = self.outputs.renamed(|path| numbered(path, number));
            outputs.write(&image, self.encoding, self.adapter, None)?;
            interrupt::set_message(STOPPED_BETWEEN);
        }
        Ok(())
    }
}
