//! Tests of pictures in passes without depth, of textures that pinhole makes for a host, and of picking.

use libtest_mimic::Trial;
use pinhole::camera::PanoramaCamera;
use pinhole::gpu::{
    Composite, CompositeOptions, CompositePicture, Frame, GpuError, Headless, PickError, Picker, Renderer,
    RendererOptions, TargetTextures, Targets, Wait, wgpu,
};
use pinhole::{Film, Scene, View};
use wgpu::{TextureFormat, TextureUsages};

use super::stage::{FIRST, SIZE, Stage, TARGET, at, pixels, pose, settings};
use crate::host_program::view_of;
use crate::support::hosts::Convention;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("host::overlay::draws_every_pixel_of_any_camera", every_pixel),
        trial("host::overlay::makes_textures_for_a_renderer", textures),
        trial("host::pick::gives_id_distance_and_place", picks),
        trial("host::pick::what_cannot_be_picked_is_an_error", errors),
    ]
}

/// Without depth and data layers, the bytes in the host's attachment are the bytes of the picture, for hits and misses,
/// and nothing else is drawn to.
fn every_pixel(headless: &'static Headless) {
    let stage = Stage::new(Convention::Perspective);
    let device = &stage.host.device;
    let renderer = Renderer::new(device, &RendererOptions::default()).wait().unwrap();
    let textures = TargetTextures::new(&renderer, device, SIZE).wait().unwrap();
    let targets = textures.targets();
    assert_eq!((textures.size(), targets.data.is_none()), (SIZE, true));
    let mut frame = Frame::new(&renderer, device, &targets).wait().unwrap();
    // Hosts have no matrices for this camera.
    let camera = PanoramaCamera::new(pose());
    let view = View::new(&camera, Film::new(SIZE[0], SIZE[1]).unwrap());
    let scene = Scene::new(&stage.spheres).unwrap();
    let uploaded = pinhole::gpu::SceneBuffers::new(&renderer, device, &stage.host.queue, &scene).wait().unwrap();
    frame.set_view(&stage.host.queue, &uploaded, &view, &settings()).unwrap();
    let expected = headless.render(&scene, &view, &settings(), pinhole::LayerSet::COLOR).wait().unwrap();

    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb] {
        let composite = Composite::new(device, &CompositeOptions::without_depth(format)).wait().unwrap();
        let mut picture = CompositePicture::new(&composite, device, &targets).wait().unwrap();
        for first in [[0, 0], FIRST] {
            if first == FIRST {
                picture.set_place(&stage.host.queue, first);
            }
            let color = stage.attachment(format, 1);
            let mut encoder = stage.host.encoder();
            renderer.record(&mut encoder, &uploaded, &frame).unwrap();
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view_of(&color),
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations::default(),
                })],
                ..wgpu::RenderPassDescriptor::default()
            });
            composite.draw(&mut pass, &picture).unwrap();
            drop(pass);
            let colors_there: Vec<[u8; 4]> = stage.host.submit_and_read(encoder, &color);
            let texel = |[x, y]: [u32; 2]| colors_there[(y * TARGET[0] + x) as usize];
            let mut colors = std::collections::BTreeSet::new();
            for pixel in pixels() {
                let light = expected.color()[at(pixel)];
                let [r, g, b] = pinhole::image::color::to_srgb8(light);
                let found = texel([pixel[0] + first[0], pixel[1] + first[1]]);
                assert_eq!(found, [r, g, b, 255], "{format:?} {first:?} {pixel:?}");
                colors.insert(found);
            }
            assert!(colors.len() > 5, "{colors:?}");
            let outside = [first[0] + SIZE[0], first[1] + SIZE[1]];
            assert_eq!([texel([outside[0], 10]), texel([10, outside[1]])], [[0; 4]; 2]);
        }
    }
}

fn textures(_: &'static Headless) {
    let stage = Stage::new(Convention::Perspective);
    let device = &stage.host.device;
    for data_layers in [false, true] {
        let options = RendererOptions { data_layers, ..RendererOptions::default() };
        let renderer = Renderer::new(device, &options).wait().unwrap();
        let textures = TargetTextures::new(&renderer, device, SIZE).wait().unwrap();
        let targets = textures.targets();
        assert_eq!(targets.data.is_some(), data_layers);
        Frame::new(&renderer, device, &targets).wait().unwrap();
        let views = targets.data.iter().flat_map(|data| [data.depth, data.normal, data.id]);
        for view in std::iter::once(targets.color).chain(views) {
            let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
            assert!(view.texture().usage().contains(usage));
        }
        // A pass with depth needs data layers.
        let composite = stage.composite(TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float, 1);
        let picture = CompositePicture::new(&composite, device, &targets).wait();
        assert_eq!(picture.is_ok(), data_layers, "{picture:?}");
        for size in [[0, 5], [u32::MAX, 5]] {
            let error = TargetTextures::new(&renderer, device, size).wait().unwrap_err();
            assert!(matches!(error, GpuError::Device { .. }), "{error}");
        }
    }
    // A texture that cannot be drawn is also refused without depth.
    let composite = Composite::new(device, &CompositeOptions::without_depth(TextureFormat::Rgba8Unorm)).wait().unwrap();
    let wrong = view_of(&stage.layers.depth);
    let error = CompositePicture::new(&composite, device, &Targets { color: &wrong, data: None }).wait();
    assert!(matches!(error, Err(GpuError::Target { layer: "color", .. })), "{error:?}");
}

