//! Spheres among triangles that the host rasterizes with its own matrices: reversed depth, no far plane, four samples.
//! Spheres and triangles hide each other.
//!
//! Drag to turn the camera, turn the wheel to come nearer. The space bar stops the box that turns, `t` hides the
//! triangles, `d` skips shading of hidden spheres, `s` writes the spheres as `Headless` renders them; Escape quits.
//!
//! ```sh
//! cargo run --release --manifest-path examples/hosts/Cargo.toml -p pinhole-host-raster
//! ```
#![allow(clippy::print_stdout, reason = "a host tells what a key did")]

mod boxes;

use std::time::Instant;

use boxes::Boxes;
use pinhole::camera::{CameraKind, DepthOrder};
use pinhole::gpu::{
    Composite, CompositeDepth, CompositeOptions, CompositePicture, DepthTest, Frame, HostDepth, Renderer,
    RendererOptions, SceneBuffers, TargetTextures, Wait, wgpu,
};
use pinhole::{Film, LinearRgb, RenderSettings, Scene, View};
use pinhole_host_common::{Gpu, Host, Next, Orbit, Outcome, molecule, run, save_still};
use wgpu::{TextureFormat, TextureUsages};

/// Number of samples for each pixel of the host's attachments.
const SAMPLES: u32 = 4;
/// The background in linear light.
const SKY: [f32; 3] = [0.55, 0.65, 0.75];

fn main() -> Outcome<()> {
    run::<Raster>()
}

struct Raster {
    scene: Scene,
    settings: RenderSettings,
    boxes: Boxes,
    renderer: Renderer,
    composite: Composite,
    depth_test: DepthTest,
    buffers: SceneBuffers,
    pictures: Pictures,
    angle: f64,
    turned_at: Option<Instant>,
    draws_boxes: bool,
    tests_early: bool,
}

/// The objects that depend on the size of the window.
struct Pictures {
    film: Film,
    // The host's attachments, and the depth of its triangles with one sample for each pixel.
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
    early_depth: wgpu::TextureView,
    // The picture of the spheres.
    frame: Frame,
    picture: CompositePicture,
    host_depth: HostDepth,
}

impl Host for Raster {
    const TITLE: &'static str = "pinhole among triangles";

    fn new(gpu: &Gpu, size: [u32; 2], _: &Orbit) -> Outcome<Self> {
        // The host's depth is computed from the data layers.
        let options =
            RendererOptions { cameras: vec![CameraKind::Pinhole], data_layers: true, ..RendererOptions::default() };
        let renderer = Renderer::new(&gpu.device, &options).wait()?;
        let depth = CompositeDepth::new(Boxes::DEPTH, DepthOrder::NearIsOne);
        let mut options = CompositeOptions::new(gpu.format, depth);
        options.sample_count = SAMPLES;
        let composite = Composite::new(&gpu.device, &options).wait()?;
        let depth_test = DepthTest::new(&renderer, &gpu.device).wait()?;
        let scene = molecule()?;
        let buffers = SceneBuffers::new(&renderer, &gpu.device, &gpu.queue, &scene).wait()?;
        let pictures = Pictures::new(gpu, &renderer, &composite, &depth_test, size)?;
        Ok(Self {
            scene,
            settings: RenderSettings { background: LinearRgb::new(SKY)?, ..RenderSettings::default() },
            boxes: Boxes::new(gpu, SAMPLES),
            renderer,
            composite,
            depth_test,
            buffers,
            pictures,
            angle: 0.6,
            turned_at: Some(Instant::now()),
            draws_boxes: true,
            tests_early: false,
        })
    }

    fn resize(&mut self, gpu: &Gpu, size: [u32; 2], _: &Orbit) -> Outcome<()> {
        let (renderer, composite) = (&self.renderer, &self.composite);
        self.pictures = Pictures::new(gpu, renderer, composite, &self.depth_test, size)?;
        Ok(())
    }

