//! Tests of rays through points of the lens other than its centre. Pictures with one ray for each pixel have no such
//! rays, so the kernel is edited to use another point.

use libtest_mimic::{Failed, Trial};
use pinhole::accel::AccelChoice;
use pinhole::glam::{DVec2, DVec3};
use pinhole::gpu::Decision;
use pinhole::verify::{LegalCameraRay, Recording};

use crate::planted::faulty;
use crate::verify_views as views;

/// Points in all cases of the map from the square to the disk, on a seam, and on the edge.
const POINTS: [[f32; 2]; 7] =
    [[0.5, 0.5], [0.9, 0.6], [0.4, 0.1], [0.1, 0.45], [0.3, 0.95], [0.75, 0.75], [0.0, 0.5]];

/// Maximum distance between a unit direction and that of the reference: twenty roundings of f32.
const NEAR: f64 = 20.0 / (1 << 24) as f64;

pub(crate) fn trials() -> Vec<Trial> {
    POINTS
        .into_iter()
        .map(|point| {
            let [x, y] = point;
            Trial::test(format!("lens::through_{x}_{y}"), move || rays_are_the_references(point))
        })
        .collect()
}

fn rays_are_the_references(lens: [f32; 2]) -> Result<(), Failed> {
    let [x, y] = lens;
    let headless = faulty("camera/entry.wgsl", "vec2f(0.5)", &format!("vec2f({x:?}, {y:?})"))?;
    let view = views::lens();
    let accel = headless.plan_accel(&view.scene, AccelChoice::List);
    let buffers = headless.upload(&view.scene, &accel.build(view.scene.spheres()).into())?;
    let go_on = |_: &_| Decision::GoOn;
    let recording = headless.record(&buffers, &view.seen(), &view.settings, &mut { go_on })?;
    let Recording { camera, uploaded, film, pixels, .. } = &recording;
    let mut traced = 0;
    for (index, pixel) in pixels.iter().enumerate() {
        let Some(ray) = pixel.ray else { continue };
        let (i, j) = (index as u32 % film.width(), index as u32 / film.width());
        let location = film.relative_location(f64::from(i) + 0.5, f64::from(j) + 0.5);
        let point = DVec2::from(lens.map(f64::from));
        let expected = view.camera.ray_through_lens(location, point);
        let [origin, direction] =
            [ray.origin, ray.direction].map(|v| DVec3::from(v.map(f64::from)));
        let off = (direction - expected.direction).length();
        if off > NEAR {
            return Err(format!("({i}, {j}): the direction is off by {off:e}").into());
        }
        let at = view.scene.origin() + origin - expected.at(ray.distance.into());
        if at.length() > NEAR * f64::from(ray.distance) {
            return Err(format!("({i}, {j}): the origin is off by {at:?}").into());
        }
        // The location in f32 is the nearest one. Its rounding error rotates a ray by less than the bounds.
        let location = location.as_vec2().to_array();
        let legal = LegalCameraRay::new(camera.kind, uploaded, location, lens);
        let is_legal = |axis: usize| legal.direction[axis].contains(ray.direction[axis].into());
        if !(0..3).all(is_legal) {
            return Err(format!("({i}, {j}): the direction is not legal: {legal:?}").into());
        }
        traced += 1;
    }
    // For a camera with a lens, the box may be visible in the whole film.
    if traced == pixels.len() { Ok(()) } else { Err(format!("only {traced} are traced").into()) }
}
