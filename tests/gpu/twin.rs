//! Tests that kernels give the results of plain f32, to the bit, on versions of lavapipe that round to nearest and fuse
//! no operations. On these drivers, this is stricter than legality. Also tests rays through points of the lens beside
//! its centre. Pictures with one ray for each pixel lack them, so the kernel is edited to use another point.

use libtest_mimic::{Failed, Trial};
use pinhole::accel::AccelChoice;
use pinhole::glam::{DVec2, DVec3, Vec3};
use pinhole::gpu::Headless;
use pinhole::image::NO_ID;
use pinhole::internals::NO_HIT;
use pinhole::render::PrimarySettings;
use pinhole::verify::{LegalCameraRay, Recording, TracedRay};
use pinhole::{LinearRgb, Shading};

use crate::harness::trial_unless;
use crate::planted::faulty;
use crate::support::View;
use crate::support::legal_device::{Habit, LegalDevice};
use crate::{scenes, verify};

/// The versions of lavapipe that are known to round to nearest and fuse no operations. Mesa 26.2 is known to differ.
const PLAIN: [&str; 2] = ["Mesa 22.3", "Mesa 25.0"];

pub(crate) fn trials() -> Vec<Trial> {
    let twins = scenes::all().into_iter().map(|(name, view)| {
        let name = format!("twin::{name}");
        trial_unless(name, lacking_plain_f32, move |headless| check(headless, &view))
    });
    let lens = POINTS.into_iter().map(|point| {
        let [x, y] = point;
        Trial::test(format!("lens::through_{x}_{y}"), move || rays_are_the_references(point))
    });
    twins.chain(lens).collect()
}

/// The reason if the driver does not compute exactly like plain f32. Such drivers are legal
/// although they differ, see docs/explain/drivers.md.
fn lacking_plain_f32(headless: &'static Headless) -> Option<String> {
    let info = headless.adapter_info();
    let is_plain = PLAIN.iter().any(|version| info.driver_info.starts_with(version));
    (!is_plain).then(|| format!("{} {} need not compute as plain f32 does", info.driver, info.driver_info))
}

/// Twin of `surface_color` in shaders/primary/shading.wgsl.
fn color(primary: &PrimarySettings, of: LinearRgb, normal: [f32; 3], ray: &TracedRay) -> [f32; 3] {
    if primary.shading == Shading::Flat {
        return of.to_array();
    }
    let cosine = Vec3::from(normal).dot(Vec3::from(ray.direction)).abs();
    (Vec3::from(of.to_array()) * cosine).to_array()
}

fn check(headless: &Headless, view: &View) -> Result<(), Failed> {
    let film = &view.film;
    let recording = view.record(headless, &view.planned(headless, AccelChoice::Auto))?;
    let differing = (0..film.height())
        .flat_map(|j| (0..film.width()).map(move |i| [i, j]))
        .filter(|pixel| !is_same(view, &recording, *pixel))
        .count();
    match differing {
        0 => Ok(()),
        count => Err(format!("{count} pixels differ").into()),
    }
}

fn is_same(view: &View, recording: &Recording, pixel: [u32; 2]) -> bool {
    let Recording { camera, uploaded, film, primary, pixels, image, rendered: _ } = recording;
    let index = (pixel[1] * film.width() + pixel[0]) as usize;
    let (id, depth) = (image.id().unwrap()[index], image.depth().unwrap()[index]);
    let traced = &pixels[index];
    let mut plain = LegalDevice { habit: Habit::Nearest, random: fastrand::Rng::with_seed(0) };
    let (ray, meets_box) = plain.ray(camera.kind, uploaded, film, pixel);
    let (mut nearest_t, mut nearest_id) = (NO_HIT, NO_ID);
    if meets_box {
        for (id, sphere) in (0..).zip(view.scene.spheres()) {
            let t = plain.intersect(&ray, *sphere);
            // Ids ascend, so `<` prefers the smaller id at equal distances.
            if t < nearest_t {
                (nearest_t, nearest_id) = (t, id);
            }
        }
    }
    let same_ray = traced.ray.is_none_or(|found| found == ray);
    if nearest_id == NO_ID {
        return same_ray && id == NO_ID && traced.id == NO_ID && depth == f32::INFINITY;
    }
    let normal = image.normal().unwrap()[index];
    same_ray
        && traced.ray.is_some()
        && (traced.id, id) == (nearest_id, nearest_id)
        && traced.t.to_bits() == nearest_t.to_bits()
        && depth.to_bits() == (ray.distance + nearest_t).to_bits()
        && bits(image.color()[index]) == bits(color(primary, view.scene.color(id), normal, &ray))
}

fn bits(v: [f32; 3]) -> [u32; 3] {
    v.map(f32::to_bits)
}

/// Points in all cases of the map from the square to the disk, on a seam, and on the edge.
const POINTS: [[f32; 2]; 7] = [[0.5, 0.5], [0.9, 0.6], [0.4, 0.1], [0.1, 0.45], [0.3, 0.95], [0.75, 0.75], [0.0, 0.5]];

/// Maximum distance between a unit direction and the direction of the reference: twenty roundings of f32.
const NEAR: f64 = 20.0 / (1 << 24) as f64;

fn rays_are_the_references(lens: [f32; 2]) -> Result<(), Failed> {
    let [x, y] = lens;
    let headless = faulty("camera/entry.wgsl", "vec2f(0.5)", &format!("vec2f({x:?}, {y:?})"))?;
    let view = verify::lens();
    let recording = view.record(&headless, &view.planned(&headless, AccelChoice::List))?;
    let Recording { camera, uploaded, film, pixels, .. } = &recording;
    let mut traced = 0;
    for (index, pixel) in pixels.iter().enumerate() {
        let Some(ray) = pixel.ray else { continue };
        let (i, j) = (index as u32 % film.width(), index as u32 / film.width());
        let location = film.relative_location(f64::from(i) + 0.5, f64::from(j) + 0.5);
        let point = DVec2::from(lens.map(f64::from));
        let expected = view.camera.ray_through_lens(location, point);
        let [origin, direction] = [ray.origin, ray.direction].map(|v| DVec3::from(v.map(f64::from)));
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
