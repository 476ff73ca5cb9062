//! How much work is submitted at once.

use std::time::Duration;

/// What a submission should take: long enough that the waiting between two of them does not count, short
/// enough for a watchdog, a progress bar and Ctrl-C.
const TARGET: Duration = Duration::from_millis(60);

/// How many workgroups the first submission has: some milliseconds of a software device's time.
const FIRST: u64 = 2048;

/// How many spheres a submission tries at most, where every ray tries all: less than half a second of a
/// software device's time.
const MOST_TESTS: u64 = 1 << 27;

/// Adapts to the device, from one submission to the next.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct SubmissionSize {
    next: u64,
    most: u64,
}

impl SubmissionSize {
    /// For rays of which each tries about so many spheres.
    pub(in crate::gpu) fn new(tests_per_ray: usize) -> Self {
        let tests_per_group = 64 * tests_per_ray.max(1) as u64;
        // A list of spheres costs a thousand times what a structure does; and its rays cost nothing or all of
        // it, so that what was learned from sky is no guide.
        let most = (MOST_TESTS / tests_per_group).max(1);
        Self { next: FIRST.min(most / 16).max(1), most }
    }

    /// How many workgroups the next submission should have.
    pub(in crate::gpu) fn groups(self) -> u64 {
        self.next
    }

    /// Takes note of what a submission took. What looks quick may have been sky, so that it grows by steps.
    pub(in crate::gpu) fn took(&mut self, groups: u64, elapsed: Duration) {
        if groups == 0 {
            return;
        }
        let ratio = TARGET.as_secs_f64() / elapsed.as_secs_f64().max(1e-6);
        let fits = (groups as f64 * ratio.min(8.0)) as u64;
        // That a small remainder was quick is no reason to submit less.
        let is_remainder = groups < self.next && elapsed < TARGET;
        let next = if is_remainder { fits.max(self.next) } else { fits };
        self.next = next.clamp(1, self.most);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_device_gets_less_and_a_quick_one_more() {
        let mut submission_size = SubmissionSize::new(1);
        assert_eq!(submission_size.groups(), FIRST);
        submission_size.took(FIRST, Duration::from_millis(600));
        assert_eq!(submission_size.groups(), FIRST / 10);
        submission_size.took(FIRST / 10, Duration::from_secs(3600));
        assert_eq!(submission_size.groups(), 1);
        submission_size.took(1, Duration::ZERO);
        assert_eq!(submission_size.groups(), 8);
        submission_size.took(1000, Duration::from_millis(30));
        assert_eq!(submission_size.groups(), 2000);
    }

    #[test]
    fn a_remainder_slows_nothing_unless_it_is_slow() {
        let mut submission_size = SubmissionSize::new(1);
        submission_size.took(1, Duration::from_millis(1));
        assert_eq!(submission_size.groups(), FIRST);
        submission_size.took(FIRST / 2, Duration::from_millis(10));
        assert_eq!(submission_size.groups(), 3 * FIRST);
        submission_size.took(FIRST, Duration::from_millis(120));
        assert_eq!(submission_size.groups(), FIRST / 2);
    }

    /// 49,152 spheres for each of 64 rays are three million tests, a hundredth of a second.
    #[test]
    fn without_a_structure_submissions_are_short() {
        let mut submission_size = SubmissionSize::new(3 << 14);
        assert_eq!(submission_size.groups(), 2);
        for _ in 0..10 {
            submission_size.took(submission_size.groups(), Duration::ZERO);
        }
        assert_eq!(submission_size.groups(), 42);
    }
}
