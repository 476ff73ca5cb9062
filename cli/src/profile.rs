//! `render --profile`: measures where time goes, prints a table, and writes a trace for viewers of such files.
//!
//! There is one profile for the whole program, so that every part of it can name its phases.

use std::ffi::OsString;
use std::io::{BufWriter, Write};
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::Duration;

use anyhow::Result;
use clap::Args;
use serde::Serialize;

use super::failure::Failure;
use super::input::extension;
use super::output::{self, check_writable, name_all, unnamed_with};
use super::progress;
use super::speak::{tell, tell_all};
use super::table::table;
use pinhole::gpu::{PassClock, Profile, ProfilePhase, ProfileSpan, ProfileTotal, ProfileTrack};

static PROFILING: OnceLock<Profiling> = OnceLock::new();

/// The flag for a profile.
#[derive(Debug, Args)]
pub(super) struct ProfileArgs {
    /// Say at the end where the time went: the phases of the program, and the passes of the device. With a file, also
    /// write every phase and pass to it, as a trace in the format of Chrome, for ui.perfetto.dev
    #[arg(
        long,
        value_name = "FILE.json",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "",
        conflicts_with = "print_scene"
    )]
    profile: Option<OsString>,
}

/// Begins a phase of the program, if a profile was asked for.
pub(super) fn phase(name: &'static str) -> Option<ProfilePhase> {
    PROFILING.get().map(|profiling| profiling.profile.phase(name))
}

/// Returns the profile that a device fills in, if one was asked for.
pub(super) fn of_device() -> Option<Profile> {
    PROFILING.get().map(|profiling| profiling.profile.clone())
}

/// A profile that was asked for, and the file for its trace.
struct Profiling {
    profile: Profile,
    trace: Option<PathBuf>,
}

/// Begins the profile if the flag is given, and checks that the file can be written.
pub(super) fn start(args: &ProfileArgs) -> Result<(), Failure> {
    let Some(file) = &args.profile else { return Ok(()) };
    let trace = (!file.is_empty()).then(|| PathBuf::from(file));
    if let Some(path) = &trace {
        // No other output of `render` has this extension, so none of them can be the same file.
        if extension(path).as_deref() != Some("json") {
            return Err(Failure::usage(format!(
                "{}: a profile is written as .json; change the extension",
                path.display()
            )));
        }
        check_writable(path)?;
    }
    PROFILING.get_or_init(|| Profiling { profile: Profile::default(), trace });
    Ok(())
}

/// Refuses to overwrite an input with the trace.
pub(super) fn check_not_inputs(inputs: &[PathBuf]) -> Result<(), Failure> {
    let trace = PROFILING.get().and_then(|profiling| profiling.trace.as_ref());
    output::check_not_inputs(trace.into_iter(), inputs)
}

/// Writes the trace, if there is a file for it, and prints the table, if a profile was asked for.
pub(super) fn finish() -> Result<()> {
    PROFILING.get().map_or(Ok(()), Profiling::finish)
}

impl Profiling {
    fn finish(&self) -> Result<()> {
        let elapsed = self.profile.elapsed();
        if let Some(path) = &self.trace {
            let events = events(&self.profile.spans());
            let file = unnamed_with(path, |file| {
                let mut sink = BufWriter::new(file);
                serde_json::to_writer(&mut sink, &events)?;
                sink.flush()
            })?;
            name_all(vec![(path, file)])?;
            if self.profile.dropped() > 0 {
                tell(format_args!(
                    "note: {}: the last {} phases and passes are left out, because the file would be very large; the \
                     table counts all",
                    path.display(),
                    self.profile.dropped()
                ));
            }
        }
        progress::clear();
        tell_all(&readable(&self.profile.totals(), self.profile.clock(), elapsed));
        Ok(())
    }
}

/// The name of the row for time of the host in no phase.
const OTHER: &str = "other";

/// The name of the row for time in which no pass ran.
const IDLE: &str = "idle";