    fn draw(&mut self, gpu: &Gpu, orbit: &Orbit, window: &wgpu::Texture) -> Outcome<Next> {
        if let Some(before) = &mut self.turned_at {
            let now = Instant::now();
            self.angle += 0.7 * now.duration_since(*before).as_secs_f64();
            *before = now;
        }
        let pictures = &mut self.pictures;
        let aspect = pictures.film.aspect();
        self.boxes.set(&gpu.queue, orbit.matrices(aspect), self.angle);

        // The camera of the spheres is made from the host's matrices.
        let camera = orbit.host_camera(aspect)?;
        let view = View::new(&camera, pictures.film);
        pictures.frame.set_view(&gpu.queue, &self.buffers, &view, &self.settings)?;
        pictures.picture.set_camera(&gpu.queue, &camera, [0, 0]);

        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if self.tests_early && self.draws_boxes {
            let mut pass = begin(&mut encoder, &[], &pictures.early_depth);
            self.boxes.draw_depth(&mut pass);
            drop(pass);
            let (test, depth) = (&self.depth_test, &mut pictures.host_depth);
            depth.set_camera(&gpu.queue, &camera, &pictures.frame, [0, 0])?;
            let frame = &pictures.frame;
            self.renderer.record_with_depth(&mut encoder, &self.buffers, frame, test, depth)?;
        } else {
            self.renderer.record(&mut encoder, &self.buffers, &pictures.frame)?;
        }

        let window = window.create_view(&wgpu::TextureViewDescriptor::default());
        let [r, g, b] = SKY.map(f64::from);
        let color = wgpu::RenderPassColorAttachment {
            view: &pictures.color,
            depth_slice: None,
            resolve_target: Some(&window),
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }),
                store: wgpu::StoreOp::Discard,
            },
        };
        let mut pass = begin(&mut encoder, &[Some(color)], &pictures.depth);
        if self.draws_boxes {
            self.boxes.draw(&mut pass);
        }
        self.composite.draw(&mut pass, &pictures.picture)?;
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        Ok(if self.turned_at.is_some() { Next::Draw } else { Next::Wait })
    }

    fn key(&mut self, key: &str, orbit: &Orbit) -> Outcome<()> {
        match key {
            " " => {
                self.turned_at = if self.turned_at.is_some() { None } else { Some(Instant::now()) };
            }
            "t" => self.draws_boxes = !self.draws_boxes,
            "d" => self.tests_early = !self.tests_early,
            "s" => {
                let film = self.pictures.film;
                let camera = orbit.host_camera(film.aspect())?;
                save_still("raster", &self.scene, &View::new(&camera, film), &self.settings)?;
            }
            _ => return Ok(()),
        }
        let (boxes, early) = (self.draws_boxes, self.tests_early);
        println!("turning {}, triangles {boxes}, early depth {early}", self.turned_at.is_some());
        Ok(())
    }
}

impl Pictures {
    fn new(
        gpu: &Gpu,
        renderer: &Renderer,
        composite: &Composite,
        depth_test: &DepthTest,
        size: [u32; 2],
    ) -> Outcome<Self> {
        let textures = TargetTextures::new(renderer, &gpu.device, size).wait()?;
        let targets = textures.targets();
        let attachment = |format, sample_count, usage| attachment(gpu, size, format, sample_count, usage);
        let early_depth = attachment(Boxes::DEPTH, 1, TextureUsages::TEXTURE_BINDING);
        Ok(Self {
            film: Film::new(size[0], size[1])?,
            color: attachment(gpu.format, SAMPLES, TextureUsages::empty()),
            depth: attachment(Boxes::DEPTH, SAMPLES, TextureUsages::empty()),
            frame: Frame::new(renderer, &gpu.device, &targets).wait()?,
            picture: CompositePicture::new(composite, &gpu.device, &targets).wait()?,
            host_depth: HostDepth::new(depth_test, &gpu.device, &early_depth).wait()?,
            early_depth,
        })
    }
}

fn attachment(
    gpu: &Gpu,
    [width, height]: [u32; 2],
    format: TextureFormat,
    sample_count: u32,
    usage: TextureUsages,
) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("attachment"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | usage,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Begins a pass, and clears the depth.
fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    color_attachments: &[Option<wgpu::RenderPassColorAttachment<'_>>],
    depth: &wgpu::TextureView,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("triangles"),
        color_attachments,
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    })
}
