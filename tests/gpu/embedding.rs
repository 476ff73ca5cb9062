//! Tests of recording into the encoder and the textures of another application's device.

use std::sync::{Arc, Mutex};

use libtest_mimic::Trial;
use pinhole::accel::{AccelChoice, AccelPlan, BrickKind, Primitive, Structure};
use pinhole::camera::film::Film;
use pinhole::camera::{CameraKind, PinholeCamera};
use pinhole::gpu::{
    ColorTarget, DataTargets, Frame, GpuError, Headless, Renderer, RendererOptions, SceneBuffers,
    Targets, adapter, wgpu,
};
use pinhole::image::NO_ID;
use pinhole::{LinearRgb, RenderSettings, Scene};

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
    ]
}

/// An application with its own device, which has the default limits of WebGPU.
pub(crate) struct Host {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
}

impl Host {
    pub(crate) fn new() -> Self {
        Self::with_limits(wgpu::Limits::default())
    }

    pub(crate) fn with_limits(required_limits: wgpu::Limits) -> Self {
        let adapter = adapter::choose(None).unwrap();
        let descriptor =
            wgpu::DeviceDescriptor { required_limits, ..wgpu::DeviceDescriptor::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
        Self { device, queue }
    }

    pub(crate) fn texture(&self, size: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("host"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        })
    }

    pub(crate) fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Runs the encoder and returns the word in a buffer.
    fn submit_and_read_word(&self, mut encoder: wgpu::CommandEncoder, word: &wgpu::Buffer) -> u32 {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_buffer_to_buffer(word, 0, &buffer, 0, 4);
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
        self.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        let bytes = buffer.get_mapped_range(..).unwrap();
        u32::from_ne_bytes(bytes[..].try_into().unwrap())
    }

    /// Runs the encoder and returns the bytes of a texture.
    pub(crate) fn submit_and_read(
        &self,
        mut encoder: wgpu::CommandEncoder,
        texture: &wgpu::Texture,
    ) -> Vec<u8> {
        let used = texture.width() * texture.format().block_copy_size(None).unwrap();
        let row = used.next_multiple_of(256);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
        self.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        let bytes = buffer.get_mapped_range(..).unwrap();
        bytes.chunks(row as usize).flat_map(|row| row[..used as usize].to_vec()).collect()
    }
}

pub(crate) fn view_of(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn three_spheres() -> View {
    View::three_spheres()
}

pub(crate) fn size_of_film(film: &Film) -> [u32; 2] {
    [film.width(), film.height()]
}

/// The expected bytes, computed from the ids of the CPU reference, so that no rounding is involved.
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
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::GREEN),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..wgpu::RenderPassDescriptor::default()
    });
}

fn foreign_frame(_: &'static Headless) {
    let host = Host::new();
    let view = three_spheres();
    let size = size_of_film(&view.film);
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).unwrap();
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).unwrap();
    let target = host.texture(size, wgpu::TextureFormat::Rgba8Unorm);
    let target_view = view_of(&target);
    let targets = Targets { color: &target_view, data: None };
    let mut frame = Frame::new(&renderer, &host.device, &targets).unwrap();
    frame.set_view(&host.queue, &scene, &view.seen(), &view.settings).unwrap();

    // The application records its own commands for the same texture in the same encoder: a clear before, a copy after.
    let mut encoder = host.encoder();
    clear(&mut encoder, &target_view);
    renderer.record(&mut encoder, &scene, &frame).unwrap();
    let bytes = host.submit_and_read(encoder, &target);

    assert_eq!(bytes.len(), size[0] as usize * size[1] as usize * 4);
    assert!(bytes == expected_bytes(&view), "the texture differs from the reference");
}

/// If the hits of a picture do not fit into one buffer, the picture is rendered in two bands.
fn several_bands(_: &'static Headless) {
    let host = Host::new();
    let mut view = View::three_spheres();
    view.film = Film::new(2400, 1900).unwrap().with_y_axis(view.film.y_axis());
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).unwrap();
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).unwrap();
    let target = host.texture(size_of_film(&view.film), wgpu::TextureFormat::Rgba8Unorm);
    let targets = Targets { color: &view_of(&target), data: None };
    let mut frame = Frame::new(&renderer, &host.device, &targets).unwrap();
    frame.set_view(&host.queue, &scene, &view.seen(), &view.settings).unwrap();
    let mut encoder = host.encoder();
    renderer.record(&mut encoder, &scene, &frame).unwrap();
    let bytes = host.submit_and_read(encoder, &target);
    // In a picture this large, some pixels are so close to a silhouette that both colours are correct.
    let expected = expected_bytes(&view);
    let pixels = bytes.chunks(4).zip(expected.chunks(4));
    let different = pixels.filter(|(a, b)| a != b).count();
    assert!(different < 20, "{different} pixels differ from the reference");
}

