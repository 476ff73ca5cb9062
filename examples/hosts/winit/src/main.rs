//! Spheres in a bare window, in the light of a studio, on a device that the program owns.
//!
//! Drag to turn the camera, turn the wheel to come nearer. Samples accumulate while nothing moves. `s` writes the same
//! picture as `Headless` renders it; Escape quits.
//!
//! ```sh
//! cargo run --release --manifest-path examples/hosts/Cargo.toml -p pinhole-host-winit
//! ```
#![allow(clippy::print_stdout, reason = "a host tells when its picture is complete")]

use std::time::Duration;

use pinhole::camera::CameraKind;
use pinhole::gpu::{
    Composite, CompositeOptions, CompositePicture, LitPicture, LitRenderer, LitState, Renderer, RendererOptions,
    SceneBuffers, TargetTextures, Wait, wgpu,
};
use pinhole::{Film, RenderSettings, Scene, View};
use pinhole_host_common::{Budget, Gpu, Host, Next, Orbit, Outcome, molecule, run, save_still, studio};

fn main() -> Outcome<()> {
    run::<BareWindow>()
}

struct BareWindow {
    scene: Scene,
    settings: RenderSettings,
    // These are made once for the device, the kind of render pass, and the scene.
    renderer: LitRenderer,
    composite: Composite,
    buffers: SceneBuffers,
    // These are made once for a size of the window.
    pictures: Pictures,
    budget: Budget,
    is_done: bool,
}

struct Pictures {
    film: Film,
    lit: LitPicture,
    shown: CompositePicture,
}

impl Host for BareWindow {
    const TITLE: &'static str = "pinhole in a bare window";

    fn new(gpu: &Gpu, size: [u32; 2], orbit: &Orbit) -> Outcome<Self> {
        let options =
            RendererOptions { cameras: vec![CameraKind::Pinhole], data_layers: true, ..RendererOptions::default() };
        let renderer = LitRenderer::new(Renderer::new(&gpu.device, &options).wait()?);
        // The pass over the window has no depth.
        let composite = Composite::new(&gpu.device, &CompositeOptions::without_depth(gpu.format)).wait()?;
        let (scene, settings) = (molecule()?, studio(-0.7, 16));
        let buffers = SceneBuffers::for_studio(renderer.renderer(), &gpu.device, &gpu.queue, &scene).wait()?;
        let pictures = Pictures::new(gpu, &renderer, &composite, &buffers, &settings, size, orbit)?;
        let budget = Budget::new(Duration::from_millis(40));
        Ok(Self { scene, settings, renderer, composite, buffers, pictures, budget, is_done: false })
    }

    fn resize(&mut self, gpu: &Gpu, size: [u32; 2], orbit: &Orbit) -> Outcome<()> {
        let Self { renderer, composite, buffers, settings, .. } = self;
        self.pictures = Pictures::new(gpu, renderer, composite, buffers, settings, size, orbit)?;
        Ok(())
    }

    fn draw(&mut self, gpu: &Gpu, orbit: &Orbit, window: &wgpu::Texture) -> Outcome<Next> {
        let Self { renderer, buffers, settings, budget, .. } = self;
        let Gpu { device, queue, .. } = gpu;
        let Pictures { film, lit, shown } = &mut self.pictures;
        let camera = orbit.camera(film.aspect())?;
        // Samples are kept unless the camera has moved.
        lit.set(renderer, device, queue, buffers, &View::new(&camera, *film), settings).wait()?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let progress = budget.record(lit, renderer, queue, &mut encoder, buffers)?;
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
        self.composite.draw(&mut pass, shown)?;
        drop(pass);
        queue.submit([encoder.finish()]);

        let is_done = progress.is_some_and(|progress| progress.state == LitState::Done);
        if std::mem::replace(&mut self.is_done, is_done) != is_done {
            println!("{}", if is_done { "done" } else { "refining" });
        }
        Ok(if is_done { Next::Wait } else { Next::Draw })
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
    fn new(
        gpu: &Gpu,
        renderer: &LitRenderer,
        composite: &Composite,
        buffers: &SceneBuffers,
        settings: &RenderSettings,
        size: [u32; 2],
        orbit: &Orbit,
    ) -> Outcome<Self> {
        let Gpu { device, queue, .. } = gpu;
        let textures = TargetTextures::new(renderer.renderer(), device, size).wait()?;
        let targets = textures.targets();
        let film = Film::new(size[0], size[1])?;
        let camera = orbit.camera(film.aspect())?;
        let view = View::new(&camera, film);
        Ok(Self {
            film,
            lit: LitPicture::new(renderer, device, queue, buffers, &view, settings, &targets).wait()?,
            shown: CompositePicture::new(composite, device, &targets).wait()?,
        })
    }
}