fn picks(_: &'static Headless) {
    for convention in [Convention::Perspective, Convention::OrthographicReversed] {
        let stage = Stage::new(convention);
        let mut picker = Picker::new(&stage.host.device, 3).wait().unwrap();
        let mut random = fastrand::Rng::with_seed(5);
        let (mut hits, mut asked) = (0, Vec::new());
        for frame in 0..120 {
            let mut encoder = stage.host.encoder();
            stage.trace(&mut encoder);
            let pixel = [random.u32(0..SIZE[0]), random.u32(0..SIZE[1])];
            let mut record = |targets: &Targets<'_>| picker.record(&mut encoder, targets, &stage.view(), pixel);
            stage.layers.with(true, &mut record).unwrap();
            asked.push(pixel);
            // Nothing is there before the submission.
            if asked.len() == 1 {
                assert_eq!(picker.take(), Ok(None));
            }
            stage.host.submit(encoder);
            // The program waits only now and then.
            if frame % 3 == 2 {
                stage.host.wait();
                for pixel in asked.drain(..) {
                    let picked = picker.take().unwrap().unwrap();
                    assert_eq!(picked.pixel, pixel);
                    if stage.is_near_a_silhouette(pixel) {
                        continue;
                    }
                    let truth = stage.truth(pixel);
                    assert_eq!(picked.hit.map(|hit| hit.id as usize), truth.map(|truth| truth.id));
                    let Some((hit, truth)) = picked.hit.zip(truth) else { continue };
                    assert!((f64::from(hit.distance) - truth.distance).abs() < 1e-4);
                    assert!((hit.place - truth.point).length() < 1e-4);
                    hits += 1;
                }
                assert_eq!(picker.take(), Ok(None));
            }
        }
        assert!(hits > 20, "{hits}");
    }
}

fn errors(_: &'static Headless) {
    let stage = Stage::new(Convention::Perspective);
    let mut picker = Picker::new(&stage.host.device, 2).wait().unwrap();
    let mut encoder = stage.host.encoder();
    stage.trace(&mut encoder);
    let mut record = |view: &pinhole::View<'_>, pixel, has_data| {
        let layers = &stage.layers;
        layers.with(has_data, |targets| picker.record(&mut encoder, targets, view, pixel))
    };
    let view = stage.view();
    for pixel in [[SIZE[0], 0], [0, SIZE[1]], [u32::MAX, 0]] {
        assert_eq!(record(&view, pixel, true), Err(PickError::Outside { pixel, size: SIZE }));
    }
    assert_eq!(record(&view, [0, 0], false), Err(PickError::NoDataLayers));
    let other = pinhole::View::new(&stage.camera, Film::new(8, 9).unwrap());
    let refused = Err(PickError::OtherFilm { film: [8, 9], size: SIZE });
    assert_eq!(record(&other, [0, 0], true), refused);
    assert_eq!(record(&view, [0, 0], true), Ok(()));
    assert_eq!(record(&view, [1, 0], true), Ok(()));
    assert_eq!(record(&view, [2, 0], true), Err(PickError::Full { capacity: 2 }));
    // The commands are never executed.
    drop(encoder);
    assert_eq!(picker.take(), Err(PickError::Lost { pixel: [0, 0] }));
    assert_eq!(picker.take(), Err(PickError::Lost { pixel: [1, 0] }));
    assert_eq!(picker.take(), Ok(None));

    // The ring is usable again.
    let mut encoder = stage.host.encoder();
    stage.trace(&mut encoder);
    let pixel = [SIZE[0] / 2, SIZE[1] / 2];
    let record = |targets: &Targets<'_>| picker.record(&mut encoder, targets, &stage.view(), pixel);
    stage.layers.with(true, record).unwrap();
    stage.host.submit(encoder);
    stage.host.wait();
    assert_eq!(picker.take().unwrap().unwrap().pixel, pixel);
}
