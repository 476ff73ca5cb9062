//! Tests that kernels compute the same as plain f32, to the bit, on versions of lavapipe that round to nearest and fuse
//! no operations; on these drivers this is stricter than legality. And tests of rays through points of the lens other than
//! its centre: pictures with one ray for each pixel have no such rays, so the kernel is edited to use another point.

use libtest_mimic::{Failed, Trial};
use pinhole::accel::AccelChoice;
use pinhole::camera::CameraKind;
use pinhole::camera::film::YAxis;
use pinhole::glam::{DVec2, DVec3, UVec2, Vec2, Vec3};
use pinhole::gpu::Headless;
use pinhole::image::NO_ID;
use pinhole::internals::NO_HIT;
use pinhole::render::PrimarySettings;
use pinhole::verify::{LegalCameraRay, Recording, TracedRay, UploadedView};
use pinhole::{Film, LinearRgb, Shading};

use crate::harness::trial_unless;
use crate::planted::faulty;
use crate::support::View;
use crate::{scenes, verify};

/// The versions of lavapipe that are known to round to nearest and fuse nothing. Mesa 26.2 is known to differ.
const PLAIN: [&str; 2] = ["Mesa 22.3", "Mesa 25.0"];

pub(crate) fn trials() -> Vec<Trial> {
    [own(), through_the_lens()].into_iter().flatten().collect()
}

fn own() -> Vec<Trial> {
    scenes::all()
        .into_iter()
        .map(|(name, view)| {
            let name = format!("twin::{name}");
            trial_unless(name, lacking_plain_f32, move |headless| check(headless, &view))
        })
        .collect()
}

/// Whether the driver computes exactly like plain f32. Other drivers are legal although they differ, see
/// docs/drivers.md.
fn lacking_plain_f32(headless: &'static Headless) -> Option<String> {
    let info = headless.adapter_info();
    let is_plain = PLAIN.iter().any(|version| info.driver_info.starts_with(version));
    (!is_plain)
        .then(|| format!("{} {} need not compute as plain f32 does", info.driver, info.driver_info))
}

/// Twin of `relative_location` in shaders/camera/film.wgsl.
fn location(film: &Film, pixel: UVec2) -> Vec2 {
    let size = UVec2::new(film.width(), film.height()).as_ivec2();
    let location = (pixel.as_ivec2() * 2 + 1 - size).as_vec2() / size.as_vec2();
    let sign = if film.y_axis() == YAxis::Up { -1.0 } else { 1.0 };
    Vec2::new(location.x, sign * location.y)
}

/// Twin of `camera_ray` and `enter_scene`. It is `None` if the ray misses the box.
fn ray(kind: CameraKind, view: &UploadedView, film: &Film, pixel: UVec2) -> (TracedRay, bool) {
    let [origin, right, up, forward, min, max] =
        [view.origin, view.right, view.up, view.forward, view.scene_min, view.scene_max]
            .map(Vec3::from);
    let location = location(film, pixel);
    let [first, second, third] = view.numbers;
    let mut is_seen = true;
    let aside = location.x * right + location.y * up;
    let (origin, toward, advance) = match kind {
        CameraKind::Orthographic => (origin + aside, None, view.advance),
        CameraKind::Panorama => {
            let longitude = sin_cos_half_turns(location.x);
            let latitude = sin_cos_half_turns(0.5 * location.y);
            let heading = longitude.x * right + longitude.y * forward;
            let tangent = longitude.y * right - longitude.x * forward;
            let straight = latitude.y * heading + latitude.x * up;
            let toward = second * straight - third * tangent;
            (origin + first * tangent, Some(toward), 0.0)
        }
        CameraKind::Fisheye => {
            let spot = location * Vec2::new(first, second);
            let radius = spot.dot(spot).sqrt();
            is_seen = radius <= 1.0;
            let angle = sin_cos_half_turns(radius.min(1.0) * third);
            let side = spot / radius.max(2_f32.powi(-40));
            let aside = side.x * right + side.y * up;
            (origin, Some(angle.x * aside + angle.y * forward), 0.0)
        }
        // The centre of the lens acts as the pinhole.
        _ => (origin + view.advance * aside, Some(aside + forward), view.advance),
    };
    let (direction, distance) = match toward {
        None => (forward, advance),
        Some(toward) => {
            let length = toward.dot(toward).sqrt();
            (toward * (1.0 / length), advance * length)
        }
    };
    let size = direction.abs().max(Vec3::splat(2_f32.powi(-40)));
    let inverse = 1.0 / Vec3::select(direction.cmpge(Vec3::ZERO), size, -size);
    let (a, b) = ((min - origin) * inverse, (max - origin) * inverse);
    let near = a.min(b).max_element().max(0.0);
    let far = a.max(b).min_element();
    let ray = TracedRay {
        origin: (origin + near * direction).to_array(),
        direction: direction.to_array(),
        distance: distance + near,
    };
    (ray, is_seen && near <= far)
}

