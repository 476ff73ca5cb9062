//! `render --profile`: measures the time of phases, and prints a table.
//!
//! There is one profile for the whole program, so that all code can name its phases.

use std::sync::OnceLock;
use std::time::Duration;

use clap::Args;

use crate::terminal::progress::{self, tell_all};
use crate::terminal::text::table;
use pinhole::gpu::{Profile, ProfilePhase, ProfileTotal, ProfileTrack};

static PROFILE: OnceLock<Profile> = OnceLock::new();

#[derive(Debug, Args)]
pub(crate) struct ProfileArgs {
    /// Say at the end where the time went: the phases of the program, and the passes of the device. Each pass is submitted
    /// by itself, which takes longer
    #[arg(long, conflicts_with = "print_scene")]
    profile: bool,
}

/// Begins a phase of the program, if a profile was asked for.
pub(crate) fn phase(name: &'static str) -> Option<ProfilePhase> {
    PROFILE.get().map(|profile| profile.phase(name))
}

/// Returns the profile that a device fills in, if one was asked for.
pub(crate) fn of_device() -> Option<Profile> {
    PROFILE.get().cloned()
}

/// Begins the profile if the flag is given.
pub(crate) fn start(args: &ProfileArgs) {
    if args.profile {
        begin();
    }
}

/// Begins the profile, so that it can be read.
pub(crate) fn begin() {
    PROFILE.get_or_init(Profile::default);
}

/// Runs `work`, and returns the time of the phases and passes of each list of names, and how many there were.
pub(crate) fn spent<const N: usize, E>(
    names: [&[&str]; N],
    work: impl FnOnce() -> Result<(), E>,
) -> Result<[(Duration, u64); N], E> {
    let sums = || {
        let totals = PROFILE.get().map(Profile::totals).unwrap_or_default();
        names.map(|names| {
            let named = totals.iter().filter(|total| names.contains(&total.name));
            named.fold((Duration::ZERO, 0), |(own, calls), total| (own + total.own, calls + total.calls))
        })
    };
    let before = sums();
    work()?;
    let mut spent = sums();
    for (after, before) in spent.iter_mut().zip(before) {
        *after = (after.0 - before.0, after.1 - before.1);
    }
    Ok(spent)
}

/// Prints the table, if a profile was asked for.
pub(crate) fn finish() {
    if let Some(profile) = PROFILE.get() {
        let elapsed = profile.elapsed();
        progress::clear();
        tell_all(&readable(&profile.totals(), elapsed));
    }
}

/// Formats the totals as a table: the rendering thread, other threads, and the device.
fn readable(totals: &[ProfileTotal], elapsed: Duration) -> String {
    let mut rows: Vec<[String; 4]> = Vec::new();
    for (title, track) in [
        ("host", ProfileTrack::Host),
        ("host, other threads", ProfileTrack::OtherThreads),
        ("device", ProfileTrack::Device),
    ] {
        let mut found: Vec<_> = totals.iter().filter(|total| total.track == track).collect();
        if found.is_empty() {
            continue;
        }
        // The sort is stable, so equal times keep their order.
        found.sort_by_key(|total| std::cmp::Reverse(total.own));
        rows.push([title.to_owned(), String::new(), String::new(), String::new()]);
        for total in &found {
            rows.push(row(total.name, &total.calls.to_string(), total.own, elapsed));
        }
        if track == ProfileTrack::Host {
            let named = found.iter().map(|total| total.own).sum();
            rows.push(row("other", "", elapsed.saturating_sub(named), elapsed));
        }
    }
    let heading = ["where the time went", "calls", "ms", "share"];
    format!("profile: {:.3} s\n{}", elapsed.as_secs_f64(), table(heading, &rows))
}

fn row(name: &str, calls: &str, time: Duration, elapsed: Duration) -> [String; 4] {
    let share = 100.0 * time.as_secs_f64() / elapsed.as_secs_f64().max(1e-9);
    let milliseconds = 1e3 * time.as_secs_f64();
    [format!("  {name}"), calls.to_owned(), format!("{milliseconds:.1}"), format!("{share:.1}%")]
}
