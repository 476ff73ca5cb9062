//! Tests of the depth and the colours that are drawn into a host's render pass.

use libtest_mimic::Trial;
use pinhole::camera::{DepthOrder, HostCamera};
use pinhole::gpu::{
    ColorTarget, Composite, CompositeDepth, CompositeOptions, CompositePicture, DepthTest, GpuError, Headless,
    HostDepth, RendererOptions, TargetEncoding, Targets, Wait, wgpu,
};
use pinhole::image::NO_ID;
use pinhole::{Film, LinearRgb, Scene};
use wgpu::TextureFormat;

use super::stage::{FIRST, RANGE, SIZE, Stage, TARGET, at, at_target, begin, pixels, pose, projection, settings};
use super::triangle::{There, Triangle, triangle_at};
use crate::host_program::{Drawing, Host, view_of};
use crate::support::hosts::{Convention, view};
use crate::support::spheres;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("host::depth_out::is_that_of_the_matrices", right),
        trial("host::depth_out::faults_are_found", faults),
        trial("host::depth_out::colors_in_every_kind_of_target", colors),
        trial("host::depth_out::near_and_far_planes", planes),
        trial("host::depth_out::what_does_not_fit_is_refused", refused),
        trial("host::depth_in::hides_what_is_behind", hides),
        trial("host::depth_in::faults_are_found", hiding_faults),
        trial("host::depth_in::a_picture_larger_than_one_band", several_bands),
    ]
}

/// The settings with which the composite is drawn.
#[derive(Clone, Copy)]
struct Draw {
    camera: HostCamera,
    first_pixel: [u32; 2],
    /// The depth to which the host clears.
    cleared: f32,
}

/// The errors of the depths: their distance from the truth in units of the permitted rounding, and the number of pixels
/// that have a depth but should not, or the other way round.
#[derive(Debug)]
struct Wrong {
    /// The error of the conversion from the distance in the depth layer.
    conversion: f64,
    /// The error of all steps, from the spheres on.
    whole: f64,
    coverage: usize,
    /// Number of pixels that are judged, and of pixels that are too close to a silhouette to be judged.
    judged: usize,
    unjudged: usize,
}

impl Wrong {
    fn is_right(&self) -> bool {
        self.conversion <= 1.0 && self.whole <= 1.0 && self.coverage == 0
    }
}

const HALF_ULP: f64 = 1.0 / (1 << 24) as f64;

fn judge(stage: &Stage, drawn: Draw) -> Wrong {
    let formats = [TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float];
    let [_, depth] = stage.composited(formats, &drawn.camera, drawn.first_pixel, drawn.cleared);
    let found: Vec<f32> = stage.host.read(&depth);
    let distances: Vec<f32> = stage.host.read(&stage.layers.depth);

    let (far, near) = (stage.far(), 1.0 - stage.far());
    let mut wrong = Wrong { conversion: 0.0, whole: 0.0, coverage: 0, judged: 0, unjudged: 0 };
    let is_in = |at: [u32; 2]| (0..2).all(|axis| at[axis].wrapping_sub(FIRST[axis]) < SIZE[axis]);
    for row in 0..TARGET[1] {
        for column in 0..TARGET[0] {
            let there = found[(row * TARGET[0] + column) as usize];
            if !is_in([column, row]) && there != far {
                wrong.coverage += 1;
            }
        }
    }
    for pixel in pixels() {
        let found = f64::from(found[at_target(pixel)]);
        let truth = stage.truth(pixel);
        let distance = distances[at(pixel)];
        let is_hit = distance < 1e30;
        // At a silhouette, rounding decides whether a sphere is hit.
        if stage.is_near_a_silhouette(pixel) {
            wrong.unjudged += 1;
            continue;
        }
        wrong.judged += 1;
        let Some(truth) = truth else {
            wrong.coverage += usize::from(found != f64::from(far) || is_hit);
            continue;
        };
        if !is_hit || found == f64::from(far) || found == f64::from(near) {
            wrong.coverage += 1;
            continue;
        }
        let location = Stage::location(pixel);
        let camera = &stage.camera;
        let start = camera.clip_depth(location, if is_parallel(stage) { 0.0 } else { 1e30 });
        let change = |distance: f64| (camera.clip_depth(location, distance) - start).abs();
        // The last rounding is the rounding of the format. The others are those of the quotient, which is at most 2.5
        // ULP wrong, of the four products and sums of its numerator, and of its rounded parameters.
        let rounding = |distance: f64| HALF_ULP * (found.abs() + start.abs() + 12.0 * change(distance));
        let expected = camera.clip_depth(location, f64::from(distance));
        let error = (found - expected).abs() / rounding(f64::from(distance));
        wrong.conversion = wrong.conversion.max(error);
        // The distance is rounded in a scene of this size, with a larger error where the ray grazes the sphere.
        let length = truth.distance + 8.0;
        let distance_error = 4.0 * HALF_ULP * length / truth.cosine;
        let slope = change(truth.distance) / truth.distance;
        let permitted = rounding(truth.distance) + slope * distance_error;
        wrong.whole = wrong.whole.max((found - truth.depth).abs() / permitted);
    }
    wrong
}

