//! The line of standard error that shows the progress of the program. There is one line for the whole program, so that
//! every message can hide it while it is printed.

use std::io::IsTerminal;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// The progress line of the program.
static LINE: Mutex<Line> =
    Mutex::new(Line { bar: None, total: None, is_held: false, is_closed: false, plain: None });

/// The time between two lines where standard error is no terminal.
const PLAIN: Duration = Duration::from_secs(10);

/// What the line shows, if anything.
pub(super) struct Line {
    pub(super) bar: Option<ProgressBar>,
    /// Number of steps of a bar; `None` for a stage whose length is not known.
    pub(super) total: Option<u64>,
    /// Whether the line shows the progress of all frames, and not that of one picture.
    pub(super) is_held: bool,
    pub(super) is_closed: bool,
    /// The lines without a terminal, since the first part of a picture.
    pub(super) plain: Option<Plain>,
}

/// When lines are due where standard error is no terminal.
pub(super) struct Plain {
    start: Instant,
    next: Instant,
}

impl Plain {
    pub(super) fn new(now: Instant) -> Self {
        Self { start: now, next: now + PLAIN }
    }

    /// The line about a part of the picture, if one is due.
    pub(super) fn line(
        &mut self,
        now: Instant,
        part: f64,
        message: Option<&str>,
    ) -> Option<String> {
        if now < self.next {
            return None;
        }
        self.next = now + PLAIN;
        let (percent, seconds) = (100.0 * part, now.duration_since(self.start).as_secs_f64());
        let message = message.map_or(String::new(), |message| format!("; {message}"));
        Some(format!("rendering: {percent:.0}% after {seconds:.0} s{message}"))
    }
}

/// The line, which nobody else changes meanwhile.
pub(super) fn line() -> MutexGuard<'static, Line> {
    LINE.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Line {
    /// Shows another bar in place of the one that is there.
    pub(super) fn show(
        &mut self,
        bar: ProgressBar,
        template: &str,
        total: Option<u64>,
    ) -> &ProgressBar {
        if let Some(old) = self.bar.take() {
            old.finish_and_clear();
        }
        // A wrong template is not a reason to fail.
        let style = ProgressStyle::with_template(template);
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
        self.total = total;
        self.bar.insert(bar)
    }

    /// Whether the line is shown, which needs a terminal.
    pub(super) fn is_seen(&self) -> bool {
        !self.is_closed && std::io::stderr().is_terminal()
    }
}

/// Runs `write` while the line is hidden.
pub(super) fn while_hidden<T>(write: impl FnOnce() -> T) -> T {
    let bar = line().bar.clone();
    match bar {
        Some(bar) => bar.suspend(write),
        None => write(),
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
        let lines: Vec<_> = (0..35)
            .filter_map(|second| plain.line(after(second), second as f64 / 40.0, Some("more")))
            .collect();
        let wanted = [(25, 10), (50, 20), (75, 30)];
        let wanted = wanted.map(|(part, time)| format!("rendering: {part}% after {time} s; more"));
        assert_eq!(lines, wanted);
        assert_eq!(plain.line(after(41), 1.0, None).unwrap(), "rendering: 100% after 41 s");
    }
}
