//! Measures what spheres cost a host program, on the adapter that `pinhole render` would choose:
//!
//! * tracing, with and without a depth of the host, and drawing into its render pass, for 100,000 spheres in 1280×960
//!   pixels;
//! * a studio of the same spheres, in a host's encoders and by `Headless`, and a frame of a live picture;
//! * the first frame of three spheres, from a device that is open, with different ways to build the pipelines. Drivers
//!   keep what they compile on the disk: `MESA_SHADER_CACHE_DISABLE=true` shows how long it takes without that.
//!
//! ```sh
//! cargo bench --bench embed
//! ```
//! Everything is measured by turns, and the least time counts.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark may panic, and prints")]

use std::time::Instant;

use pinhole::accel::{AccelChoice, Structure};
use pinhole::camera::{CameraKind, DepthOrder, HostCamera};
use pinhole::generate::Kind;
use pinhole::gpu::{
    Composite, CompositeDepth, CompositeOptions, CompositePicture, DataTargets, Decision,
    DepthTest, Frame, Headless, HeadlessOptions, HostDepth, LitPicture, LitRenderer, LitState,
    LivePicture, Renderer, RendererOptions, SceneBuffers, Structures, Targets, adapter, wgpu,
};
use pinhole::image::Layer;
use pinhole::render::{Integrator, Occlusion, Studio};
use pinhole::{Film, LayerSet, LinearRgb, RenderSettings, Scene, View};
use wgpu::{TextureFormat, TextureUsages};

const SIZE: [u32; 2] = [1280, 960];

struct Host {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

impl Host {
    fn new() -> Self {
        let adapter = adapter::choose(None).unwrap();
        let descriptor = wgpu::DeviceDescriptor::default();
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
        Self { device, queue }
    }

    fn view(&self, format: TextureFormat, usage: TextureUsages) -> wgpu::TextureView {
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// Records, submits and waits.
    fn run(&self, record: impl FnOnce(&mut wgpu::CommandEncoder)) {
        let mut encoder =
            self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        record(&mut encoder);
        self.queue.submit([encoder.finish()]);
        self.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    }
}

/// The views of the layers of a frame.
struct Layers([wgpu::TextureView; 4]);

impl Layers {
    fn new(host: &Host) -> Self {
        let usage = TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING;
        let formats = [
            TextureFormat::Rgba8Unorm,
            TextureFormat::R32Float,
            TextureFormat::Rgba32Float,
            TextureFormat::R32Uint,
        ];
        Self(formats.map(|format| host.view(format, usage)))
    }

    fn targets(&self) -> Targets<'_> {
        let [color, depth, normal, id] = &self.0;
        Targets { color, data: Some(DataTargets { depth, normal, id }) }
    }
}

/// A camera in front of the unit cube, with reversed depth and no far plane.
fn camera() -> HostCamera {
    let to_view = [[-1., 0., 0., 0.], [0., 1., 0., 0.], [0., 0., -1., 0.], [0.5, -0.5, -1.2, 1.]];
    let projection =
        [[2., 0., 0., 0.], [0., 8. / 3., 0., 0.], [0., 0., 0., -1.], [0., 0., 0.1, 0.]];
    HostCamera::new(to_view, projection, DepthOrder::NearIsOne).unwrap()
}

/// Clears the attachments, and draws.
fn host_pass(
    encoder: &mut wgpu::CommandEncoder,
    [color, depth]: [&wgpu::TextureView; 2],
    cleared: f32,
    draw: impl FnOnce(&mut wgpu::RenderPass<'_>),
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(cleared),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    });
    draw(&mut pass);
}

/// Number of times that everything is measured.
const TURNS: usize = 12;

/// Something to be measured, and the least time that it took, in milliseconds.
struct Case<'a> {
    name: String,
    run: Box<dyn FnMut() + 'a>,
    least: f64,
}

#[derive(Default)]
struct Cases<'a>(Vec<Case<'a>>);

impl<'a> Cases<'a> {
    fn add(&mut self, name: impl Into<String>, run: impl FnMut() + 'a) {
        self.0.push(Case { name: name.into(), run: Box::new(run), least: f64::INFINITY });
    }

    /// Measures all by turns, and prints them with their share of the first.
    fn measure(mut self, title: &str) {
        for _ in 0..TURNS {
            for case in &mut self.0 {
                let started = Instant::now();
                (case.run)();
                case.least = case.least.min(started.elapsed().as_secs_f64() * 1e3);
            }
        }
        println!("{title}");
        let first = self.0[0].least;
        for Case { name, least, .. } in &self.0 {
            println!("{name:40} {least:7.1} ms {:6.1} %", 100.0 * least / first);
        }
        println!();
    }
}