fn is_parallel(stage: &Stage) -> bool {
    stage.convention.is_orthographic()
}

fn plainly(stage: &Stage) -> Draw {
    Draw { camera: stage.camera, first_pixel: FIRST, cleared: stage.far() }
}

fn right(_: &'static Headless) {
    for convention in Convention::ALL {
        for stage in [Stage::new(convention), Stage::oblique(convention)] {
            let wrong = judge(&stage, plainly(&stage));
            println!("{convention:?}: {wrong:?}");
            assert!(wrong.is_right(), "{convention:?}: {wrong:?}");
            assert!(wrong.judged > 6000 && wrong.unjudged < 200, "{convention:?}: {wrong:?}");
        }
    }
}

fn faults(_: &'static Headless) {
    for convention in Convention::ALL {
        let stage = Stage::new(convention);
        let made = |convention: Convention, range| {
            let projection = projection(convention, range);
            HostCamera::new(view(&pose(), -1.0), projection, convention.order()).unwrap()
        };
        let plain = plainly(&stage);
        let mut planted = vec![
            (
                "a near plane that is a ten-thousandth nearer",
                Draw { camera: made(convention, [RANGE[0] * 0.9999, RANGE[1]]), ..plain },
            ),
            ("a column too far", Draw { first_pixel: [FIRST[0] + 1, FIRST[1]], ..plain }),
            ("a row too high", Draw { first_pixel: [FIRST[0], FIRST[1] - 1], ..plain }),
            ("depth that is not cleared", Draw { cleared: 1.0 - stage.far(), ..plain }),
        ];
        let other = match convention {
            Convention::Perspective => Convention::Infinite,
            Convention::Reversed => Convention::InfiniteReversed,
            Convention::Infinite => Convention::InfiniteReversed,
            Convention::InfiniteReversed => Convention::Perspective,
            Convention::Orthographic => Convention::OrthographicReversed,
            Convention::OrthographicReversed => Convention::Orthographic,
        };
        planted.push(("another convention", Draw { camera: made(other, RANGE), ..plain }));
        for (name, drawn) in planted {
            let wrong = judge(&stage, drawn);
            assert!(!wrong.is_right(), "{convention:?}: {name} is not found: {wrong:?}");
        }
    }
}

/// The bytes of a picture are the bytes of the spheres' colours, for every target, and float targets hold linear light.
fn colors(_: &'static Headless) {
    let stage = Stage::new(Convention::Reversed);
    for format in [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Bgra8UnormSrgb,
        TextureFormat::Rgba16Float,
    ] {
        let formats = [format, TextureFormat::Depth24Plus];
        let [color, _] = stage.composited(formats, &stage.camera, FIRST, stage.far());
        let bytes: Vec<u8> = stage.host.read(&color);
        let texel = bytes.len() / (TARGET[0] * TARGET[1]) as usize;
        let mut seen = 0;
        for pixel in stage.clear_pixels() {
            let found = &bytes[at_target(pixel) * texel..][..texel];
            let Some(truth) = stage.truth(pixel) else {
                // The colour to which the host cleared: black, and opaque.
                assert!(texel == 8 || found == [0, 0, 0, 255], "{format:?} {pixel:?}: {found:?}");
                continue;
            };
            seen += 1;
            let light = stage.spheres[truth.id].color;
            let [r, g, b] = light.to_srgb8();
            match format {
                TextureFormat::Rgba16Float => {
                    let red = half(u16::from_le_bytes([found[0], found[1]]));
                    let expected = light.to_array()[0];
                    assert!((red - expected).abs() < 2e-3 * expected + 1e-6, "{red} {expected}");
                }
                TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb => {
                    assert_eq!(found, [b, g, r, 255], "{format:?} {pixel:?}");
                }
                _ => assert_eq!(found, [r, g, b, 255], "{format:?} {pixel:?}"),
            }
        }
        assert!(seen > 1500, "{seen}");
    }
}

