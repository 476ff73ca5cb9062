//! What is noted of the passes of a submission: their names, for a profile, and when each began and ended by the device's
//! clock, for measurements of tracing.

use wgpu::{
    Buffer, BufferUsages, CommandEncoder, ComputePassTimestampWrites, Device, QuerySet, Queue,
};

use crate::gpu::error::GpuError;

/// Number of timestamps of a submission, two for each pass. It is the most that WebGPU allows.
const STAMPS: u32 = 4096;

/// The passes of a submission. By default nothing is noted.
#[derive(Debug, Default)]
pub(in crate::gpu) struct PassTimes {
    is_on: bool,
    names: Vec<&'static str>,
    stamps: Option<Stamps>,
}

/// Where a device writes timestamps, and from where the host reads them. It needs the feature `TIMESTAMP_QUERY`.
#[derive(Debug)]
pub(in crate::gpu) struct Stamps {
    queries: QuerySet,
    resolved: Buffer,
    readable: Buffer,
}

impl PassTimes {
    /// Notes the passes of a submission, with their timestamps if there is a place for them.
    pub(in crate::gpu) fn new(stamps: Option<Stamps>) -> Self {
        Self { is_on: true, names: Vec::new(), stamps }
    }

    /// The timestamp writes for the descriptor of the next pass, which has this name.
    pub(in crate::gpu) fn writes(
        &mut self,
        name: &'static str,
    ) -> Option<ComputePassTimestampWrites<'_>> {
        let first = 2 * self.names.len() as u32;
        if !self.is_on || first + 2 > STAMPS {
            return None;
        }
        self.names.push(name);
        self.stamps.as_ref().map(|stamps| ComputePassTimestampWrites {
            query_set: &stamps.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// The names of the passes, in order.
    pub(in crate::gpu) fn names(&self) -> &[&'static str] {
        &self.names
    }

    /// Records, after the passes, the copy of their timestamps to the buffer that the host reads.
    pub(in crate::gpu) fn record_copy(&self, encoder: &mut CommandEncoder) {
        if let Some((stamps, bytes)) = self.stamped() {
            encoder.resolve_query_set(&stamps.queries, 0..(bytes / 8) as u32, &stamps.resolved, 0);
            encoder.copy_buffer_to_buffer(&stamps.resolved, 0, &stamps.readable, 0, bytes);
        }
    }

    /// The buffer that must be mapped before the timestamps are read.
    pub(in crate::gpu) fn buffer(&self) -> Option<&Buffer> {
        self.stamped().map(|(stamps, _)| &stamps.readable)
    }

    /// The first and last tick of each pass, if the device measures them. The buffer must be mapped; it is unmapped.
    pub(in crate::gpu) fn ticks(&self) -> Result<Vec<[u64; 2]>, GpuError> {
        let Some((stamps, _)) = self.stamped() else {
            return Ok(Vec::new());
        };
        let bytes = stamps
            .readable
            .get_mapped_range(..)
            .map_err(|error| GpuError::Device { message: error.to_string() })?;
        let pairs = bytes.chunks_exact(16).take(self.names.len());
        let ticks = pairs.map(bytemuck::pod_read_unaligned).collect();
        drop(bytes);
        stamps.readable.unmap();
        Ok(ticks)
    }

    /// Returns the place for timestamps, for the next submission.
    pub(in crate::gpu) fn into_stamps(self) -> Option<Stamps> {
        self.stamps
    }

    /// The place for timestamps, and the number of bytes that were written there, if there are any.
    fn stamped(&self) -> Option<(&Stamps, u64)> {
        let stamps = self.stamps.as_ref().filter(|_| !self.names.is_empty())?;
        Some((stamps, 16 * self.names.len() as u64))
    }
}

impl Stamps {
    pub(in crate::gpu) fn new(device: &Device) -> Self {
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("pinhole pass times"),
                size: u64::from(STAMPS) * 8,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pinhole pass times"),
                ty: wgpu::QueryType::Timestamp,
                count: STAMPS,
            }),
            resolved: buffer(BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            readable: buffer(BufferUsages::COPY_DST | BufferUsages::MAP_READ),
        }
    }

    /// The length of a tick in nanoseconds.
    pub(in crate::gpu) fn nanoseconds_per_tick(queue: &Queue) -> f64 {
        f64::from(queue.get_timestamp_period())
    }
}
