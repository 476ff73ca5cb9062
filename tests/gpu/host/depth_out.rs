//! The depth and the colours that are drawn into a host's render pass.

use libtest_mimic::Trial;
use pinhole::camera::{DepthOrder, HostCamera};
use pinhole::glam::DVec3;
use pinhole::gpu::{
    ColorTarget, Composite, CompositeDepth, CompositeOptions, CompositePicture, GpuError, Headless,
    TargetEncoding, Targets, wgpu,
};
use wgpu::TextureFormat;

use super::stage::{FIRST, RANGE, SIZE, Stage, TARGET, begin, pixels, pose, projection};
use crate::embedding::view_of;
use crate::support::hosts::{Convention, view};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("host::depth_out::is_that_of_the_matrices", right),
        trial("host::depth_out::faults_are_found", faults),
        trial("host::depth_out::colors_in_every_kind_of_target", colors),
        trial("host::depth_out::near_and_far_planes", planes),
        trial("host::depth_out::what_does_not_fit_is_refused", refused),
    ]
}

/// How the composite is drawn.
#[derive(Clone, Copy)]
struct Drawn {
    camera: HostCamera,
    first_pixel: [u32; 2],
    /// The depth before.
    cleared: f32,
}

/// What is wrong with the depths: how far they are from the truth, in units of what rounding permits, and in how many
/// pixels there is a depth and should be none, or the other way round.
#[derive(Debug)]
struct Wrong {
    /// Of the conversion from the distance that the depth layer holds.
    conversion: f64,
    /// Of everything from the spheres on.
    whole: f64,
    coverage: usize,
    /// Pixels that are judged, and pixels that are too close to a silhouette for that.
    judged: usize,
    unjudged: usize,
}

impl Wrong {
    fn is_right(&self) -> bool {
        self.conversion <= 1.0 && self.whole <= 1.0 && self.coverage == 0
    }
}

const HALF_ULP: f64 = 1.0 / (1 << 24) as f64;

fn judge(stage: &Stage, drawn: Drawn) -> Wrong {
    let color = stage.attachment(TextureFormat::Rgba8Unorm, 1);
    let depth = stage.attachment(TextureFormat::Depth32Float, 1);
    let composite = stage.composite(color.format(), depth.format(), 1);
    let mut picture = stage.picture(&composite);
    picture.set_camera(&stage.host.queue, &drawn.camera, drawn.first_pixel);
    let mut encoder = stage.host.encoder();
    stage.trace(&mut encoder);
    {
        let (color, depth) = (view_of(&color), view_of(&depth));
        let mut pass = begin(&mut encoder, &color, None, &depth, Some(drawn.cleared));
        composite.draw(&mut pass, &picture).unwrap();
    }
    let found = stage.host.submit_and_read(encoder, &depth);
    let found: Vec<f32> = bytemuck::pod_collect_to_vec(&found);
    let distances = stage.host.submit_and_read(stage.host.encoder(), &stage.layers.depth);
    let distances: Vec<f32> = bytemuck::pod_collect_to_vec(&distances);

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
        let at = (pixel[1] + FIRST[1]) * TARGET[0] + pixel[0] + FIRST[0];
        let found = f64::from(found[at as usize]);
        let truth = stage.truth(pixel);
        let distance = distances[(pixel[1] * SIZE[0] + pixel[0]) as usize];
        let is_hit = distance < 1e30;
        // At a silhouette, rounding decides what is hit.
        if pixel_is_near_a_silhouette(stage, pixel) {
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
        // The last rounding is that of the format; the others are of the quotient, which is at most 2.5 ULP wrong, of
        // the four products and sums of its numerator, and of its rounded parameters.
        let rounding =
            |distance: f64| HALF_ULP * (found.abs() + start.abs() + 12.0 * change(distance));
        let expected = camera.clip_depth(location, f64::from(distance));
        let error = (found - expected).abs() / rounding(f64::from(distance));
        wrong.conversion = wrong.conversion.max(error);
        // The distance is rounded in a scene of this size, and more so where the ray grazes the sphere.
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

/// Whether the ray passes a sphere at less than a thousandth of its radius from its silhouette.
pub(super) fn pixel_is_near_a_silhouette(stage: &Stage, pixel: [u32; 2]) -> bool {
    use pinhole::camera::Camera;
    let ray = stage.camera.ray_in_world(Stage::location(pixel));
    stage.spheres.iter().any(|sphere| {
        let to_center = DVec3::from(sphere.center) - ray.origin;
        let along = to_center.dot(ray.direction);
        let aside = (to_center - along * ray.direction).length();
        (aside / sphere.radius - 1.0).abs() < 2e-3
    })
}

fn plainly(stage: &Stage) -> Drawn {
    Drawn { camera: stage.camera, first_pixel: FIRST, cleared: stage.far() }
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
                Drawn { camera: made(convention, [RANGE[0] * 0.9999, RANGE[1]]), ..plain },
            ),
            ("a column too far", Drawn { first_pixel: [FIRST[0] + 1, FIRST[1]], ..plain }),
            ("a row too high", Drawn { first_pixel: [FIRST[0], FIRST[1] - 1], ..plain }),
            ("depth that is not cleared", Drawn { cleared: 1.0 - stage.far(), ..plain }),
        ];
        let other = match convention {
            Convention::Perspective => Convention::Infinite,
            Convention::Reversed => Convention::InfiniteReversed,
            Convention::Infinite => Convention::InfiniteReversed,
            Convention::InfiniteReversed => Convention::Perspective,
            Convention::Orthographic => Convention::OrthographicReversed,
            Convention::OrthographicReversed => Convention::Orthographic,
        };
        planted.push(("another convention", Drawn { camera: made(other, RANGE), ..plain }));
        for (name, drawn) in planted {
            let wrong = judge(&stage, drawn);
            assert!(!wrong.is_right(), "{convention:?}: {name} is not found: {wrong:?}");
        }
    }
}

