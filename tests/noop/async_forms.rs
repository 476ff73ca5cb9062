//! The async forms on a native device: they can be sent to other threads, and never wait for one another.

use std::pin::pin;
use std::task::{Context, Poll, Waker};

use pinhole::gpu::{
    Frame, GpuError, Headless, Recolor, Renderer, RendererOptions, SceneBuffers, Targets, adapter,
};
use pinhole::internals::ShaderEdit;

use crate::{Host, SIZE, scene};

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
    let renderer = at_once(Renderer::new_async(&host.device, &options)).unwrap();
    let scene = scene();
    let buffers = SceneBuffers::new_async(&renderer, &host.device, &host.queue, &scene);
    at_once(buffers).unwrap();
    let color = host.texture(SIZE, options.color.texture_format());
    let targets = Targets { color: &color, data: None };
    at_once(Frame::new_async(&renderer, &host.device, &targets)).unwrap();
    at_once(Recolor::new_async(&host.device)).unwrap();
}

/// What wgpu refuses is a value, in the async form as in the blocking one, and names file and line.
#[test]
fn what_wgpu_refuses_is_a_value() {
    let host = Host::new();
    let options = RendererOptions { edits: vec![broken()], ..RendererOptions::default() };
    let refused = at_once(Renderer::new_async(&host.device, &options)).unwrap_err();
    let GpuError::Device { message } = &refused else { panic!("{refused}") };
    assert!(message.contains("primary/trace.wgsl:"), "{message}");
    assert_eq!(Renderer::new(&host.device, &options).unwrap_err(), refused);
}

/// An edit after which a kernel does not compile.
pub(crate) fn broken() -> ShaderEdit {
    ShaderEdit {
        file: "primary/trace.wgsl".into(),
        find: "fn trace(".into(),
        replace: "fn none() -> absent {}\n@compute @workgroup_size(8, 8) fn trace(".into(),
    }
}

/// The futures of adapter choice can be sent as well. They are not polled, because they would look for drivers.
#[test]
fn adapters_are_found_by_futures_that_can_be_sent() {
    fn can_be_sent<T: Send>(_: &T) {}
    can_be_sent(&adapter::choose_async(None));
    can_be_sent(&adapter::candidates_async(None));
    can_be_sent(&Headless::open_async(&pinhole::gpu::HeadlessOptions::default()));
}
