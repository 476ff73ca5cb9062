//! The properties of a device that bound pictures and scenes, and the host memory that scenes take on their way to it.

use wgpu::{DeviceType, Limits};

use crate::accel::{AccelPlan, PlannedBuffer};
use crate::gpu::device_shape::DeviceShape;

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
    pub(in crate::gpu) fn shape(&self) -> DeviceShape {
        DeviceShape::of(self.device_type)
    }

    /// Number of bytes of host memory that `bytes` on the device occupy.
    pub(in crate::gpu) fn in_host(&self, bytes: u64) -> u64 {
        if self.device_type == DeviceType::Cpu { bytes } else { 0 }
    }

    /// Number of bytes of host memory in use while one of the bricks is built. The device has those before it.
    pub(in crate::gpu) fn building_bytes(
        &self,
        plan: &AccelPlan,
        buffers: &[PlannedBuffer],
    ) -> u64 {
        plan.host_bytes_by_brick(self.in_host(of_one_brick(buffers)), 0)
    }

    /// Number of bytes of host memory in use while one of the bricks is copied, with the copy that is queued.
    pub(in crate::gpu) fn uploading_bytes(
        &self,
        plan: &AccelPlan,
        buffers: &[PlannedBuffer],
    ) -> u64 {
        let queued = of_one_brick(buffers);
        plan.host_bytes_by_brick(self.in_host(queued), queued + self.in_host(queued))
    }
}

/// Number of bytes of the buffers of a brick.
fn of_one_brick(buffers: &[PlannedBuffer]) -> u64 {
    buffers.iter().map(|buffer| buffer.bytes_per_binding).sum()
}
