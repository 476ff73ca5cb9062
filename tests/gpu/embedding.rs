//! Tests of recording into the encoder and the textures of another application's device, and of the async forms. These
//! make the same pictures as the blocking forms, and return while the device works.

use std::pin::{Pin, pin};
use std::sync::{Arc, Mutex};
use std::task::Poll;

use libtest_mimic::Trial;
use pinhole::accel::{AccelChoice, BrickKind, Primitive, Structure};
use pinhole::camera::film::Film;
use pinhole::camera::{CameraKind, PinholeCamera};
use pinhole::gpu::{
    ColorTarget, Frame, GpuError, Headless, Renderer, RendererOptions, SceneBuffers, Targets, Wait, adapter, wgpu,
};
use pinhole::image::NO_ID;
use pinhole::{LayerSet, LinearRgb, RenderSettings, Scene};

use crate::host_program::{Drawing, Host, view_of};
use crate::support::appearances::settings;
use crate::support::{View, spheres};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("embedding::a_foreign_encoder_gets_the_spheres_in_its_texture", foreign_frame),
        trial("embedding::a_picture_larger_than_one_band", several_bands),
        trial("embedding::one_encoder_holds_several_views", several_views),
        trial("embedding::linear_colors_and_data_layers_in_the_hosts_textures", data_layers),
        trial("embedding::what_wgpu_refuses_never_reaches_the_hosts_handler", hosts_handler),
        trial("embedding::a_host_learns_that_rays_were_given_up", given_up),
        trial("embedding::unfit_targets_are_refused", unfit_targets),
        trial("embedding::what_is_not_ready_is_refused", not_ready),
        trial("embedding::a_lit_picture_in_a_hosts_frame_is_refused", lit_frame),
        trial("async_forms::they_make_the_pictures_of_the_blocking_forms", same_pictures),
        trial("async_forms::two_renders_on_one_thread_take_turns", turns),
        trial("async_forms::a_render_that_is_given_up_blocks_nobody", dropped),
        trial("async_forms::a_renderer_built_in_pieces_draws_the_spheres", pieces),
    ]
}

/// A host whose device has the default limits of WebGPU.
impl Host {
    pub(crate) fn new() -> Self {
        Self::with_limits(wgpu::Limits::default())
    }

    pub(crate) fn with_limits(required_limits: wgpu::Limits) -> Self {
        let adapter = adapter::choose(None).wait().unwrap();
        let descriptor = wgpu::DeviceDescriptor { required_limits, ..wgpu::DeviceDescriptor::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
        Self { device, queue }
    }
}

pub(crate) fn size_of_film(film: &Film) -> [u32; 2] {
    [film.width(), film.height()]
}

/// The expected bytes. They are computed from the ids of the CPU reference, so that no rounding is involved.
pub(crate) fn expected_bytes(view: &View) -> Vec<u8> {
    let reference = view.reference();
    let background = view.settings.background;
    let color = |id: &u32| {
        if *id == NO_ID { background } else { view.scene.color(*id) }
    };
    let rgba = |id| {
        let [r, g, b] = color(id).to_srgb8();
        [r, g, b, 255]
    };
    reference.id().unwrap().iter().flat_map(rgba).collect()
}

/// A render pass of the application.
fn clear(encoder: &mut wgpu::CommandEncoder, target: &wgpu::TextureView) {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::GREEN), store: wgpu::StoreOp::Store },
        })],
        ..wgpu::RenderPassDescriptor::default()
    });
}

fn foreign_frame(_: &'static Headless) {
    let host = Host::new();
    let view = View::three_spheres();
    let size = size_of_film(&view.film);
    let Drawing { renderer, layers, mut frame } = Drawing::new(&host, &RendererOptions::default(), size);
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).wait().unwrap();
    frame.set_view(&host.queue, &scene, &view.seen(), &view.settings).unwrap();

    // The application records its own commands for the same texture in the same encoder: a clear before, a copy after.
    let mut encoder = host.encoder();
    clear(&mut encoder, &view_of(&layers.color));
    renderer.record(&mut encoder, &scene, &frame).unwrap();
    let bytes: Vec<u8> = host.submit_and_read(encoder, &layers.color);

    assert_eq!(bytes.len(), size[0] as usize * size[1] as usize * 4);
    assert!(bytes == expected_bytes(&view), "the texture differs from the reference");
}

