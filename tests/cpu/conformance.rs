//! Certificates of the answers of any renderer. The reference is never accused, and planted faults are found.

use pinhole::camera::{Camera, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose};
use pinhole::geometry::ray::Ray;
use pinhole::glam::DVec3;
use pinhole::image::NO_ID;
use pinhole::verify::conformance::{Answers, Conformance, ConformanceError, DepthKind, Rays, Reason};
use pinhole::verify::{Checker, Outcome};
use pinhole::{Film, Image, LayerSet, LinearRgb, RenderSettings, Scene, View, cpu};

use crate::support::spheres;
use crate::verify::{hostile_spheres, poses};

/// The layers that a renderer returns.
#[derive(Clone)]
pub(crate) struct Layers {
    pub(crate) size: [u32; 2],
    pub(crate) ids: Vec<u32>,
    pub(crate) depths: Vec<f64>,
    pub(crate) normals: Vec<[f64; 3]>,
}

impl Layers {
    /// The layers of the reference, in f32.
    pub(crate) fn by_reference(scene: &Scene, view: &View<'_>) -> Self {
        Self::of_image(&cpu::render(scene, view, &RenderSettings::default(), LayerSet::DATA).unwrap())
    }

    /// The layers of a picture.
    pub(crate) fn of_image(image: &Image) -> Self {
        Self {
            size: [image.width(), image.height()],
            ids: image.id().unwrap().to_vec(),
            depths: image.depth().unwrap().iter().copied().map(f64::from).collect(),
            normals: image.normal().unwrap().iter().map(|n| n.map(f64::from)).collect(),
        }
    }

    /// Ids and depths of given rays, by a function that computes the distance to a sphere.
    fn by_testing_all(
        spheres: &[[f32; 4]],
        size: [u32; 2],
        rays: &[Ray],
        test: impl Fn([f32; 3], [f32; 3], [f32; 4]) -> Option<f32>,
    ) -> Self {
        let hits = rays.iter().map(|ray| {
            let narrow = |v: DVec3| v.as_vec3().to_array();
            let (origin, direction) = (narrow(ray.origin), narrow(ray.direction));
            let hits = spheres.iter().zip(0..);
            hits.filter_map(|(sphere, id)| Some((test(origin, direction, *sphere)?, id)))
                .min_by(|a, b| a.0.total_cmp(&b.0))
        });
        let (depths, ids) = hits.map(|hit| hit.map_or((0.0, NO_ID), |(t, id)| (f64::from(t), id))).unzip();
        Self { size, ids, depths, normals: Vec::new() }
    }

    pub(crate) fn answers(&self) -> Answers<'_> {
        let depths = Some(&*self.depths);
        Answers { size: self.size, ids: &self.ids, depths, ..Answers::default() }
    }
}

fn scene(spheres: &[[f32; 4]]) -> Scene {
    Scene::from_f32(spheres.to_vec(), LinearRgb::WHITE).unwrap()
}

fn film() -> Film {
    Film::new(61, 47).unwrap()
}

fn certified(scene: &Scene, answers: &Answers<'_>, rays: Rays<'_>) -> Conformance {
    Checker::new(scene).unwrap().certify_answers(answers, rays, None).unwrap()
}

/// The index of the camera that is far away, among [`cameras`].
const FAR: usize = 1;

/// Cameras outside, far away, inside, and an orthographic one.
pub(crate) fn cameras(scene: &Scene) -> Vec<Box<dyn Camera>> {
    let (size, [outside, far, within]) = poses(scene);
    vec![
        Box::new(PinholeCamera::with_vertical_fov(outside, 0.7, 1.3).unwrap()),
        Box::new(PinholeCamera::new(far, 100.0 * size, [0.6 * size, 0.5 * size]).unwrap()),
        Box::new(PinholeCamera::with_vertical_fov(within, 1.9, 1.3).unwrap()),
        Box::new(OrthographicCamera::new(outside, [0.9 * size, 0.7 * size]).unwrap()),
        Box::new(PanoramaCamera::new(within)),
        Box::new(FisheyeCamera::new(outside, 1.1, 0.8).unwrap()),
    ]
}

