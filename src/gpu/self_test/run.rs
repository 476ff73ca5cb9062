//! Running the self-test on a device. Its dispatches are recorded here, and `Headless` submits them.

use bytemuck::{Pod, bytes_of, cast_slice};
use wgpu::{BindGroup, Buffer, BufferUsages, CommandEncoder, ComputePipeline, Device};

use crate::gpu::checks::Checks;
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::passes::frame::iteration_limit;
use crate::gpu::resources::{buffer, numbered_group};
use crate::gpu::self_test::records::{Arithmetic, Exact, Loop, Operands, SelfTest, Values};
use crate::gpu::self_test::report::{SelfTestExtent, SelfTestReport};
use crate::gpu::self_test::{cones, loops, records, rounding};
use crate::gpu::shader::layouts::{layout, storage, uniform};
use crate::gpu::shader::{Kernel, pipeline};
use crate::recording::cone_rays::{ConeAnswer, RayAndCone, rays_and_cones};

/// Number of inputs of each operation, in a quick and in a full test. Both are multiples of the workgroup size.
const QUICK: usize = 512;
const FULL: usize = 1 << 17;

/// Number of rays and cones in a full test.
const CONES: usize = 1 << 16;

const WORKGROUP: u32 = 64;

/// The dispatches of a self-test, with their inputs.
#[derive(Debug)]
pub(crate) struct SelfTestRun {
    operands: Vec<Operands>,
    values: Vec<Values>,
    rays_and_cones: Vec<RayAndCone>,
    limit: u32,
    /// Dispatches of operations that round. In a full test, dispatches of exact operations and of loops follow.
    dispatches: Vec<Dispatch>,
}

impl SelfTestRun {
    pub(crate) async fn new(device: &Device, extent: SelfTestExtent, edits: &Edits) -> Result<Self, GpuError> {
        let (checks, limit) = (Checks::default(), iteration_limit(device));
        let is_full = extent == SelfTestExtent::Full;
        let count = if is_full { FULL } else { QUICK };
        let (operands, values) = (records::operands(count), records::values(count));
        let rays_and_cones = rays_and_cones(if is_full { CONES } else { 0 });
        let once = [SelfTest::default()];
        let kernel = |entry_point| Kernel::new(entry_point, &[]);
        let mut all = dispatches::<_, Arithmetic>(device, &checks, &kernel("arithmetic"), &once, &operands);
        if is_full {
            let exact = dispatches::<_, Exact>(device, &checks, &kernel("exact"), &once, &values);
            let cones =
                dispatches::<_, ConeAnswer>(device, &checks, &kernel("cones").edited(edits)?, &once, &rays_and_cones);
            // Only the number of inputs matters, because the kernel does not read them.
            let inputs = [0_u32; loops::INVOCATIONS as usize];
            let runs = loops::runs(limit);
            let loops = dispatches::<_, Loop>(device, &checks, &kernel("loops"), &runs, &inputs);
            all.extend(exact.into_iter().chain(cones).chain(loops));
        }
        checks.passed().await?;
        Ok(Self { operands, values, rays_and_cones, limit, dispatches: all })
    }

    pub(crate) fn record(&self, encoder: &mut CommandEncoder) {
        self.dispatches.iter().for_each(|dispatch| dispatch.record(encoder));
    }

    /// The buffers that must be mapped before [`SelfTestRun::judge`].
    pub(crate) fn buffers(&self) -> Vec<&Buffer> {
        self.dispatches.iter().map(|dispatch| &dispatch.readable.buffer).collect()
    }

    /// Judges the results of the device.
    pub(crate) fn judge(&self) -> Result<SelfTestReport, GpuError> {
        let mut properties = rounding::judge(&self.operands, &self.dispatches[0].read()?);
        if let [_, exact, cones, loops @ ..] = &self.dispatches[..] {
            properties.extend(rounding::judge_exact(&self.values, &exact.read()?));
            properties.push(cones::judge(&self.rays_and_cones, &cones.read()?));
            let answers = loops.iter().map(Dispatch::read).collect::<Result<Vec<_>, _>>()?;
            properties.push(loops::judge(self.limit, &answers));
        }
        Ok(SelfTestReport::new(properties))
    }
}

/// A dispatch of a kernel, with its pipeline and buffers.
#[derive(Debug)]
struct Dispatch {
    pipeline: ComputePipeline,
    group: BindGroup,
    answers: Buffer,
    readable: ReadableBuffer,
    workgroups: u32,
}

/// Dispatches of a kernel, one for each record, with one invocation for each input. The kernel is built in the same way
/// as kernels of a renderer. Its bind group has the record, and an input and a result for each invocation.
fn dispatches<Input: Pod, Answer: Pod>(
    device: &Device,
    checks: &Checks,
    kernel: &Kernel,
    records: &[SelfTest],
    inputs: &[Input],
) -> Vec<Dispatch> {
    let label = "pinhole self-test";
    let kinds = [uniform::<SelfTest>(), storage::<Input>(true), storage::<Answer>(false)];
    let layout = checks.create(device, || layout(device, label, &kinds));
    let pipeline = pipeline(device, kernel, &[&layout], checks);
    let filled = |bytes: &[u8], usage| {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes.len() as u64,
            usage,
            mapped_at_creation: true,
        });
        // If the buffer could not be created, the enclosing error scope has recorded it.
        if let Ok(mut target) = buffer.get_mapped_range_mut(..) {
            target.copy_from_slice(bytes);
        }
        buffer.unmap();
        buffer
    };
    let dispatch = |record: &SelfTest| {
        let record = filled(bytes_of(record), BufferUsages::UNIFORM);
        let input = filled(cast_slice(inputs), BufferUsages::STORAGE);
        let size = (inputs.len() * size_of::<Answer>()) as u64;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let answers = buffer(device, "pinhole self-test answers", size, usage);
        let bound = [&record, &input, &answers].map(Buffer::as_entire_binding);
        Dispatch {
            pipeline: pipeline.clone(),
            group: numbered_group(device, label, &layout, bound),
            answers,
            readable: ReadableBuffer::new(device, "pinhole self-test answers", size),
            workgroups: (inputs.len() as u32).div_ceil(WORKGROUP),
        }
    };
    records.iter().map(|record| checks.create(device, || dispatch(record))).collect()
}

impl Dispatch {
    fn record(&self, encoder: &mut CommandEncoder) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(self.workgroups, 1, 1);
        drop(pass);
        self.readable.record_copy(encoder, &self.answers);
    }

    /// Returns the results, and unmaps the buffer, which must be mapped.
    fn read<Answer: Pod>(&self) -> Result<Vec<Answer>, GpuError> {
        self.readable.read(<[Answer]>::to_vec)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::headless::waiting::Wait;

    #[test]
    fn every_kernel_is_accepted_by_a_device_with_webgpu_limits() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        let run = SelfTestRun::new(&device, SelfTestExtent::Full, &Edits::default()).wait().unwrap();
        assert_eq!(run.buffers().len(), 6);
        let run = SelfTestRun::new(&device, SelfTestExtent::Quick, &Edits::default()).wait().unwrap();
        assert_eq!(run.buffers().len(), 1);
    }
}
