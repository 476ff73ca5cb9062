//! Compares structures with testing every sphere, ray by ray, to the bit. Without the margin, losses must be seen.

use fastrand::Rng;
use glam::DVec3;

use super::search::{GridIndex, Search, SearchStructure, TreeIndex};
use super::sphere::intersect;
use crate::accel::wide_tree_visit::BoxRay;
use crate::accel::{AccelPlan, Structure};
use crate::geometry::cone::ConeInFrame;
use crate::geometry::cone_crossing;
use crate::geometry::math::wide;
use crate::geometry::ray::Ray;
use crate::image::color::LinearRgb;
use crate::recording::cone_rays::rays_and_cones;
use crate::scene::cone::{Caps, Cone};
use crate::scene::sphere_array::SphereArray;
use crate::scene::{Appearance, Colors, Scene, Shape};

#[allow(dead_code, reason = "some of its scenes are for other tests")]
#[path = "../../tests/support/spheres.rs"]
mod spheres;

fn scenes() -> Vec<(&'static str, spheres::Spheres)> {
    let sizes = |rng: &mut Rng| 10_f32.powf(-6.0 * rng.f32()) * 0.3;
    vec![
        ("random", spheres::random(3000, 1, |_| 0.02)),
        ("six decades", spheres::random(800, 2, sizes)),
        ("twice", spheres::twice(300)),
        ("coincident", spheres::coincident(200)),
        ("concentric", spheres::concentric(300)),
        ("nested", spheres::nested(300)),
        ("mirrored", spheres::mirrored(300)),
        ("geometric", spheres::geometric(300)),
        ("one around all", spheres::one_around_all(500)),
        ("clusters", spheres::clusters(8, 80)),
        ("far", spheres::far(400)),
        ("flat", spheres::flat(400)),
        ("line", spheres::line(300)),
        ("outlier", spheres::outlier(500)),
        ("huge", spheres::scaled(&spheres::random(400, 3, |_| 0.05), 2_f32.powi(55))),
        ("tiny", spheres::scaled(&spheres::random(400, 4, |_| 0.05), 2_f32.powi(-50))),
        ("few", spheres::random(17, 5, |_| 0.3)),
    ]
}

fn scene(spheres: &spheres::Spheres) -> Scene {
    let appearance = Appearance::new(Colors::One(LinearRgb::WHITE));
    Scene::from_parts(SphereArray::F32(spheres.clone()), appearance).unwrap()
}

fn direction(random: &mut Rng) -> DVec3 {
    let axis = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    match random.u32(0..6) {
        0 => axis[random.usize(0..6)],
        1 => (axis[random.usize(0..3)] + 1e-9 * axis[random.usize(0..6)]).normalize_or(DVec3::X),
        _ => DVec3::from([0; 3].map(|_| random.f64() - 0.5)).normalize_or(DVec3::X),
    }
}

/// A ray along a sphere's silhouette, from its surface, from within or from anywhere, up to 10¹⁶ radii away.
fn ray(random: &mut Rng, spheres: &[[f32; 4]]) -> Ray {
    let [x, y, z, radius] = spheres[random.usize(0..spheres.len())];
    let (center, radius) = (wide([x, y, z]), f64::from(radius));
    let outward = direction(random);
    let toward = direction(random);
    let along = (toward - outward * toward.dot(outward)).normalize_or(outward.any_orthonormal_vector());
    let away = radius * 10_f64.powf(18.0 * random.f64() - 2.0);
    match random.u32(0..8) {
        0 => Ray { origin: center + radius * outward, direction: toward },
        1 => Ray { origin: center + radius * outward, direction: along },
        2 => Ray { origin: center + radius * random.f64() * outward, direction: toward },
        3 => Ray { origin: center, direction: outward },
        4 => Ray { origin: center - away * toward, direction: toward },
        _ => {
            let beside = radius * (1.0 + (random.f64() - 0.5) * 10_f64.powf(-16.0 * random.f64()));
            Ray { origin: center + beside * outward - away * along, direction: along }
        }
    }
}

fn distance(ray: &Ray) -> impl Fn(Shape) -> Option<f64> {
    |shape| match shape {
        Shape::Sphere([x, y, z, radius]) => intersect(ray, wide([x, y, z]), radius.into()).map(|(t, _)| t),
        Shape::Cone(cone) => cone_crossing::intersect(ray, &cone).map(|(t, _)| t),
    }
}

/// The id of the nearest shape and the bits of its distance.
fn nearest(search: Search<'_>, ray: &Ray) -> Option<(u32, u64)> {
    search.nearest(ray, distance(ray)).map(|nearest| (nearest.id, nearest.t.to_bits()))
}

const KINDS: [Structure; 2] = [Structure::WideTree, Structure::Grid];

#[test]
fn structures_have_the_answers_of_testing_every_sphere() {
    let mut random = Rng::with_seed(31);
    let mut misses = 0;
    for (name, spheres) in scenes() {
        let scene = scene(&spheres);
        let structures = KINDS.map(|kind| SearchStructure::of(&scene, kind));
        let mut hits = 0;
        for _ in 0..1500 {
            let ray = ray(&mut random, scene.spheres());
            let every = Search::from(&scene);
            let wanted = nearest(every, &ray);
            let hit = distance(&ray);
            let t = wanted.map_or(random.f64(), |(_, t)| f64::from_bits(t));
            let limits = [t, t.next_up(), t * 3.0 * random.f64(), f64::INFINITY];
            let any = |search: Search<'_>| {
                limits.map(|t_max| {
                    let is_before = |_, shape| hit(shape).is_some_and(|t| t < t_max);
                    search.any(&ray, t_max, is_before)
                })
            };
            let any_wanted = any(every);
            for (kind, structure) in KINDS.iter().zip(&structures) {
                let search = Search::from(structure);
                assert_eq!(wanted, nearest(search, &ray), "{name}, {kind:?}: {ray:?}");
                assert_eq!(any_wanted, any(search), "{name}, {kind:?}: {ray:?} before {limits:?}");
            }
            *if wanted.is_some() { &mut hits } else { &mut misses } += 1;
        }
        assert!(hits > 300, "{name}: {hits}");
    }
    assert!(misses > 3000, "{misses}");
}

