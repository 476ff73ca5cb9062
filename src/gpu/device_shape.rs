//! What suits software devices, and what suits GPUs. Pictures do not depend on it.

use wgpu::DeviceType;

/// The order and the amounts of work that suit a type of device.
///
/// Those of software devices were measured with Mesa's lavapipe. Those of GPUs follow from how GPUs work: no GPU has
/// been measured yet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::gpu) struct DeviceShape {
    /// Whether rows of workgroups are taken in an order that spreads any run of them over the picture. Software devices
    /// give each thread a contiguous run of workgroups, and none should get only background. GPUs give workgroups one by
    /// one to whatever is free, and neighbouring workgroups read the same spheres, which caches keep.
    pub(in crate::gpu) spreads_rows: bool,
    /// Maximum number of pixels of a tile of a picture of primary rays. A tile is submitted, awaited and read back by
    /// itself, while a GPU is idle, so that fewer are better; but the buffers and textures of 2²⁰ pixels take 48 MiB.
    pub(in crate::gpu) max_tile_pixels: u64,
    /// Whether one pass takes whole samples of light paths, where it can. Software devices then neither read nor write the
    /// state of paths, which takes them as long as tracing. On GPUs, invocations whose paths have ended would wait for
    /// others, and such a large kernel leaves room for fewer of them.
    pub(in crate::gpu) paths_in_one_pass: bool,
    /// Maximum number of light paths that are traced at a time. The state of 2¹⁹ paths takes 56 to 80 MiB. A large GPU
    /// runs a quarter of a million invocations together, of which few are left after some surfaces.
    pub(in crate::gpu) max_paths: u64,
    /// Number of workgroups of the first submission, before the device is known to be slow or quick.
    pub(in crate::gpu) first_groups: u64,
    /// Maximum number of intersection tests in a submission, for structures in which every ray tests all spheres. They
    /// take a software device less than half a second, and a small GPU, at ten thousand million tests per second, a
    /// tenth of a second.
    pub(in crate::gpu) max_tests: u64,
}

/// Maximum number of paths where memory is scarce.
const FEW_PATHS: u64 = 1 << 19;

impl DeviceShape {
    /// The order and the amounts for a type of device.
    pub(in crate::gpu) fn of(device_type: DeviceType) -> Self {
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

    /// The same for a picture that a host program records, which needs its memory for other things.
    pub(in crate::gpu) fn of_host(self) -> Self {
        Self { max_paths: FEW_PATHS, ..self }
    }

    /// A GPU that shares the memory of the host, or that nothing is known of. A picture of 1920×1080 is one tile.
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
