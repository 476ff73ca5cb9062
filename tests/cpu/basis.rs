//! Orthonormal bases over random and degenerate input.

use glam::DVec3;
use pinhole::geometry::basis::OrthonormalBasis;
use pinhole::glam;

/// A vector of random direction, and of a length between 10⁻¹⁰⁰ and 10¹⁰⁰.
fn random_vector(random: &mut fastrand::Rng) -> DVec3 {
    let direction = DVec3::from([0; 3].map(|_| random.f64() * 2.0 - 1.0));
    direction * 10_f64.powf(random.f64() * 200.0 - 100.0)
}

fn assert_orthonormal(basis: &OrthonormalBasis, context: &str) {
    let (u, v, w) = (basis.u(), basis.v(), basis.w());
    for (name, value, expected) in [
        ("|u|", u.length(), 1.0),
        ("|v|", v.length(), 1.0),
        ("|w|", w.length(), 1.0),
        ("u·v", u.dot(v), 0.0),
        ("u·w", u.dot(w), 0.0),
        ("v·w", v.dot(w), 0.0),
        ("|u × v − w|", (u.cross(v) - w).length(), 0.0),
    ] {
        assert!((value - expected).abs() < 1e-14, "{name} = {value} for {context}");
    }
}

#[test]
fn any_two_vectors_make_a_right_handed_basis() {
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..100_000 {
        let (a, b) = (random_vector(&mut random), random_vector(&mut random));
        let basis = OrthonormalBasis::from_vectors(a, b).unwrap();
        assert_orthonormal(&basis, &format!("{a} and {b}"));
        // w lies along a, and b in the half plane of v.
        assert!(basis.w().dot(a) > 0.0 && basis.v().dot(b) > 0.0, "{a} and {b}");
    }
}

#[test]
fn nearly_parallel_vectors_make_a_basis_or_none() {
    let mut random = fastrand::Rng::with_seed(2);
    for _ in 0..10_000 {
        let (a, c) = (random_vector(&mut random), random_vector(&mut random));
        let across = OrthonormalBasis::from_vectors(a, c).unwrap().u();
        let tilt = 10_f64.powf(-random.f64() * 20.0);
        let b = a + across * a.length() * tilt;
        match OrthonormalBasis::from_vectors(a, b) {
            Some(basis) => assert_orthonormal(&basis, &format!("tilt {tilt:e}")),
            None => assert!(tilt < 1e-8, "tilt {tilt:e}"),
        }
    }
}

#[test]
fn a_known_basis() {
    let basis = OrthonormalBasis::from_vectors([0.0, 0.0, 2.0], [0.0, 3.0, 5.0]).unwrap();
    assert_eq!((basis.u(), basis.v(), basis.w()), (DVec3::X, DVec3::Y, DVec3::Z));
}

#[test]
fn degenerate_vectors_make_no_basis() {
    let good = DVec3::new(1.0, 2.0, 3.0);
    let none = |a: DVec3, b: DVec3| assert_eq!(OrthonormalBasis::from_vectors(a, b), None);
    none(DVec3::ZERO, good);
    none(good, DVec3::ZERO);
    for factor in [1.0, -1.0, 1e-300, -1e300] {
        none(good, good * factor);
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut vector = good;
            vector[axis] = bad;
            none(vector, good);
            none(good, vector);
        }
    }
}