/// Grids accept most of these rays, including rays that start outside the scene.
#[test]
fn grids_accept_rays_from_far_away() {
    let mut random = Rng::with_seed(34);
    let scene = scene(&spheres::random(300, 7, |_| 0.05));
    let plan = AccelPlan::of(scene.spheres(), Structure::Grid, u64::MAX);
    let grid = GridIndex::new(&plan, &scene).unwrap();
    for (away, is_accepted) in [(1e6, true), (1e9, false)] {
        for _ in 0..100 {
            let toward = direction(&mut random);
            let ray = Ray { origin: -away * toward, direction: toward };
            assert_eq!(grid.visit(&ray, f64::INFINITY, &mut |_, _| f64::INFINITY), is_accepted);
        }
    }
}

/// Rays with directions that are not of unit length, or with NaN or infinities, have the same answers too.
#[test]
fn odd_rays_have_the_same_answers() {
    let mut random = Rng::with_seed(32);
    let scene = scene(&spheres::random(300, 7, |_| 0.05));
    let structures = KINDS.map(|kind| SearchStructure::of(&scene, kind));
    let odd = [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e200, -0.0];
    for i in 0..2000 {
        let mut ray = ray(&mut random, scene.spheres());
        let axis = random.usize(0..3);
        match i % 3 {
            0 => ray.direction *= 10_f64.powf(2.0 * random.f64() - 1.0),
            1 => ray.origin[axis] = odd[random.usize(0..5)],
            _ => ray.direction[axis] = odd[random.usize(0..5)],
        }
        for structure in &structures {
            let found = [Search::from(&scene), Search::from(structure)].map(|s| nearest(s, &ray));
            assert_eq!(found[0], found[1], "{ray:?}");
        }
    }
}

/// The share of rays that lose the sphere that they hit first, with fractions of the margin and of the f32 rounding.
fn lost([of_margin, of_rounding]: [f64; 2]) -> f64 {
    let mut random = Rng::with_seed(33);
    let (mut hits, mut losses) = (0, 0);
    for (_, spheres) in scenes() {
        let scene = scene(&spheres);
        let tree = TreeIndex::of_spheres(&scene).unwrap();
        for _ in 0..1500 {
            let ray = ray(&mut random, scene.spheres());
            let Some((id, t)) = nearest(Search::from(&scene), &ray) else { continue };
            let mut boxes = BoxRay::new(ray.origin, ray.direction, tree.corners.unwrap()).unwrap();
            boxes.margin *= of_margin;
            boxes.rounding *= of_rounding;
            let mut is_found = false;
            let limit = f64::from_bits(t);
            tree.tree.visit(&boxes, limit, |range| {
                is_found |= tree.tree.ids[range].contains(&id);
                limit
            });
            hits += 1;
            losses += u32::from(!is_found);
        }
    }
    f64::from(losses) / f64::from(hits)
}

/// The extra width of boxes is needed, and exceeds the need.
#[test]
fn without_the_margin_spheres_are_lost() {
    let shares = [[0.0, 0.0], [1.0, 0.0], [1.0 / 64.0, 0.5]].map(lost);
    assert!(shares[..2].iter().all(|share| *share > 1e-3), "{shares:?}");
    assert!(shares[2] <= 0.0, "{shares:?}");
}

#[test]
fn an_empty_scene_has_no_hits() {
    let scene = scene(&Vec::new());
    let tree = SearchStructure::new(&scene).unwrap();
    let ray = Ray { origin: DVec3::ZERO, direction: DVec3::X };
    assert_eq!(nearest(Search::from(&tree), &ray), None);
}

/// Rays to rims, tips and tangent points of cones and needles of all sizes, among many others and some spheres.
#[test]
fn trees_of_cones_have_the_answers_of_testing_every_cone() {
    let mut hits = 0;
    for part in rays_and_cones(6400).chunks(64) {
        let as_given = |cone: &ConeInFrame| Cone {
            start: wide(cone.start).to_array(),
            end: wide(cone.end).to_array(),
            radii: cone.radii(),
            caps: match cone.are_closed() {
                [false, false] => Caps::None,
                [true, false] => Caps::First,
                [false, true] => Caps::Second,
                [true, true] => Caps::Both,
            },
        };
        let cones: Vec<Cone> =
            part.iter().map(|input| as_given(&input.cone)).filter(|cone| cone.check().is_ok()).collect();
        let balls = spheres::random(20, 7, |_| 0.05).iter().map(|ball| ball.map(f64::from)).collect();
        let scene = Scene::from_shapes(SphereArray::F64(balls), &cones, LinearRgb::WHITE.into()).unwrap();
        let structure = SearchStructure::new(&scene).unwrap();
        assert!(structure.cones.is_some() && scene.shape_count() > 80);
        for input in part {
            let ray = Ray { origin: wide(input.origin) - scene.origin(), direction: wide(input.direction) };
            let wanted = nearest(Search::from(&scene), &ray);
            assert_eq!(wanted, nearest(Search::from(&structure), &ray), "{ray:?}");
            hits += u32::from(wanted.is_some_and(|(id, _)| id >= 20));
        }
    }
    assert!(hits > 3000, "{hits}");
}
