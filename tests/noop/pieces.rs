//! Renderers that are built on another thread, or one pipeline at a time.

use std::thread;

use pinhole::camera::CameraKind;
use pinhole::gpu::{
    Frame, GpuError, Headless, LitPicture, Recolor, Renderer, RendererOptions, SceneBuffers,
};

use crate::async_forms::broken;
use crate::{Host, ready};

#[test]
fn everything_may_be_shared_between_threads() {
    fn shared<T: Send + Sync + 'static>() {}
    shared::<Renderer>();
    shared::<SceneBuffers>();
    shared::<Frame>();
    shared::<LitPicture>();
    shared::<Recolor>();
    shared::<Headless>();
    shared::<GpuError>();
}

#[test]
fn a_renderer_is_built_on_another_thread() {
    let host = Host::new();
    let options = RendererOptions::default();
    let (device, of_thread) = (host.device.clone(), options.clone());
    let thread = thread::spawn(move || Renderer::new(&device, &of_thread));
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
    let refused = renderer.record(&mut host.encoder(), &scene, &frame).unwrap_err();
    let GpuError::NotReady { remaining: all } = refused else { panic!("{refused}") };
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

/// Nothing is recorded of a frame that is not ready.
#[test]
fn what_is_not_ready_leaves_the_encoder_as_it_was() {
    let host = Host::new();
    let options = RendererOptions::default();
    let renderer = Renderer::begin(&host.device, &options);
    let (scene, frame) = ready(&host, &renderer, &options);
    let mut encoder = host.encoder();
    let (calls, refused) =
        crate::calls::of(|| renderer.record(&mut encoder, &scene, &frame).unwrap_err());
    assert!(matches!(refused, GpuError::NotReady { .. }), "{refused}");
    assert_eq!(calls, crate::calls::Calls::default());
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
