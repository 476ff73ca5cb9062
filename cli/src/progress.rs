//! What the program is doing, for people: one line on a terminal's standard error, gone at the end.
//!
//! There is one for the whole program, so that whatever is told can move it out of the way.

use std::borrow::Cow;
use std::io::IsTerminal;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// What is shown.
static LINE: Mutex<Line> = Mutex::new(Line { bar: None, total: None, is_closed: false });

struct Line {
    bar: Option<ProgressBar>,
    /// Of a bar; a stage without an end has none.
    total: Option<u64>,
    is_closed: bool,
}

fn line() -> MutexGuard<'static, Line> {
    LINE.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Line {
    fn show(&mut self, bar: ProgressBar, template: &str, total: Option<u64>) -> &ProgressBar {
        if let Some(old) = self.bar.take() {
            old.finish_and_clear();
        }
        // A template that is wrong is no reason to fail.
        let style = ProgressStyle::with_template(template);
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
        self.total = total;
        self.bar.insert(bar)
    }

    /// Whether there is somebody to show it to.
    fn is_seen(&self) -> bool {
        !self.is_closed && std::io::stderr().is_terminal()
    }
}

/// Shows a stage whose end is not known.
pub(super) fn stage(text: impl Into<Cow<'static, str>>) {
    let mut line = line();
    if line.is_seen() {
        let bar = line.show(ProgressBar::new_spinner(), "{spinner} {msg}", None);
        bar.set_message(pinhole::text::one_line(&text.into()));
        bar.enable_steady_tick(Duration::from_millis(100));
    }
}

/// Whether there is somebody to show progress to.
#[cfg(feature = "gpu")]
pub(super) fn is_seen() -> bool {
    line().is_seen()
}

/// Into how many steps a bar is divided.
#[cfg(feature = "gpu")]
const STEPS: u64 = 10_000;

/// Shows how much is traced, from 0 to 1.
#[cfg(feature = "gpu")]
pub(super) fn tracing(part: f64) {
    show_part(part, "tracing [{bar:40}] {percent}%, {eta} left", None);
}

/// Shows how far a lit picture is, from 0 to 1, and what else there is to say.
#[cfg(feature = "gpu")]
pub(super) fn rendering(part: f64, message: String) {
    let template = "rendering [{bar:20}] {percent}%, {eta} left; {wide_msg}";
    show_part(part, template, Some(message));
}

#[cfg(feature = "gpu")]
fn show_part(part: f64, template: &str, message: Option<String>) {
    let mut line = line();
    if !line.is_seen() {
        return;
    }
    if line.total != Some(STEPS) {
        line.show(ProgressBar::new(STEPS), template, Some(STEPS));
    }
    if let Some(bar) = &line.bar {
        if let Some(message) = message {
            bar.set_message(message);
        }
        bar.set_position((part * STEPS as f64) as u64);
    }
}

/// Writes while the line is out of the way.
pub(super) fn beside<T>(write: impl FnOnce() -> T) -> T {
    let bar = line().bar.clone();
    match bar {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

/// Takes the line away.
pub(super) fn clear() {
    let mut line = line();
    line.total = None;
    if let Some(bar) = line.bar.take() {
        bar.finish_and_clear();
    }
}

/// Takes the line away for good.
pub(super) fn close() {
    clear();
    line().is_closed = true;
}