/// If the hits of a picture do not fit into one buffer, the picture is rendered in two bands.
fn several_bands(_: &'static Headless) {
    let host = Host::new();
    let mut view = View::three_spheres();
    view.film = Film::new(2400, 1900).unwrap().with_y_axis(view.film.y_axis());
    let mut drawing = Drawing::new(&host, &RendererOptions::default(), size_of_film(&view.film));
    let scene = drawing.scene(&host, &view.scene);
    let encoder = drawing.record(&host, &scene, &view.seen(), &view.settings);
    let bytes: Vec<u8> = host.submit_and_read(encoder, &drawing.layers.color);
    // In a picture this large, some pixels are so close to a silhouette that both colours are correct.
    let expected = expected_bytes(&view);
    let pixels = bytes.chunks(4).zip(expected.chunks(4));
    let different = pixels.filter(|(a, b)| a != b).count();
    assert!(different < 20, "{different} pixels differ from the reference");
}

fn several_views(_: &'static Headless) {
    let host = Host::new();
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).wait().unwrap();
    let views = [View::three_spheres(), View::three_spheres_orthographic()];
    // Two frames of the same scene are recorded in one submission.
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &views[0].scene).wait().unwrap();
    let mut encoder = host.encoder();
    let textures = views.each_ref().map(|view| {
        let layers = host.layers(size_of_film(&view.film), wgpu::TextureFormat::Rgba8Unorm);
        let mut frame = layers.frame(&renderer, &host.device, false);
        frame.set_view(&host.queue, &scene, &view.seen(), &view.settings).unwrap();
        renderer.record(&mut encoder, &scene, &frame).unwrap();
        layers.color
    });
    host.submit(encoder);
    for (view, texture) in views.iter().zip(&textures) {
        let found: Vec<u8> = host.read(texture);
        assert!(found == expected_bytes(view), "{:?}", view.camera.kind());
    }
}

/// A kernel that reaches the iteration limit sets the status of the frame, until the application clears it.
fn given_up(_: &'static Headless) {
    let host = Host::new();
    let Drawing { renderer, mut frame, .. } = Drawing::new(&host, &RendererOptions::default(), [24, 16]);
    let is_software = host.device.adapter_info().device_type == wgpu::DeviceType::Cpu;
    for (count, expected) in [(10, 0), (30_000, u32::from(is_software)), (10, 0)] {
        let spheres = spheres::nearly_coincident(count);
        let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
        let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.5).unwrap();
        let buffers = host.scene(&renderer, &scene, AccelChoice::Grid, 1 << 27);
        let view = pinhole::View::new(&camera, Film::new(24, 16).unwrap());
        frame.set_view(&host.queue, &buffers, &view, &RenderSettings::default()).unwrap();
        let mut encoder = host.encoder();
        encoder.clear_buffer(frame.status(), 0, None);
        renderer.record(&mut encoder, &buffers, &frame).unwrap();
        assert_eq!(host.submit_and_read_word(encoder, frame.status()), expected, "{count}");
    }
}

fn unfit_targets(_: &'static Headless) {
    let host = Host::new();
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).wait().unwrap();
    let refusal = |texture: &wgpu::Texture| {
        let targets = Targets { color: &view_of(texture), data: None };
        Frame::new(&renderer, &host.device, &targets).wait().map(|_| ()).unwrap_err().to_string()
    };
    let wrong_format = host.texture([8, 8], wgpu::TextureFormat::Rgba16Float);
    let message = refusal(&wrong_format);
    assert!(message.contains("Rgba16Float") && message.contains("Rgba8Unorm"), "{message}");

    let with_data = RendererOptions { data_layers: true, ..RendererOptions::default() };
    let with_data = Renderer::new(&host.device, &with_data).wait().unwrap();
    let good = host.texture([8, 8], ColorTarget::Srgb8.texture_format());
    let targets = Targets { color: &view_of(&good), data: None };
    let error = Frame::new(&with_data, &host.device, &targets).wait().map(|_| ()).unwrap_err();
    assert!(matches!(error, GpuError::Target { layer: "data", .. }), "{error}");

    // No error reached the error handler of the application's device, which would have panicked.
}

