//! Shows a live picture as a program with a window would: the camera moves around a molecule, and each frame is recorded
//! into the program's own encoder. Then the camera rests, and samples accumulate.
//!
//! ```sh
//! cargo run --release --example live -- 4hhb.pdb 640 480
//! ```
//!
//! Writes the last frame in motion, `live.png`, and the picture at rest, `still.png`, and prints how long they took.
#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;
use std::time::Instant;

use pinhole::camera::PinholeCamera;
use pinhole::glam::DVec3;
use pinhole::gpu::{
    LitPicture, LitRenderer, LitState, LivePicture, Renderer, RendererOptions, SceneBuffers, TargetTextures, Wait,
    adapter, wgpu,
};
use pinhole::render::{Integrator, Occlusion, Studio};
use pinhole::{Film, LinearRgb, RenderSettings, View};
use pinhole_data::load::pdb;

mod shared;

/// Number of frames in motion, and the angle between two of them in degrees.
const FRAMES: u32 = 40;
const STEP: f64 = 1.0;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("usage: live FILE.pdb [WIDTH HEIGHT]")?;
    let mut side = |default: u32| arguments.next().map_or(Ok(default), |text| text.parse());
    let size = [side(640)?, side(480)?];
    let film = Film::new(size[0], size[1])?;
    let scene = pdb::read(&std::fs::read(&file)?, 0)?.scene(LinearRgb::WHITE)?;

    // The program's device.
    let adapter = adapter::choose(None).wait()?;
    let descriptor = wgpu::DeviceDescriptor::default();
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;

    // The renderer, the scene and the two pictures of it.
    let options = RendererOptions { data_layers: true, ..RendererOptions::default() };
    let lit = LitRenderer::new(Renderer::new(&device, &options).wait()?);
    let textures = TargetTextures::new(lit.renderer(), &device, size).wait()?;
    let targets = textures.targets();
    let buffers = SceneBuffers::for_studio(lit.renderer(), &device, &queue, &scene).wait()?;
    let settings = settings();
    let camera = PinholeCamera::framing_from_the_front(scene.subject(), film.aspect())?;
    let around = |degrees: f64| {
        let turned = pinhole::camera::turned(DVec3::NEG_Z, DVec3::Y, degrees);
        let pose = pinhole::camera::Pose::looking_along(DVec3::ZERO, turned, DVec3::Y)?;
        PinholeCamera::framing(scene.subject(), pose, 0.6, film.aspect(), 0.07)
    };
    let view = View::new(&camera, film);
    let mut live = LivePicture::new(&lit, &device, &queue, &buffers, &view, &settings, &targets).wait()?;
    let mut still = LitPicture::new(&lit, &device, &queue, &buffers, &view, &settings, &targets).wait()?;

    let mut times = Vec::new();
    for frame in 0..FRAMES {
        let camera = around(STEP * f64::from(frame))?;
        let start = Instant::now();
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        live.set(&lit, &device, &queue, &buffers, &View::new(&camera, film), &settings).wait()?;
        live.record(&lit, &queue, &mut encoder, &buffers)?;
        queue.submit([encoder.finish()]);
        // A program with a window would go on while the device works.
        device.poll(wgpu::PollType::wait_indefinitely())?;
        times.push(start.elapsed().as_secs_f64());
    }
    shared::save(&device, &queue, targets.color.texture(), "live.png")?;
    times.sort_by(f64::total_cmp);
    let median = times[times.len() / 2];
    println!("in motion: {:.1} ms a frame, {:.1} frames/s", 1e3 * median, 1.0 / median);

    let camera = around(STEP * f64::from(FRAMES - 1))?;
    let start = Instant::now();
    still.set(&lit, &device, &queue, &buffers, &View::new(&camera, film), &settings).wait()?;
    loop {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let progress = still.record(&lit, &queue, &mut encoder, &buffers, 4_000_000)?;
        queue.submit([encoder.finish()]);
        device.poll(wgpu::PollType::wait_indefinitely())?;
        if progress.state == LitState::Done {
            break;
        }
    }
    shared::save(&device, &queue, targets.color.texture(), "still.png")?;
    let samples = settings.sampling.samples;
    println!("at rest: {samples} samples in {:.2} s", start.elapsed().as_secs_f64());
    println!("wrote live.png and still.png, rendered on {}", adapter.get_info().name);
    Ok(())
}

/// A lamp with shadows, and ambient light with occlusion.
fn settings() -> RenderSettings {
    let mut settings = RenderSettings::studio();
    settings.background = LinearRgb::from_srgb8([243, 244, 246]);
    settings.sampling.samples = 64;
    settings.integrator = Integrator::Studio(Studio {
        occlusion: Some(Occlusion { radius: Some(12.0), samples: 2 }),
        ..Studio::default()
    });
    settings
}