fn several_views(_: &'static Headless) {
    let host = Host::new();
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).unwrap();
    let views = [three_spheres(), View::three_spheres_orthographic()];
    // Two frames of the same scene are recorded in one submission.
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &views[0].scene).unwrap();
    let mut encoder = host.encoder();
    let textures: Vec<wgpu::Texture> = views
        .iter()
        .map(|view| {
            let size = size_of_film(&view.film);
            let target = host.texture(size, wgpu::TextureFormat::Rgba8Unorm);
            let targets = Targets { color: &view_of(&target), data: None };
            let mut frame = Frame::new(&renderer, &host.device, &targets).unwrap();
            let View { camera, film, settings, .. } = view;
            frame
                .set_view(
                    &host.queue,
                    &scene,
                    &pinhole::View::new(camera.as_ref(), *film),
                    settings,
                )
                .unwrap();
            renderer.record(&mut encoder, &scene, &frame).unwrap();
            target
        })
        .collect();
    let first = host.submit_and_read(encoder, &textures[0]);
    let second = host.submit_and_read(host.encoder(), &textures[1]);
    assert!(first == expected_bytes(&views[0]), "pinhole");
    assert!(second == expected_bytes(&views[1]), "orthographic");
}

/// A kernel that reaches the iteration limit sets the status of the frame, until the application clears it.
fn given_up(_: &'static Headless) {
    let host = Host::new();
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).unwrap();
    let target = host.texture([24, 16], wgpu::TextureFormat::Rgba8Unorm);
    let targets = Targets { color: &view_of(&target), data: None };
    let mut frame = Frame::new(&renderer, &host.device, &targets).unwrap();
    let is_software = host.device.adapter_info().device_type == wgpu::DeviceType::Cpu;
    for (count, expected) in [(10, 0), (30_000, u32::from(is_software)), (10, 0)] {
        let spheres = spheres::nearly_coincident(count);
        let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
        let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.5).unwrap();
        let film = Film::new(24, 16).unwrap();
        let accel = AccelPlan::new(scene.spheres(), AccelChoice::Grid, 1 << 27);
        let accel = accel.build(scene.spheres());
        let buffers =
            SceneBuffers::with_accel(&renderer, &host.device, &host.queue, &scene, &accel).unwrap();
        frame
            .set_view(
                &host.queue,
                &buffers,
                &pinhole::View::new(&camera, film),
                &RenderSettings::default(),
            )
            .unwrap();
        let mut encoder = host.encoder();
        encoder.clear_buffer(frame.status(), 0, None);
        renderer.record(&mut encoder, &buffers, &frame).unwrap();
        assert_eq!(host.submit_and_read_word(encoder, frame.status()), expected, "{count}");
    }
}

fn unfit_targets(_: &'static Headless) {
    let host = Host::new();
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).unwrap();
    let refusal = |texture: &wgpu::Texture| {
        let targets = Targets { color: &view_of(texture), data: None };
        Frame::new(&renderer, &host.device, &targets).map(|_| ()).unwrap_err().to_string()
    };
    let wrong_format = host.texture([8, 8], wgpu::TextureFormat::Rgba16Float);
    let message = refusal(&wrong_format);
    assert!(message.contains("Rgba16Float") && message.contains("Rgba8Unorm"), "{message}");

    let with_data = RendererOptions { data_layers: true, ..RendererOptions::default() };
    let with_data = Renderer::new(&host.device, &with_data).unwrap();
    let good = host.texture([8, 8], ColorTarget::Srgb8.texture_format());
    let targets = Targets { color: &view_of(&good), data: None };
    let error = Frame::new(&with_data, &host.device, &targets).map(|_| ()).unwrap_err();
    assert!(matches!(error, GpuError::Target { layer: "data", .. }), "{error}");

    // No error reached the error handler of the application's device, which would have panicked.
}

