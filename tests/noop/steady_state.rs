//! What recording a frame costs a host: nothing is created, submitted, awaited or read back.

use pinhole::gpu::{Renderer, RendererOptions, wgpu};
use pinhole::{RenderSettings, View};

use crate::calls::{self, Calls};
use crate::{Host, film, pinhole_camera, ready};

/// The counts below mean something: each kind of call is seen.
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
    let (created, buffer) = calls::of(|| buffer(wgpu::BufferUsages::MAP_READ));
    assert_eq!(created.created, 1, "{created:?}");
    let (written, ()) = calls::of(|| host.queue.write_buffer(&buffer, 0, &[0; 16]));
    assert_eq!(written.writes, 1, "{written:?}");
    let (submitted, _) = calls::of(|| host.queue.submit([]));
    assert_eq!(submitted.submitted, 1, "{submitted:?}");
    let (mapped, ()) = calls::of(|| buffer.map_async(wgpu::MapMode::Read, .., |_| {}));
    assert_eq!(mapped.mapped, 1, "{mapped:?}");
    let (waited, polled) = calls::of(|| host.device.poll(wgpu::PollType::wait_indefinitely()));
    polled.unwrap();
    assert_eq!(waited.waited, 1, "{waited:?}");
}

#[test]
fn recording_creates_submits_awaits_and_reads_nothing() {
    let host = Host::new();
    for data_layers in [false, true] {
        let options = RendererOptions { data_layers, ..RendererOptions::default() };
        let (built, renderer) = calls::of(|| Renderer::new(&host.device, &options).unwrap());
        assert!(built.created > 10, "{built:?}");
        let (scene, mut frame) = ready(&host, &renderer, &options);
        for _ in 0..3 {
            let camera = pinhole_camera();
            let view = View::new(&camera, film());
            let settings = RenderSettings::default();
            let (set, done) = calls::of(|| frame.set_view(&host.queue, &scene, &view, &settings));
            done.unwrap();
            // One write of less than a kilobyte.
            assert_eq!(set, Calls { writes: 1, all: set.all, ..Calls::default() });
            let mut encoder = host.encoder();
            let (recorded, done) = calls::of(|| renderer.record(&mut encoder, &scene, &frame));
            done.unwrap();
            assert_eq!(recorded, Calls { all: recorded.all, ..Calls::default() });
            host.queue.submit([encoder.finish()]);
        }
    }
}
