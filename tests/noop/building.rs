//! Tests of renderers that are built on another thread, one pipeline at a time, or by async forms. On a native device
//! these never wait for one another.

use std::pin::pin;
use std::task::{Context, Poll, Waker};
use std::thread;

use pinhole::camera::{CameraKind, DepthOrder, HostCamera};
use pinhole::gpu::{
    DepthTest, Frame, GpuError, Headless, HeadlessOptions, HostDepth, LitPicture, LitRenderer, LivePicture, Recolor,
    Renderer, RendererOptions, SceneBuffers, Wait, adapter, wgpu,
};
use pinhole::internals::ShaderEdit;

use crate::host_program::{Host, view_of};
use crate::steady_state::{Calls, calls_of};
use crate::{SIZE, ready, scene};

#[test]
fn everything_may_be_shared_between_threads() {
    fn shared<T: Send + Sync + 'static>() {}
    shared::<Renderer>();
    shared::<SceneBuffers>();
    shared::<Frame>();
    shared::<LitPicture>();
    shared::<LitRenderer>();
    shared::<LivePicture>();
    shared::<Recolor>();
    shared::<Headless>();
    shared::<GpuError>();
}

#[test]
fn a_renderer_is_built_on_another_thread() {
    let host = Host::new();
    let options = RendererOptions::default();
    let (device, of_thread) = (host.device.clone(), options.clone());
    let thread = thread::spawn(move || Renderer::new(&device, &of_thread).wait());
    let renderer = thread.join().unwrap().unwrap();
    let (scene, frame) = ready(&host, &renderer, &options);
    renderer.record(&mut host.encoder(), &scene, &frame).unwrap();
}

/// Scenes and frames can be made at once. A frame is recorded when its own pipelines are built.
#[test]
fn a_renderer_is_built_piece_by_piece() {
    let host = Host::new();
    let cameras = vec![CameraKind::Pinhole, CameraKind::Orthographic];
    let options = RendererOptions { cameras, ..RendererOptions::default() };
    let mut renderer = Renderer::begin(&host.device, &options);
    let (scene, frame) = ready(&host, &renderer, &options);
    let mut encoder = host.encoder();
    let (calls, refused) = calls_of(|| renderer.record(&mut encoder, &scene, &frame).unwrap_err());
    let GpuError::NotReady { remaining: all } = refused else { panic!("{refused}") };
    assert_eq!(calls, Calls::default(), "nothing is recorded of a frame that is not ready");
    assert_eq!(all % 2, 0, "the pipelines of two cameras");
    for remaining in (0..all).rev() {
        assert_eq!(renderer.build_next(&host.device), Ok(remaining));
        let recorded = renderer.record(&mut host.encoder(), &scene, &frame);
        if remaining <= all / 2 {
            assert_eq!(recorded, Ok(()), "the pipelines of the first camera are built");
        } else if remaining == all - 1 {
            assert_eq!(recorded, Err(GpuError::NotReady { remaining }));
        }
    }
    assert_eq!(renderer.build_next(&host.device), Ok(0));
}

/// The pipelines of a frame are built before the others, regardless of the order of the options.
#[test]
fn the_pipelines_of_a_frame_are_built_first() {
    let host = Host::new();
    let cameras = vec![CameraKind::Orthographic, CameraKind::Pinhole];
    let options = RendererOptions { cameras, data_layers: true, ..RendererOptions::default() };
    let mut renderer = Renderer::begin(&host.device, &options);
    let (scene, frame) = ready(&host, &renderer, &options);
    let all = renderer.build_next(&host.device).unwrap();
    assert_eq!(renderer.build_first(&scene, &frame), Ok(2), "the search, and the shading");
    for built in 1..=2 {
        let recorded = renderer.record(&mut host.encoder(), &scene, &frame);
        assert!(matches!(recorded, Err(GpuError::NotReady { .. })), "{recorded:?}");
        assert_eq!(renderer.build_next(&host.device), Ok(all - built));
    }
    assert_eq!(renderer.build_first(&scene, &frame), Ok(0));
    renderer.record(&mut host.encoder(), &scene, &frame).unwrap();

    // With the depth of a host, other pipelines are needed, and nothing is recorded until they are built.
    let (test, depth) = host_depth(&host, &renderer, &frame);
    let mut encoder = host.encoder();
    let (calls, refused) =
        calls_of(|| renderer.record_with_depth(&mut encoder, &scene, &frame, &test, &depth).unwrap_err());
    assert!(matches!(refused, GpuError::NotReady { .. }), "{refused}");
    assert_eq!(calls, Calls::default());
    while renderer.build_next(&host.device).unwrap() > 0 {}
    renderer.record_with_depth(&mut encoder, &scene, &frame, &test, &depth).unwrap();
}

