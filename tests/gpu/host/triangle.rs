//! Tests that spheres and a triangle of the host hide each other.

use libtest_mimic::Trial;
use pinhole::camera::Camera;
use pinhole::glam::{DVec2, DVec3};
use pinhole::gpu::{Headless, wgpu};
use wgpu::TextureFormat;

use super::stage::{FIRST, SIZE, Stage, at_target, begin, pixels};
use crate::host_program::view_of;
use crate::support::hosts::Convention;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("host::triangle::hides_and_is_hidden", both_ways),
        trial("host::triangle::with_four_samples", four_samples),
    ]
}

/// A triangle that passes through the spheres.
pub(super) const CORNERS: [DVec3; 3] =
    [DVec3::new(-2.4, -1.3, 1.9), DVec3::new(2.6, -0.4, -0.7), DVec3::new(-0.3, 2.2, 0.4)];
const COLOR: [u8; 4] = [0, 0, 255, 255];

/// The host's own pipeline, which draws the triangle.
pub(super) struct Triangle {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl Triangle {
    pub(super) fn new(stage: &Stage, color: TextureFormat, depth: TextureFormat, samples: u32) -> Self {
        let device = &stage.host.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("triangle"),
            source: wgpu::ShaderSource::Wgsl(
                "@group(0) @binding(0) var<uniform> corners: array<vec4f, 3>;
                @vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
                    return corners[i];
                }
                @fragment fn fragment() -> @location(0) vec4f { return vec4f(0.0, 0.0, 1.0, 1.0); }"
                    .into(),
            ),
        });
        let order = stage.composite_depth(depth);
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("triangle"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: depth,
                depth_write_enabled: Some(true),
                depth_compare: Some(order.compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(color.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("corners"),
            size: 48,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let corners = CORNERS.map(|corner| (stage.to_clip * corner.extend(1.0)).as_vec4().to_array());
        stage.host.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&corners));
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("triangle"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        Self { pipeline, group }
    }

    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// The part of the triangle at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum There {
    Nothing,
    /// The pixel is so close to an edge that the rasterizer's grid decides.
    Edge,
    /// The point on the triangle.
    Triangle(DVec3),
}

/// The triangle at the centre of a pixel, by its edges in pixels and its plane in space.
pub(super) fn triangle_at(stage: &Stage, pixel: [u32; 2]) -> There {
    let size = DVec2::new(SIZE[0].into(), SIZE[1].into());
    let in_pixels = |location: DVec2| (location * DVec2::new(0.5, -0.5) + 0.5) * size;
    let corners = CORNERS.map(|corner| in_pixels(stage.camera.location_of(corner).unwrap()));
    let at = in_pixels(Stage::location(pixel));
    let turn = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).signum();
    let inside = (0..3)
        .map(|i| {
            let (from, to) = (corners[i], corners[(i + 1) % 3]);
            turn * (to - from).normalize().perp_dot(at - from)
        })
        .fold(f64::INFINITY, f64::min);
    // Rasterizers place corners on a grid of 1/256 pixel.
    if inside.abs() < 2.0 / 256.0 {
        return There::Edge;
    }
    if inside < 0.0 {
        return There::Nothing;
    }
    let ray = stage.camera.ray_in_world(Stage::location(pixel));
    let normal = (CORNERS[1] - CORNERS[0]).cross(CORNERS[2] - CORNERS[0]);
    let along = (CORNERS[0] - ray.origin).dot(normal) / ray.direction.dot(normal);
    There::Triangle(ray.at(along))
}

/// The colour that a pixel must have; `None` if a silhouette, an edge or equal depths leave it open.
fn expected(stage: &Stage, pixel: [u32; 2], resolution: f64) -> Option<[u8; 4]> {
    if stage.is_near_a_silhouette(pixel) {
        return None;
    }
    let sphere = stage.truth(pixel).map(|truth| {
        let [r, g, b] = stage.spheres[truth.id].color.to_srgb8();
        (truth.depth, [r, g, b, 255])
    });
    match (sphere, triangle_at(stage, pixel)) {
        (_, There::Edge) => None,
        (None, There::Nothing) => Some([0, 0, 0, 255]),
        (Some((_, color)), There::Nothing) => Some(color),
        (None, There::Triangle(_)) => Some(COLOR),
        (Some((depth, color)), There::Triangle(point)) => {
            let ahead = (stage.depth_of(point) - depth) * if stage.far() == 1.0 { 1.0 } else { -1.0 };
            (ahead.abs() > resolution).then_some(if ahead > 0.0 { color } else { COLOR })
        }
    }
}

