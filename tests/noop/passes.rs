//! Tests that record and submit every kind of pass on a device with WebGPU's default limits and no features.

use pinhole::accel::{AccelChoice, AccelPlan, Structure};
use pinhole::gpu::{ColorTarget, LitPicture, LitRenderer, Recolor, Renderer, RendererOptions, Wait};
use pinhole::render::Sampling;
use pinhole::scene::{NewColors, SceneUpdate};
use pinhole::{Appearance, Colors, RenderSettings, Scene, SphereArray, View};

use crate::host_program::Host;
use crate::{SIZE, cameras, film, pinhole_camera, scene, spheres};

#[test]
fn primary_rays_of_every_camera_structure_and_target() {
    let host = Host::new();
    let (scene, cameras) = (scene(), cameras());
    for (color, data_layers, keeps_rays) in
        [(ColorTarget::Srgb8, false, false), (ColorTarget::Linear16, true, true), (ColorTarget::Linear32, true, false)]
    {
        let options = RendererOptions {
            color,
            data_layers,
            keeps_rays,
            structures: Structure::ALL.to_vec(),
            ..RendererOptions::default()
        };
        let renderer = Renderer::new(&host.device, &options).wait().unwrap();
        let mut frame = host.frame(&renderer, &options, SIZE);
        use AccelChoice::{Grid, List, Tree};
        // Bindings of 2048 bytes divide the scene into bricks.
        let bricks = AccelPlan::new(scene.spheres(), List, 2048).build(scene.spheres());
        assert!(bricks.bricks().len() > 1);
        for (choice, binding) in [(Grid, 1 << 27), (Tree, 1 << 27), (List, 1 << 27), (List, 2048)] {
            let buffers = host.scene(&renderer, &scene, choice, binding);
            for camera in &cameras {
                let view = View::new(camera.as_ref(), film());
                let settings = RenderSettings::default();
                frame.set_view(&host.queue, &buffers, &view, &settings).unwrap();
                let refused = host.refused(|| {
                    let mut encoder = host.encoder();
                    renderer.record(&mut encoder, &buffers, &frame).unwrap();
                    host.submit(encoder);
                });
                assert_eq!(refused, None, "{color:?} {choice:?} {:?}", camera.kind());
            }
        }
    }
}

/// A picture whose hits are larger than one binding.
#[test]
fn several_bands() {
    let host = Host::new();
    let options = RendererOptions::default();
    let renderer = Renderer::new(&host.device, &options).wait().unwrap();
    let buffers = host.scene(&renderer, &scene(), AccelChoice::Auto, 1 << 27);
    let mut frame = host.frame(&renderer, &options, [4096, 4096]);
    let camera = pinhole_camera();
    let view = View::new(&camera, pinhole::Film::new(4096, 4096).unwrap());
    frame.set_view(&host.queue, &buffers, &view, &RenderSettings::default()).unwrap();
    let refused = host.refused(|| {
        let mut encoder = host.encoder();
        renderer.record(&mut encoder, &buffers, &frame).unwrap();
        host.submit(encoder);
    });
    assert_eq!(refused, None);
}

#[test]
fn new_colors() {
    let host = Host::new();
    let colors = Appearance::new(Colors::Rgba8(vec![[9, 9, 9, 255]; 300]));
    let mut scene = Scene::from_parts(SphereArray::F32(spheres()), colors).unwrap();
    let renderer = Renderer::new(&host.device, &RendererOptions::default()).wait().unwrap();
    let mut buffers = host.scene(&renderer, &scene, AccelChoice::Auto, 1 << 27);
    let recolor = Recolor::new(&host.device).wait().unwrap();
    let colors = Some(NewColors::Rgba8(&[[1, 2, 3, 255]; 5]));
    let update = SceneUpdate { first: 7, colors, ..SceneUpdate::default() };
    scene.apply(&update).unwrap();
    let refused = host.refused(|| {
        let (device, queue, mut encoder) = (&host.device, &host.queue, host.encoder());
        recolor.record(device, queue, &mut encoder, &mut buffers, &scene, &update).wait().unwrap();
        host.submit(encoder);
    });
    assert_eq!(refused, None);
}

#[test]
fn studios_and_paths() {
    let host = Host::new();
    let scene = scene();
    for (color, data_layers, indirect) in
        [(ColorTarget::Srgb8, false, true), (ColorTarget::Linear16, true, true), (ColorTarget::Linear32, true, false)]
    {
        let options = RendererOptions { color, data_layers, indirect, ..RendererOptions::default() };
        let renderer = Renderer::new(&host.device, &options).wait().unwrap();
        let buffers = host.scene(&renderer, &scene, AccelChoice::Auto, 1 << 27);
        let lit = LitRenderer::new(renderer);
        for settings in [RenderSettings::studio(), RenderSettings::path()] {
            let sampling = Sampling { samples: 2, ..settings.sampling };
            let settings = RenderSettings { sampling, ..settings };
            for camera in cameras() {
                let view = View::new(camera.as_ref(), film());
                let (device, queue) = (&host.device, &host.queue);
                let mut picture = host.with_targets(&options, SIZE, |targets| {
                    LitPicture::new(&lit, device, queue, &buffers, &view, &settings, targets).wait().unwrap()
                });
                let refused = host.refused(|| {
                    let mut encoder = host.encoder();
                    picture.record(&lit, queue, &mut encoder, &buffers, u64::MAX).unwrap();
                    host.submit(encoder);
                });
                assert_eq!(refused, None, "{} {:?}", settings.integrator.name(), camera.kind());
            }
        }
    }
}