fn main() {
    let host = Host::new();
    let info = host.device.adapter_info();
    println!("{} ({:?}), {} {}\n", info.name, info.backend, info.driver, info.driver_info);
    let layers = Layers::new(&host);
    many_spheres(&host, &layers);
    studios(&host, &layers);
    three_spheres(&host, &layers);
}

fn many_spheres(host: &Host, layers: &Layers) {
    let Host { device, queue } = host;
    let cameras = vec![CameraKind::Pinhole];
    let options = RendererOptions { data_layers: true, cameras, ..RendererOptions::default() };
    let renderer = Renderer::new(device, &options).unwrap();
    let spheres = Kind::Random.spheres(100_000, 1).unwrap();
    let scene = Scene::from_f32(spheres, LinearRgb::from_srgb8([200, 120, 60])).unwrap();
    let scene = SceneBuffers::new(&renderer, device, queue, &scene).unwrap();
    let mut frame = Frame::new(&renderer, device, &layers.targets()).unwrap();
    let (camera, film) = (camera(), Film::new(SIZE[0], SIZE[1]).unwrap());
    let settings = RenderSettings::default();
    frame.set_view(queue, &scene, &View::new(&camera, film), &settings).unwrap();
    let test = DepthTest::new(&renderer, device).unwrap();
    let (renderer, scene, frame, test) = (&renderer, &scene, &frame, &test);

    let mut cases = Cases::default();
    cases.add("record", || host.run(|encoder| renderer.record(encoder, scene, frame).unwrap()));

    let drawn = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
    let color = host.view(TextureFormat::Rgba8Unorm, drawn);
    // The nearest spheres are 1.2 away, and the farthest 2.2.
    for (distance, name) in [(1e9, "nothing"), (1.25, "most"), (1.0, "everything")] {
        let depth = host.view(TextureFormat::Depth32Float, drawn);
        let mut host_depth = HostDepth::new(test, device, &depth).unwrap();
        host_depth.set_camera(queue, &camera, frame, [0, 0]).unwrap();
        host.run(|encoder| host_pass(encoder, [&color, &depth], 0.1 / distance, |_| {}));
        cases.add(format!("record, the host hides {name}"), move || {
            host.run(|encoder| {
                renderer.record_with_depth(encoder, scene, frame, test, &host_depth).unwrap();
            });
        });
    }
    // What is drawn is the whole picture.
    cases.add("(record once more)", || {
        host.run(|encoder| renderer.record(encoder, scene, frame).unwrap());
    });
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb] {
        let compared = CompositeDepth::new(TextureFormat::Depth32Float, DepthOrder::NearIsOne);
        for (options, name) in [
            (None, "empty pass"),
            (Some(CompositeOptions::new(format, compared)), "pass, draw"),
            (Some(CompositeOptions::lit(format, compared)), "pass, draw as lit"),
        ] {
            let drawn_picture = options.map(|options| {
                let composite = Composite::new(device, &options).unwrap();
                let targets = layers.targets();
                let mut picture = CompositePicture::new(&composite, device, &targets).unwrap();
                picture.set_camera(queue, &camera, [0, 0]);
                (composite, picture)
            });
            let color = host.view(format, drawn);
            let depth = host.view(TextureFormat::Depth32Float, drawn);
            cases.add(format!("{name}, {format:?}"), move || {
                host.run(|encoder| {
                    host_pass(encoder, [&color, &depth], 0.0, |pass| {
                        if let Some((composite, picture)) = &drawn_picture {
                            composite.draw(pass, picture).unwrap();
                        }
                    });
                });
            });
        }
    }
    cases.measure("100,000 spheres, 1280x960");
}

