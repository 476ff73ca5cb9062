//! Generated scenes: they are the same on every machine, and match their description.

use pinhole::camera::Camera;
use pinhole::generate::{Kind, MAX_COUNT, Standard};
use pinhole::{LinearRgb, Scene};

fn spheres(kind: Kind, count: u64, seed: u64) -> Vec<[f32; 4]> {
    kind.spheres(count, seed).unwrap()
}

/// The FNV-1a hash of the bytes that a file would have.
fn hash(spheres: &[[f32; 4]]) -> u64 {
    let bytes = spheres.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A program in another language reproduced the random ones, to the bit. A change of these values changes all timings
/// that were ever reported.
#[test]
fn the_same_bytes_everywhere() {
    for (kind, eighth, expected) in [
        (Kind::Random, [0.336_846_9, 0.291_912_56, 0.503_863_16, 0.015_396_557], 0x0f4d_5f06_df19_b0b6),
        (Kind::Lattice, [0.097_222_224, 0.041_666_668, 0.013_888_889, 0.019_641_856], 0x3eba_aa20_0b59_49c5),
        (Kind::Clusters, [0.164_799_23, 0.183_925_29, 0.042_285_606, 1.150_728e-6], 0x97d2_a1d7_73c1_5c74),
        (Kind::Sphereflake, [0.549_809_75, 0.314_107_48, 0.772_165_54, 0.083_333_336], 0xca2b_dcee_e21f_0e83),
    ] {
        let found = spheres(kind, 20_000, 1);
        assert_eq!((found[7], hash(&found)), (eighth, expected), "{kind:?}");
        assert_eq!(found, spheres(kind, 20_000, 1));
    }
}

#[test]
fn seeds_matter_where_there_is_chance() {
    for kind in Kind::ALL {
        let differ = spheres(*kind, 100, 1) != spheres(*kind, 100, 2);
        assert_eq!(differ, matches!(kind, Kind::Random | Kind::Clusters), "{kind:?}");
    }
}

#[test]
fn every_number_of_spheres_makes_a_scene() {
    for kind in Kind::ALL {
        for count in [0, 1, 2, 9, 999, 2001] {
            let spheres = spheres(*kind, count, 3);
            assert_eq!(spheres.len() as u64, count, "{kind:?}");
            let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
            assert_eq!(scene.len() as u64, count, "{kind:?}");
        }
        let error = kind.spheres(MAX_COUNT + 1, 0).unwrap_err().to_string();
        assert_eq!(error, "4294967295 spheres are too many; a scene has at most 4294967294");
    }
}

#[test]
fn what_kinds_promise() {
    let in_cube = |s: &[f32; 4]| s[..3].iter().all(|x| (0.0..=1.0).contains(x));
    let random = spheres(Kind::Random, 1000, 4);
    assert!(random.iter().all(|s| in_cube(s) && (0.025..=0.05).contains(&s[3])));

    // 4·2³ spheres fill two cells a side; each but those at the border touches twelve others.
    let lattice = spheres(Kind::Lattice, 4 * 5 * 5 * 5, 0);
    let touching = |a: &[f32; 4], b: &[f32; 4]| {
        let squares: f32 = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum();
        let gap = squares.sqrt() - a[3] - b[3];
        assert!(gap > -1e-6 || a == b, "{a:?} and {b:?} overlap");
        gap.abs() < 1e-6
    };
    let neighbours = |a: &[f32; 4]| lattice.iter().filter(|b| touching(a, b)).count();
    assert!(lattice.iter().all(in_cube));
    assert_eq!(lattice.iter().map(neighbours).max(), Some(12));

    let clusters = spheres(Kind::Clusters, 20_000, 5);
    assert!(clusters.iter().all(|s| (1e-6..=1e-2).contains(&s[3])));
    let median = |mut numbers: Vec<f32>| {
        numbers.sort_by(f32::total_cmp);
        numbers[numbers.len() / 2]
    };
    let radius = median(clusters.iter().map(|s| s[3]).collect());
    assert!((0.8e-4..1.25e-4).contains(&radius), "log-uniform: {radius}");
}

#[test]
fn standard_scenes() {
    for standard in Standard::ALL {
        assert_eq!(standard.film().unwrap().width(), 1024, "{}", standard.name());
        assert!(standard.camera().unwrap().vectors().right.length() > 0.0);
    }
    assert_eq!(Standard::L1M.count(), 1_000_188);
    let spheres = Standard::C200k.spheres().unwrap();
    assert_eq!(spheres, Kind::Clusters.spheres(200_000, Standard::SEED).unwrap());
}
