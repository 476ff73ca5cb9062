//! Marks beside the parts: which units are being rendered, and which failed and why. They are for people and for
//! `status`; nothing waits for them, and a mark that is wrong changes no picture.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime};

use super::files;
use super::folder::{FAILED, Folder, PARTS, RUNNING};
use super::units;
use crate::deadline::{give_up, say_unlimited};

/// The time after which a mark is written again.
const BEAT: Duration = Duration::from_secs(5);

/// A unit whose mark is older does not run any more.
const STALE: Duration = Duration::from_secs(30);

/// The mark of a unit that is being rendered, which is renewed by a thread of its own. It is removed with this value.
pub(super) struct Mark {
    path: PathBuf,
    /// Ends the thread when it is dropped.
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Mark {
    /// Marks a unit. If it is not dropped within the limit, the program ends with the exit code for devices that do not
    /// answer, because a driver that hangs cannot be stopped in any other way.
    pub(super) fn new(folder: &Folder, unit: usize, limit: Option<Duration>) -> Self {
        let (path, failed) = (folder.running(unit), folder.failed(unit));
        write(&path);
        let (stop, stopped) = channel();
        let (started, marked) = (Instant::now(), path.clone());
        let thread = std::thread::Builder::new().spawn(move || {
            loop {
                let left = limit.map(|limit| limit.saturating_sub(started.elapsed()));
                match stopped.recv_timeout(left.unwrap_or(BEAT).min(BEAT)) {
                    Err(RecvTimeoutError::Timeout) => {}
                    _ => return,
                }
                if let Some(limit) = limit.filter(|limit| started.elapsed() >= *limit) {
                    let why = format!("unit {unit} did not end within {} s", limit.as_secs_f64());
                    files::mark(&failed, &why);
                    files::unmark(&marked);
                    give_up(&why);
                }
                write(&marked);
            }
        });
        if let (Err(error), Some(_)) = (&thread, limit) {
            say_unlimited(error);
        }
        Self { path, stop: Some(stop), thread: thread.ok() }
    }
}

impl Drop for Mark {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
        files::unmark(&self.path);
    }
}

/// A mark that cannot be written is not an error: a full disk is one when the part is written.
fn write(path: &Path) {
    let host = std::env::var("SLURMD_NODENAME").or_else(|_| std::env::var("HOSTNAME"));
    let host = host.unwrap_or_else(|_| "this machine".to_owned());
    files::mark(path, &format!("process {} of {host}\n", std::process::id()));
}

/// What a process that was killed leaves is removed after this time.
const LEFT: Duration = Duration::from_secs(3600);

/// Removes files that were never given their names, because the processes that wrote them were killed.
pub(super) fn sweep(folder: &Folder) {
    let parts = folder.path().join(PARTS);
    let names = files::names(&parts);
    let unnamed: Vec<_> = names.iter().filter(|name| name.starts_with(".pinhole-")).collect();
    if unnamed.is_empty() {
        return;
    }
    let now = now_there(folder);
    for path in unnamed.into_iter().map(|name| parts.join(name)) {
        let age = files::modified(&path).and_then(|time| now.duration_since(time).ok());
        if age.is_some_and(|age| age > LEFT) {
            files::unmark(&path);
        }
    }
}

/// Says why a unit failed.
pub(super) fn set_failed(folder: &Folder, unit: usize, why: &str) {
    files::mark(&folder.failed(unit), why);
}

/// Says that a unit is done.
pub(super) fn clear_failed(folder: &Folder, unit: usize) {
    files::unmark(&folder.failed(unit));
}

/// The marks of a job.
pub(super) struct Marks {
    /// Units whose marks are fresh.
    pub(super) running: Vec<usize>,
    /// Units that failed, and why.
    pub(super) failed: Vec<(usize, String)>,
}

impl Marks {
    pub(super) fn read(folder: &Folder) -> Self {
        let units = folder.manifest.units;
        let now = now_there(folder);
        let is_fresh = |unit: &usize| {
            let time = files::modified(&folder.running(*unit));
            // A mark that seems to come from the future is one of a moment ago.
            time.is_some_and(|time| now.duration_since(time).unwrap_or_default() < STALE)
        };
        let running = units_in(&folder.path().join(RUNNING), units).into_iter().filter(is_fresh);
        let failed = units_in(&folder.path().join(FAILED), units).into_iter().map(|unit| {
            let why = files::read_text(&folder.failed(unit)).unwrap_or_default();
            (unit, why.chars().take(400).collect())
        });
        Self { running: running.collect(), failed: failed.collect() }
    }
}

/// The time as the file system has it, which may be that of another machine whose clock is different.
fn now_there(folder: &Folder) -> SystemTime {
    let file = tempfile::NamedTempFile::new_in(folder.path().join(RUNNING));
    let time = file.and_then(|file| file.as_file().metadata()).and_then(|file| file.modified());
    time.unwrap_or_else(|_| SystemTime::now())
}

/// The units that files in a folder are named after, in order.
fn units_in(folder: &Path, count: usize) -> Vec<usize> {
    let numbers = files::names(folder).into_iter().filter_map(|name| name.parse::<usize>().ok());
    let mut numbers: Vec<usize> = numbers.filter(|unit| *unit < count).collect();
    numbers.sort_unstable();
    numbers
}

/// The units that failed, for people.
pub(super) fn failures(failed: &[(usize, String)]) -> String {
    // Equal reasons are said once.
    let mut reasons: Vec<(&str, Vec<usize>)> = Vec::new();
    for (unit, why) in failed {
        match reasons.iter_mut().find(|(reason, _)| reason == why) {
            Some((_, units)) => units.push(*unit),
            None => reasons.push((why, vec![*unit])),
        }
    }
    let lines =
        reasons.iter().map(|(why, of)| format!("failed {}: {}\n", units::ranges(of), why.trim()));
    lines.collect()
}
