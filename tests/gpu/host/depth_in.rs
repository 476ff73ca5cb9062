//! The host's depth ends primary rays.

use libtest_mimic::Trial;
use pinhole::gpu::{Headless, wgpu};
use pinhole::image::NO_ID;
use wgpu::TextureFormat;

use super::depth_out::pixel_is_near_a_silhouette;
use super::stage::{FIRST, SIZE, Stage, begin, pixels};
use super::triangle::{There, Triangle, triangle_at};
use crate::embedding::view_of;
use crate::support::hosts::Convention;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("host::depth_in::hides_what_is_behind", hides),
        trial("host::depth_in::faults_are_found", faults),
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
