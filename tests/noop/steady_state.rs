//! Tests that recording a frame creates, submits, awaits and reads back nothing. They count the
//! calls of a thread that wgpu logs.

use std::cell::RefCell;
use std::sync::Once;

use pinhole::accel::AccelChoice;
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::gpu::{
    LitPicture, LitRenderer, LitState, LivePicture, Renderer, RendererOptions, SceneBuffers, Wait, wgpu,
};
use pinhole::{RenderSettings, View};

use crate::host_program::Host;
use crate::{SIZE, film, pinhole_camera, ready, scene};

/// Numbers of calls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Calls {
    /// Resources of any kind that were created.
    pub(crate) created: u32,
    /// Writes that were queued. wgpu copies the written data to its own memory.
    pub(crate) writes: u32,
    pub(crate) submitted: u32,
    /// Calls that wait for the device or ask whether it is done.
    pub(crate) waited: u32,
    /// Calls that map memory of the device or read it.
    pub(crate) mapped: u32,
    /// All calls that are logged.
    pub(crate) all: u32,
}

thread_local! {
    static CALLS: RefCell<Calls> = const { RefCell::new(Calls {
        created: 0, writes: 0, submitted: 0, waited: 0, mapped: 0, all: 0,
    }) };
}

struct Counter;

impl log::Log for Counter {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.target().starts_with("wgpu_core")
    }

    fn log(&self, record: &log::Record<'_>) {
        if !self.enabled(record.metadata()) {
            return;
        }
        let line = record.args().to_string();
        let starts = |with: &str| line.starts_with(with);
        CALLS.with_borrow_mut(|calls| {
            let waits = ["Device::poll", "poll_all_devices", "Queue::on_submitted_work_done"];
            if starts("Device::create_") || starts("Texture::create_") {
                calls.created += 1;
            } else if starts("Queue::write_") {
                calls.writes += 1;
            } else if line == "Queue::submit" {
                calls.submitted += 1;
            } else if waits.into_iter().any(starts) {
                calls.waited += 1;
            } else if starts("Buffer::map_async") || starts("Buffer::get_mapped_range") {
                calls.mapped += 1;
            }
            calls.all += 1;
        });
    }

    fn flush(&self) {}
}

/// The calls that `work` makes on this thread.
pub(crate) fn calls_of<T>(work: impl FnOnce() -> T) -> (Calls, T) {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        log::set_logger(&Counter).unwrap();
        log::set_max_level(log::LevelFilter::Trace);
    });
    CALLS.take();
    let result = work();
    (CALLS.take(), result)
}

/// The counts below are meaningful: each kind of call is seen.
#[test]
fn every_kind_of_call_is_counted() {
    let host = Host::new();
    let buffer = |usage| {
        host.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 16,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    };
    let (created, buffer) = calls_of(|| buffer(wgpu::BufferUsages::MAP_READ));
    assert_eq!(created.created, 1, "{created:?}");
    let (written, ()) = calls_of(|| host.queue.write_buffer(&buffer, 0, &[0; 16]));
    assert_eq!(written.writes, 1, "{written:?}");
    let (submitted, _) = calls_of(|| host.queue.submit([]));
    assert_eq!(submitted.submitted, 1, "{submitted:?}");
    let (mapped, ()) = calls_of(|| buffer.map_async(wgpu::MapMode::Read, .., |_| {}));
    assert_eq!(mapped.mapped, 1, "{mapped:?}");
    let (waited, polled) = calls_of(|| host.device.poll(wgpu::PollType::wait_indefinitely()));
    polled.unwrap();
    assert_eq!(waited.waited, 1, "{waited:?}");
}

#[test]
fn recording_creates_submits_awaits_and_reads_nothing() {
    let host = Host::new();
    for data_layers in [false, true] {
        let options = RendererOptions { data_layers, ..RendererOptions::default() };
        let (built, renderer) = calls_of(|| Renderer::new(&host.device, &options).wait().unwrap());
        assert!(built.created > 10, "{built:?}");
        let (scene, mut frame) = ready(&host, &renderer, &options);
        for _ in 0..3 {
            let camera = pinhole_camera();
            let view = View::new(&camera, film());
            let settings = RenderSettings::default();
            let (set, done) = calls_of(|| frame.set_view(&host.queue, &scene, &view, &settings));
            done.unwrap();
            // A single write of less than a kilobyte.
            assert_eq!(set, Calls { writes: 1, all: set.all, ..Calls::default() });
            let mut encoder = host.encoder();
            let (recorded, done) = calls_of(|| renderer.record(&mut encoder, &scene, &frame));
            done.unwrap();
            assert_eq!(recorded, Calls { all: recorded.all, ..Calls::default() });
            host.queue.submit([encoder.finish()]);
        }
    }
}

