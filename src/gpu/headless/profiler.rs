//! Filling in a profile: the passes of each submission, by the device's clock or by the host's.

use std::sync::{Mutex, PoisonError};

use wgpu::{Device, DeviceType, Features, Queue};

use crate::gpu::error::GpuError;
use crate::gpu::headless::waiting::Instant;
use crate::gpu::passes::pass_times::{PassTimes, Stamps};
use crate::gpu::profile::{PassClock, Profile};

/// A profile, and what a device needs to fill it in.
#[derive(Debug)]
pub(in crate::gpu) struct Profiler {
    pub(in crate::gpu) profile: Profile,
    pub(in crate::gpu) clock: PassClock,
    nanoseconds_per_tick: f64,
    /// Places for timestamps that no submission uses.
    free: Mutex<Vec<Stamps>>,
    /// The first tick that was read, from which others are counted, so that few digits are lost.
    first_tick: Mutex<Option<u64>>,
}

impl Profiler {
    pub(in crate::gpu) fn new(profile: Profile, device: &Device, queue: &Queue) -> Self {
        let has_clock = device.features().contains(Features::TIMESTAMP_QUERY);
        let is_software = device.adapter_info().device_type == DeviceType::Cpu;
        let clock = match profile.wanted_clock() {
            PassClock::Automatic if has_clock && !is_software => PassClock::Device,
            PassClock::Device if has_clock => PassClock::Device,
            _ => PassClock::Host,
        };
        profile.set_clock(clock);
        Self {
            profile,
            clock,
            nanoseconds_per_tick: Stamps::nanoseconds_per_tick(queue),
            free: Mutex::default(),
            first_tick: Mutex::default(),
        }
    }

    /// The place for timestamps of a submission, if the device measures its passes.
    pub(in crate::gpu) fn stamps(&self, device: &Device) -> Option<Stamps> {
        if self.clock != PassClock::Device {
            return None;
        }
        let free = self.free.lock().unwrap_or_else(PoisonError::into_inner).pop();
        Some(free.unwrap_or_else(|| Stamps::new(device)))
    }

    /// Adds the passes of a submission that has finished, whose timestamps are mapped. The device may have begun with it
    /// at `began`.
    pub(in crate::gpu) fn add(
        &self,
        times: PassTimes,
        submitted: Instant,
        began: Instant,
    ) -> Result<(), GpuError> {
        if self.clock == PassClock::Device {
            let ticks = times.ticks()?;
            let mut first_tick = self.first_tick.lock().unwrap_or_else(PoisonError::into_inner);
            let first = ticks.first().map(|[begin, _]| *first_tick.get_or_insert(*begin));
            let nanoseconds = |tick: u64| {
                (tick.saturating_sub(first.unwrap_or(0)) as f64 * self.nanoseconds_per_tick) as u64
            };
            let spans = ticks.iter().map(|ticks| ticks.map(nanoseconds));
            self.profile.add_passes(submitted, times.names().iter().copied().zip(spans));
        } else if let Some(first) = times.names().first() {
            let is_one = times.names().iter().all(|name| name == first);
            let name = if is_one { first } else { "several passes" };
            self.profile.add_submission(name, began, Instant::now());
        }
        if let Some(stamps) = times.into_stamps() {
            self.free.lock().unwrap_or_else(PoisonError::into_inner).push(stamps);
        }
        Ok(())
    }
}
