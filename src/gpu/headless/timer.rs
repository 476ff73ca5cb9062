//! Measuring times with the clock of the device.

use std::time::Duration;

use wgpu::{Buffer, CommandEncoder, ComputePassTimestampWrites, Device, QuerySet, Queue};

use crate::gpu::error::GpuError;

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

const STAMPS: u32 = 2;
const BYTES: u64 = STAMPS as u64 * size_of::<u64>() as u64;

/// Measures the time of one compute pass at a time. It needs the feature `TIMESTAMP_QUERY`.
#[derive(Debug)]
pub(in crate::gpu) struct PassTimer {
    queries: QuerySet,
    resolved: Buffer,
    readable: Buffer,
    nanoseconds_per_tick: f32,
}

impl PassTimer {
    /// Creates a timer, or returns `None` if the device cannot measure passes.
    pub(in crate::gpu) fn new(device: &Device, queue: &Queue) -> Option<Self> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |label, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        let usages = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let readable = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        Some(Self {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pinhole timer"),
                ty: wgpu::QueryType::Timestamp,
                count: STAMPS,
            }),
            resolved: buffer("pinhole timer", usages),
            readable: buffer("pinhole timer", readable),
            nanoseconds_per_tick: queue.get_timestamp_period(),
        })
    }

    /// The timestamp writes that the descriptor of the measured pass needs.
    pub(in crate::gpu) fn writes(&self) -> ComputePassTimestampWrites<'_> {
        ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    /// Records, after the pass, the copy of the timestamps to the buffer that the host reads.
    pub(in crate::gpu) fn record_copy(&self, encoder: &mut CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..STAMPS, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, BYTES);
    }

    pub(in crate::gpu) fn buffer(&self) -> &Buffer {
        &self.readable
    }

    /// Returns the time that the pass took, and unmaps the buffer, which must be mapped.
    pub(in crate::gpu) fn read(&self) -> Result<Duration, GpuError> {
        let bytes = self
            .readable
            .get_mapped_range(..)
            .map_err(|error| GpuError::Device { message: error.to_string() })?;
        let [start, end]: [u64; STAMPS as usize] = bytemuck::pod_read_unaligned(&bytes);
        drop(bytes);
        self.readable.unmap();
        let nanoseconds = end.saturating_sub(start) as f64 * f64::from(self.nanoseconds_per_tick);
        Ok(Duration::from_nanos(nanoseconds as u64))
    }
}
