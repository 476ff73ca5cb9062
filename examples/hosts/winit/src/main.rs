//! Spheres in a bare window, on a device that the program owns.
//!
//! Drag to turn the camera, turn the wheel to come nearer. `s` writes the same picture as `Headless` renders it; Escape
//! quits.
//!
//! ```sh
//! cargo run --release -p pinhole-host-winit
//! ```

use pinhole::camera::CameraKind;
use pinhole::gpu::{
    Composite, CompositeOptions, CompositePicture, Frame, Renderer, RendererOptions, SceneBuffers,
    TargetTextures, wgpu,
};
use pinhole::{Film, RenderSettings, Scene, View};
use pinhole_host_common::{Gpu, Host, Next, Orbit, Outcome, molecule, run, save_still};

fn main() -> Outcome<()> {
    run::<BareWindow>()
}

struct BareWindow {
    scene: Scene,
    settings: RenderSettings,
    // Once for the device, for the kind of render pass, and for the scene.
    renderer: Renderer,
    composite: Composite,
    buffers: SceneBuffers,
    // Once for a size of the window.
    pictures: Pictures,
}

struct Pictures {
    film: Film,
    frame: Frame,
    picture: CompositePicture,
}

impl Host for BareWindow {
    const TITLE: &'static str = "pinhole in a bare window";

    fn new(gpu: &Gpu, size: [u32; 2]) -> Outcome<Self> {
        let options =
            RendererOptions { cameras: vec![CameraKind::Pinhole], ..RendererOptions::default() };
        let renderer = Renderer::new(&gpu.device, &options)?;
        let composite = Composite::new(&gpu.device, &CompositeOptions::without_depth(gpu.format))?;
        let scene = molecule()?;
        let buffers = SceneBuffers::new(&renderer, &gpu.device, &gpu.queue, &scene)?;
        let pictures = Pictures::new(gpu, &renderer, &composite, size)?;
        Ok(Self {
            scene,
            settings: RenderSettings::default(),
            renderer,
            composite,
            buffers,
            pictures,
        })
    }

    fn resize(&mut self, gpu: &Gpu, size: [u32; 2]) -> Outcome<()> {
        self.pictures = Pictures::new(gpu, &self.renderer, &self.composite, size)?;
        Ok(())
    }

    fn draw(&mut self, gpu: &Gpu, orbit: &Orbit, window: &wgpu::Texture) -> Outcome<Next> {
        let Pictures { film, frame, picture } = &mut self.pictures;
        let camera = orbit.camera(film.aspect())?;
        frame.set_view(&gpu.queue, &self.buffers, &View::new(&camera, *film), &self.settings)?;
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.renderer.record(&mut encoder, &self.buffers, frame)?;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("window"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &window.create_view(&wgpu::TextureViewDescriptor::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..wgpu::RenderPassDescriptor::default()
        });
        self.composite.draw(&mut pass, picture)?;
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        Ok(Next::Wait)
    }

    fn key(&mut self, key: &str, orbit: &Orbit) -> Outcome<()> {
        if key == "s" {
            let film = self.pictures.film;
            let camera = orbit.camera(film.aspect())?;
            save_still("winit", &self.scene, &View::new(&camera, film), &self.settings)?;
        }
        Ok(())
    }
}

impl Pictures {
    fn new(gpu: &Gpu, renderer: &Renderer, composite: &Composite, size: [u32; 2]) -> Outcome<Self> {
        let textures = TargetTextures::new(renderer, &gpu.device, size)?;
        let targets = textures.targets();
        Ok(Self {
            film: Film::new(size[0], size[1])?,
            frame: Frame::new(renderer, &gpu.device, &targets)?,
            picture: CompositePicture::new(composite, &gpu.device, &targets)?,
        })
    }
}
