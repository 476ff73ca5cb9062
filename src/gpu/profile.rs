//! A profile of a render: the time of the phases of the host and of the passes of the device.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};
use std::time::Duration;

use crate::gpu::headless::waiting::Instant;

/// A record of where time goes. A [`Headless`](crate::gpu::Headless) that is opened with it
/// ([`HeadlessOptions::profile`](crate::gpu::HeadlessOptions::profile)) fills it in. Clones share one record, whose
/// time begins when it is created.
///
/// A device adds the passes that render, denoise and recolour, and the phases of the host around them. The caller adds
/// other phases with [`Profile::phase`]. Pictures do not depend on the profile. All times are by the host's clock. With
/// a profile, every pass is submitted by itself, so that the time of its submission is the time of the pass. This takes
/// longer than rendering without a profile.
#[derive(Clone, Debug)]
pub struct Profile {
    start: Instant,
    thread: ThreadId,
    shared: Arc<Mutex<State>>,
}

/// A track: a thread or a device that spends time.
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
    /// The track on which the time was spent.
    pub track: ProfileTrack,
    /// Number of phases or passes with this name.
    pub calls: u64,
    /// Sum of their lengths, without the phases within them.
    pub own: Duration,
}

/// The state that clones of a profile share.
#[derive(Debug, Default)]
struct State {
    totals: Vec<ProfileTotal>,
    /// The phases of each thread that have begun, from the outermost to the innermost.
    open: HashMap<ThreadId, Vec<Open>>,
    phases: u64,
}

/// A phase that has begun.
#[derive(Debug)]
struct Open {
    number: u64,
    /// The time of the phases within this phase.
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

    /// Returns the totals by track and name, in the order in which the first phase or pass of each name ended.
    #[must_use]
    pub fn totals(&self) -> Vec<ProfileTotal> {
        self.shared().totals.clone()
    }

    /// Adds a pass, or several passes of one submission, that took `duration`.
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
        // Futures that take turns on one thread may end their phases in another order than a stack would.
        if let Some(place) = open.iter().position(|open| open.number == self.number) {
            inner = open.remove(place).inner;
            if let Some(outer) = place.checked_sub(1).and_then(|outer| open.get_mut(outer)) {
                outer.inner += duration;
            }
        }
        shared.add(self.name, track, duration.saturating_sub(inner));
    }
}

/// The name of a submission in a profile: its last pass. An earlier pass only counts the work of the last.
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
