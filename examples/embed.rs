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
use pinhole::{Film, RenderSettings, Scene, View};

mod shared;

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "embed.png".to_owned());

    // A host already has an adapter, a device, a queue and a texture. WebGPU's default limits are enough.
    let adapter = adapter::choose(None).wait()?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
    let format = RendererOptions::default().color.texture_format();
    let usage = wgpu::TextureUsages::STORAGE_BINDING;
    let texture = shared::texture(&device, [WIDTH, HEIGHT], format, usage);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());

    // The renderer is made once per device.
    let renderer = Renderer::new(&device, &RendererOptions::default()).wait()?;

    // The buffers of a scene are made once per scene.
    let scene = Scene::new(&shared::helix())?;
    let scene = SceneBuffers::new(&renderer, &device, &queue, &scene).wait()?;

    // A frame is made once per set of targets. Its view may change from one picture to the next.
    let mut frame = Frame::new(&renderer, &device, &Targets { color: &view, data: None }).wait()?;
    let film = Film::new(WIDTH, HEIGHT)?;
    let pose = Pose::looking_at([7.0, 5.0, 10.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0])?;
    let camera = PinholeCamera::with_vertical_fov(pose, 40_f64.to_radians(), film.aspect())?;
    frame.set_view(&queue, &scene, &View::new(&camera, film), &RenderSettings::default())?;

    // For every picture, pinhole records into the host's encoder, which may hold other work before and after.
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    renderer.record(&mut encoder, &scene, &frame)?;
    queue.submit([encoder.finish()]);
    shared::save(&device, &queue, &texture, &path)?;
    println!("wrote {path}, rendered on {}", adapter.get_info().name);
    Ok(())
}