/// A studio of 100,000 spheres with eight samples, shadows and two directions of ambient occlusion for each.
fn studios(host: &Host, layers: &Layers) {
    let Host { device, queue } = host;
    let cameras = vec![CameraKind::Pinhole];
    let options = RendererOptions { data_layers: true, cameras, ..RendererOptions::default() };
    let lit = LitRenderer::new(Renderer::new(device, &options).unwrap());
    let spheres = Kind::Random.spheres(100_000, 1).unwrap();
    let of_host = Scene::from_f32(spheres, LinearRgb::from_srgb8([200, 120, 60])).unwrap();
    let scene = SceneBuffers::for_studio(lit.renderer(), device, queue, &of_host).unwrap();
    let (camera, film) = (camera(), Film::new(SIZE[0], SIZE[1]).unwrap());
    let view = View::new(&camera, film);
    let mut settings = RenderSettings::studio();
    settings.sampling.samples = 8;
    let occlusion = Some(Occlusion { radius: Some(0.05), samples: 2 });
    settings.integrator = Integrator::Studio(Studio { occlusion, ..Studio::default() });
    let (lit, scene, view, settings) = (&lit, &scene, &view, &settings);

    let headless = Headless::open(&HeadlessOptions::default()).unwrap();
    let structures = headless.plan_accel(&of_host, AccelChoice::Auto).build(of_host.spheres());
    let structures = Structures { accel: structures, occluders: None };
    let uploaded = headless.upload(&of_host, &structures).unwrap();
    let data = LayerSet::DATA.with(Layer::Alpha);
    let mut cases = Cases::default();
    cases.add("Headless, 8 samples", || {
        let watch = &mut |_: &_| Decision::GoOn;
        headless.render_uploaded(&uploaded, view, settings, data, watch).unwrap();
    });
    // Every turn is another picture, whose random numbers are others.
    for (max_rays, name) in [(u64::MAX, "all at once"), (4_000_000, "4 million rays at a time")] {
        let mut settings = settings.clone();
        let mut picture =
            LitPicture::new(lit, device, queue, scene, view, &settings, &layers.targets()).unwrap();
        cases.add(format!("LitPicture, 8 samples, {name}"), move || {
            settings.sampling.seed += 1;
            picture.set(lit, device, queue, scene, view, &settings).unwrap();
            let mut state = LitState::Refining;
            while state != LitState::Done {
                host.run(|encoder| {
                    state = picture.record(lit, queue, encoder, scene, max_rays).unwrap().state;
                });
            }
        });
    }
    let mut live =
        LivePicture::new(lit, device, queue, scene, view, settings, &layers.targets()).unwrap();
    cases.add("LivePicture, a frame", move || {
        live.set(lit, device, queue, scene, view, settings).unwrap();
        host.run(|encoder| {
            live.record(lit, queue, encoder, scene).unwrap();
        });
    });
    cases.measure("a studio of 100,000 spheres, 1280x960");
}

/// What a host does from its first call to its first frame, after which it drops everything.
fn first_frame(host: &Host, layers: &Layers, options: &RendererOptions, is_all: bool) {
    let mut renderer = Renderer::begin(&host.device, options);
    if is_all {
        while renderer.build_next(&host.device).unwrap() > 0 {}
    }
    frame_of(host, layers, &mut renderer);
}

fn frame_of(host: &Host, layers: &Layers, renderer: &mut Renderer) {
    let Host { device, queue } = host;
    let spheres = vec![[0.3, 0.5, 0.5, 0.1], [0.5, 0.5, 0.5, 0.15], [0.7, 0.5, 0.5, 0.1]];
    let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
    let scene = SceneBuffers::new(renderer, device, queue, &scene).unwrap();
    let mut frame = Frame::new(renderer, device, &layers.targets()).unwrap();
    let (camera, film) = (camera(), Film::new(SIZE[0], SIZE[1]).unwrap());
    frame.set_view(queue, &scene, &View::new(&camera, film), &RenderSettings::default()).unwrap();
    for _ in 0..renderer.build_first(&scene, &frame).unwrap() {
        renderer.build_next(device).unwrap();
    }
    host.run(|encoder| renderer.record(encoder, &scene, &frame).unwrap());
}

fn three_spheres(host: &Host, layers: &Layers) {
    let all = &RendererOptions { data_layers: true, ..RendererOptions::default() };
    let cameras = vec![CameraKind::Pinhole];
    let one_camera = &RendererOptions { cameras, ..all.clone() };
    let structures = vec![Structure::List];
    let one = &RendererOptions { structures, several_bricks: false, ..one_camera.clone() };
    let mut cases = Cases::default();
    for (options, is_all, name) in [
        (all, true, "all pipelines"),
        (one_camera, true, "those of one camera"),
        (one, true, "those of one camera and structure"),
        (all, false, "those of the frame"),
    ] {
        cases.add(name, move || first_frame(host, layers, options, is_all));
    }
    let mut renderer = Renderer::begin(&host.device, one);
    while renderer.build_next(&host.device).unwrap() > 0 {}
    cases.add("a later frame, with a new scene", move || frame_of(host, layers, &mut renderer));
    cases.measure("three spheres, 1280x960, to the first frame");
}
