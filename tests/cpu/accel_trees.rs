//! The tree against trying every sphere, in f32 and to the bit.

use fastrand::Rng;
use pinhole::internals::{NO_HIT, Nearest, WideTree};

use crate::rays::{assert_same, brute, corners, rays};
use crate::support::spheres::{self, Spheres, random, scaled};

fn check(name: &str, spheres: &Spheres, count: usize) {
    let (low, high) = corners(spheres);
    // The rule of the host.
    let margin = (high - low).length() / 262_144.0;
    let wide = WideTree::build(spheres, margin);
    wide.validate(spheres).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(wide, WideTree::build(spheres, margin), "{name}");

    let ordered = |ids: &[u32]| -> Spheres { ids.iter().map(|id| spheres[*id as usize]).collect() };
    let in_wide = ordered(wide.ids());
    let mut rng = Rng::with_seed(spheres.len() as u64);
    let mut hits = 0;
    for ray in rays(&mut rng, spheres, count) {
        let expected = brute(spheres, &ray);
        let mut found = Nearest::NONE;
        wide.find_nearest(&in_wide, wide.ids(), &ray, &mut found);
        assert_same(found, expected, name, &ray);
        // Strictly before, so not at the nearest distance itself.
        for (t_max, any) in [(NO_HIT, expected.t < NO_HIT), (expected.t, false)] {
            assert_eq!(wide.find_any(&in_wide, &ray, t_max), any, "{name}: {ray:?}");
        }
        hits += u32::from(expected.t < NO_HIT);
    }
    assert!(hits > 0 || spheres.is_empty(), "{name}");
}

#[test]
fn few_spheres() {
    for count in (0..=60).chain([191, 192, 193, 200]) {
        check(&format!("{count} spheres"), &random(count, 1, |_| 0.1), 400);
    }
}

#[test]
fn random_spheres() {
    check("20,000", &random(20_000, 2, |_| 0.01), 1_600);
    check("sparse", &random(20_000, 3, |_| 0.001), 1_600);
    check("four decades", &spheres::four_decades(5_000), 2_000);
}

#[test]
fn spheres_that_nothing_tells_apart() {
    check("1,000 equal", &vec![[1.0, 2.0, 3.0, 0.5]; 1_000], 800);
    check("coincident", &spheres::coincident(100_000), 40);
    check("concentric", &spheres::concentric(100_000), 40);
    check("twice", &spheres::twice(2_000), 2_000);
}

#[test]
fn spheres_in_order() {
    check("line", &spheres::line(1_000), 1_000);
    check("nested", &spheres::nested(1_000), 800);
    check("geometric", &spheres::geometric(1_000), 800);
    check("lattice", &spheres::lattice(20), 1_600);
}

#[test]
fn spheres_of_uneven_size_and_density() {
    check("one around all", &spheres::one_around_all(3_000), 2_000);
    check("clusters", &spheres::clusters(50, 200), 2_000);
    check("far", &spheres::far(2_000), 2_000);
    let tiny = random(2_000, 10, |_| 0.02);
    for scale in [2_f32.powi(-50), 2_f32.powi(55)] {
        check("scaled", &scaled(&tiny, scale), 1_000);
    }
}
