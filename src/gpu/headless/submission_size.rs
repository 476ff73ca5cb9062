//! The amount of work of one submission, which adapts to the speed of the device.

use std::time::Duration;

use crate::gpu::device_shape::DeviceShape;

/// The time that a submission should take: so long that the wait between two submissions is negligible, and short
/// enough for a watchdog, a progress bar and Ctrl-C.
const TARGET: Duration = Duration::from_millis(60);

/// Number of workgroups of a submission, which adapts from one submission to the next.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct SubmissionSize {
    next: u64,
    max: u64,
}

impl SubmissionSize {
    /// The initial size for rays that each test about `tests_per_ray` spheres.
    pub(in crate::gpu) fn new(tests_per_ray: usize, shape: DeviceShape) -> Self {
        let tests_per_group = 64 * tests_per_ray.max(1) as u64;
        // A list of spheres costs a thousand times as much as a structure. Moreover, its rays cost either nothing or
        // the full amount, so times that were measured in the background do not predict those of other regions.
        let max = (shape.max_tests / tests_per_group).max(1);
        Self { next: shape.first_groups.min(max / 16).max(1), max }
    }

    /// Number of workgroups that the next submission should have.
    pub(in crate::gpu) fn groups(self) -> u64 {
        self.next
    }

    /// Adapts the size to the time that a submission took. A quick submission may have contained background only, so
    /// the size grows by a factor of 8 at most.
    pub(in crate::gpu) fn adapt(&mut self, groups: u64, elapsed: Duration) {
        if groups == 0 {
            return;
        }
        let ratio = TARGET.as_secs_f64() / elapsed.as_secs_f64().max(1e-6);
        let fits = (groups as f64 * ratio.min(8.0)) as u64;
        // A remainder that is smaller than requested and was quick is no reason to submit less.
        let is_remainder = groups < self.next && elapsed < TARGET;
        let next = if is_remainder { fits.max(self.next) } else { fits };
        self.next = next.clamp(1, self.max);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOFTWARE: wgpu::DeviceType = wgpu::DeviceType::Cpu;
    const FIRST: u64 = 2048;

    fn initial(tests_per_ray: usize) -> SubmissionSize {
        SubmissionSize::new(tests_per_ray, DeviceShape::of(SOFTWARE))
    }

    #[test]
    fn a_slow_device_gets_less_and_a_quick_one_more() {
        let mut submission_size = initial(1);
        assert_eq!(submission_size.groups(), FIRST);
        submission_size.adapt(FIRST, Duration::from_millis(600));
        assert_eq!(submission_size.groups(), FIRST / 10);
        submission_size.adapt(FIRST / 10, Duration::from_secs(3600));
        assert_eq!(submission_size.groups(), 1);
        submission_size.adapt(1, Duration::ZERO);
        assert_eq!(submission_size.groups(), 8);
        submission_size.adapt(1000, Duration::from_millis(30));
        assert_eq!(submission_size.groups(), 2000);
    }

    #[test]
    fn a_remainder_reduces_the_size_only_if_it_is_slow() {
        let mut submission_size = initial(1);
        submission_size.adapt(1, Duration::from_millis(1));
        assert_eq!(submission_size.groups(), FIRST);
        submission_size.adapt(FIRST / 2, Duration::from_millis(10));
        assert_eq!(submission_size.groups(), 3 * FIRST);
        submission_size.adapt(FIRST, Duration::from_millis(120));
        assert_eq!(submission_size.groups(), FIRST / 2);
    }

    /// A workgroup of 64 rays that each test 49,152 spheres makes three million tests, which take a hundredth of a
    /// second.
    #[test]
    fn without_a_structure_submissions_are_short() {
        let mut submission_size = initial(3 << 14);
        assert_eq!(submission_size.groups(), 2);
        for _ in 0..10 {
            submission_size.adapt(submission_size.groups(), Duration::ZERO);
        }
        assert_eq!(submission_size.groups(), 42);
    }
}