#[test]
fn the_reference_is_never_accused() {
    let random = spheres::random(400, 1, |rng| 0.02 + 0.1 * rng.f32());
    let scenes = std::iter::once(random).chain(hostile_spheres());
    for (number, spheres) in scenes.enumerate() {
        // The first scenes are plain, at any scale.
        let is_plain = number < 4;
        let scene = scene(&spheres);
        for (place, camera) in cameras(&scene).into_iter().enumerate() {
            let view = View::new(camera.as_ref(), film());
            let made = Layers::by_reference(&scene, &view);
            let answers = Answers { normals: Some(&made.normals), ..made.answers() };
            let found = certified(&scene, &answers, Rays::View(view));
            let name = format!("scene {number}, {}:\n{found}", camera.kind().name());
            // Depths and normals are rounded to f32.
            assert!(found.largest() <= 2.0, "{name}");
            assert_ne!(found.outcome(), Outcome::Violated, "{name}");
            // From far away, spheres are small beside the rounding error of their distance.
            if is_plain && place != FAR {
                assert_eq!(found.outcome(), Outcome::Proved, "{name}");
                assert!(found.decided_fraction() >= 0.997, "{name}");
            }
            let ids = Answers { depths: None, normals: None, ..answers };
            assert!(certified(&scene, &ids, Rays::View(view)).largest() < 1e-3, "{name}");
        }
    }
}

#[test]
fn a_pixel_without_a_ray_must_be_a_miss() {
    let scene = scene(&[[0.0, 0.0, 0.0, 1.0]]);
    let pose = Pose::looking_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = FisheyeCamera::new(pose, 1.0, 1.0).unwrap();
    let view = View::new(&camera, Film::new(9, 9).unwrap());
    let mut made = Layers::by_reference(&scene, &view);
    assert_eq!(certified(&scene, &made.answers(), Rays::View(view)).outcome(), Outcome::Proved);
    (made.ids[0], made.depths[0]) = (0, 2.0);
    let found = certified(&scene, &made.answers(), Rays::View(view));
    assert_eq!(found.worst[0].reason, Reason::NoRay);
    assert_eq!(found.histogram().last(), Some(&(f64::INFINITY, 1)));
}

/// A ray of numbers in f32.
fn narrowed(Ray { origin, direction }: Ray) -> Ray {
    Ray { origin: origin.as_vec3().as_dvec3(), direction: direction.as_vec3().as_dvec3() }
}

/// A picture of many spheres with its rays, rounded to f32, and the answers of a careful f32 renderer.
struct TestPicture {
    scene: Scene,
    rays: Vec<Ray>,
    made: Layers,
}

impl TestPicture {
    fn new() -> Self {
        let scene = scene(&spheres::random(300, 5, |rng| 0.01 + 0.06 * rng.f32()));
        let camera = cameras(&scene).swap_remove(0);
        let view = View::new(camera.as_ref(), film());
        let size = [view.film.width(), view.film.height()];
        let pixels = (0..size[1]).flat_map(|j| (0..size[0]).map(move |i| [i, j]));
        let rays: Vec<Ray> = pixels.map(|pixel| narrowed(view.ray_through_center(pixel).unwrap())).collect();
        let made = Layers::by_testing_all(scene.spheres(), size, &rays, careful);
        Self { scene, rays, made }
    }

    fn judged(&self, made: &Layers) -> Conformance {
        certified(&self.scene, &made.answers(), Rays::Given(&self.rays))
    }

    fn hits(&self) -> usize {
        self.made.ids.iter().filter(|id| **id != NO_ID).count()
    }

