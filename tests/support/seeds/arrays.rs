//! Good files of arrays.

use pinhole::load::Options;

use super::Seed;
use crate::arrays as files;

/// Two spheres: x, y, z, radius.
const NUMBERS: [f32; 8] = [-2.0, 0.0, 0.5, 1.0, 2.0, -1.0, 0.0, 0.5];

pub(super) fn raw() -> Vec<Seed> {
    vec![Seed::new(little_endian())]
}

pub(super) fn npy() -> Vec<Seed> {
    let big: Vec<u8> = NUMBERS.iter().flat_map(|x| f64::from(*x).to_be_bytes()).collect();
    vec![
        Seed::new(files::npy("<f4", false, "(2, 4)", &little_endian())),
        Seed::with_options(
            files::npy(">f8", true, "(2, 3)", &big[..48]),
            Options::default().with_radius(1.0),
        ),
        Seed::new(files::structured()),
    ]
}

pub(super) fn npz() -> Vec<Seed> {
    let [spheres, positions] = [0, 1].map(|index| npy().swap_remove(index));
    let (spheres, radius) = (spheres.bytes, positions.options);
    vec![
        Seed::new(files::zip(&[("other.npy", &spheres), ("spheres.npy", &spheres)], false)),
        Seed::new(files::zip(&[("arr_0.npy", &spheres)], true)),
        Seed::with_options(files::zip(&[("a.npy", &positions.bytes)], true), radius),
        Seed::new(files::zip(&[("a.npy", &files::structured())], false)),
    ]
}

fn little_endian() -> Vec<u8> {
    NUMBERS.iter().flat_map(|x| x.to_le_bytes()).collect()
}
