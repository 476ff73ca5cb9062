//! Shows the progress of the program on one line of standard error, if that is a terminal. The line fits the terminal,
//! and is removed at the end. Where standard error is no terminal, a long render writes a line now and then.

use std::borrow::Cow;
use std::time::{Duration, Instant};

use indicatif::ProgressBar;

use super::progress_line::{Plain, line};
use super::speak::tell;

/// Shows a stage whose length is not known.
pub(super) fn stage(text: impl Into<Cow<'static, str>>) {
    let mut line = line();
    if line.is_seen() && !line.is_held {
        let bar = line.show(ProgressBar::new_spinner(), "{spinner} {wide_msg}", None);
        bar.set_message(pinhole::internals::text::one_line(&text.into()));
        bar.enable_steady_tick(Duration::from_millis(100));
    }
}

/// Shows the progress of many pictures, in place of that of each of them from now on. Returns whether it is shown, which
/// needs a terminal.
pub(super) fn frames(text: String) -> bool {
    let mut line = line();
    let is_seen = line.is_seen();
    if is_seen {
        if !line.is_held {
            line.is_held = true;
            let bar = line.show(ProgressBar::new_spinner(), "{spinner} {msg}", None);
            bar.enable_steady_tick(Duration::from_millis(100));
        }
        if let Some(bar) = &line.bar {
            bar.set_message(text);
        }
    }
    is_seen
}

/// Whether progress is shown, which needs a terminal.
pub(super) fn is_seen() -> bool {
    line().is_seen()
}

/// Number of steps of a bar.
const STEPS: u64 = 10_000;

/// Shows the fraction of the picture that is traced, from 0 to 1.
pub(super) fn tracing(part: f64) {
    show_part(part, "tracing [{wide_bar}] {percent}%, {eta} left", None);
}

/// Shows the fraction of a lit picture that is done, from 0 to 1, with a message.
pub(super) fn rendering(part: f64, message: String) {
    let template = "rendering {percent}%, {eta} left; {wide_msg}";
    show_part(part, template, Some(message));
}

fn show_part(part: f64, template: &str, message: Option<String>) {
    let mut line = line();
    if line.is_closed || line.is_held {
        return;
    }
    if !line.is_seen() {
        let now = Instant::now();
        let plain = line.plain.get_or_insert_with(|| Plain::new(now));
        let due = plain.line(now, part, message.as_deref());
        // To tell it needs the lock.
        drop(line);
        due.iter().for_each(tell);
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

/// Removes the line.
pub(super) fn clear() {
    let mut line = line();
    (line.total, line.plain) = (None, None);
    if let Some(bar) = line.bar.take() {
        bar.finish_and_clear();
    }
}

/// Removes the line, and shows no more progress.
pub(super) fn close() {
    clear();
    line().is_closed = true;
}
