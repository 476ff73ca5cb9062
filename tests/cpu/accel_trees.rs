//! Both trees against trying every sphere, in f32 and to the bit.

use fastrand::Rng;
use pinhole::accel::{BinaryTree, NO_HIT, Nearest, RayF32, WideTree, intersect_sphere};
use pinhole::glam::Vec3;

type Spheres = Vec<[f32; 4]>;

/// What a host does: low and high corner of the scene's box.
fn corners(spheres: &Spheres) -> (Vec3, Vec3) {
    let corner = |sign: f32| {
        move |&[x, y, z, radius]: &[f32; 4]| Vec3::new(x, y, z) + Vec3::splat(sign * radius)
    };
    let low = spheres.iter().map(corner(-1.0)).reduce(Vec3::min).unwrap_or(Vec3::ZERO);
    let high = spheres.iter().map(corner(1.0)).reduce(Vec3::max).unwrap_or(Vec3::ONE);
    (low, high)
}

fn brute(spheres: &Spheres, ray: &RayF32) -> Nearest {
    let mut nearest = Nearest::NONE;
    for (id, sphere) in spheres.iter().enumerate() {
        let t = intersect_sphere(ray, *sphere);
        if t < NO_HIT {
            nearest.offer(t, id as u32);
        }
    }
    nearest
}

fn unit(rng: &mut Rng) -> Vec3 {
    loop {
        let v = Vec3::from_array([(); 3].map(|()| rng.f32() * 2.0 - 1.0));
        if (0.01..1.0).contains(&v.length_squared()) {
            return v / v.length();
        }
    }
}

/// A point of the box, often on its surface.
fn point(rng: &mut Rng, (low, high): (Vec3, Vec3)) -> Vec3 {
    let share = |rng: &mut Rng| match rng.u32(0..4) {
        0 => 0.0,
        1 => 1.0,
        _ => rng.f32(),
    };
    low + (high - low) * Vec3::new(share(rng), share(rng), share(rng))
}

fn rays(rng: &mut Rng, spheres: &Spheres, count: usize) -> Vec<RayF32> {
    let bounds = corners(spheres);
    let axis = |rng: &mut Rng| {
        let mut direction = Vec3::ZERO;
        direction[rng.usize(0..3)] = if rng.bool() { 1.0 } else { -1.0 };
        direction
    };
    let some_sphere = |rng: &mut Rng| match spheres.len() {
        0 => [0.5, 0.5, 0.5, 0.1],
        n => spheres[rng.usize(0..n)],
    };
    (0..count)
        .map(|i| {
            let [x, y, z, radius] = some_sphere(rng);
            let center = Vec3::new(x, y, z);
            let (origin, direction) = match i % 8 {
                0 => (point(rng, bounds), unit(rng)),
                // Along an axis, often along a face of the box: exact zeros, of both signs.
                1 => (point(rng, bounds), axis(rng) * 1.0),
                2 => (point(rng, bounds), -axis(rng)),
                // In a plane of two axes.
                3 => {
                    let mut direction = unit(rng);
                    direction[rng.usize(0..3)] = 0.0;
                    (point(rng, bounds), direction.normalize_or(Vec3::X))
                }
                // From within a sphere, and from its wall.
                4 => (center + unit(rng) * (radius * rng.f32()), unit(rng)),
                5 => (center + unit(rng) * radius, unit(rng)),
                // At a sphere, and past its rim as near as f32 says.
                6 => {
                    let origin = point(rng, bounds);
                    (origin, (center - origin).normalize_or(Vec3::Y))
                }
                _ => {
                    let origin = point(rng, bounds);
                    let rim = center + unit(rng).any_orthonormal_vector() * radius;
                    (origin, (rim - origin).normalize_or(Vec3::Z))
                }
            };
            RayF32 { origin, direction }
        })
        .collect()
}

fn assert_same(found: Nearest, expected: Nearest, name: &str, ray: &RayF32) {
    assert_eq!(
        (found.id, found.t.to_bits()),
        (expected.id, expected.t.to_bits()),
        "{name}: {found:?}, not {expected:?}, along {ray:?}"
    );
}

