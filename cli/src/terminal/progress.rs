//! Output on the terminal: lines, results, and the progress of the work.

use std::borrow::Cow;
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use anyhow::Context;
use indicatif::{ProgressBar, ProgressStyle};

use pinhole::internals::text::whole_line;

/// Shows a stage whose length is not known.
pub(crate) fn stage(text: impl Into<Cow<'static, str>>) {
    let mut line = line();
    if line.is_seen() && line.frames.is_none() {
        let bar = line.show(ProgressBar::new_spinner(), "{spinner} {wide_msg}", None);
        bar.set_message(whole_line(&text.into()));
        bar.enable_steady_tick(Duration::from_millis(100));
    }
}

/// Shows the progress of many pictures, which replaces that of single pictures from now on.
pub(crate) fn frames(text: String) {
    let mut line = line();
    let is_first = line.frames.replace(text.clone()).is_none();
    if line.is_seen() {
        if is_first {
            let bar = line.show(ProgressBar::new_spinner(), "{spinner} {msg}", None);
            bar.enable_steady_tick(Duration::from_millis(100));
        }
        if let Some(bar) = &line.bar {
            bar.set_message(text);
        }
    }
}

/// Whether progress is shown, which needs a terminal.
pub(crate) fn is_seen() -> bool {
    line().is_seen()
}

/// Number of steps of a bar.
const STEPS: u64 = 10_000;

/// Shows the fraction of the picture that is traced, from 0 to 1.
pub(crate) fn tracing(part: f64) {
    show_part(part, "tracing [{wide_bar}] {percent}%, {eta} left", None);
}

/// Shows the fraction of a lit picture that is done, from 0 to 1, with a message.
pub(crate) fn rendering(part: f64, message: String) {
    let template = "rendering {percent}%, {eta} left; {wide_msg}";
    show_part(part, template, Some(message));
}

fn show_part(part: f64, template: &str, message: Option<String>) {
    let mut line = line();
    if line.is_closed || (line.is_seen() && line.frames.is_some()) {
        return;
    }
    if !line.is_seen() {
        let now = Instant::now();
        let frames = line.frames.clone();
        let plain = line.plain.get_or_insert_with(|| Plain::new(now));
        let due = plain.line(now, part, message.as_deref());
        let of_frame = |frames| format!("{frames}; {:.0}% of this frame", 100.0 * part);
        let due = due.map(|due| frames.map_or(due, of_frame));
        // `tell` needs the lock.
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

pub(crate) fn clear() {
    let mut line = line();
    (line.total, line.plain) = (None, None);
    if let Some(bar) = line.bar.take() {
        bar.finish_and_clear();
    }
}

/// Removes the line, and stops showing progress.
pub(crate) fn close() {
    clear();
    line().is_closed = true;
}

static LINE: Mutex<Line> = Mutex::new(Line { bar: None, total: None, frames: None, is_closed: false, plain: None });

/// The time between two lines if standard error is not a terminal.
const PLAIN: Duration = Duration::from_secs(10);

/// The contents of the line.
pub(crate) struct Line {
    pub(crate) bar: Option<ProgressBar>,
    /// Number of steps of a bar; `None` for a stage whose length is not known.
    pub(crate) total: Option<u64>,
    /// The progress of all frames, which is shown instead of that of one picture.
    pub(crate) frames: Option<String>,
    pub(crate) is_closed: bool,
    /// The state of the lines without a terminal, since the first part of a picture.
    pub(crate) plain: Option<Plain>,
}

/// The times at which lines are due if standard error is not a terminal.
pub(crate) struct Plain {
    start: Instant,
    next: Instant,
}

impl Plain {
    pub(crate) fn new(now: Instant) -> Self {
        Self { start: now, next: now + PLAIN }
    }

    /// Returns the line about the progress of a picture, if one is due.
    pub(crate) fn line(&mut self, now: Instant, part: f64, message: Option<&str>) -> Option<String> {
        if now < self.next {
            return None;
        }
        self.next = now + PLAIN;
        let (percent, seconds) = (100.0 * part, now.duration_since(self.start).as_secs_f64());
        let message = message.map_or(String::new(), |message| format!("; {message}"));
        Some(format!("rendering: {percent:.0}% after {seconds:.0} s{message}"))
    }
}

/// Locks the line, so that no other thread changes it meanwhile.
pub(crate) fn line() -> MutexGuard<'static, Line> {
    LINE.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Line {
    /// Shows another bar in place of the current one.
    pub(crate) fn show(&mut self, bar: ProgressBar, template: &str, total: Option<u64>) -> &ProgressBar {
        if let Some(old) = self.bar.take() {
            old.finish_and_clear();
        }
        // A wrong template should not make the program fail.
        let style = ProgressStyle::with_template(template);
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
        self.total = total;
        self.bar.insert(bar)
    }

    /// Whether the line is shown, which needs a terminal.
    pub(crate) fn is_seen(&self) -> bool {
        !self.is_closed && std::io::stderr().is_terminal()
    }
}

/// Runs `write` while the line is hidden.
pub(crate) fn while_hidden<T>(write: impl FnOnce() -> T) -> T {
    let bar = line().bar.clone();
    match bar {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

/// Prints one line on standard error, with control characters escaped.
pub(crate) fn tell(line: impl fmt::Display) {
    let line = whole_line(&line.to_string());
    while_hidden(|| {
        let _ = writeln!(io::stderr().lock(), "{line}");
    });
}

/// Prints a text of several lines on standard error.
pub(crate) fn tell_all(text: &str) {
    let _ = write!(io::stderr().lock(), "{text}");
}

/// Returns a function that prints notes on standard error, or nothing if `quiet`.
pub(crate) fn notes(quiet: bool) -> impl Fn(&dyn fmt::Display) + Copy {
    move |note: &dyn fmt::Display| {
        if !quiet {
            tell(format_args!("note: {note}"));
        }
    }
}

/// Writes the result to standard output.
pub(crate) fn answer(bytes: &[u8]) -> anyhow::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        // The reader has closed the pipe because it needs no more.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.context("standard output: cannot be written"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_terminal_a_line_comes_every_ten_seconds() {
        let start = Instant::now();
        let after = |seconds| start + Duration::from_secs(seconds);
        let mut plain = Plain::new(start);
        let lines: Vec<_> =
            (0..35).filter_map(|second| plain.line(after(second), second as f64 / 40.0, Some("more"))).collect();
        let wanted = [(25, 10), (50, 20), (75, 30)];
        let wanted = wanted.map(|(part, time)| format!("rendering: {part}% after {time} s; more"));
        assert_eq!(lines, wanted);
        assert_eq!(plain.line(after(41), 1.0, None).unwrap(), "rendering: 100% after 41 s");
    }
}