/// Twin of `sin_cos_half_turns` and `sin_cos_eighth` in shaders/math/trigonometry.wgsl.
fn sin_cos_half_turns(half_turns: f32) -> Vec2 {
    let quarters = (2.0 * half_turns).round_ties_even();
    let rest = half_turns - 0.5 * quarters;
    let angle = std::f32::consts::PI * rest;
    let z = angle * angle;
    let sine = z * (-1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 + z * (1.0 / 362_880.0))));
    let cosine = z
        * (-0.5
            + z * (1.0 / 24.0
                + z * (-1.0 / 720.0 + z * (1.0 / 40_320.0 + z * (-1.0 / 3_628_800.0)))));
    let first = Vec2::new(angle + angle * sine, 1.0 + cosine);
    match (quarters as i32).rem_euclid(4) {
        0 => first,
        1 => Vec2::new(first.y, -first.x),
        2 => -first,
        _ => Vec2::new(-first.y, first.x),
    }
}

/// Twin of `intersect_sphere` in shaders/scene/sphere.wgsl, line by line.
fn intersect_sphere(ray: &TracedRay, [x, y, z, radius]: [f32; 4]) -> f32 {
    let direction = Vec3::from(ray.direction);
    let to_center = Vec3::new(x, y, z) - Vec3::from(ray.origin);
    let b = to_center.dot(direction);
    let foot_to_center = to_center - b * direction;
    let discriminant = radius * radius - foot_to_center.dot(foot_to_center);
    let c = to_center.dot(to_center) - radius * radius;
    let half_chord = discriminant.max(0.0).sqrt();
    let from_foot = if c > 0.0 { -half_chord } else { half_chord };
    let is_sum = b * from_foot >= 0.0;
    let t = if is_sum { b + from_foot } else { c / (b - from_foot) };
    if discriminant >= 0.0 && t > 0.0 { t } else { NO_HIT }
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
        .flat_map(|j| (0..film.width()).map(move |i| UVec2::new(i, j)))
        .filter(|pixel| !is_same(view, &recording, *pixel))
        .count();
    match differing {
        0 => Ok(()),
        count => Err(format!("{count} pixels differ").into()),
    }
}

fn is_same(view: &View, recording: &Recording, pixel: UVec2) -> bool {
    let Recording { camera, uploaded, film, primary, pixels, image, rendered: _ } = recording;
    let index = (pixel.y * film.width() + pixel.x) as usize;
    let (id, depth) = (image.id().unwrap()[index], image.depth().unwrap()[index]);
    let traced = &pixels[index];
    let (ray, meets_box) = ray(camera.kind, uploaded, film, pixel);
    let (mut nearest_t, mut nearest_id) = (NO_HIT, NO_ID);
    if meets_box {
        for (id, sphere) in (0..).zip(view.scene.spheres()) {
            let t = intersect_sphere(&ray, *sphere);
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
const POINTS: [[f32; 2]; 7] =
    [[0.5, 0.5], [0.9, 0.6], [0.4, 0.1], [0.1, 0.45], [0.3, 0.95], [0.75, 0.75], [0.0, 0.5]];

/// Maximum distance between a unit direction and that of the reference: twenty roundings of f32.
const NEAR: f64 = 20.0 / (1 << 24) as f64;

fn through_the_lens() -> Vec<Trial> {
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