fn data_layers(_: &'static Headless) {
    let host = Host::new();
    let view = View::three_spheres();
    let options = RendererOptions { color: ColorTarget::Linear16, data_layers: true, ..RendererOptions::default() };
    let mut drawing = Drawing::new(&host, &options, size_of_film(&view.film));
    let scene = drawing.scene(&host, &view.scene);
    let encoder = drawing.record(&host, &scene, &view.seen(), &view.settings);
    let ids: Vec<u32> = host.submit_and_read(encoder, &drawing.layers.id);
    let reference = view.reference();
    assert!(ids == reference.id().unwrap(), "ids");
    let depths: Vec<f32> = host.read(&drawing.layers.depth);
    for (found, expected) in depths.iter().zip(reference.depth().unwrap()) {
        if expected.is_finite() {
            assert!((found - expected).abs() < 1e-4, "{found} is not {expected}");
        } else {
            assert_eq!(found.to_bits(), 1e30_f32.to_bits());
        }
    }
    // The red of the background is 0.4342 in linear light, rounded to the eleven bits of a half float.
    let red = host.read::<u16>(&drawing.layers.color)[0];
    assert_eq!((red >> 10, red & 0x3ff), (13, 754), "{red:#x}");
}

fn hosts_handler(_: &'static Headless) {
    let host = Host::new();
    let reached = Arc::new(Mutex::new(Vec::new()));
    let handler = Arc::clone(&reached);
    host.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        handler.lock().unwrap().push(error.to_string());
    }));
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).wait().unwrap();
    let target = host.texture([8, 8], ColorTarget::Srgb8.texture_format());
    // Only wgpu can detect that this view has layers.
    let layered = target.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..wgpu::TextureViewDescriptor::default()
    });
    let targets = Targets { color: &layered, data: None };
    let error = Frame::new(&renderer, &host.device, &targets).wait().map(|_| ()).unwrap_err();
    assert!(matches!(error, GpuError::Device { .. }), "{error}");
    assert_eq!(*reached.lock().unwrap(), Vec::<String>::new());
}

/// Frames support primary rays only. Other settings are an error, and nothing is recorded.
fn lit_frame(_: &'static Headless) {
    let host = Host::new();
    let view = View::three_spheres();
    let size = size_of_film(&view.film);
    let Drawing { renderer, mut frame, .. } = Drawing::new(&host, &RendererOptions::default(), size);
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).wait().unwrap();
    for settings in [RenderSettings::studio(), RenderSettings::path()] {
        let refused = frame.set_view(&host.queue, &scene, &view.seen(), &settings);
        let integrator = settings.integrator.name();
        assert_eq!(refused, Err(GpuError::NotPrimary { integrator }));
    }
    let mut encoder = host.encoder();
    assert_eq!(renderer.record(&mut encoder, &scene, &frame), Err(GpuError::NoView));
}

fn not_ready(_: &'static Headless) {
    let host = Host::new();
    let options = RendererOptions { cameras: vec![CameraKind::Orthographic], ..RendererOptions::default() };
    let Drawing { renderer, mut frame, .. } = Drawing::new(&host, &options, [8, 8]);
    let view = View::three_spheres();
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).wait().unwrap();
    let mut encoder = host.encoder();
    assert_eq!(renderer.record(&mut encoder, &scene, &frame), Err(GpuError::NoView));
    let again = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).wait().unwrap();

    let mut set_view = |film: &Film| {
        let view_of_film = pinhole::View::new(view.camera.as_ref(), *film);
        frame.set_view(&host.queue, &scene, &view_of_film, &view.settings)
    };
    assert!(matches!(set_view(&view.film), Err(GpuError::Target { .. })));
    set_view(&Film::new(8, 8).unwrap()).unwrap();
    assert_eq!(
        renderer.record(&mut encoder, &scene, &frame),
        Err(GpuError::NoPipeline {
            camera: CameraKind::Pinhole,
            kind: BrickKind { structure: Structure::List, primitive: Primitive::Sphere }
        })
    );
    assert_eq!(renderer.record(&mut encoder, &again, &frame), Err(GpuError::OtherScene));
    let linear = RendererOptions { color: ColorTarget::Linear16, ..options };
    let linear = Renderer::new(&host.device, &linear).wait().unwrap();
    assert_eq!(linear.record(&mut encoder, &scene, &frame), Err(GpuError::OtherRenderer));
    // The encoder can still be used.
    host.queue.submit([encoder.finish()]);
}