/// The bytes of a picture are those of the spheres' colours, whatever the target; and float targets hold linear light.
fn colors(_: &'static Headless) {
    let stage = Stage::new(Convention::Reversed);
    let depth = stage.attachment(TextureFormat::Depth24Plus, 1);
    for format in [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Bgra8UnormSrgb,
        TextureFormat::Rgba16Float,
    ] {
        let color = stage.attachment(format, 1);
        let composite = stage.composite(format, depth.format(), 1);
        let mut picture = stage.picture(&composite);
        picture.set_camera(&stage.host.queue, &stage.camera, FIRST);
        let mut encoder = stage.host.encoder();
        stage.trace(&mut encoder);
        {
            let (color, depth) = (view_of(&color), view_of(&depth));
            let mut pass = begin(&mut encoder, &color, None, &depth, Some(stage.far()));
            composite.draw(&mut pass, &picture).unwrap();
        }
        let bytes = stage.host.submit_and_read(encoder, &color);
        let texel = bytes.len() / (TARGET[0] * TARGET[1]) as usize;
        let mut seen = 0;
        for pixel in pixels().filter(|pixel| !pixel_is_near_a_silhouette(&stage, *pixel)) {
            let at = ((pixel[1] + FIRST[1]) * TARGET[0] + pixel[0] + FIRST[0]) as usize;
            let found = &bytes[at * texel..][..texel];
            let Some(truth) = stage.truth(pixel) else {
                // What the host cleared to: black, and opaque.
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

/// Hits behind the far plane are not drawn, and hits in front of the near plane are, at its depth.
fn planes(_: &'static Headless) {
    for convention in [Convention::Perspective, Convention::Reversed] {
        let stage = Stage::new(convention);
        let range = [6.5, 8.0];
        let camera = projection(convention, range);
        let camera = HostCamera::new(view(&pose(), -1.0), camera, convention.order()).unwrap();
        let color = stage.attachment(TextureFormat::Rgba8Unorm, 1);
        let depth = stage.attachment(TextureFormat::Depth32Float, 1);
        let composite = stage.composite(color.format(), depth.format(), 1);
        let mut picture = stage.picture(&composite);
        picture.set_camera(&stage.host.queue, &camera, FIRST);
        let mut encoder = stage.host.encoder();
        stage.trace(&mut encoder);
        {
            let (color, depth) = (view_of(&color), view_of(&depth));
            let mut pass = begin(&mut encoder, &color, None, &depth, Some(stage.far()));
            composite.draw(&mut pass, &picture).unwrap();
        }
        let found = stage.host.submit_and_read(encoder, &depth);
        let colors = stage.host.submit_and_read(stage.host.encoder(), &color);
        let found: Vec<f32> = bytemuck::pod_collect_to_vec(&found);
        let mut seen = [0; 3];
        for pixel in pixels().filter(|pixel| !pixel_is_near_a_silhouette(&stage, *pixel)) {
            let Some(truth) = stage.truth(pixel) else { continue };
            let at = (pixel[1] + FIRST[1]) * TARGET[0] + pixel[0] + FIRST[0];
            let found = found[at as usize];
            let color = &colors[4 * at as usize..][..4];
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
    // A format that is no colour, and a number of samples that no device must have.
    for (format, samples) in [(TextureFormat::Depth32Float, 1), (TextureFormat::Rgba8Unorm, 3)] {
        let mut options = CompositeOptions::new(format, depth);
        options.sample_count = samples;
        let error = Composite::new(device, &options).unwrap_err();
        assert!(matches!(error, GpuError::Device { .. }), "{error}");
    }
    let mut options = CompositeOptions::new(TextureFormat::Rgba8Unorm, depth);
    options.encoding = TargetEncoding::Linear;
    options.source = ColorTarget::Linear16;
    let composite = Composite::new(device, &options).unwrap();
    // The picture is in another format than the one to be drawn.
    let error = stage.layers.with(|targets| {
        CompositePicture::new(&composite, device, targets).map(|_| ()).unwrap_err()
    });
    assert!(matches!(error, GpuError::Target { layer: "color", .. }), "{error}");
    // There is no depth layer.
    let error = stage.layers.with(|targets| {
        let targets = Targets { data: None, ..*targets };
        CompositePicture::new(&composite, device, &targets).map(|_| ()).unwrap_err()
    });
    assert!(matches!(error, GpuError::Target { layer: "data", .. }), "{error}");

    let composite = stage.composite(TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float, 1);
    let picture = stage.picture(&composite);
    let (color, depth) = (
        stage.attachment(TextureFormat::Rgba8Unorm, 1),
        stage.attachment(TextureFormat::Depth32Float, 1),
    );
    let mut encoder = stage.host.encoder();
    let (color, depth) = (view_of(&color), view_of(&depth));
    let mut pass = begin(&mut encoder, &color, None, &depth, Some(1.0));
    assert_eq!(composite.draw(&mut pass, &picture), Err(GpuError::NoCamera));
}