/// A normal number of 16 bits.
fn half(bits: u16) -> f32 {
    let exponent = i32::from(bits >> 10 & 31) - 15;
    (1.0 + f32::from(bits & 1023) / 1024.0) * 2_f32.powi(exponent)
}

/// Hits behind the far plane are not drawn. Hits in front of the near plane are drawn at its depth.
fn planes(_: &'static Headless) {
    for convention in [Convention::Perspective, Convention::Reversed] {
        let stage = Stage::new(convention);
        let range = [6.5, 8.0];
        let camera = projection(convention, range);
        let camera = HostCamera::new(view(&pose(), -1.0), camera, convention.order()).unwrap();
        let formats = [TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float];
        let [color, depth] = stage.composited(formats, &camera, FIRST, stage.far());
        let (found, colors) = (stage.host.read::<f32>(&depth), stage.host.read::<[u8; 4]>(&color));
        let mut seen = [0; 3];
        for pixel in stage.clear_pixels() {
            let Some(truth) = stage.truth(pixel) else { continue };
            let (found, color) = (found[at_target(pixel)], colors[at_target(pixel)]);
            let into = -pose().basis().w().dot(truth.point - pose().origin());
            let case = if into < range[0] - 1e-4 {
                assert_eq!(found, 1.0 - stage.far(), "{pixel:?} at {into}");
                0
            } else if into > range[1] + 1e-4 {
                assert_eq!(found, stage.far(), "{pixel:?} at {into}");
                assert_eq!(color, [0, 0, 0, 255], "{pixel:?} at {into}");
                1
            } else {
                assert!((0.0..=1.0).contains(&found), "{pixel:?} at {into}");
                2
            };
            seen[case] += 1;
        }
        assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
    }
}

fn refused(_: &'static Headless) {
    let stage = Stage::new(Convention::Perspective);
    let device = &stage.host.device;
    let depth = CompositeDepth::new(TextureFormat::Depth32Float, DepthOrder::NearIsZero);
    // A format that has no colour, and a number of samples that no device has to support.
    for (format, samples) in [(TextureFormat::Depth32Float, 1), (TextureFormat::Rgba8Unorm, 3)] {
        let mut options = CompositeOptions::new(format, depth);
        options.sample_count = samples;
        let error = Composite::new(device, &options).wait().unwrap_err();
        assert!(matches!(error, GpuError::Device { .. }), "{error}");
    }
    let mut options = CompositeOptions::new(TextureFormat::Rgba8Unorm, depth);
    options.encoding = TargetEncoding::Linear;
    options.source = ColorTarget::Linear16;
    let composite = Composite::new(device, &options).wait().unwrap();
    // The picture has another format than the pipeline draws.
    let picture = |targets: &Targets<'_>| CompositePicture::new(&composite, device, targets).wait();
    let error = stage.layers.with(true, picture).map(|_| ()).unwrap_err();
    assert!(matches!(error, GpuError::Target { layer: "color", .. }), "{error}");
    // There is no depth layer.
    let error = stage.layers.with(false, picture).map(|_| ()).unwrap_err();
    assert!(matches!(error, GpuError::Target { layer: "data", .. }), "{error}");

    let composite = stage.composite(TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float, 1);
    let picture = stage.picture(&composite);
    let formats = [TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float];
    let [color, depth] = formats.map(|format| view_of(&stage.attachment(format, 1)));
    let mut encoder = stage.host.encoder();
    let mut pass = begin(&mut encoder, &color, None, &depth, Some(1.0));
    assert_eq!(composite.draw(&mut pass, &picture), Err(GpuError::NoCamera));
}