/// The depth of a host whose targets have the size of the frame.
fn host_depth(host: &Host, renderer: &Renderer, frame: &Frame) -> (DepthTest, HostDepth) {
    let view = view_of(&host.texture(SIZE, wgpu::TextureFormat::Depth32Float));
    let test = DepthTest::new(renderer, &host.device).wait().unwrap();
    let mut depth = HostDepth::new(&test, &host.device, &view).wait().unwrap();
    let identity = [[1., 0., 0., 0.], [0., 1., 0., 0.], [0., 0., 1., 0.], [0., 0., 0., 1.]];
    let projection = [[1., 0., 0., 0.], [0., 1., 0., 0.], [0., 0., 0., -1.], [0., 0., 0.1, 0.]];
    let camera = HostCamera::new(identity, projection, DepthOrder::NearIsOne).unwrap();
    depth.set_camera(&host.queue, &camera, frame, [0, 0]).unwrap();
    (test, depth)
}

#[test]
fn a_refused_kernel_ends_the_building() {
    let host = Host::new();
    let options = RendererOptions { edits: vec![broken()], ..RendererOptions::default() };
    let mut renderer = Renderer::begin(&host.device, &options);
    let refused = renderer.build_next(&host.device).unwrap_err();
    assert!(matches!(refused, GpuError::Device { .. }), "{refused}");
    assert_eq!(renderer.build_next(&host.device), Err(refused));
}

/// Polls a future once. Native devices answer at once, so nothing is ever awaited.
fn at_once<T>(future: impl Future<Output = T> + Send) -> T {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => panic!("a native device answers at once"),
    }
}

#[test]
fn everything_is_made_without_waiting() {
    let host = Host::new();
    let options = RendererOptions::default();
    let renderer = at_once(Renderer::new(&host.device, &options)).unwrap();
    let scene = scene();
    let buffers = SceneBuffers::new(&renderer, &host.device, &host.queue, &scene);
    at_once(buffers).unwrap();
    host.with_targets(&options, SIZE, |targets| {
        at_once(Frame::new(&renderer, &host.device, targets)).unwrap();
    });
    at_once(Recolor::new(&host.device)).unwrap();
}

/// A call that wgpu refuses gives an error that names file and line, in async and blocking forms.
#[test]
fn what_wgpu_refuses_is_a_value() {
    let host = Host::new();
    let options = RendererOptions { edits: vec![broken()], ..RendererOptions::default() };
    let refused = at_once(Renderer::new(&host.device, &options)).unwrap_err();
    let GpuError::Device { message } = &refused else { panic!("{refused}") };
    assert!(message.contains("primary/trace.wgsl:"), "{message}");
    assert_eq!(Renderer::new(&host.device, &options).wait().unwrap_err(), refused);
}

/// An edit after which a kernel does not compile.
fn broken() -> ShaderEdit {
    ShaderEdit {
        file: "primary/trace.wgsl".into(),
        find: "fn trace(".into(),
        replace: "fn none() -> absent {}\n@compute @workgroup_size(8, 8) fn trace(".into(),
    }
}

/// The futures of adapter choice can be sent too. They are not polled, because they would look for drivers.
#[test]
fn adapters_are_found_by_futures_that_can_be_sent() {
    fn can_be_sent<T: Send>(_: &T) {}
    can_be_sent(&adapter::choose(None));
    can_be_sent(&adapter::candidates(None));
    can_be_sent(&Headless::open(&HeadlessOptions::default()));
}
