//! Draws a quick picture in the window's render pass, stretched to the viewport.
//!
//! egui could draw it too, but its shader does more work for each pixel, which matters on software devices.

use eframe::egui_wgpu::RenderState;
use eframe::wgpu;

/// Draws a triangle that covers the viewport, with a texture. The texture has encoded colours. A target that encodes
/// colours itself gets linear light.
const SHADER: &str = "
override IS_LINEAR: bool;
@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var linear: sampler;

struct Corner { @builtin(position) position: vec4f, @location(0) at: vec2f }

@vertex fn corner(@builtin(vertex_index) index: u32) -> Corner {
    let at = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0;
    return Corner(vec4f(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0, 1.0), at);
}

@fragment fn color(corner: Corner) -> @location(0) vec4f {
    let encoded = textureSampleLevel(picture, linear, corner.at, 0.0).rgb;
    if !IS_LINEAR {
        return vec4f(encoded, 1.0);
    }
    let high = pow((encoded + 0.055) / 1.055, vec3f(2.4));
    return vec4f(select(high, encoded / 12.92, encoded <= vec3f(0.04045)), 1.0);
}
";

/// The pipeline for the window's format.
pub(crate) struct Blit {
    pipeline: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
}

impl Blit {
    pub(crate) fn new(render: &RenderState) -> Self {
        let device = &render.device;
        let label = Some("picture in the window");
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let is_linear = f64::from(u8::from(render.target_format.is_srgb()));
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("color"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &[("IS_LINEAR", is_linear)],
                    ..wgpu::PipelineCompilationOptions::default()
                },
                targets: &[Some(render.target_format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        Self { pipeline, sampler }
    }

    /// Makes the bind group for drawing a texture.
    pub(crate) fn group(&self, device: &wgpu::Device, texture: &wgpu::TextureView) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture in the window"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(texture) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        })
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, group: &wgpu::BindGroup) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}