/// Formats the totals as a table: the thread that renders, threads beside it, and the device.
fn readable(totals: &[ProfileTotal], clock: Option<PassClock>, elapsed: Duration) -> String {
    let of = |wanted: &dyn Fn(ProfileTrack) -> bool| {
        let mut found: Vec<_> = totals.iter().filter(|total| wanted(total.track)).collect();
        // The sort is stable, so equal times keep their order.
        found.sort_by_key(|total| std::cmp::Reverse(total.own));
        found
    };
    let mut rows: Vec<[String; 4]> = Vec::new();
    let mut add = |name: &str, totals: &[&ProfileTotal], rest: Option<&str>| {
        if totals.is_empty() {
            return;
        }
        rows.push([name.to_owned(), String::new(), String::new(), String::new()]);
        for total in totals {
            rows.push(row(total.name, Some(total.calls), total.own, elapsed));
        }
        if let Some(rest) = rest {
            let named: Duration = totals.iter().map(|total| total.own).sum();
            rows.push(row(rest, None, elapsed.saturating_sub(named), elapsed));
        }
    };
    add("host", &of(&|track| track == ProfileTrack::Host(0)), Some(OTHER));
    let is_beside = |track| matches!(track, ProfileTrack::Host(thread) if thread > 0);
    add("host, other threads", &of(&is_beside), None);
    add("device", &of(&|track| track == ProfileTrack::Device), Some(IDLE));
    let clock = match clock {
        Some(PassClock::Host) => {
            "; passes by the host's clock and each submitted by itself, because this device's timestamps do not measure \
             the work"
        }
        Some(_) => "; passes by the device's clock",
        None => "",
    };
    let heading = ["where the time went", "calls", "ms", "share"];
    format!("profile: {:.3} s{clock}\n{}", elapsed.as_secs_f64(), table(heading, &rows))
}

fn row(name: &str, calls: Option<u64>, time: Duration, elapsed: Duration) -> [String; 4] {
    let share = 100.0 * time.as_secs_f64() / elapsed.as_secs_f64().max(1e-9);
    [
        format!("  {name}"),
        calls.map_or_else(String::new, |calls| calls.to_string()),
        format!("{:.1}", 1e3 * time.as_secs_f64()),
        format!("{share:.1}%"),
    ]
}

/// An event of the Chrome trace event format: a span, or the name of a track.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Event {
    Span {
        name: &'static str,
        cat: &'static str,
        ph: &'static str,
        /// Start and length in microseconds.
        ts: f64,
        dur: f64,
        pid: u32,
        tid: u32,
    },
    Name {
        name: &'static str,
        ph: &'static str,
        pid: u32,
        tid: u32,
        args: NameArguments,
    },
}

#[derive(Debug, Serialize)]
struct NameArguments {
    name: String,
}

/// The number of the process in a trace.
const PROCESS: u32 = 1;

/// The number of a track in a trace: the thread that renders, the device, and other threads of the host.
fn thread_of(track: ProfileTrack) -> u32 {
    match track {
        ProfileTrack::Host(0) => 1,
        ProfileTrack::Host(thread) => 2 + thread,
        _ => 2,
    }
}

/// The events of a trace: the names of the tracks that are used, and the spans by their start.
fn events(spans: &[ProfileSpan]) -> Vec<Event> {
    let mut spans = spans.to_vec();
    spans.sort_by_key(|span| (span.start, std::cmp::Reverse(span.duration)));
    let mut tracks: Vec<_> = spans.iter().map(|span| span.track).collect();
    tracks.sort_by_key(|track| thread_of(*track));
    tracks.dedup();
    let names = tracks.into_iter().map(|track| {
        let name = match track {
            ProfileTrack::Host(0) => "host".to_owned(),
            ProfileTrack::Host(thread) => format!("host, thread {thread}"),
            _ => "device".to_owned(),
        };
        let args = NameArguments { name };
        Event::Name { name: "thread_name", ph: "M", pid: PROCESS, tid: thread_of(track), args }
    });
    let microseconds = |time: Duration| time.as_nanos() as f64 / 1e3;
    let spans = spans.iter().map(|span| Event::Span {
        name: span.name,
        cat: if span.track == ProfileTrack::Device { "device" } else { "host" },
        ph: "X",
        ts: microseconds(span.start),
        dur: microseconds(span.duration),
        pid: PROCESS,
        tid: thread_of(span.track),
    });
    names.chain(spans).collect()
}
