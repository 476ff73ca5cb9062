//! Saves pictures on a thread, by the code of `pinhole render`.

use std::sync::mpsc::{Receiver, channel};
use std::time::Instant;

use eframe::egui;
use pinhole_cli::viewing::{RenderFlags, ViewError};

/// A picture that is being saved.
pub(crate) struct Saving {
    pub(crate) output: String,
    pub(crate) started: Instant,
    result: Receiver<Result<(), ViewError>>,
}

impl Saving {
    /// Starts to render and write a picture.
    pub(crate) fn start(
        flags: RenderFlags,
        output: String,
        context: egui::Context,
    ) -> std::io::Result<Self> {
        let (sender, result) = channel();
        std::thread::Builder::new().name("saving".to_owned()).spawn({
            let output = output.clone();
            move || {
                let _ = sender.send(flags.save(&output));
                context.request_repaint();
            }
        })?;
        Ok(Self { output, started: Instant::now(), result })
    }

    /// Whether the picture is written, or why not, once that is known.
    pub(crate) fn result(&self) -> Option<Result<(), ViewError>> {
        use std::sync::mpsc::TryRecvError;
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                Some(Err(ViewError::new(format!("{}: saving ended without a result", self.output))))
            }
        }
    }
}
