//! The test of rays with cones: the reference against what is legal for a device.

use pinhole::geometry::math::unit;
use pinhole::geometry::ray::Ray;
use pinhole::glam::DVec3;
use pinhole::internals::{ConeAnswer, LegalConeHits, NO_HIT, RayAndCone, intersect_cone, rays_and_cones};

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
