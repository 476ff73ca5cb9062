//! Running the self-test on a device. Its dispatches are recorded here, and `Headless` submits them.

use std::marker::PhantomData;

use bytemuck::{Pod, bytes_of, cast_slice};
use wgpu::{
    BindGroup, BindGroupLayout, Buffer, BufferUsages, CommandEncoder, ComputePipeline, Device,
};

use crate::gpu::checks::Checks;
use crate::gpu::error::GpuError;
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::passes::frame::iteration_limit;
use crate::gpu::resources::{buffer, numbered_group};
use crate::gpu::self_test::records::{Arithmetic, Exact, Looped, Operands, SelfTest, Values};
use crate::gpu::self_test::report::{SelfTestExtent, SelfTestReport};
use crate::gpu::self_test::{loops, records, rounding};
use crate::gpu::shader::layouts::{layout, storage, uniform};
use crate::gpu::shader::{Probe, pipeline, self_test_kernel};

/// Numbers of inputs of each operation, which are multiples of the workgroup size.
const QUICK: usize = 512;
const FULL: usize = 1 << 17;

const WORKGROUP: u32 = 64;

/// The dispatches of a self-test, with their inputs.
#[derive(Debug)]
pub(crate) struct SelfTestRun {
    operands: Vec<Operands>,
    arithmetic: Dispatch,
    full: Option<Full>,
}

/// The dispatches that a quick test leaves out.
#[derive(Debug)]
struct Full {
    values: Vec<Values>,
    exact: Dispatch,
    limit: u32,
    loops: Vec<Dispatch>,
}

impl SelfTestRun {
    pub(crate) async fn new(device: &Device, extent: SelfTestExtent) -> Result<Self, GpuError> {
        let checks = Checks::default();
        let count = match extent {
            SelfTestExtent::Quick => QUICK,
            SelfTestExtent::Full => FULL,
        };
        let operands = records::operands(count);
        let kernel = TestKernel::<_, Arithmetic>::new(device, Probe::Arithmetic, &checks);
        let arithmetic = kernel.dispatch(device, &SelfTest::default(), &operands, &checks);
        let full = match extent {
            SelfTestExtent::Quick => None,
            SelfTestExtent::Full => Some(Full::new(device, count, &checks)),
        };
        checks.passed().await?;
        Ok(Self { operands, arithmetic, full })
    }

    fn dispatches(&self) -> impl Iterator<Item = &Dispatch> {
        let full = self.full.iter();
        let rest = full.flat_map(|full| std::iter::once(&full.exact).chain(&full.loops));
        std::iter::once(&self.arithmetic).chain(rest)
    }

    pub(crate) fn record(&self, encoder: &mut CommandEncoder) {
        for dispatch in self.dispatches() {
            dispatch.record(encoder);
        }
    }

    /// The buffers that must be mapped before [`SelfTestRun::judge`].
    pub(crate) fn buffers(&self) -> Vec<&Buffer> {
        self.dispatches().map(|dispatch| &dispatch.readable.buffer).collect()
    }

    /// Judges the results of the device.
    pub(crate) fn judge(&self) -> Result<SelfTestReport, GpuError> {
        let mut properties = rounding::judge(&self.operands, &self.arithmetic.read()?);
        if let Some(Full { values, exact, limit, loops }) = &self.full {
            properties.extend(rounding::judge_exact(values, &exact.read()?));
            let answers = loops.iter().map(Dispatch::read).collect::<Result<Vec<_>, _>>()?;
            properties.push(loops::judge(*limit, &answers));
        }
        Ok(SelfTestReport::new(properties))
    }
}

impl Full {
    fn new(device: &Device, count: usize, checks: &Checks) -> Self {
        let values = records::values(count);
        let kernel = TestKernel::<_, Exact>::new(device, Probe::Exact, checks);
        let exact = kernel.dispatch(device, &SelfTest::default(), &values, checks);
        let kernel = TestKernel::<u32, Looped>::new(device, Probe::Loops, checks);
        let limit = iteration_limit(device);
        // Only the number of inputs matters, because the kernel does not read them.
        let invocations = [0_u32; loops::INVOCATIONS as usize];
        let loops = loops::runs(limit)
            .iter()
            .map(|uniform| kernel.dispatch(device, uniform, &invocations, checks))
            .collect();
        Self { values, exact, limit, loops }
    }
}

/// A kernel of the self-test, built in the same way as those of a renderer.
struct TestKernel<Input, Answer> {
    pipeline: ComputePipeline,
    layout: BindGroupLayout,
    records: PhantomData<(Input, Answer)>,
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

impl<Input: Pod, Answer: Pod> TestKernel<Input, Answer> {
    fn new(device: &Device, probe: Probe, checks: &Checks) -> Self {
        let layout = checks.create(device, || layout_of::<Input, Answer>(device));
        let pipeline = pipeline(device, &self_test_kernel(probe), &[&layout], checks);
        Self { pipeline, layout, records: PhantomData }
    }

    /// Creates a dispatch with one invocation for each input.
    fn dispatch(
        &self,
        device: &Device,
        uniform: &SelfTest,
        inputs: &[Input],
        checks: &Checks,
    ) -> Dispatch {
        checks.create(device, || {
            let filled = |label, bytes: &[u8], usage| {
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
            let uniform = filled("pinhole self-test", bytes_of(uniform), BufferUsages::UNIFORM);
            let input =
                filled("pinhole self-test inputs", cast_slice(inputs), BufferUsages::STORAGE);
            let (label, size) =
                ("pinhole self-test answers", (inputs.len() * size_of::<Answer>()) as u64);
            let answers =
                buffer(device, label, size, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
            let readable = ReadableBuffer::new(device, label, size);
            let bound = [&uniform, &input, &answers].map(Buffer::as_entire_binding);
            let group = numbered_group(device, "pinhole self-test", &self.layout, bound);
            let pipeline = self.pipeline.clone();
            let workgroups = (inputs.len() as u32).div_ceil(WORKGROUP);
            Dispatch { pipeline, group, answers, readable, workgroups }
        })
    }
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

/// Layout of bind group 0 of a kernel of the self-test: the shared record, and an input and a result for each
/// invocation.
fn layout_of<Input, Answer>(device: &Device) -> wgpu::BindGroupLayout {
    let kinds = [uniform::<SelfTest>(), storage::<Input>(true), storage::<Answer>(false)];
    layout(device, "pinhole self-test", &kinds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::headless::waiting::Wait;

    #[test]
    fn every_kernel_is_accepted_by_a_device_with_webgpu_limits() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        let run = SelfTestRun::new(&device, SelfTestExtent::Full).wait().unwrap();
        assert_eq!(run.buffers().len(), 5);
        let run = SelfTestRun::new(&device, SelfTestExtent::Quick).wait().unwrap();
        assert_eq!(run.buffers().len(), 1);
    }
}