    /// A pixel in the middle of a sphere that also covers the neighbouring pixels.
    fn inner_hit(&self) -> usize {
        let (ids, width) = (&self.made.ids, self.made.size[0] as usize);
        let is_inner = |i: &usize| {
            let around = [i - 1, i + 1, i - width, i + width];
            ids[*i] != NO_ID && around.iter().all(|at| ids[*at] == ids[*i])
        };
        (width..ids.len() - width).find(is_inner).unwrap()
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The method of Haines and others, "Precision Improvements for Ray/Sphere Intersection" (2019), in f32.
fn careful(origin: [f32; 3], direction: [f32; 3], [x, y, z, r]: [f32; 4]) -> Option<f32> {
    let l = [x - origin[0], y - origin[1], z - origin[2]];
    let b = dot(l, direction);
    let f = [0, 1, 2].map(|axis| l[axis] - b * direction[axis]);
    let q = r * r - dot(f, f);
    (q >= 0.0 && b > 0.0).then(|| b - q.sqrt())
}

/// The quadratic formula of textbooks, in f32.
fn textbook(origin: [f32; 3], direction: [f32; 3], [x, y, z, r]: [f32; 4]) -> Option<f32> {
    let l = [x - origin[0], y - origin[1], z - origin[2]];
    let (a, b, c) = (dot(direction, direction), -2.0 * dot(l, direction), dot(l, l) - r * r);
    let q = b * b - 4.0 * a * c;
    (q >= 0.0 && b < 0.0).then(|| (-b - q.sqrt()) / (2.0 * a))
}

#[test]
fn an_honest_renderer_in_f32_is_proved() {
    let picture = TestPicture::new();
    assert!(picture.hits() > 600, "{}", picture.hits());
    let found = picture.judged(&picture.made);
    assert_eq!((found.outcome(), found.at_most), (Outcome::Proved, 24.0), "{found}");
    assert!(found.largest() < 8.0 && found.decided_fraction() > 0.99, "{found}");
    let counted: usize = found.histogram().iter().map(|(_, count)| count).sum();
    assert_eq!(counted, picture.rays.len());
}

#[test]
fn two_wrong_ids_are_found() {
    let picture = TestPicture::new();
    let mut made = picture.made.clone();
    let [hit, miss] = [picture.inner_hit(), made.ids.iter().position(|id| *id == NO_ID).unwrap()];
    let id = made.ids[hit];
    made.ids[hit] = (id + 1) % 300;
    made.ids[miss] = id;
    let found = picture.judged(&made);
    assert_eq!(found.count(Outcome::Violated), 2, "{found}");
    for (index, reason) in [(hit, Some(id)), (miss, None)] {
        let pixel = [index as u32 % made.size[0], index as u32 / made.size[0]];
        let finding = found.worst.iter().find(|finding| finding.pixel == pixel).unwrap();
        assert_eq!(finding.outcome, Outcome::Violated);
        assert_eq!(finding.exact.map(|(id, _)| id), reason, "{finding}");
        assert!(finding.margin > 1e-4 && finding.margin < 10.0, "{finding}");
    }
}

/// Wrong ids are found without depths: a miss, a sphere behind another, and a sphere elsewhere.
#[test]
fn wrong_ids_are_found_without_depths() {
    let picture = TestPicture::new();
    let hit = picture.inner_hit();
    let id = picture.made.ids[hit];
    let ray = picture.rays[hit];
    let behind = |(_, [x, y, z, r]): &(u32, [f32; 4])| {
        let l = DVec3::new((*x).into(), (*y).into(), (*z).into()) - ray.origin;
        let b = l.dot(ray.direction);
        let off = (l - b * ray.direction).length();
        off < 0.5 * f64::from(*r) && b > picture.made.depths[hit] + 0.2
    };
    let spheres = || (0..).zip(picture.scene.spheres().iter().copied());
    let behind = spheres().find(behind).map(|(id, _)| id);
    let mut tried = 0;
    for (wrong, reason) in
        [(Some(NO_ID), Reason::Hidden(id)), (behind, Reason::Hidden(id)), (Some((id + 1) % 300), Reason::Missed)]
    {
        let Some(wrong) = wrong else { continue };
        let mut made = picture.made.clone();
        made.ids[hit] = wrong;
        let answers = Answers { depths: None, ..made.answers() };
        let found = certified(&picture.scene, &answers, Rays::Given(&picture.rays));
        assert_eq!(found.count(Outcome::Violated), 1, "{wrong}: {found}");
        assert_eq!(found.worst[0].reason, reason, "{found}");
        // The margin is a length in the scene.
        assert!(found.worst[0].margin > 1e-4, "{found}");
        tried += 1;
    }
    assert!(tried >= 2);
}

#[test]
fn the_textbooks_formula_is_found() {
    let picture = TestPicture::new();
    let made = Layers::by_testing_all(picture.scene.spheres(), picture.made.size, &picture.rays, textbook);
    let violated = picture.judged(&made).count(Outcome::Violated);
    assert!(violated > picture.hits() / 20, "{violated} of {}", picture.hits());
}

#[test]
fn depth_along_the_axis_is_not_distance() {
    let scene = scene(&spheres::random(100, 6, |_| 0.08));
    for camera in cameras(&scene).iter().take(4) {
        let view = View::new(camera.as_ref(), film());
        let mut made = Layers::by_reference(&scene, &view);
        let vectors = camera.vectors();
        let axis = vectors.forward.normalize_or_zero();
        for (index, depth) in made.depths.iter_mut().enumerate() {
            let width = view.film.width();
            let pixel = [index as u32 % width, index as u32 / width];
            *depth *= view.ray_through_center(pixel).unwrap().direction.dot(axis);
        }
        let along = Answers { depth_kind: DepthKind::AlongAxis, ..made.answers() };
        let found = certified(&scene, &along, Rays::View(view));
        assert_eq!(found.count(Outcome::Violated), 0, "{found}");
        let found = certified(&scene, &made.answers(), Rays::View(view));
        let is_parallel = matches!(camera.kind().name(), "orthographic");
        assert_eq!(found.count(Outcome::Violated) == 0, is_parallel, "{found}");
    }
}

#[test]
fn turned_normals_are_found() {
    let scene = scene(&spheres::random(100, 6, |_| 0.08));
    let camera = cameras(&scene).swap_remove(0);
    let view = View::new(camera.as_ref(), film());
    let made = Layers::by_reference(&scene, &view);
    let hits = made.ids.iter().filter(|id| **id != NO_ID).count();
    let spoilt = |spoil: fn(DVec3) -> DVec3| {
        let normals: Vec<[f64; 3]> = made.normals.iter().map(|n| spoil(DVec3::from(*n)).to_array()).collect();
        let answers = Answers { depths: None, normals: Some(&normals), ..made.answers() };
        let found = certified(&scene, &answers, Rays::View(view));
        assert!(found.worst[0].reason == Reason::Normal || found.largest() < 1.0, "{found}");
        found.count(Outcome::Violated)
    };
    assert_eq!(spoilt(|normal| normal), 0);
    assert_eq!(spoilt(|normal| -normal), hits);
    assert!(spoilt(|normal| DVec3::new(-normal.x, normal.y, normal.z)) > hits * 9 / 10);
    assert!(spoilt(|normal| (normal + DVec3::splat(1e-3)).normalize_or_zero()) > hits / 2);
    assert_eq!(spoilt(|normal| 1.01 * normal), hits);
}

/// The normal of a hit as renderers compute it, from the place of the hit in the world, in f32.
fn normal_in_world(ray: &Ray, depth: f64, center: [f32; 3]) -> [f32; 3] {
    let [o, d] = [ray.origin, ray.direction].map(|v| v.as_vec3().to_array());
    let v = [0, 1, 2].map(|axis| o[axis] + depth as f32 * d[axis] - center[axis]);
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// Coordinates far from the origin have few digits, so that normals made of them do as well.
#[test]
fn honest_normals_far_from_the_origin_are_not_accused() {
    let mut hits = 0;
    for (far, turned) in [(0.0_f32, 1e-4), (4096.0, 5e-3), (1e4, 1e-2), (1e6, 1.0)] {
        for axes in [[1.0_f32, 1.0, 1.0], [1.0, 0.0, 0.0]] {
            let center = axes.map(|axis| axis * far);
            let [x, y, z] = center.map(f64::from);
            let scene = Scene::from_f32(vec![[center[0], center[1], center[2], 1.0]], LinearRgb::WHITE).unwrap();
            let pose = Pose::looking_at([x, y, z + 8.0], [x, y, z], [0.0, 1.0, 0.0]).unwrap();
            let camera = PinholeCamera::with_vertical_fov(pose, 0.3, 1.0).unwrap();
            let view = View::new(&camera, Film::new(64, 64).unwrap());
            let pixels = (0..64).flat_map(|j| (0..64).map(move |i| [i, j]));
            let rays: Vec<Ray> = pixels.map(|pixel| narrowed(view.ray_through_center(pixel).unwrap())).collect();
            let in_world = [[center[0], center[1], center[2], 1.0]];
            let made = Layers::by_testing_all(&in_world, [64, 64], &rays, careful);
            let normals: Vec<[f64; 3]> = rays
                .iter()
                .zip(&made.depths)
                .map(|(ray, depth)| normal_in_world(ray, *depth, center).map(f64::from))
                .collect();
            let answers = Answers { normals: Some(&normals), ..made.answers() };
            for rays in [Rays::Given(&rays), Rays::View(view)] {
                let found = certified(&scene, &answers, rays);
                assert_eq!(found.count(Outcome::Violated), 0, "{far}: {found}");
                let spoil = |n: &[f64; 3]| (DVec3::from(*n) + turned * DVec3::Y).normalize_or_zero().to_array();
                let normals: Vec<_> = normals.iter().map(spoil).collect();
                let found = certified(&scene, &Answers { normals: Some(&normals), ..answers }, rays);
                hits = made.ids.iter().filter(|id| **id != NO_ID).count();
                assert!(found.count(Outcome::Violated) > hits / 2, "{far}: {found}");
                assert_eq!(found.worst[0].reason, Reason::Normal);
            }
        }
    }
    assert!(hits > 2000, "{hits}");
}

/// Measures the table of least errors in `docs/explain/how-verify-decides.md`.
#[test]
fn least_errors_are_those_of_the_table() {
    let scenes = [
        spheres::random(300, 5, |rng| 0.01 + 0.06 * rng.f32()),
        spheres::random(800, 6, |_| 0.02),
        spheres::four_decades(400),
        spheres::random(3, 7, |_| 0.3),
    ];
    let seen = |scene: &Scene, turn: f64| {
        let (_, [outside, ..]) = poses(scene);
        let away = (scene.bounds_to_frame().center() - outside.origin()).normalize_or_zero();
        let turned = away + turn * away.any_orthonormal_vector();
        let pose = Pose::looking_along(outside.origin(), turned, [0.1, 1.0, 0.2]).unwrap();
        PinholeCamera::with_vertical_fov(pose, 0.7, 1.3).unwrap()
    };
    let errors: Vec<i32> = (-24..-4).collect();
    let mut table = String::new();
    for (name, has_depths, has_normals) in [
        ("depths, times 1 + e", true, false),
        ("radii, times 1 + e", true, false),
        ("radii, times 1 + e; ids alone", false, false),
        ("camera, turned by e radians", true, false),
        ("camera, turned by e radians; ids alone", false, false),
        ("normals, turned by e radians", false, true),
    ] {
        // The exponent of the first error that is found, in each scene.
        let mut found = [Vec::new(), Vec::new()];
        for spheres in &scenes {
            let exact = scene(spheres);
            let camera = seen(&exact, 0.0);
            let view = View::new(&camera, film());
            let pixels = (0..47).flat_map(|j| (0..61).map(move |i| [i, j]));
            let rays: Vec<Ray> = pixels.map(|pixel| narrowed(view.ray_through_center(pixel).unwrap())).collect();
            for (found, rays) in found.iter_mut().zip([Rays::Given(&rays), Rays::View(view)]) {
                let is_missed = |exponent: &i32| {
                    let e = 2_f64.powi(*exponent);
                    let part = |word: &str| if name.starts_with(word) { e } else { 0.0 };
                    let spoilt = spheres.iter().map(|[x, y, z, r]| [*x, *y, *z, r + r * part("radii") as f32]);
                    let spoilt = scene(&spoilt.collect::<Vec<_>>());
                    let mut made = Layers::by_reference(&spoilt, &View::new(&seen(&exact, part("camera")), film()));
                    made.depths.iter_mut().for_each(|depth| *depth *= 1.0 + part("depths"));
                    let turned = |n: &[f64; 3]| {
                        let n = DVec3::from(*n);
                        (n + part("normals") * n.any_orthonormal_vector()).normalize_or_zero().to_array()
                    };
                    let normals: Vec<_> = made.normals.iter().map(turned).collect();
                    let answers = Answers {
                        depths: made.answers().depths.filter(|_| has_depths),
                        normals: Some(&*normals).filter(|_| has_normals),
                        ..made.answers()
                    };
                    certified(&exact, &answers, rays).outcome() != Outcome::Violated
                };
                found.push(errors[errors.partition_point(is_missed)]);
            }
        }
        let columns = found.map(|found| {
            let [first, last] = [found.iter().min(), found.iter().max()].map(|exponent| 2_f64.powi(*exponent.unwrap()));
            format!("{:.1e} | {last:.1e}", first / 2.0)
        });
        table += &format!("| {name} | {} |\n", columns.join(" | "));
    }
    let docs = include_str!("../../docs/explain/how-verify-decides.md");
    assert!(docs.contains(&table), "the table is now\n{table}");
}

#[test]
fn a_smaller_limit_decides_more() {
    let picture = TestPicture::new();
    let checker = Checker::new(&picture.scene).unwrap();
    let decided = |limit| {
        let answers = picture.made.answers();
        let rays = Rays::Given(&picture.rays);
        checker.certify_answers(&answers, rays, Some(limit)).unwrap()
    };
    let (small, large) = (decided(10.0), decided(1e5));
    assert!(small.decided_fraction() > large.decided_fraction());
    assert_eq!((small.outcome(), large.outcome()), (Outcome::Proved, Outcome::Undecided));
    // The least k of a pixel does not depend on the limit.
    for (small, large) in small.least.iter().zip(&large.least) {
        assert!((small - large).abs() <= 1e-6 * large, "{small} {large}");
    }
}

#[test]
fn what_cannot_be_judged_is_refused() {
    let scene = scene(&[[0.0, 0.0, 0.0, 1.0]]);
    let checker = Checker::new(&scene).unwrap();
    let ray = Ray { origin: DVec3::Z * 3.0, direction: -DVec3::Z };
    let good = Answers {
        size: [1, 1],
        ids: &[0],
        depths: Some(&[2.0]),
        normals: Some(&[[0.0, 0.0, 1.0]]),
        ..Answers::default()
    };
    let judge = |answers: Answers<'_>, rays: &[Ray], limit| checker.certify_answers(&answers, Rays::Given(rays), limit);
    assert_eq!(judge(good, &[ray], None).unwrap().outcome(), Outcome::Proved);
    let long = Ray { direction: DVec3::Z * 1.00001, ..ray };
    let nowhere = Ray { origin: DVec3::NAN, ..ray };
    let along = DepthKind::AlongAxis;
    for (answers, ray, limit, words) in [
        (Answers { size: [2, 1], ..good }, ray, None, "there are 1 ids for a picture of 2x1"),
        (Answers { depths: Some(&[]), ..good }, ray, None, "there are 0 depths"),
        (Answers { normals: Some(&[]), ..good }, ray, None, "there are 0 normals"),
        (Answers { ids: &[1], ..good }, ray, None, "the id at pixel (0, 0) is 1, but the scene has 1"),
        (Answers { depths: Some(&[-1.0]), ..good }, ray, None, "the depth at pixel (0, 0) is -1"),
        (Answers { depths: Some(&[f64::NAN]), ..good }, ray, None, "the depth at pixel (0, 0) is NaN"),
        (Answers { normals: Some(&[[f64::NAN; 3]]), ..good }, ray, None, "the normal at pixel (0, 0)"),
        (Answers { depth_kind: along, ..good }, ray, None, "depths along an axis need a camera"),
        (good, long, None, "the direction of the ray at pixel (0, 0) has the length 1.00001"),
        (good, nowhere, None, "the ray at pixel (0, 0) starts at [NaN, NaN, NaN]"),
        (good, ray, Some(0.0), "the limit 0 must be greater than 0"),
        (good, ray, Some(f64::NAN), "the limit NaN must be"),
    ] {
        let error: ConformanceError = judge(answers, &[ray], limit).unwrap_err();
        assert!(error.to_string().starts_with(words), "{error}");
    }
    let pose = Pose::looking_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = PanoramaCamera::new(pose);
    for (film, answers, words) in [
        (Film::new(2, 1).unwrap(), good, "the picture is 1x1 pixels, but the view is 2x1"),
        (Film::new(1, 1).unwrap(), Answers { depth_kind: along, ..good }, "depths along an axis"),
    ] {
        let rays = Rays::View(View::new(&camera, film));
        let error = checker.certify_answers(&answers, rays, None).unwrap_err();
        assert!(error.to_string().starts_with(words), "{error}");
    }
    // The depth of a miss does not matter.
    let away = Ray { direction: DVec3::Z, ..ray };
    let miss = Answers { ids: &[NO_ID], depths: Some(&[f64::NAN]), ..good };
    assert_eq!(judge(miss, &[away], None).unwrap().outcome(), Outcome::Proved);
}
