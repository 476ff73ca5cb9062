//! Renders spheres into the frame of a host program that already uses wgpu.
//!
//! The host owns the device, the queue, the encoder and the texture; pinhole only records commands. The host of this
//! example is minimal: it opens an adapter, and after the frame it writes its texture to a file.
//!
//! ```sh
//! cargo run --release --example embed -- embed.png
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;

use pinhole::camera::{PinholeCamera, Pose};
use pinhole::gpu::{Frame, Renderer, RendererOptions, SceneBuffers, Targets, Wait, adapter, wgpu};
use pinhole::{Film, LinearRgb, RenderSettings, Scene, Sphere, View};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "embed.png".to_owned());

    // A host already has an adapter, a device, a queue and a texture. WebGPU's default limits are enough.
    let adapter = adapter::choose(None).wait()?;
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
    let texture = host_texture(&device);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());

    // The renderer is made once per device.
    let renderer = Renderer::new(&device, &RendererOptions::default()).wait()?;

    // The buffers of a scene are made once per scene.
    let spheres: Vec<Sphere> = (0..60_u8)
        .map(|i| {
            let angle = f64::from(i) * 0.4;
            let color = LinearRgb::from_srgb8([255 - 3 * i, 120, 60 + 3 * i]);
            let height = f64::from(i) * 0.1 - 3.0;
            Sphere::new([2.0 * angle.cos(), height, 2.0 * angle.sin()], 0.4, color)
        })
        .collect();
    let scene = SceneBuffers::new(&renderer, &device, &queue, &Scene::new(&spheres)?).wait()?;

    // A frame is made once per set of targets. Its view may change from one picture to the next.
    let mut frame = Frame::new(&renderer, &device, &Targets { color: &view, data: None }).wait()?;
    let film = Film::new(WIDTH, HEIGHT)?;
    let pose = Pose::looking_at([7.0, 5.0, 10.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0])?;
    let camera = PinholeCamera::with_vertical_fov(pose, 40_f64.to_radians(), film.aspect())?;
    frame.set_view(&queue, &scene, &View::new(&camera, film), &RenderSettings::default())?;

    // For every picture, pinhole records into the host's encoder, which may hold other work before and after.
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    renderer.record(&mut encoder, &scene, &frame)?;
    let readback = host_copy(&device, &mut encoder, &texture);
    queue.submit([encoder.finish()]);

    readback.map_async(wgpu::MapMode::Read, .., |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    // WebGPU aligns rows to 256 bytes, and 640 pixels of 4 bytes are a multiple of that.
    let pixels = readback.get_mapped_range(..)?.to_vec();
    image::save_buffer(&path, &pixels, WIDTH, HEIGHT, image::ExtendedColorType::Rgba8)?;
    println!("wrote {path}, rendered on {}", adapter.get_info().name);
    Ok(())
}

fn host_texture(device: &wgpu::Device) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the host's texture"),
        size: wgpu::Extent3d { width: WIDTH, height: HEIGHT, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: RendererOptions::default().color.texture_format(),
        usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn host_copy(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    texture: &wgpu::Texture,
) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("the host's readback"),
        size: u64::from(WIDTH * HEIGHT * 4),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(WIDTH * 4),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    buffer
}
