//! Where the time of a render goes: spans of the host's phases and of the device's passes.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};
use std::time::Duration;

use crate::gpu::headless::waiting::Instant;

/// Maximum number of spans that are kept one by one. They take 40 MiB; totals count all of them.
const MAX_SPANS: usize = 1 << 20;

/// A record of where time goes, which a [`Headless`](crate::gpu::Headless) fills in that was opened with it
/// ([`HeadlessOptions::profile`](crate::gpu::HeadlessOptions::profile)). Clones share one record, and its time begins
/// when it is created.
///
/// A device fills in the passes that render, denoise and recolour, and the phases of the host around them. The caller
/// adds phases of its own with [`Profile::phase`]. Pictures do not depend on it.
#[derive(Clone, Debug)]
pub struct Profile {
    start: Instant,
    clock: PassClock,
    shared: Arc<Mutex<Shared>>,
}

/// The clock that measures the passes of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum PassClock {
    /// The device's clock, unless the device has none or is a software device, whose timestamps do not measure the
    /// work.
    #[default]
    Automatic,
    /// The device's clock where it has one. Submissions are as large as without a profile.
    Device,
    /// The host's clock. Every pass is submitted by itself, so that the time of its submission is that of the pass. This
    /// takes longer than without a profile.
    Host,
}

/// Where a span of time was spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ProfileTrack {
    /// A thread of the host. Threads are numbered in the order of their first phases, and 0 is the thread that created
    /// the profile.
    Host(u32),
    /// The device.
    Device,
}

/// A span of time: one phase of the host, or one pass of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ProfileSpan {
    /// Name of the phase or pass. A pass has the name of its shader's entry point.
    pub name: &'static str,
    /// Where the time was spent.
    pub track: ProfileTrack,
    /// The start of the span, counted from the creation of the profile.
    pub start: Duration,
    /// The length of the span.
    pub duration: Duration,
}

/// The time of all spans of one name on one track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ProfileTotal {
    /// Name of the phases or passes.
    pub name: &'static str,
    /// Where the time was spent.
    pub track: ProfileTrack,
    /// Number of spans.
    pub calls: u64,
    /// The sum of their lengths, without the phases within them.
    pub own: Duration,
}

/// What clones of a profile share.
#[derive(Debug, Default)]
struct Shared {
    spans: Vec<ProfileSpan>,
    dropped: u64,
    totals: Vec<ProfileTotal>,
    /// The numbers of the threads.
    threads: HashMap<ThreadId, u32>,
    /// The phases of each thread that have begun, the outer first.
    open: HashMap<ThreadId, Vec<Open>>,
    phases: u64,
    /// The clock that measures passes, once a device was opened.
    clock: Option<PassClock>,
    /// The nanoseconds that are added to those of the device's clock to get those of the host's.
    offset: Option<i128>,
}

/// A phase that has begun.
#[derive(Debug)]
struct Open {
    number: u64,
    /// The time of the phases within it.
    inner: Duration,
}

/// A phase of the host that ends when this is dropped.
#[derive(Debug)]
#[must_use = "the phase ends when this is dropped"]
pub struct ProfilePhase {
    profile: Profile,
    name: &'static str,
    thread: ThreadId,
    number: u64,
    began: Instant,
}

impl Default for Profile {
    fn default() -> Self {
        Self::new(PassClock::Automatic)
    }
}

/// Two profiles are equal if they are the same record.
impl PartialEq for Profile {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shared, &other.shared)
    }
}

impl Profile {
    /// Creates an empty profile, whose time begins now.
    #[must_use]
    pub fn new(clock: PassClock) -> Self {
        let mut shared = Shared::default();
        shared.threads.insert(thread::current().id(), 0);
        Self { start: Instant::now(), clock, shared: Arc::new(Mutex::new(shared)) }
    }

    /// Begins a phase of the host on this thread, which ends when the returned value is dropped. A phase may contain
    /// others.
    pub fn phase(&self, name: &'static str) -> ProfilePhase {
        let thread = thread::current().id();
        let mut shared = self.shared();
        shared.phases += 1;
        let number = shared.phases;
        shared.open.entry(thread).or_default().push(Open { number, inner: Duration::ZERO });
        drop(shared);
        ProfilePhase { profile: self.clone(), name, thread, number, began: Instant::now() }
    }

    /// Returns the time since the creation of the profile.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// Returns all spans that have ended, in the order in which they ended. Of very many, only the first 2²⁰ are kept;
    /// [`Profile::dropped`] is the number of the others.
    #[must_use]
    pub fn spans(&self) -> Vec<ProfileSpan> {
        let shared = self.shared();
        let offset = shared.offset.unwrap_or(0);
        let placed = |span: &ProfileSpan| match (span.track, shared.clock) {
            (ProfileTrack::Device, Some(PassClock::Device)) => {
                let start = span.start.as_nanos() as i128 + offset;
                ProfileSpan { start: Duration::from_nanos(start.max(0) as u64), ..*span }
            }
            _ => *span,
        };
        shared.spans.iter().map(placed).collect()
    }

