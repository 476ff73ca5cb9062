//! Says how many frames are done.

use std::time::{Duration, Instant};

use crate::progress;
use crate::speak::tell;

/// Time between two lines where there is no terminal.
const PAUSE: Duration = Duration::from_secs(20);

/// How many frames are done, and since when.
pub(super) struct Status {
    total: usize,
    done: usize,
    started: Instant,
    said: Instant,
    quiet: bool,
}

impl Status {
    pub(super) fn new(total: usize, quiet: bool) -> Self {
        let now = Instant::now();
        Self { total, done: 0, started: now, said: now, quiet }
    }

    /// Shows that the next frame is at work.
    pub(super) fn show(&mut self) {
        let text = self.text();
        if !progress::frames(text.clone()) && !self.quiet && self.said.elapsed() >= PAUSE {
            self.said = Instant::now();
            tell(text);
        }
    }

    /// Counts a frame as done.
    pub(super) fn count(&mut self) {
        self.done += 1;
    }

    pub(super) fn done(&self) -> usize {
        self.done
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
