//! Running shader parts alone, in kernels of the tests, which compute one answer for each question.

use pinhole::gpu::{Headless, wgpu};
use wgpu::util::DeviceExt;

/// The WGSL before the parts, which declares the buffers of questions and answers.
const BINDINGS: &str = "
@group(0) @binding(0) var<storage, read> questions: array<vec4u>;
@group(0) @binding(1) var<storage, read_write> answers: array<vec4u>;
";

/// Returns the results of `fn answer(question: vec4u) -> vec4u`, which one of the parts must provide, for all
/// questions.
///
/// `tables` are storage buffers of words, with their groups and bindings.
pub(crate) fn answers(
    headless: &Headless,
    parts: &[&str],
    tables: &[(u32, u32, &[u32])],
    questions: &[[u32; 4]],
) -> Vec<[u32; 4]> {
    assert_eq!(questions.len() % 64, 0, "whole workgroups");
    let main = "
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) invocation: vec3u,
        @builtin(num_workgroups) workgroups: vec3u) {
    let index = invocation.y * workgroups.x * 64u + invocation.x;
    if (index < arrayLength(&questions)) {
        answers[index] = answer(questions[index]);
    }
}";
    let source = [BINDINGS, &parts.join("\n"), main].concat();
    let (device, queue) = (headless.device(), headless.queue());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("part"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("part"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let filled = |bytes: &[u8]| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytes,
            usage: wgpu::BufferUsages::STORAGE,
        })
    };
    let size = size_of_val(questions) as u64;
    let empty = |usage| {
        let descriptor =
            wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        device.create_buffer(&descriptor)
    };
    let written = empty(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = empty(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let mut buffers = vec![(0, 0, filled(bytemuck::cast_slice(questions))), (0, 1, written)];
    for (group, binding, words) in tables {
        buffers.push((*group, *binding, filled(bytemuck::cast_slice(words))));
    }
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    for group in buffers.iter().map(|(group, ..)| *group) {
        let of_group = buffers.iter().filter(|(of, ..)| *of == group);
        let entries: Vec<_> = of_group
            .map(|(_, binding, buffer)| wgpu::BindGroupEntry {
                binding: *binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let layout = pipeline.get_bind_group_layout(group);
        let bound = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &entries,
        });
        pass.set_bind_group(group, &bound, &[]);
    }
    let workgroups = questions.len() as u32 / 64;
    // There may be at most 65,535 workgroups along an axis.
    pass.dispatch_workgroups(workgroups.min(4096), workgroups.div_ceil(4096), 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&buffers[1].2, 0, &read, 0, size);
    queue.submit([encoder.finish()]);
    read.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let mapped = read.get_mapped_range(..).unwrap();
    bytemuck::cast_slice(&mapped).to_vec()
}
