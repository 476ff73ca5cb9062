//! The host's depth ends primary rays.

use libtest_mimic::Trial;
use pinhole::camera::HostCamera;
use pinhole::gpu::{
    DataTargets, DepthTest, Frame, Headless, HostDepth, Renderer, RendererOptions, SceneBuffers,
    Targets, wgpu,
};
use pinhole::image::NO_ID;
use pinhole::{Film, LinearRgb, Scene};
use wgpu::TextureFormat;

use super::depth_out::pixel_is_near_a_silhouette;
use super::stage::{FIRST, SIZE, Stage, begin, pixels, pose, projection, settings};
use super::triangle::{There, Triangle, triangle_at};
use crate::embedding::{Host, view_of};
use crate::support::hosts::{Convention, view};
use crate::support::spheres;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("host::depth_in::hides_what_is_behind", hides),
        trial("host::depth_in::faults_are_found", faults),
        trial("host::depth_in::a_picture_larger_than_one_band", several_bands),
    ]
}

/// Number of pixels whose id is not the one that must be there.
fn wrong(stage: &Stage, format: TextureFormat, first_pixel: [u32; 2], cleared: f32) -> usize {
    let color = stage.attachment(TextureFormat::Rgba8Unorm, 1);
    let depth = stage.attachment(format, 1);
    let triangle = Triangle::new(stage, color.format(), format, 1);
    let mut encoder = stage.host.encoder();
    {
        let (color, depth) = (view_of(&color), view_of(&depth));
        let mut pass = begin(&mut encoder, &color, None, &depth, Some(cleared));
        triangle.draw(&mut pass);
    }
    stage.trace_with_depth(&mut encoder, &view_of(&depth), first_pixel);
    let ids = stage.host.submit_and_read(encoder, &stage.layers.id);
    let ids: Vec<u32> = bytemuck::pod_collect_to_vec(&ids);
    let distances = stage.host.submit_and_read(stage.host.encoder(), &stage.layers.depth);
    let distances: Vec<f32> = bytemuck::pod_collect_to_vec(&distances);
    let resolution = if format == TextureFormat::Depth16Unorm { 3.0 / 65535.0 } else { 1e-6 };
    let (mut wrong, mut hidden, mut shown) = (0, 0, 0);
    for pixel in pixels().filter(|pixel| !pixel_is_near_a_silhouette(stage, *pixel)) {
        let Some(truth) = stage.truth(pixel) else { continue };
        let is_hidden = match triangle_at(stage, pixel) {
            There::Edge => continue,
            There::Nothing => false,
            There::Triangle(point) => {
                let behind = truth.depth - stage.depth_of(point);
                if behind.abs() < resolution {
                    continue;
                }
                (behind > 0.0) == (stage.far() == 1.0)
            }
        };
        let at = (pixel[1] * SIZE[0] + pixel[0]) as usize;
        let expected = if is_hidden { NO_ID } else { truth.id as u32 };
        wrong += usize::from(ids[at] != expected || (distances[at] < 1e30) == is_hidden);
        *(if is_hidden { &mut hidden } else { &mut shown }) += 1;
    }
    assert!(hidden > 300 && shown > 1000, "{hidden} {shown}");
    wrong
}

fn hides(_: &'static Headless) {
    for convention in Convention::ALL {
        let stage = Stage::new(convention);
        for format in
            [TextureFormat::Depth32Float, TextureFormat::Depth24Plus, TextureFormat::Depth16Unorm]
        {
            let wrong = wrong(&stage, format, FIRST, stage.far());
            assert_eq!(wrong, 0, "{convention:?}, {format:?}");
        }
    }
}

fn faults(_: &'static Headless) {
    for convention in Convention::ALL {
        let stage = Stage::new(convention);
        let format = TextureFormat::Depth32Float;
        for first_pixel in [[FIRST[0] + 1, FIRST[1]], [FIRST[0], FIRST[1] - 1]] {
            assert!(wrong(&stage, format, first_pixel, stage.far()) > 0, "{first_pixel:?}");
        }
        assert!(wrong(&stage, format, FIRST, 1.0 - stage.far()) > 0, "cleared to the near plane");
    }
}

/// Depth is at the near or the far plane, differently from pixel to pixel, so that a pixel either shows what it shows
/// without depth, or nothing. The picture is one of several bands.
fn several_bands(_: &'static Headless) {
    const SIZE: [u32; 2] = [2400, 1900];
    let Host { device, queue } = &Host::new();
    let options = RendererOptions { data_layers: true, ..RendererOptions::default() };
    let renderer = Renderer::new(device, &options).unwrap();
    let spheres = spheres::scaled(&spheres::random(200, 3, |_| 0.1), 3.0);
    let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
    let scene = SceneBuffers::new(&renderer, device, queue, &scene).unwrap();
    let convention = Convention::Perspective;
    let projection = projection(convention, [0.01, 100.0]);
    let camera = HostCamera::new(view(&pose(), -1.0), projection, convention.order()).unwrap();
    let texture = |format, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: usage | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    };
    let layer = |format| texture(format, wgpu::TextureUsages::STORAGE_BINDING);
    let color = layer(TextureFormat::Rgba8Unorm);
    let distance = layer(TextureFormat::R32Float);
    let normal = layer(TextureFormat::Rgba32Float);
    let id = layer(TextureFormat::R32Uint);
    let [color, distance, normal, ids] = [&color, &distance, &normal, &id].map(view_of);
    let data = DataTargets { depth: &distance, normal: &normal, id: &ids };
    let mut frame =
        Frame::new(&renderer, device, &Targets { color: &color, data: Some(data) }).unwrap();
    let film = Film::new(SIZE[0], SIZE[1]).unwrap();
    frame.set_view(queue, &scene, &pinhole::View::new(&camera, film), &settings()).unwrap();

    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let depth = texture(TextureFormat::Depth16Unorm, usage);
    let mut random = fastrand::Rng::with_seed(1);
    let is_near: Vec<bool> = (0..SIZE[0] * SIZE[1]).map(|_| random.bool()).collect();
    let words: Vec<u16> = is_near.iter().map(|near| if *near { 0 } else { u16::MAX }).collect();
    queue.write_texture(
        depth.as_image_copy(),
        bytemuck::cast_slice(&words),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(2 * SIZE[0]),
            rows_per_image: None,
        },
        depth.size(),
    );
    let test = DepthTest::new(&renderer, device).unwrap();
    let mut depth = HostDepth::new(&test, device, &view_of(&depth)).unwrap();
    depth.set_camera(queue, &camera, &frame, [0, 0]).unwrap();

    let host = Host { device: device.clone(), queue: queue.clone() };
    let [without, with] = [false, true].map(|has_depth| {
        let mut encoder = host.encoder();
        if has_depth {
            renderer.record_with_depth(&mut encoder, &scene, &frame, &test, &depth).unwrap();
        } else {
            renderer.record(&mut encoder, &scene, &frame).unwrap();
        }
        bytemuck::pod_collect_to_vec::<u8, u32>(&host.submit_and_read(encoder, &id))
    });
    let hits = without.iter().filter(|id| **id != NO_ID).count();
    assert!(hits > 200_000, "{hits}");
    for (at, near) in is_near.into_iter().enumerate() {
        assert_eq!(with[at], if near { NO_ID } else { without[at] }, "pixel {at}");
    }
}
