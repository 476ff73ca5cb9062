//! The time that tracing takes.

use std::time::Duration;

/// The time that tracing took, summed over all submissions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TraceTime {
    /// Time from submission to the end of the wait, by the host's clock.
    pub wall: Duration,
    /// Time from the start to the end of the compute passes, by the device's clock; `None` if the device has none.
    pub device: Option<Duration>,
    /// Time of the longest submission, by the host's clock.
    pub longest: Duration,
    /// Number of submissions.
    pub submissions: u32,
    /// Number of traced pixels, in whole workgroups, counted once for every brick. Only pixels in which the scene's box
    /// may be visible are traced.
    pub pixels: u64,
}

impl TraceTime {
    pub(in crate::gpu) fn add(&mut self, wall: Duration, device: Option<Duration>) {
        self.wall += wall;
        self.device = device.map(|device| self.device.unwrap_or_default() + device);
        self.longest = self.longest.max(wall);
        self.submissions += 1;
    }
}
