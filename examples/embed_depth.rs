//! Renders spheres among the triangles of a host program: they hide each other.
//!
//! The host rasterizes a square with its own pipeline, its own matrices and reversed depth. pinhole renders the spheres
//! with the same matrices, draws them into the host's render pass, and says which sphere is in the middle.
//!
//! ```sh
//! cargo run --release --example embed_depth -- embed_depth.png
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;

use pinhole::camera::{DepthOrder, HostCamera};
use pinhole::gpu::{
    Composite, CompositeDepth, CompositeOptions, CompositePicture, Frame, Picker, Renderer, RendererOptions,
    SceneBuffers, TargetTextures, Wait, adapter, wgpu,
};
use pinhole::{Film, RenderSettings, Scene, View};
use wgpu::TextureFormat;

mod shared;

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "embed_depth.png".to_owned());

    // The host has a device, matrices and attachments.
    let adapter = adapter::choose(None).wait()?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
    let (to_view, projection) = host_matrices();
    let [color, depth] = [TextureFormat::Rgba8UnormSrgb, TextureFormat::Depth32Float]
        .map(|format| shared::texture(&device, [WIDTH, HEIGHT], format, wgpu::TextureUsages::RENDER_ATTACHMENT));
    let [color_view, depth_view] =
        [&color, &depth].map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
    let square = host_square(&device);

    // Pictures of spheres have data layers, because the host's depth is computed from them.
    let options = RendererOptions { data_layers: true, ..RendererOptions::default() };
    let renderer = Renderer::new(&device, &options).wait()?;
    let scene = Scene::new(&shared::helix())?;
    let scene = SceneBuffers::new(&renderer, &device, &queue, &scene).wait()?;
    let textures = TargetTextures::new(&renderer, &device, [WIDTH, HEIGHT]).wait()?;
    let targets = textures.targets();
    let mut frame = Frame::new(&renderer, &device, &targets).wait()?;

    // These are made once for a kind of render pass, and once for each set of targets.
    let compared = CompositeDepth::new(depth.format(), DepthOrder::NearIsOne);
    let composite = Composite::new(&device, &CompositeOptions::new(color.format(), compared)).wait()?;
    let mut picture = CompositePicture::new(&composite, &device, &targets).wait()?;
    let mut picker = Picker::new(&device, 3).wait()?;

    // These are set for every picture: the host's camera, the spheres, and the host's render pass.
    let camera = HostCamera::new(to_view, projection, DepthOrder::NearIsOne)?;
    let view = View::new(&camera, Film::new(WIDTH, HEIGHT)?);
    frame.set_view(&queue, &scene, &view, &RenderSettings::default())?;
    picture.set_camera(&queue, &camera, [0, 0]);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    renderer.record(&mut encoder, &scene, &frame)?;
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &color_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::WHITE), store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth_view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(&square);
    pass.draw(0..6, 0..1);
    composite.draw(&mut pass, &picture)?;
    drop(pass);
    picker.record(&mut encoder, &targets, &view, [WIDTH / 2, HEIGHT / 2])?;
    queue.submit([encoder.finish()]);
    shared::save(&device, &queue, &color, &path)?;
    println!("wrote {path}; in the middle: {:?}", picker.take()?.and_then(|picked| picked.hit));
    Ok(())
}

/// A camera 12 in front of the origin, slightly turned, and a projection with reversed depth and no far plane.
fn host_matrices() -> ([[f32; 4]; 4], [[f32; 4]; 4]) {
    let (sin, cos) = (0.35, 0.936_749_9);
    let to_view = [[1.0, 0.0, 0.0, 0.0], [0.0, cos, sin, 0.0], [0.0, -sin, cos, 0.0], [0.0, 0.0, -12.0, 1.0]];
    let projection = [[2.1, 0.0, 0.0, 0.0], [0.0, 2.8, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
    (to_view, projection)
}

/// The host's pipeline for a square through the spheres. The matrices are those of `host_matrices`.
fn host_square(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("the host's square"),
        source: wgpu::ShaderSource::Wgsl(
            "const SIN = 0.35; const COS = 0.9367499;
            @vertex fn square(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
                let x = select(-3.0, 3.0, i == 1u || i == 2u || i == 4u);
                let z = select(-3.0, 3.0, i == 2u || i == 4u || i == 5u);
                let at = vec3f(x, -SIN * z, COS * z - 12.0);
                return vec4f(2.1 * at.x, 2.8 * at.y, 0.1, -at.z);
            }
            @fragment fn gray() -> @location(0) vec4f { return vec4f(0.3, 0.35, 0.4, 1.0); }"
                .into(),
        ),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("the host's square"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(TextureFormat::Rgba8UnormSrgb.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