fn check(name: &str, spheres: &Spheres, count: usize) {
    let (low, high) = corners(spheres);
    // The rule of the host.
    let margin = (high - low).length() / 262_144.0;
    let wide = WideTree::build(spheres, margin);
    let binary = BinaryTree::build(spheres, margin);
    wide.validate(spheres).unwrap_or_else(|error| panic!("{name}: {error}"));
    binary.validate(spheres).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(wide, WideTree::build(spheres, margin), "{name}");
    assert_eq!(binary, BinaryTree::build(spheres, margin), "{name}");

    let ordered = |ids: &[u32]| -> Spheres { ids.iter().map(|id| spheres[*id as usize]).collect() };
    let (in_wide, in_binary) = (ordered(wide.ids()), ordered(binary.ids()));
    let mut rng = Rng::with_seed(spheres.len() as u64);
    let mut hits = 0;
    for ray in rays(&mut rng, spheres, count) {
        let expected = brute(spheres, &ray);
        let mut found = Nearest::NONE;
        wide.find_nearest(&in_wide, wide.ids(), &ray, &mut found);
        assert_same(found, expected, name, &ray);
        let mut found = Nearest::NONE;
        binary.find_nearest(&in_binary, binary.ids(), &ray, &mut found);
        assert_same(found, expected, name, &ray);
        // Strictly before, so not at the nearest distance itself.
        for (t_max, any) in [(NO_HIT, expected.t < NO_HIT), (expected.t, false)] {
            assert_eq!(wide.find_any(&in_wide, &ray, t_max), any, "{name}: {ray:?}");
            assert_eq!(binary.find_any(&in_binary, &ray, t_max), any, "{name}: {ray:?}");
        }
        hits += u32::from(expected.t < NO_HIT);
    }
    assert!(hits > 0 || spheres.is_empty(), "{name}");
}

fn random(count: usize, seed: u64, radius: impl Fn(&mut Rng) -> f32) -> Spheres {
    let mut rng = Rng::with_seed(seed);
    (0..count).map(|_| [rng.f32(), rng.f32(), rng.f32(), radius(&mut rng)]).collect()
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
    check("four decades", &random(5_000, 4, |rng| 10_f32.powf(-4.0 * rng.f32() - 0.5)), 2_000);
}

#[test]
fn spheres_that_nothing_tells_apart() {
    check("1,000 equal", &vec![[1.0, 2.0, 3.0, 0.5]; 1_000], 800);
    check("coincident", &vec![[0.0, 0.0, 0.0, 1.0]; 100_000], 40);
    let growing: Spheres = (0..100_000).map(|i| [7.0, 7.0, 7.0, 1.0 + i as f32 * 1e-3]).collect();
    check("concentric", &growing, 40);
    // Equal pairs, so that every answer is a tie.
    let mut twice = random(2_000, 5, |_| 0.03);
    twice.extend_from_within(..);
    check("twice", &twice, 2_000);
}

#[test]
fn spheres_in_order() {
    check("line", &(0..1_000).map(|i| [i as f32, 0.0, 0.0, 0.5]).collect(), 1_000);
    check(
        "nested",
        &(0..1_000).map(|i| [i as f32 * 1e-3, 0.0, 0.0, 1.0 + i as f32]).collect(),
        800,
    );
    let geometric = (0..1_000).map(|i| [1.03_f32.powi(i), 0.0, 0.0, 0.01 * 1.03_f32.powi(i)]);
    check("geometric", &geometric.collect(), 800);
    // Face-centred cubic, touching neighbours.
    let lattice = (0..20 * 20 * 20).filter_map(|i| {
        let [x, y, z] = [i % 20, i / 20 % 20, i / 400];
        let radius = std::f32::consts::FRAC_1_SQRT_2;
        ((x + y + z) % 2 == 0).then_some([x as f32, y as f32, z as f32, radius])
    });
    check("lattice", &lattice.collect(), 1_600);
}

#[test]
fn spheres_of_uneven_size_and_density() {
    let mut around = random(3_000, 6, |_| 0.005);
    around.insert(1_000, [0.5, 0.5, 0.5, 3.0]);
    check("one around all", &around, 2_000);
    let mut rng = Rng::with_seed(8);
    let clusters = (0..50).flat_map(|_| {
        let center = [rng.f32() * 100.0, rng.f32() * 100.0, rng.f32() * 100.0];
        let size = 10_f32.powf(-3.0 * rng.f32());
        let near: Spheres = random(200, rng.u64(..), |_| 0.05)
            .into_iter()
            .map(|[x, y, z, radius]| {
                let [a, b, c] = center;
                [a + x * size, b + y * size, c + z * size, radius * size]
            })
            .collect();
        near
    });
    check("clusters", &clusters.collect(), 2_000);
    let far = random(2_000, 9, |_| 1e-9);
    check("far", &far.iter().map(|s| s.map(|x| x * 1e7)).collect(), 2_000);
    let tiny = random(2_000, 10, |_| 0.02);
    for scale in [2_f32.powi(-50), 2_f32.powi(55)] {
        check("scaled", &tiny.iter().map(|s| s.map(|x| x * scale)).collect(), 1_000);
    }
}