fn lit_renderer(host: &Host) -> (RendererOptions, SceneBuffers, LitRenderer) {
    let options = RendererOptions { data_layers: true, ..RendererOptions::default() };
    let renderer = Renderer::new(&host.device, &options).wait().unwrap();
    let scene = host.scene(&renderer, &scene(), AccelChoice::Auto, 1 << 27);
    (options, scene, LitRenderer::new(renderer))
}

/// Lit pictures allocate nothing while the camera moves and while samples accumulate. When a recording is submitted, it
/// asks for a few bytes to be mapped, and it reads the bytes of an earlier recording.
#[test]
fn lit_pictures_create_submit_and_await_nothing() {
    let host = Host::new();
    let (device, queue) = (&host.device, &host.queue);
    let (options, scene, lit) = lit_renderer(&host);
    for settings in [RenderSettings::studio(), RenderSettings::path()] {
        let camera = pinhole_camera();
        let pose = Pose::looking_at([0.5, 1.0, 12.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
        let moved_camera = PinholeCamera::with_vertical_fov(pose, 0.7, 1.5).unwrap();
        let view = View::new(&camera, film());
        let mut picture = host.with_targets(&options, SIZE, |targets| {
            LitPicture::new(&lit, device, queue, &scene, &view, &settings, targets).wait().unwrap()
        });
        let mut record = |moves: bool| {
            let moved = if moves { moved_camera } else { camera };
            let view = View::new(&moved, film());
            let (set, begins_again) = calls_of(|| picture.set(&lit, device, queue, &scene, &view, &settings).wait());
            assert_eq!(begins_again.unwrap(), moves);
            assert_eq!(set, Calls { writes: set.writes, all: set.all, ..Calls::default() });
            assert!(set.writes <= if moves { 4 } else { 0 }, "{set:?}");
            let mut encoder = host.encoder();
            let (recorded, done) = calls_of(|| picture.record(&lit, queue, &mut encoder, &scene, 1 << 16));
            let mapped = recorded.mapped;
            let only = Calls { writes: 1, mapped, all: recorded.all, ..Calls::default() };
            assert_eq!(recorded, only);
            assert!(mapped <= 1, "{recorded:?}");
            let done = done.unwrap();
            assert!(done.rays > 0 && done.state == LitState::Refining && !done.was_lost, "{done:?}");
            queue.submit([encoder.finish()]);
            device.poll(wgpu::PollType::Poll).unwrap();
        };
        record(false);
        record(true);
    }
}

/// Live pictures allocate nothing while the camera and the lamps move.
#[test]
fn live_pictures_create_submit_and_await_nothing() {
    let host = Host::new();
    let (device, queue) = (&host.device, &host.queue);
    let (options, scene, lit) = lit_renderer(&host);
    let settings = RenderSettings::studio();
    let camera = pinhole_camera();
    let view = View::new(&camera, film());
    let mut picture = host.with_targets(&options, SIZE, |targets| {
        LivePicture::new(&lit, device, queue, &scene, &view, &settings, targets).wait().unwrap()
    });
    for frame in 0..4 {
        let eye = [0.2 * f64::from(frame), 1.0, 12.0];
        let pose = Pose::looking_at(eye, [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.7, 1.5).unwrap();
        let view = View::new(&camera, film());
        let (set, done) = calls_of(|| picture.set(&lit, device, queue, &scene, &view, &settings).wait());
        done.unwrap();
        assert_eq!(set, Calls { writes: set.writes, all: set.all, ..Calls::default() });
        assert!((1..=3).contains(&set.writes), "{set:?}");
        let mut encoder = host.encoder();
        let (recorded, done) = calls_of(|| picture.record(&lit, queue, &mut encoder, &scene));
        let (mapped, all) = (recorded.mapped, recorded.all);
        assert_eq!(recorded, Calls { writes: 2, mapped, all, ..Calls::default() });
        assert!(mapped <= 1, "{recorded:?}");
        let done = done.unwrap();
        assert!(done.rays > 0 && !done.was_lost, "{done:?}");
        queue.submit([encoder.finish()]);
        device.poll(wgpu::PollType::Poll).unwrap();
    }
}
