//! The triangles that the host rasterizes: a ground and boxes, one of which turns.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DQuat, DVec3};
use pinhole::gpu::wgpu;
use pinhole_host_common::Gpu;

/// The number of boxes; keep it equal to `boxes` in `boxes.wgsl`.
const COUNT: usize = 6;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Box {
    world_from_box: [[f32; 4]; 4],
    color: [f32; 4],
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Frame {
    clip_from_world: [[f32; 4]; 4],
    boxes: [Box; COUNT],
}

/// The host's pipelines, and the buffer with its matrices.
pub(crate) struct Boxes {
    lit: wgpu::RenderPipeline,
    depth_only: wgpu::RenderPipeline,
    frame: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl Boxes {
    /// The format of the depth, which is reversed: 1 is near, and 0 infinitely far away.
    pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

    pub(crate) fn new(gpu: &Gpu, sample_count: u32) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::include_wgsl!("boxes.wgsl"));
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("boxes"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("boxes"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let targets = [Some(gpu.format.into())];
        let pipeline = |sample_count, has_color: bool| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("boxes"),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("corner"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: Self::DEPTH,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState { count: sample_count, ..wgpu::MultisampleState::default() },
                fragment: has_color.then_some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("lit"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let (lit, depth_only) = (pipeline(sample_count, true), pipeline(1, false));
        let frame = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("boxes"),
            size: size_of::<Frame>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("boxes"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: frame.as_entire_binding() }],
        });
        Self { lit, depth_only, frame, group }
    }

    /// Sets the host's matrices and the angle of the box that turns, in radians.
    pub(crate) fn set(&self, queue: &wgpu::Queue, [view, projection]: [DMat4; 2], angle: f64) {
        let at = |size: [f64; 3], place: [f64; 3], turn: DQuat, [r, g, b]: [f32; 3]| Box {
            world_from_box: DMat4::from_scale_rotation_translation(size.into(), turn, place.into())
                .as_mat4()
                .to_cols_array_2d(),
            color: [r, g, b, 1.0],
        };
        let still = DQuat::IDENTITY;
        let turning = DQuat::from_axis_angle(DVec3::new(0.3, 1.0, 0.2).normalize_or(DVec3::Y), angle);
        let frame = Frame {
            clip_from_world: (projection * view).as_mat4().to_cols_array_2d(),
            boxes: [
                at([30.0, 0.1, 30.0], [0.0, -3.3, 0.0], still, [0.32, 0.36, 0.33]),
                at([0.3, 2.6, 0.3], [-2.9, -0.6, 0.0], still, [0.60, 0.55, 0.45]),
                at([0.3, 2.6, 0.3], [2.9, -0.6, 0.0], still, [0.60, 0.55, 0.45]),
                at([3.3, 0.15, 0.36], [0.0, 2.1, 0.0], still, [0.55, 0.30, 0.22]),
                at([2.4, 2.4, 0.05], [0.0, -0.8, -0.6], still, [0.25, 0.33, 0.50]),
                at([0.95; 3], [0.0, 0.0, 0.0], turning, [0.75, 0.72, 0.20]),
            ],
        };
        queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(&frame));
    }

    /// Draws the boxes with colour and depth.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw_with(&self.lit, pass);
    }

    /// Draws the depth of the boxes, with one sample for each pixel.
    pub(crate) fn draw_depth(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw_with(&self.depth_only, pass);
    }

    fn draw_with(&self, pipeline: &wgpu::RenderPipeline, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..36, 0..COUNT as u32);
    }
}
