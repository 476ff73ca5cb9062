//! Where the time of a render goes: phases of the host and passes of the device.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};
use std::time::Duration;

use crate::gpu::headless::waiting::Instant;

/// A record of where time goes, which a [`Headless`](crate::gpu::Headless) fills in that was opened with it
/// ([`HeadlessOptions::profile`](crate::gpu::HeadlessOptions::profile)). Clones share one record, and its time begins
/// when it is created.
///
/// A device fills in the passes that render, denoise and recolour, and the phases of the host around them. The caller
/// adds phases of its own with [`Profile::phase`]. Pictures do not depend on it. All times are by the host's clock: with
/// a profile, every pass is submitted by itself, so that the time of its submission is that of the pass. This takes
/// longer than without a profile.
#[derive(Clone, Debug)]
pub struct Profile {
    start: Instant,
    thread: ThreadId,
    shared: Arc<Mutex<State>>,
}

/// Where time was spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ProfileTrack {
    /// The thread of the host that created the profile.
    Host,
    /// Other threads of the host.
    OtherThreads,
    /// The device.
    Device,
}

/// The time of all phases or passes of one name on one track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ProfileTotal {
    /// Name of the phases or passes. A pass has the name of its shader's entry point.
    pub name: &'static str,
    /// Where the time was spent.
    pub track: ProfileTrack,
    /// How often there was one.
    pub calls: u64,
    /// The sum of their lengths, without the phases within them.
    pub own: Duration,
}

/// What clones of a profile share.
#[derive(Debug, Default)]
struct State {
    totals: Vec<ProfileTotal>,
    /// The phases of each thread that have begun, the outer first.
    open: HashMap<ThreadId, Vec<Open>>,
    phases: u64,
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
    /// Creates an empty profile, whose time begins now.
    fn default() -> Self {
        Self { start: Instant::now(), thread: thread::current().id(), shared: Arc::default() }
    }
}

/// Two profiles are equal if they are the same record.
impl PartialEq for Profile {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shared, &other.shared)
    }
}

impl Profile {
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

    /// Returns the totals by track and name, in the order in which the first of each ended.
    #[must_use]
    pub fn totals(&self) -> Vec<ProfileTotal> {
        self.shared().totals.clone()
    }

    /// Adds a pass, or several of one submission, which took so long.
    pub(crate) fn add_pass(&self, name: &'static str, duration: Duration) {
        self.shared().add(name, ProfileTrack::Device, duration);
    }

    fn shared(&self) -> MutexGuard<'_, State> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn add(&mut self, name: &'static str, track: ProfileTrack, own: Duration) {
        match self.totals.iter_mut().find(|total| (total.name, total.track) == (name, track)) {
            Some(total) => {
                total.calls += 1;
                total.own += own;
            }
            None => self.totals.push(ProfileTotal { name, track, calls: 1, own }),
        }
    }
}

impl Drop for ProfilePhase {
    fn drop(&mut self) {
        let duration = self.began.elapsed();
        let is_first = self.thread == self.profile.thread;
        let track = if is_first { ProfileTrack::Host } else { ProfileTrack::OtherThreads };
        let mut shared = self.profile.shared();
        let open = shared.open.entry(self.thread).or_default();
        let mut inner = Duration::ZERO;
        // Futures of one thread that take turns may end their phases in another order than that of a stack.
        if let Some(place) = open.iter().position(|open| open.number == self.number) {
            inner = open.remove(place).inner;
            if let Some(outer) = place.checked_sub(1).and_then(|outer| open.get_mut(outer)) {
                outer.inner += duration;
            }
        }
        shared.add(self.name, track, duration.saturating_sub(inner));
    }
}

/// The name of the pass of a submission: of its only one, or of the last, before which a short one counts its work.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NotedPass(pub(crate) Option<&'static str>);

impl NotedPass {
    pub(crate) fn note(&mut self, name: &'static str) {
        self.0 = Some(name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outer_phase_counts_without_its_inner_ones() {
        let profile = Profile::default();
        let long = Duration::from_millis(20);
        {
            let _outer = profile.phase("outer");
            for _ in 0..2 {
                let _inner = profile.phase("inner");
                thread::sleep(long);
            }
        }
        thread::scope(|scope| {
            scope.spawn(|| drop(profile.phase("beside")));
        });
        let elapsed = profile.elapsed();
        let [inner, outer, beside] = profile.totals()[..] else { panic!("three names") };
        assert_eq!((inner.calls, outer.calls, beside.calls), (2, 1, 1));
        assert!(inner.own >= 2 * long && inner.own + outer.own <= elapsed);
        let tracks = [ProfileTrack::Host, ProfileTrack::Host, ProfileTrack::OtherThreads];
        assert_eq!([inner.track, outer.track, beside.track], tracks);
    }
}
