//! Rays with cones, alone and in scenes: the reference against what is legal for a device.

use pinhole::geometry::math::unit;
use pinhole::geometry::ray::Ray;
use pinhole::glam::DVec3;
use pinhole::internals::{ConeAnswer, LegalConeHits, NO_HIT, RayAndCone, intersect_cone, rays_and_cones};
use pinhole::scene::cone::{Caps, Cone};
use pinhole::verify::{Checker, TracedRay};
use pinhole::{LinearRgb, Scene, SphereArray, cpu};

use crate::support::effort::tries;
use crate::support::legal_device::{Habit, LegalDevice};

fn exact(input: &RayAndCone) -> ConeAnswer {
    let [origin, direction] = [input.origin, input.direction].map(|v| DVec3::from(v.map(f64::from)));
    match intersect_cone(&Ray { origin, direction }, &input.cone) {
        Some((t, normal)) => ConeAnswer { normal: normal.as_vec3().to_array(), t: t as f32 },
        None => ConeAnswer { normal: [0.0; 3], t: NO_HIT },
    }
}

fn legal(input: &RayAndCone) -> LegalConeHits {
    LegalConeHits::new(input.origin, input.direction, &input.cone)
}

/// The reference computes by other formulas, so its answers show that bounds contain the exact ones.
#[test]
fn answers_of_the_reference_are_legal() {
    let mut hits = 0;
    let inputs = rays_and_cones(40_000);
    for input in &inputs {
        let (answer, legal) = (exact(input), legal(input));
        assert!(legal.allows(answer.t, answer.normal), "{input:?}: {answer:?}; legal is {legal:?}");
        hits += usize::from(answer.t < NO_HIT);
    }
    assert!(hits > inputs.len() / 3);
}

type Plant = fn(&RayAndCone, &mut ConeAnswer);

#[test]
fn wrong_answers_are_illegal() {
    let all: [(&str, Plant); 5] = [
        ("a hit that is not there", |_, answer| *answer = ConeAnswer { normal: [0.0, 0.0, 1.0], t: 1.0 }),
        ("no hit", |_, answer| answer.t = NO_HIT),
        ("a distance that is too large", |_, answer| answer.t *= 1.01),
        ("the other side of the surface", |_, answer| answer.normal = answer.normal.map(|c| -c)),
        ("the axis for the normal", |input, answer| {
            let [start, end] = [input.cone.start, input.cone.end].map(|v| DVec3::from(v.map(f64::from)));
            answer.normal = unit(end - start).unwrap().as_vec3().to_array();
        }),
    ];
    let inputs = rays_and_cones(4000);
    let hits: Vec<_> = inputs.iter().filter(|input| exact(input).t < NO_HIT && legal(input).is_decided()).collect();
    for (name, plant) in all {
        let is_found = |input: &&&RayAndCone| {
            let mut answer = exact(input);
            plant(input, &mut answer);
            !legal(input).allows(answer.t, answer.normal)
        };
        let found = hits.iter().filter(is_found).count();
        // The axis is the normal of a disc.
        assert!(found > hits.len() * 3 / 4, "{name}: {found} of {}", hits.len());
    }
}

fn cone_of(input: &RayAndCone) -> Cone {
    let [start, end] = [input.cone.start, input.cone.end].map(|place| place.map(f64::from));
    let radii = [input.cone.first_radius, input.cone.second_radius];
    let caps = match radii.map(f32::is_sign_positive) {
        [true, true] => Caps::Both,
        [true, false] => Caps::First,
        [false, true] => Caps::Second,
        [false, false] => Caps::None,
    };
    Cone::new(start, end, radii.map(|radius| radius.abs().into())).with_caps(caps)
}

/// The nearest hit of a scene by the reference, in the scene's frame.
fn nearest(scene: &Scene, spheres: &Scene, ray: &Ray) -> Option<(f64, u32)> {
    let of_sphere = cpu::trace(spheres, ray).map(|hit| (hit.t, hit.id));
    let of_cone = |(cone, id)| intersect_cone(ray, cone).map(|(t, _)| (t, id));
    let of_cones = scene.cones().iter().zip(scene.len() as u32..).filter_map(of_cone);
    of_sphere.into_iter().chain(of_cones).min_by(|(a, _), (b, _)| a.total_cmp(b))
}