fn both_ways(_: &'static Headless) {
    for convention in Convention::ALL {
        let stage = Stage::new(convention);
        // A few units in the last place of a format, for the depth of spheres and the interpolated depth.
        for (format, resolution) in [
            (TextureFormat::Depth32Float, 1e-6),
            (TextureFormat::Depth24Plus, 1e-6),
            (TextureFormat::Depth16Unorm, 3.0 / 65535.0),
        ] {
            let color = stage.attachment(TextureFormat::Rgba8Unorm, 1);
            let depth = stage.attachment(format, 1);
            let triangle = Triangle::new(&stage, color.format(), format, 1);
            let composite = stage.composite(color.format(), format, 1);
            let mut picture = stage.picture(&composite);
            picture.set_camera(&stage.host.queue, &stage.camera, FIRST);
            for spheres_first in [false, true] {
                let mut encoder = stage.host.encoder();
                stage.trace(&mut encoder);
                {
                    let (color, depth) = (view_of(&color), view_of(&depth));
                    let mut pass = begin(&mut encoder, &color, None, &depth, Some(stage.far()));
                    if !spheres_first {
                        triangle.draw(&mut pass);
                    }
                    composite.draw(&mut pass, &picture).unwrap();
                    if spheres_first {
                        triangle.draw(&mut pass);
                    }
                }
                let found: Vec<[u8; 4]> = stage.host.submit_and_read(encoder, &color);
                let context = format!("{convention:?}, {format:?}, {spheres_first}");
                compare(&stage, &found, resolution, &context);
            }
        }
    }
}

fn compare(stage: &Stage, colors: &[[u8; 4]], resolution: f64, context: &str) {
    let (mut seen, mut open) = ([0; 3], 0);
    for pixel in pixels() {
        let found = colors[at_target(pixel)];
        let Some(expected) = expected(stage, pixel, resolution) else {
            open += 1;
            continue;
        };
        assert_eq!(found, expected, "{context}: {pixel:?}, {:?}", stage.truth(pixel));
        let case = match expected {
            [0, 0, 0, 255] => 0,
            COLOR => 1,
            _ => 2,
        };
        seen[case] += 1;
    }
    assert!(seen.iter().all(|count| *count > 300), "{context}: {seen:?}");
    assert!(open < 700, "{context}: {open} pixels are open");
}

/// With four samples, pixels away from all edges have the colour of one sample.
fn four_samples(_: &'static Headless) {
    for convention in [Convention::Perspective, Convention::InfiniteReversed] {
        let stage = Stage::new(convention);
        let format = TextureFormat::Rgba8Unorm;
        let resolved = stage.attachment(format, 1);
        let color = stage.attachment(format, 4);
        let depth = stage.attachment(TextureFormat::Depth32Float, 4);
        let triangle = Triangle::new(&stage, format, depth.format(), 4);
        let composite = stage.composite(format, depth.format(), 4);
        let mut picture = stage.picture(&composite);
        picture.set_camera(&stage.host.queue, &stage.camera, FIRST);
        let mut encoder = stage.host.encoder();
        stage.trace(&mut encoder);
        {
            let (color, depth) = (view_of(&color), view_of(&depth));
            let resolved = view_of(&resolved);
            let far = Some(stage.far());
            let mut pass = begin(&mut encoder, &color, Some(&resolved), &depth, far);
            triangle.draw(&mut pass);
            composite.draw(&mut pass, &picture).unwrap();
        }
        let colors: Vec<[u8; 4]> = stage.host.submit_and_read(encoder, &resolved);
        let mut seen = 0;
        let (mut mixed, mut all) = (0, 0);
        for pixel in pixels() {
            let found = colors[at_target(pixel)];
            let around: Vec<_> = (-1..=1)
                .flat_map(|y| (-1..=1).map(move |x| (x, y)))
                .map(|(x, y)| {
                    let near = [pixel[0].checked_add_signed(x)?, pixel[1].checked_add_signed(y)?];
                    expected(&stage, near, 1e-6)
                })
                .collect();
            if around[4].is_some() && around.iter().all(|color| *color == around[4]) {
                assert_eq!(found, around[4].unwrap(), "{convention:?}: {pixel:?}");
                seen += 1;
            } else if let Some(one) = around[4] {
                all += 1;
                mixed += usize::from(found != one);
            }
        }
        assert!(seen > 3000, "{seen}");
        // Where triangle and spheres meet, samples of one pixel differ.
        assert!(mixed > 20 && mixed < all, "{mixed} of {all}");
    }
}