/// Number of pixels with a wrong id.
fn wrongly_hidden(stage: &Stage, format: TextureFormat, first_pixel: [u32; 2], cleared: f32) -> usize {
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
    let ids: Vec<u32> = stage.host.submit_and_read(encoder, &stage.layers.id);
    let distances: Vec<f32> = stage.host.read(&stage.layers.depth);
    let resolution = if format == TextureFormat::Depth16Unorm { 3.0 / 65535.0 } else { 1e-6 };
    let (mut wrongly_hidden, mut hidden, mut shown) = (0, 0, 0);
    for pixel in stage.clear_pixels() {
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
        let at = at(pixel);
        let expected = if is_hidden { NO_ID } else { truth.id as u32 };
        wrongly_hidden += usize::from(ids[at] != expected || (distances[at] < 1e30) == is_hidden);
        *(if is_hidden { &mut hidden } else { &mut shown }) += 1;
    }
    assert!(hidden > 300 && shown > 1000, "{hidden} {shown}");
    wrongly_hidden
}

fn hides(_: &'static Headless) {
    for convention in Convention::ALL {
        let stage = Stage::new(convention);
        for format in [TextureFormat::Depth32Float, TextureFormat::Depth24Plus, TextureFormat::Depth16Unorm] {
            let wrongly_hidden = wrongly_hidden(&stage, format, FIRST, stage.far());
            assert_eq!(wrongly_hidden, 0, "{convention:?}, {format:?}");
        }
    }
}

fn hiding_faults(_: &'static Headless) {
    for convention in Convention::ALL {
        let stage = Stage::new(convention);
        let format = TextureFormat::Depth32Float;
        for first_pixel in [[FIRST[0] + 1, FIRST[1]], [FIRST[0], FIRST[1] - 1]] {
            assert!(wrongly_hidden(&stage, format, first_pixel, stage.far()) > 0, "{first_pixel:?}");
        }
        assert!(wrongly_hidden(&stage, format, FIRST, 1.0 - stage.far()) > 0, "cleared to the near plane");
    }
}

/// Depth is at the near or the far plane, differently from pixel to pixel, so that a pixel either shows the same as
/// without depth, or nothing. The picture has several bands.
fn several_bands(_: &'static Headless) {
    const SIZE: [u32; 2] = [2400, 1900];
    let host = Host::new();
    let Host { device, queue } = &host;
    let options = RendererOptions { data_layers: true, ..RendererOptions::default() };
    let drawing = Drawing::new(&host, &options, SIZE);
    let spheres = spheres::scaled(&spheres::random(200, 3, |_| 0.1), 3.0);
    let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
    let scene = drawing.scene(&host, &scene);
    let Drawing { renderer, layers, mut frame } = drawing;
    let convention = Convention::Perspective;
    let projection = projection(convention, [0.01, 100.0]);
    let camera = HostCamera::new(view(&pose(), -1.0), projection, convention.order()).unwrap();
    let film = Film::new(SIZE[0], SIZE[1]).unwrap();
    frame.set_view(queue, &scene, &pinhole::View::new(&camera, film), &settings()).unwrap();

    let depth = host.texture(SIZE, TextureFormat::Depth16Unorm);
    let mut random = fastrand::Rng::with_seed(1);
    let is_near: Vec<bool> = (0..SIZE[0] * SIZE[1]).map(|_| random.bool()).collect();
    let words: Vec<u16> = is_near.iter().map(|near| if *near { 0 } else { u16::MAX }).collect();
    host.write(&depth, &words);
    let test = DepthTest::new(&renderer, device).wait().unwrap();
    let mut depth = HostDepth::new(&test, device, &view_of(&depth)).wait().unwrap();
    depth.set_camera(queue, &camera, &frame, [0, 0]).unwrap();

    let [without, with] = [false, true].map(|has_depth| {
        let mut encoder = host.encoder();
        if has_depth {
            renderer.record_with_depth(&mut encoder, &scene, &frame, &test, &depth).unwrap();
        } else {
            renderer.record(&mut encoder, &scene, &frame).unwrap();
        }
        host.submit_and_read::<u32>(encoder, &layers.id)
    });
    let hits = without.iter().filter(|id| **id != NO_ID).count();
    assert!(hits > 200_000, "{hits}");
    for (at, near) in is_near.into_iter().enumerate() {
        assert_eq!(with[at], if near { NO_ID } else { without[at] }, "pixel {at}");
    }
}
