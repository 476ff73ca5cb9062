//! Limits of a device, and the order and the amounts of work that suit it. Pictures do not depend on them.

use std::time::Duration;

use wgpu::{DeviceType, Limits};

use crate::accel::{AccelPlan, PlannedBuffer};

/// The order and the amounts of work that suit a type of device.
///
/// The values for software devices were measured with Mesa's lavapipe. The values for GPUs follow from how GPUs work:
/// no GPU has been measured yet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DeviceShape {
    /// Whether rows of workgroups are taken in an order that spreads any run of them over the picture. Software devices
    /// give each thread a contiguous run of workgroups, and none should get only background. GPUs give workgroups one by
    /// one to whatever is free, and neighbouring workgroups read the same spheres, which caches keep.
    pub(crate) spreads_rows: bool,
    /// Maximum number of pixels of a tile of a picture of primary rays. A GPU is idle while a tile is awaited and read
    /// back, so fewer tiles are better. However, the buffers and textures of 2²⁰ pixels take 48 MiB.
    pub(crate) max_tile_pixels: u64,
    /// Whether one pass takes whole samples of light paths, where it can. Software devices then neither read nor write the
    /// state of paths, which takes them as long as tracing. On GPUs, invocations whose paths have ended would wait for
    /// others, and such a large kernel leaves room for fewer of them.
    pub(crate) paths_in_one_pass: bool,
    /// Maximum number of light paths that are traced at a time. The state of 2¹⁹ paths takes 56 to 80 MiB. A large GPU
    /// runs a quarter of a million invocations together, of which few are left after some surfaces.
    pub(crate) max_paths: u64,
    /// Number of workgroups of the first submission, before the device is known to be slow or quick.
    pub(crate) first_groups: u64,
    /// Maximum number of intersection tests in a submission, for structures in which every ray tests all spheres. They
    /// take a software device less than half a second, and a small GPU, at ten thousand million tests per second, a
    /// tenth of a second.
    pub(crate) max_tests: u64,
}

/// Maximum number of paths where memory is scarce.
const FEW_PATHS: u64 = 1 << 19;

impl DeviceShape {
    /// Returns the order and the amounts of work for a type of device.
    pub(crate) fn of(device_type: DeviceType) -> Self {
        match device_type {
            DeviceType::Cpu => Self {
                spreads_rows: true,
                max_tile_pixels: 1 << 20,
                paths_in_one_pass: true,
                max_paths: FEW_PATHS,
                first_groups: 2048,
                max_tests: 1 << 27,
            },
            DeviceType::DiscreteGpu | DeviceType::VirtualGpu => {
                Self { max_tile_pixels: 1 << 22, max_paths: 1 << 21, ..Self::of_small_gpu() }
            }
            DeviceType::IntegratedGpu | DeviceType::Other => Self::of_small_gpu(),
        }
    }

    /// This shape with fewer paths, for pictures that a host program records. The host needs memory for other things.
    pub(crate) fn of_host(self) -> Self {
        Self { max_paths: FEW_PATHS, ..self }
    }

    /// The shape for a GPU that shares the memory of the host, or that is unknown. A picture of 1920×1080 is one tile.
    fn of_small_gpu() -> Self {
        Self {
            spreads_rows: false,
            max_tile_pixels: 1 << 21,
            paths_in_one_pass: false,
            max_paths: FEW_PATHS,
            first_groups: 1 << 14,
            max_tests: 1 << 30,
        }
    }
}

/// The properties of a device that bound the size of pictures and scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceLimits {
    /// Limits of the device as wgpu reports them.
    pub limits: Limits,
    /// The type of the device. A software device uses host memory as its own.
    pub device_type: DeviceType,
}

impl DeviceLimits {
    /// The order and the amounts of work that suit the device.
    pub(crate) fn shape(&self) -> DeviceShape {
        DeviceShape::of(self.device_type)
    }

    /// Number of bytes of host memory that `bytes` on the device occupy.
    pub(crate) fn in_host(&self, bytes: u64) -> u64 {
        if self.device_type == DeviceType::Cpu { bytes } else { 0 }
    }

    /// Number of bytes of host memory in use while one of the bricks is built. The device already holds earlier bricks.
    pub(crate) fn building_bytes(&self, plan: &AccelPlan, buffers: &[PlannedBuffer]) -> u64 {
        plan.host_bytes_by_brick(self.in_host(of_one_brick(buffers)), 0)
    }

    /// Number of bytes of host memory in use while one of the bricks is copied, including the queued copy.
    pub(crate) fn uploading_bytes(&self, plan: &AccelPlan, buffers: &[PlannedBuffer]) -> u64 {
        let queued = of_one_brick(buffers);
        plan.host_bytes_by_brick(self.in_host(queued), queued + self.in_host(queued))
    }
}

/// Number of bytes of the buffers of a brick.
fn of_one_brick(buffers: &[PlannedBuffer]) -> u64 {
    buffers.iter().map(|buffer| buffer.bytes_per_binding).sum()
}

/// Target time of a submission: long enough that the wait between two submissions is negligible, and short enough for a
/// watchdog, a progress bar and Ctrl-C.
const TARGET: Duration = Duration::from_millis(60);

/// Number of workgroups of a submission, which adapts from one submission to the next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SubmissionSize {
    next: u64,
    max: u64,
}

impl SubmissionSize {
    /// The initial size for rays that each test about `tests_per_ray` spheres.
    pub(crate) fn new(tests_per_ray: usize, shape: DeviceShape) -> Self {
        let tests_per_group = 64 * tests_per_ray.max(1) as u64;
        // A list of spheres costs a thousand times as much as a structure. Moreover, its rays cost either nothing or
        // the full amount, so times that were measured in the background do not predict those of other regions.
        let max = (shape.max_tests / tests_per_group).max(1);
        Self { next: shape.first_groups.min(max / 16).max(1), max }
    }

    /// Number of workgroups that the next submission should have.
    pub(crate) fn groups(self) -> u64 {
        self.next
    }

    /// Adapts the size to the time that a submission took. A quick submission may have contained background only, so
    /// the size grows by a factor of 8 at most.
    pub(crate) fn adapt(&mut self, groups: u64, elapsed: Duration) {
        if groups == 0 {
            return;
        }
        let ratio = TARGET.as_secs_f64() / elapsed.as_secs_f64().max(1e-6);
        let fits = (groups as f64 * ratio.min(8.0)) as u64;
        // A remainder that is smaller than requested and was quick does not reduce the next size.
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
