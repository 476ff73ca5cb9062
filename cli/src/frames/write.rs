//! Writes pictures as they are made, on a thread of their own.

use std::sync::mpsc::Receiver;

use anyhow::{Context, Result};

use super::names::numbered;
use super::sink::{Message, STOPPED_BETWEEN, Samples, Sink};
use super::target::{Movie, Target};
use super::{apng, gif, video, y4m};
use crate::interrupt;
use crate::output::{name_all, unnamed_with};

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