/// A device that uses all the freedom of WGSL is not accused, alone or by what narrows its bounds in a scene.
#[test]
fn no_conforming_device_is_accused() {
    let mut worst = [0.0_f64; 2];
    for (input, seed) in rays_and_cones(tries(400_000) as usize).iter().zip(0..) {
        let Ok(()) = cone_of(input).check() else { continue };
        let legal = legal(input);
        let ray = TracedRay { origin: input.origin, direction: input.direction, distance: 0.0 };
        for habit in [Habit::Nearest, Habit::Up, Habit::Down, Habit::Random] {
            let mut device = LegalDevice { habit, random: fastrand::Rng::with_seed(seed) };
            let (t, normal) = device.cone(&ray, &input.cone);
            let answer = ConeAnswer { normal: if t < NO_HIT { normal } else { [0.0; 3] }, t };
            assert!(legal.allows(t, answer.normal), "{input:?}, {habit:?}: {answer:?}; legal is {legal:?}");
            if t < NO_HIT {
                let found = outside(input, t);
                worst = [worst[0].max(found[0]), worst[1].max(found[1])];
            }
        }
    }
    assert!(worst.into_iter().all(|worst| worst < 128.0), "{worst:?}");
}

/// How far outside of the cylinder around a cone, and of its box, a point of a ray is, in roundings of the longest vector to
/// the box and 2⁻²⁰ of the larger radius together.
fn outside(input: &RayAndCone, t: f32) -> [f64; 2] {
    let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let [origin, direction, start, end] = [input.origin, input.direction, input.cone.start, input.cone.end].map(wide);
    let radii = [input.cone.first_radius, input.cone.second_radius].map(|radius| f64::from(radius.abs()));
    let axis = unit(end - start).unwrap();
    let around = DVec3::from(DVec3::AXES.map(|side| (side - side.dot(axis) * axis).length()));
    let low = (start - radii[0] * around).min(end - radii[1] * around);
    let high = (start + radii[0] * around).max(end + radii[1] * around);
    let radius = radii[0].max(radii[1]);
    let unit = f64::from(f32::EPSILON) * ((low - origin).abs().max((high - origin).abs()).length() + 2048.0 * radius);
    let point = origin + f64::from(t) * direction;
    let height = (point - start).dot(axis);
    let beyond = (-height).max(height - (end - start).length());
    let aside = (point - start - height * axis).length() - radius;
    let of_box = (low - point).max(point - high).max_element();
    [beyond.max(aside) / unit, of_box / unit]
}

#[test]
fn scenes_allow_the_reference_and_nothing_that_is_wrong() {
    let inputs: Vec<_> = rays_and_cones(24_000).into_iter().filter(|input| cone_of(input).check().is_ok()).collect();
    let (mut rays, mut decided, mut hits) = (0, 0, 0);
    // Other ids, misses, and distances that are a little off.
    let mut found = [0; 3];
    for inputs in inputs.chunks(60) {
        let cones: Vec<Cone> = inputs.iter().map(cone_of).collect();
        let spheres: Vec<[f32; 4]> = cones
            .iter()
            .step_by(4)
            .map(|cone| {
                [cone.end[0], cone.end[1], cone.end[2], 0.7 * (cone.radii[0] + cone.radii[1])].map(|x| x as f32)
            })
            .collect();
        let scene = Scene::from_shapes(SphereArray::F32(spheres), &cones, LinearRgb::WHITE.into()).unwrap();
        let spheres = Scene::from_f32(scene.spheres().to_vec(), LinearRgb::WHITE).unwrap();
        if spheres.origin() != DVec3::ZERO {
            continue;
        }
        let checker = Checker::new(&scene).unwrap();
        for RayAndCone { origin, direction, .. } in inputs {
            let legal = checker.legal_hits(*origin, *direction);
            let [origin, direction] = [origin, direction].map(|v| DVec3::from(v.map(f64::from)));
            let exact = nearest(&scene, &spheres, &Ray { origin, direction });
            let is_decided = legal.count() == 1;
            (rays, decided) = (rays + 1, decided + u32::from(is_decided));
            let Some((t, id)) = exact else {
                assert!(legal.miss, "{origin} {direction}: a miss; legal is {legal}");
                continue;
            };
            assert!(legal.allows(id, t), "{origin} {direction}: {id} at {t}; legal is {legal}");
            if is_decided {
                hits += 1;
                let off = [t * (1.0 + 1e-4), t * (1.0 - 1e-4)];
                let others = (0..scene.shape_count() as u32).filter(|other| *other != id);
                found[0] += usize::from(others.into_iter().all(|other| !legal.allows(other, t)));
                found[1] += usize::from(!legal.miss);
                found[2] += usize::from(!off.into_iter().any(|t| legal.allows(id, t)));
            }
        }
    }
    assert!(rays > 15_000 && decided > rays * 3 / 4, "{decided} of {rays}");
    assert_eq!(found[..2], [hits; 2]);
    assert!(found[2] > hits * 2 / 3, "{found:?} of {hits}");
}
