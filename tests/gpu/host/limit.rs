//! Tests that rays that end at the host's depth give the same pictures as other rays, to the bit.

use std::sync::Arc;

use libtest_mimic::Trial;
use pinhole::accel::AccelChoice;
use pinhole::camera::Camera;
use pinhole::glam::DVec3;
use pinhole::gpu::{Headless, HostDepth, Renderer, RendererOptions, SceneBuffers, Wait, wgpu};
use pinhole::internals::ShaderEdit;
use pinhole::{LinearRgb, Scene};
use wgpu::TextureFormat;

use super::stage::{FIRST, Pipelines, SIZE, Stage, settings};
use crate::host_program::{Host, view_of};
use crate::planted::planted;
use crate::support::hosts::Convention;
use crate::support::spheres::{self, Spheres};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("host::limit::gives_the_same_bits", same),
        trial("host::limit::faults_are_found", faults),
        trial("host::limit::is_near_the_hosts_depth", near),
    ]
}

/// A renderer whose rays end at the host's depth if `is_limited`.
fn renderer(stage: &Stage, is_limited: bool, edits: &[ShaderEdit]) -> Arc<Pipelines> {
    let options = RendererOptions {
        data_layers: true,
        cameras: vec![stage.camera.kind()],
        several_bricks: is_limited,
        edits: edits.to_vec(),
        ..RendererOptions::default()
    };
    if edits.is_empty() { Pipelines::with(&options) } else { Arc::new(Pipelines::new(&options)) }
}

/// The host's depth, at the first pixel of a picture.
struct HostPicture {
    texture: wgpu::Texture,
    first_pixel: [u32; 2],
}

/// A different depth in every pixel, from the near plane to the far one. Some pixels are at these planes.
fn random_depth(stage: &Stage, random: &mut fastrand::Rng) -> HostPicture {
    let texture = stage.host.texture(SIZE, TextureFormat::Depth16Unorm);
    // Depths of points among the spheres. Most depths of the whole range would be in front of them or behind them.
    let words: Vec<u16> = super::stage::pixels()
        .map(|pixel| match random.u32(0..10) {
            0 => 0,
            1 => u16::MAX,
            _ => {
                let distance = 3.0 + 8.0 * random.f64();
                let depth = stage.camera.clip_depth(Stage::location(pixel), distance);
                (depth.clamp(0.0, 1.0) * 65535.0) as u16
            }
        })
        .collect();
    stage.host.write(&texture, &words);
    HostPicture { texture, first_pixel: [0, 0] }
}

/// The depth of the spheres of the stage, which are the spheres of the scene or others.
fn own_depth(stage: &Stage) -> HostPicture {
    let formats = [TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float];
    let [_, texture] = stage.composited(formats, &stage.camera, FIRST, stage.far());
    HostPicture { texture, first_pixel: FIRST }
}

/// The bytes of all layers of a picture with the host's depth.
fn picture(
    stage: &Stage,
    Pipelines { renderer, test }: &Pipelines,
    scene: &SceneBuffers,
    depth: &HostPicture,
) -> [Vec<u8>; 4] {
    let Host { device, queue } = &stage.host;
    let layers = stage.host.layers(SIZE, TextureFormat::Rgba8Unorm);
    let mut frame = layers.frame(renderer, device, true);
    frame.set_view(queue, scene, &stage.view(), &settings()).unwrap();
    let mut host_depth = HostDepth::new(test, device, &view_of(&depth.texture)).wait().unwrap();
    host_depth.set_camera(queue, &stage.camera, &frame, depth.first_pixel).unwrap();
    let mut encoder = stage.host.encoder();
    renderer.record_with_depth(&mut encoder, scene, &frame, test, &host_depth).unwrap();
    stage.host.submit(encoder);
    layers.all().map(|layer| stage.host.read(layer))
}

fn scene(stage: &Stage, renderer: &Renderer, spheres: Spheres, choice: AccelChoice) -> SceneBuffers {
    let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
    let bytes = stage.host.device.limits().max_storage_buffer_binding_size;
    stage.host.scene(renderer, &scene, choice, bytes)
}

fn stages() -> impl Iterator<Item = Stage> {
    Convention::ALL.into_iter().flat_map(|of| [Stage::new(of), Stage::oblique(of)])
}

/// Spheres in the middle of the stage.
fn random_spheres(count: usize, seed: u64) -> Spheres {
    let radius = 1.5 / (count as f32).cbrt();
    let spheres = spheres::random(count, seed, |random| radius * (0.2 + 0.2 * random.f32()));
    let moved = |[x, y, z, r]: [f32; 4]| {
        let [x, y, z] = [x, y, z].map(|at| 4.0 * at - 2.0);
        [x, y, z, 2.0 * r]
    };
    spheres.into_iter().map(moved).collect()
}