/// Runs a future by an executor that knows nothing of devices, and returns how often the future returned unfinished.
fn run<T>(future: impl Future<Output = T>) -> (u32, T) {
    let mut future = pin!(future);
    let mut unfinished = 0;
    let result = pollster::block_on(std::future::poll_fn(|context| {
        let polled = future.as_mut().poll(context);
        unfinished += u32::from(polled.is_pending());
        polled
    }));
    (unfinished, result)
}

fn same_pictures(headless: &'static Headless) {
    let view = View::three_spheres();
    for mut settings in settings() {
        settings.sampling.denoise = !settings.integrator.is_primary();
        let expected = headless.render(&view.scene, &view.seen(), &settings, LayerSet::ALL).wait().unwrap();
        let seen = view.seen();
        // The speed of the device determines how often it returned unfinished.
        let (_, found) = run(headless.render(&view.scene, &seen, &settings, LayerSet::ALL));
        assert!(found.unwrap() == expected, "{}", settings.integrator.name());
    }
}

fn turns(headless: &'static Headless) {
    let view = View::three_spheres();
    let seen = view.seen();
    let [first, second, _] = settings();
    let expected = [&first, &second]
        .map(|settings| headless.render(&view.scene, &seen, settings, LayerSet::COLOR).wait().unwrap());
    type Render<'a> = Pin<Box<dyn Future<Output = Result<pinhole::Image, GpuError>> + 'a>>;
    let mut renders: [Option<Render<'_>>; 2] = [&first, &second].map(|settings| {
        let render = headless.render(&view.scene, &seen, settings, LayerSet::COLOR);
        Some(Box::pin(render) as Render<'_>)
    });
    let mut found = [None, None];
    pollster::block_on(std::future::poll_fn(|context| {
        for (render, found) in renders.iter_mut().zip(&mut found) {
            if let Some(Poll::Ready(image)) = render.as_mut().map(|f| f.as_mut().poll(context)) {
                *found = Some(image.unwrap());
                *render = None;
            }
        }
        if renders.iter().all(Option::is_none) { Poll::Ready(()) } else { Poll::Pending }
    }));
    assert!(found == expected.map(Some));
}

/// A render that was begun and dropped, while it waited for any of its submissions, neither holds the
/// device nor makes the next render fail.
fn dropped(headless: &'static Headless) {
    let view = View::three_spheres();
    let seen = view.seen();
    let [primary, studio, _] = settings();
    for settings in [primary, studio] {
        let render = || headless.render(&view.scene, &seen, &settings, LayerSet::ALL);
        let (submissions, expected) = run(render());
        let expected = expected.unwrap();
        for waited in 1..=submissions {
            let mut begun = Box::pin(render());
            let mut unfinished = 0;
            pollster::block_on(std::future::poll_fn(|context| {
                // The number of submissions adapts to the device, so this render may need fewer.
                if begun.as_mut().poll(context).is_ready() {
                    return Poll::Ready(());
                }
                unfinished += 1;
                if unfinished == waited { Poll::Ready(()) } else { Poll::Pending }
            }));
            drop(begun);
            let again = headless.render(&view.scene, &seen, &settings, LayerSet::ALL).wait();
            assert!(again.unwrap() == expected, "given up at wait {waited}");
        }
    }
}

fn pieces(_: &'static Headless) {
    let host = Host::new();
    let view = View::three_spheres();
    let (device, queue) = (&host.device, &host.queue);
    let mut renderer = Renderer::begin(device, &RendererOptions::default());
    let scene = SceneBuffers::new(&renderer, device, queue, &view.scene).wait().unwrap();
    let layers = host.layers(size_of_film(&view.film), wgpu::TextureFormat::Rgba8Unorm);
    let mut frame = layers.frame(&renderer, device, false);
    frame.set_view(queue, &scene, &view.seen(), &view.settings).unwrap();
    let mut encoder = host.encoder();
    let mut refused = 0;
    while let Err(error) = renderer.record(&mut encoder, &scene, &frame) {
        assert!(matches!(error, GpuError::NotReady { .. }), "{error}");
        refused += 1;
        renderer.build_next(device).unwrap();
    }
    assert!(refused > 0);
    assert!(host.submit_and_read::<u8>(encoder, &layers.color) == expected_bytes(&view));
}