fn data_layers(_: &'static Headless) {
    let host = Host::new();
    let view = View::three_spheres();
    let size = size_of_film(&view.film);
    let options = RendererOptions {
        color: ColorTarget::Linear16,
        data_layers: true,
        ..RendererOptions::default()
    };
    let renderer = Renderer::new(&host.device, &options).unwrap();
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).unwrap();
    let color = host.texture(size, wgpu::TextureFormat::Rgba16Float);
    let depth = host.texture(size, wgpu::TextureFormat::R32Float);
    let normal = host.texture(size, wgpu::TextureFormat::Rgba32Float);
    let id = host.texture(size, wgpu::TextureFormat::R32Uint);
    let data =
        DataTargets { depth: &view_of(&depth), normal: &view_of(&normal), id: &view_of(&id) };
    let targets = Targets { color: &view_of(&color), data: Some(data) };
    let mut frame = Frame::new(&renderer, &host.device, &targets).unwrap();
    frame.set_view(&host.queue, &scene, &view.seen(), &view.settings).unwrap();
    let mut encoder = host.encoder();
    renderer.record(&mut encoder, &scene, &frame).unwrap();
    let ids = host.submit_and_read(encoder, &id);
    let ids: Vec<u32> = bytemuck::pod_collect_to_vec(&ids);
    let reference = view.reference();
    assert!(ids == reference.id().unwrap(), "ids");
    let depths = host.submit_and_read(host.encoder(), &depth);
    let depths: Vec<f32> = bytemuck::pod_collect_to_vec(&depths);
    for (found, expected) in depths.iter().zip(reference.depth().unwrap()) {
        if expected.is_finite() {
            assert!((found - expected).abs() < 1e-4, "{found} is not {expected}");
        } else {
            assert_eq!(found.to_bits(), 1e30_f32.to_bits());
        }
    }
    // The red of the background is 0.4342 in linear light, rounded to the eleven bits of a half float.
    let colors = host.submit_and_read(host.encoder(), &color);
    let red = u16::from_le_bytes([colors[0], colors[1]]);
    assert_eq!((red >> 10, red & 0x3ff), (13, 754), "{red:#x}");
}

fn hosts_handler(_: &'static Headless) {
    let host = Host::new();
    let reached = Arc::new(Mutex::new(Vec::new()));
    let handler = Arc::clone(&reached);
    host.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        handler.lock().unwrap().push(error.to_string());
    }));
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).unwrap();
    let target = host.texture([8, 8], ColorTarget::Srgb8.texture_format());
    // Only wgpu can detect that this view has layers.
    let layered = target.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..wgpu::TextureViewDescriptor::default()
    });
    let targets = Targets { color: &layered, data: None };
    let error = Frame::new(&renderer, &host.device, &targets).map(|_| ()).unwrap_err();
    assert!(matches!(error, GpuError::Device { .. }), "{error}");
    assert_eq!(*reached.lock().unwrap(), Vec::<String>::new());
}

/// Frames support primary rays only. Other settings are an error, and nothing is recorded.
fn lit_frame(_: &'static Headless) {
    let host = Host::new();
    let view = three_spheres();
    let size = size_of_film(&view.film);
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).unwrap();
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).unwrap();
    let target = host.texture(size, wgpu::TextureFormat::Rgba8Unorm);
    let targets = Targets { color: &view_of(&target), data: None };
    let mut frame = Frame::new(&renderer, &host.device, &targets).unwrap();
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
    let options =
        RendererOptions { cameras: vec![CameraKind::Orthographic], ..RendererOptions::default() };
    let renderer = Renderer::new(&host.device, &options).unwrap();
    let view = three_spheres();
    let scene = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).unwrap();
    let small = host.texture([8, 8], wgpu::TextureFormat::Rgba8Unorm);
    let targets = Targets { color: &view_of(&small), data: None };
    let mut frame = Frame::new(&renderer, &host.device, &targets).unwrap();
    let mut encoder = host.encoder();
    assert_eq!(renderer.record(&mut encoder, &scene, &frame), Err(GpuError::NoView));
    let again = SceneBuffers::new(&renderer, &host.device, &host.queue, &view.scene).unwrap();

    let mut set_view = |film: &Film| {
        frame.set_view(
            &host.queue,
            &scene,
            &pinhole::View::new(view.camera.as_ref(), *film),
            &view.settings,
        )
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
    let linear = Renderer::new(&host.device, &linear).unwrap();
    assert_eq!(linear.record(&mut encoder, &scene, &frame), Err(GpuError::OtherRenderer));
    // The encoder can still be used.
    host.queue.submit([encoder.finish()]);
}
