//! Spheres as an image in a drawing of vello: clipped by a rounded frame, and once more small, turned and translucent.
//!
//! Drag to turn the camera, turn the wheel to come nearer. `s` writes the image as `Headless` renders it; Escape quits.
//!
//! ```sh
//! cargo run --release -p pinhole-host-vello
//! ```
#![allow(clippy::print_stdout, reason = "a host tells what it wrote")]

use pinhole::camera::CameraKind;
use pinhole::gpu::{Frame, Renderer, RendererOptions, SceneBuffers, TargetTextures, wgpu};
use pinhole::{Film, RenderSettings, Scene, View};
use pinhole_host_common::{Gpu, Host, Next, Orbit, Outcome, molecule, run, save_still};
use vello::kurbo::{Affine, RoundedRect, Stroke};
use vello::peniko::{Color, Fill, ImageData};
use wgpu::util::TextureBlitter;

/// The margin around the image, in pixels.
const MARGIN: u32 = 40;

fn main() -> Outcome<()> {
    run::<Drawing>()
}

struct Drawing {
    scene: Scene,
    settings: RenderSettings,
    renderer: Renderer,
    buffers: SceneBuffers,
    vello: vello::Renderer,
    blitter: TextureBlitter,
    pictures: Pictures,
}

/// What belongs to a size of the window.
struct Pictures {
    film: Film,
    frame: Frame,
    /// The texture of the frame, as vello knows it.
    image: ImageData,
    /// What vello draws to.
    canvas: wgpu::TextureView,
    size: [u32; 2],
}

impl Host for Drawing {
    const TITLE: &'static str = "pinhole in vello";
    // The canvas of vello has encoded colours, which are copied as they are.
    const IS_SRGB: bool = false;

    fn new(gpu: &Gpu, size: [u32; 2], _: &Orbit) -> Outcome<Self> {
        let options =
            RendererOptions { cameras: vec![CameraKind::Pinhole], ..RendererOptions::default() };
        let renderer = Renderer::new(&gpu.device, &options)?;
        let scene = molecule()?;
        let buffers = SceneBuffers::new(&renderer, &gpu.device, &gpu.queue, &scene)?;
        let options = vello::RendererOptions {
            antialiasing_support: vello::AaSupport::area_only(),
            ..vello::RendererOptions::default()
        };
        let mut vello = vello::Renderer::new(&gpu.device, options)?;
        let pictures = Pictures::new(gpu, &renderer, &mut vello, size)?;
        let blitter = TextureBlitter::new(&gpu.device, gpu.format);
        let settings = RenderSettings::default();
        Ok(Self { scene, settings, renderer, buffers, vello, blitter, pictures })
    }

    fn resize(&mut self, gpu: &Gpu, size: [u32; 2], _: &Orbit) -> Outcome<()> {
        self.vello.unregister_texture(self.pictures.image.clone());
        self.pictures = Pictures::new(gpu, &self.renderer, &mut self.vello, size)?;
        Ok(())
    }

    fn draw(&mut self, gpu: &Gpu, orbit: &Orbit, window: &wgpu::Texture) -> Outcome<Next> {
        let Pictures { film, frame, image, canvas, size: [width, height] } = &mut self.pictures;
        let camera = orbit.camera(film.aspect())?;
        frame.set_view(&gpu.queue, &self.buffers, &View::new(&camera, *film), &self.settings)?;
        let encoder =
            || gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut rays = encoder();
        self.renderer.record(&mut rays, &self.buffers, frame)?;
        // Vello submits its own work, which reads the texture, so the rays are submitted before.
        gpu.queue.submit([rays.finish()]);

        self.vello.mark_override_image_dirty(image);
        let params = vello::RenderParams {
            base_color: Color::from_rgb8(0x26, 0x2b, 0x33),
            width: *width,
            height: *height,
            antialiasing_method: vello::AaConfig::Area,
        };
        let drawing = draw_around(image);
        self.vello.render_to_texture(&gpu.device, &gpu.queue, &drawing, canvas, &params)?;

        let mut copy = encoder();
        let window = window.create_view(&wgpu::TextureViewDescriptor::default());
        self.blitter.copy(&gpu.device, &mut copy, canvas, &window);
        gpu.queue.submit([copy.finish()]);
        Ok(Next::Wait)
    }

    fn key(&mut self, key: &str, orbit: &Orbit) -> Outcome<()> {
        if key == "s" {
            let film = self.pictures.film;
            let camera = orbit.camera(film.aspect())?;
            println!("panel {}x{}+{MARGIN}+{MARGIN}", film.width(), film.height());
            save_still("vello", &self.scene, &View::new(&camera, film), &self.settings)?;
        }
        Ok(())
    }
}

impl Pictures {
    fn new(
        gpu: &Gpu,
        renderer: &Renderer,
        vello: &mut vello::Renderer,
        size: [u32; 2],
    ) -> Outcome<Self> {
        let film_size = size.map(|side| side.saturating_sub(2 * MARGIN).max(1));
        let textures = TargetTextures::new(renderer, &gpu.device, film_size)?;
        let targets = textures.targets();
        let canvas = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("canvas"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        Ok(Self {
            film: Film::new(film_size[0], film_size[1])?,
            frame: Frame::new(renderer, &gpu.device, &targets)?,
            image: vello.register_texture(targets.color.texture().clone()),
            canvas: canvas.create_view(&wgpu::TextureViewDescriptor::default()),
            size,
        })
    }
}

/// The host's drawing: the image in a frame, and a card with the image in front of it.
fn draw_around(image: &ImageData) -> vello::Scene {
    let mut scene = vello::Scene::new();
    let (width, height, margin) =
        (f64::from(image.width), f64::from(image.height), f64::from(MARGIN));
    let frame = RoundedRect::new(0.0, 0.0, width, height, 24.0);
    let place = Affine::translate((margin, margin));
    scene.push_clip_layer(Fill::NonZero, place, &frame);
    scene.draw_image(image, place);
    scene.pop_layer();
    let orange = Color::from_rgb8(0xe8, 0x92, 0x3c);
    scene.stroke(&Stroke::new(4.0), place, orange, None, &frame);

    let card = Affine::translate((margin + 0.78 * width, margin + 0.76 * height))
        * Affine::rotate(-0.2)
        * Affine::scale(0.25);
    scene.push_layer(Fill::NonZero, vello::peniko::Mix::Normal, 0.8, card, &frame);
    scene.draw_image(image, card);
    scene.pop_layer();
    scene.stroke(&Stroke::new(10.0), card, orange, None, &frame);
    scene
}
