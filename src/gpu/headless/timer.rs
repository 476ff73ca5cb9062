//! The device's own clock.

use std::time::Duration;

use wgpu::{Buffer, CommandEncoder, ComputePassTimestampWrites, Device, QuerySet, Queue};

use crate::gpu::error::GpuError;

/// How long tracing took, over all submissions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TraceTime {
    /// From submitting to having waited, by the host's clock.
    pub wall: Duration,
    /// From the first to the last instruction, by the device's clock, if it has one.
    pub device: Option<Duration>,
    /// The longest submission, by the host's clock.
    pub longest: Duration,
    /// How many submissions there were.
    pub submissions: u32,
    /// How many pixels were traced, in whole workgroups, and once for every brick: those in which the scene's box may
    /// be seen.
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

/// Measures one compute pass at a time. Needs the feature `TIMESTAMP_QUERY`.
#[derive(Debug)]
pub(in crate::gpu) struct PassTimer {
    queries: QuerySet,
    resolved: Buffer,
    readable: Buffer,
    nanoseconds_per_tick: f32,
}

impl PassTimer {
    /// `None` if the device has no clock for passes.
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

    /// What the pass needs to be measured.
    pub(in crate::gpu) fn writes(&self) -> ComputePassTimestampWrites<'_> {
        ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    /// Records, behind the pass, the copy to what the host reads.
    pub(in crate::gpu) fn record_copy(&self, encoder: &mut CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..STAMPS, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, BYTES);
    }

    pub(in crate::gpu) fn buffer(&self) -> &Buffer {
        &self.readable
    }

    /// How long the pass took; unmaps the buffer, which must be mapped.
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
