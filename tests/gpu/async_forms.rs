//! Tests of the async forms on an adapter: they make the pictures of the blocking forms, and return while the device
//! works.

use std::pin::{Pin, pin};
use std::task::Poll;

use libtest_mimic::Trial;
use pinhole::gpu::{Frame, GpuError, Headless, Renderer, RendererOptions, SceneBuffers, Targets};
use pinhole::{LayerSet, RenderSettings};

use crate::embedding::{Host, expected_bytes, size_of_film, view_of};
use crate::support::View;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("async_forms::they_make_the_pictures_of_the_blocking_forms", same_pictures),
        trial("async_forms::two_renders_on_one_thread_take_turns", turns),
        trial("async_forms::a_render_that_is_given_up_blocks_nobody", given_up),
        trial("async_forms::a_renderer_built_in_pieces_draws_the_spheres", pieces),
    ]
}

fn all_settings() -> [RenderSettings; 3] {
    let mut studio = RenderSettings::studio();
    studio.sampling.samples = 3;
    let mut path = RenderSettings::path();
    path.sampling.samples = 3;
    path.is_denoised = true;
    [RenderSettings::default(), studio, path]
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
    for settings in all_settings() {
        let expected =
            headless.render(&view.scene, &view.seen(), &settings, LayerSet::ALL).unwrap();
        let seen = view.seen();
        // How often it returned unfinished depends on how fast the device is.
        let (_, found) = run(headless.render_async(&view.scene, &seen, &settings, LayerSet::ALL));
        assert!(found.unwrap() == expected, "{}", settings.integrator.name());
    }
}

fn turns(headless: &'static Headless) {
    let view = View::three_spheres();
    let seen = view.seen();
    let [first, second, _] = all_settings();
    let expected = [&first, &second]
        .map(|settings| headless.render(&view.scene, &seen, settings, LayerSet::COLOR).unwrap());
    type Render<'a> = Pin<Box<dyn Future<Output = Result<pinhole::Image, GpuError>> + 'a>>;
    let mut renders: [Option<Render<'_>>; 2] = [&first, &second].map(|settings| {
        let render = headless.render_async(&view.scene, &seen, settings, LayerSet::COLOR);
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

/// A render that was begun and dropped, while it waited for any of its submissions, neither holds the device nor lets
/// the next render fail.
fn given_up(headless: &'static Headless) {
    let view = View::three_spheres();
    let seen = view.seen();
    let [primary, studio, _] = all_settings();
    for settings in [primary, studio] {
        let render = || headless.render_async(&view.scene, &seen, &settings, LayerSet::ALL);
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
            let again = headless.render(&view.scene, &seen, &settings, LayerSet::ALL);
            assert!(again.unwrap() == expected, "given up at wait {waited}");
        }
    }
}

fn pieces(_: &'static Headless) {
    let host = Host::new();
    let view = View::three_spheres();
    let (device, queue) = (&host.device, &host.queue);
    let mut renderer = Renderer::begin(device, &RendererOptions::default());
    let scene = SceneBuffers::new(&renderer, device, queue, &view.scene).unwrap();
    let target =
        host.texture(size_of_film(&view.film), pinhole::gpu::wgpu::TextureFormat::Rgba8Unorm);
    let targets = Targets { color: &view_of(&target), data: None };
    let mut frame = Frame::new(&renderer, device, &targets).unwrap();
    frame.set_view(queue, &scene, &view.seen(), &view.settings).unwrap();
    let mut encoder = host.encoder();
    let mut refused = 0;
    while let Err(error) = renderer.record(&mut encoder, &scene, &frame) {
        assert!(matches!(error, GpuError::NotReady { .. }), "{error}");
        refused += 1;
        renderer.build_next(device).unwrap();
    }
    assert!(refused > 0);
    assert!(host.submit_and_read(encoder, &target) == expected_bytes(&view));
}
