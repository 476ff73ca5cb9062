//! What is written of several pictures, and how.

use std::io;
use std::sync::mpsc::Receiver;

use super::target::Target;
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
    pub(super) pictures: &'a Receiver<Message>,
    pub(super) sink: &'a Sink<'a>,
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