/// The number of bytes that differ between the pictures with and without a limit, for one stage.
fn different(stage: &Stage, seed: u64, edits: &[ShaderEdit]) -> usize {
    let [without, with] =
        [false, true].map(|is_limited| renderer(stage, is_limited, if is_limited { edits } else { &[] }));
    let mut random = fastrand::Rng::with_seed(seed);
    let depths = [random_depth(stage, &mut random), own_depth(stage)];
    let of_the_stage: Spheres = stage
        .spheres
        .iter()
        .map(|sphere| [sphere.center[0], sphere.center[1], sphere.center[2], sphere.radius])
        .map(|sphere| sphere.map(|number| number as f32))
        .collect();
    let mut count = 0;
    for (spheres, choice) in [
        (of_the_stage, AccelChoice::List),
        (random_spheres(500, seed), AccelChoice::Grid),
        (random_spheres(500, seed), AccelChoice::Tree),
        (random_spheres(30_000, seed), AccelChoice::Auto),
    ] {
        let [a, b] = [&without, &with].map(|shared| scene(stage, &shared.renderer, spheres.clone(), choice));
        for depth in &depths {
            let (a, b) = (picture(stage, &without, &a, depth), picture(stage, &with, &b, depth));
            let ids: Vec<u32> = bytemuck::pod_collect_to_vec(&a[3]);
            let hits = ids.iter().filter(|id| **id != u32::MAX).count();
            assert!(hits > 100 && hits < ids.len() - 100, "{hits}");
            let pairs = a.iter().flatten().zip(b.iter().flatten());
            count += pairs.filter(|(a, b)| a != b).count();
        }
    }
    count
}

fn same(_: &'static Headless) {
    for (seed, stage) in (0..).zip(stages()) {
        assert_eq!(different(&stage, seed, &[]), 0, "{:?}", stage.convention);
    }
}

fn faults(_: &'static Headless) {
    for fault in planted("limit") {
        for word in &fault.setup {
            let stages: Vec<Stage> = match word.strip_prefix("Oblique") {
                Some(word) => conventions(word).map(Stage::oblique).collect(),
                None => conventions(word).map(Stage::new).collect(),
            };
            assert!(!stages.is_empty(), "{word}");
            for stage in stages {
                let found = different(&stage, 1, std::slice::from_ref(&fault.edit));
                assert!(found > 0, "{:?}: {}", stage.convention, fault.name);
            }
        }
    }
}

/// The convention with a name, or all conventions.
fn conventions(name: &str) -> impl Iterator<Item = Convention> {
    let is_named = move |one: &Convention| name == "All" || name == format!("{one:?}");
    Convention::ALL.into_iter().filter(is_named)
}

/// If `hide` leaves misses as they are, the depth layer shows where rays end, counted from the box of the scene.
fn near(_: &'static Headless) {
    for stage in stages() {
        let fault = planted("limit").find(|fault| fault.name == "misses_not_hidden").unwrap();
        let renderer = renderer(&stage, true, &[fault.edit]);
        let scene = scene(&stage, &renderer.renderer, vec![[0.0, 0.0, 0.0, 1.0]], AccelChoice::Auto);
        let [_, limits, _, ids] = picture(&stage, &renderer, &scene, &own_depth(&stage));
        let limits: Vec<f32> = bytemuck::pod_collect_to_vec(&limits);
        let ids: Vec<u32> = bytemuck::pod_collect_to_vec(&ids);
        let (mut judged, mut removed) = (0, 0);
        for (at, pixel) in super::stage::pixels().enumerate() {
            let Some(truth) = stage.truth(pixel) else { continue };
            let ray = stage.camera.ray_in_world(Stage::location(pixel));
            let planes = [-1.0, 1.0].map(|side| (DVec3::splat(side) - ray.origin) / ray.direction);
            let enters = planes[0].min(planes[1]).max_element();
            let leaves = planes[0].max(planes[1]).min_element();
            // Hits are near the point. This includes hits that `hide` removes because they are slightly too far.
            let is_hit = ids[at] != u32::MAX || limits[at] == 0.0;
            if is_hit || stage.is_near_a_silhouette(pixel) || enters + 0.01 > leaves {
                continue;
            }
            if limits[at] >= 1e30 {
                removed += 1;
                continue;
            }
            let ahead = f64::from(limits[at]) + enters - truth.distance;
            // The box is a little larger than the sphere.
            assert!((-1e-4..0.01).contains(&ahead), "{:?} {pixel:?}: {ahead}", stage.convention);
            judged += 1;
        }
        assert!(judged > 100 && removed < 10, "{:?}: {judged}, {removed}", stage.convention);
    }
}