    /// Returns the number of spans that [`Profile::spans`] lacks.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.shared().dropped
    }

    /// Returns the totals of all spans by track and name, in the order in which the first of each ended.
    #[must_use]
    pub fn totals(&self) -> Vec<ProfileTotal> {
        self.shared().totals.clone()
    }

    /// Returns the clock that measures passes: that of the device, or that of the host. It is `None` before a device was
    /// opened.
    #[must_use]
    pub fn clock(&self) -> Option<PassClock> {
        self.shared().clock
    }

    /// The clock that was asked for.
    pub(in crate::gpu) fn wanted_clock(&self) -> PassClock {
        self.clock
    }

    /// Notes the clock that measures passes.
    pub(in crate::gpu) fn set_clock(&self, clock: PassClock) {
        self.shared().clock = Some(clock);
    }

    /// Adds a pass whose submission the host saw from one time to another.
    pub(in crate::gpu) fn add_submission(&self, name: &'static str, from: Instant, to: Instant) {
        let start = from.saturating_duration_since(self.start);
        let duration = to.saturating_duration_since(from);
        let track = ProfileTrack::Device;
        self.shared().add(ProfileSpan { name, track, start, duration }, duration);
    }

    /// Adds the passes of a submission, each with its first and last nanosecond by the device's clock.
    ///
    /// The device's clock has another zero than the host's. No pass can have begun before the host submitted it, so the
    /// difference of the clocks is at least that of any submission and its first pass. The largest of these is taken.
    pub(in crate::gpu) fn add_passes(
        &self,
        submitted: Instant,
        passes: impl Iterator<Item = (&'static str, [u64; 2])>,
    ) {
        let submitted = submitted.saturating_duration_since(self.start).as_nanos() as i128;
        let mut shared = self.shared();
        for (index, (name, [begin, end])) in passes.enumerate() {
            if index == 0 {
                let least = submitted - i128::from(begin);
                shared.offset = Some(shared.offset.map_or(least, |offset| offset.max(least)));
            }
            let (start, track) = (Duration::from_nanos(begin), ProfileTrack::Device);
            let duration = Duration::from_nanos(end.saturating_sub(begin));
            shared.add(ProfileSpan { name, track, start, duration }, duration);
        }
    }

    fn shared(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Shared {
    /// Adds a span, of which `own` is the time without the phases within it.
    fn add(&mut self, span: ProfileSpan, own: Duration) {
        let ProfileSpan { name, track, .. } = span;
        match self.totals.iter_mut().find(|total| (total.name, total.track) == (name, track)) {
            Some(total) => {
                total.calls += 1;
                total.own += own;
            }
            None => self.totals.push(ProfileTotal { name, track, calls: 1, own }),
        }
        if self.spans.len() < MAX_SPANS {
            self.spans.push(span);
        } else {
            self.dropped += 1;
        }
    }
}

impl Drop for ProfilePhase {
    fn drop(&mut self) {
        let duration = self.began.elapsed();
        let start = self.began.saturating_duration_since(self.profile.start);
        let mut shared = self.profile.shared();
        let next = shared.threads.len() as u32;
        let track = ProfileTrack::Host(*shared.threads.entry(self.thread).or_insert(next));
        let open = shared.open.entry(self.thread).or_default();
        let mut inner = Duration::ZERO;
        // Futures of one thread that take turns may end their phases in another order than that of a stack.
        if let Some(place) = open.iter().position(|open| open.number == self.number) {
            inner = open.remove(place).inner;
            if let Some(outer) = place.checked_sub(1).and_then(|outer| open.get_mut(outer)) {
                outer.inner += duration;
            }
        }
        let span = ProfileSpan { name: self.name, track, start, duration };
        shared.add(span, duration.saturating_sub(inner));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outer_phase_counts_without_its_inner_ones() {
        let profile = Profile::default();
        {
            let _outer = profile.phase("outer");
            for _ in 0..2 {
                let _inner = profile.phase("inner");
                thread::sleep(Duration::from_millis(2));
            }
        }
        let spans = profile.spans();
        assert_eq!(
            spans.iter().map(|span| span.name).collect::<Vec<_>>(),
            ["inner", "inner", "outer"]
        );
        assert!(spans[0].start >= spans[2].start);
        let [inner, outer] = profile.totals()[..] else { panic!("two names") };
        assert_eq!((inner.calls, outer.calls), (2, 1));
        assert_eq!(inner.own, spans[0].duration + spans[1].duration);
        assert_eq!(outer.own, spans[2].duration - inner.own);
    }

    #[test]
    fn threads_are_numbered_from_that_of_the_profile() {
        let profile = Profile::default();
        thread::scope(|scope| {
            scope.spawn(|| drop(profile.phase("beside")));
        });
        drop(profile.phase("here"));
        let tracks: Vec<_> = profile.spans().iter().map(|span| span.track).collect();
        assert_eq!(tracks, [ProfileTrack::Host(1), ProfileTrack::Host(0)]);
    }

    /// The second submission shows that the first began later than it was submitted.
    #[test]
    fn the_clocks_differ_so_that_no_pass_begins_before_its_submission() {
        let profile = Profile::new(PassClock::Device);
        profile.set_clock(PassClock::Device);
        let at = |nanoseconds| profile.start + Duration::from_nanos(nanoseconds);
        profile.add_passes(at(1000), [("first", [500, 600])].into_iter());
        profile
            .add_passes(at(1400), [("second", [800, 1000]), ("third", [1000, 1100])].into_iter());
        let starts: Vec<_> = profile.spans().iter().map(|span| span.start.as_nanos()).collect();
        assert_eq!(starts, [1100, 1400, 1600]);
        assert_eq!(profile.totals()[1].own, Duration::from_nanos(200));
    }
}
