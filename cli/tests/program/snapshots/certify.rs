//! Arrays that `pinhole certify` cannot judge.

use super::cases::{Case, lines};
use crate::npy_files::{npy, zip};

/// Pixels of `scene.toml`.
const PIXELS: usize = 40 * 30;

/// Bytes of an array of pixels that are all the same, except for the one at (2, 1).
fn pixels<const N: usize>(value: [u8; N], other: [u8; N]) -> Vec<u8> {
    (0..PIXELS).flat_map(|i| if i == 42 { other } else { value }).collect()
}

fn vectors(value: [f32; 3], other: [f32; 3]) -> Vec<u8> {
    let bytes = |v: [f32; 3]| v.map(f32::to_le_bytes).concat();
    (0..PIXELS).flat_map(|i| bytes(if i == 42 { other } else { value })).collect()
}

/// The arrays that the command lines name. Those of good ones are of one sphere that fills the picture.
pub(super) fn files() -> Vec<(&'static str, Vec<u8>)> {
    let (size, of_vectors) = ("(30, 40)", "(30, 40, 3)");
    let id = |dtype: &str, bytes: &[u8]| npy(dtype, false, size, bytes);
    let zero = [0; 4];
    let depth =
        |other: f32| npy("<f4", false, size, &pixels(1_f32.to_le_bytes(), other.to_le_bytes()));
    let vectors_of = |value, other| npy("<f4", false, of_vectors, &vectors(value, other));
    let along = [0.0, 0.0, -1.0];
    let directions = vectors_of(along, along);
    let origins = npy("<f4", false, "(3,)", &[0; 12]);
    let rays = |directions: &[u8], origins: &[u8]| {
        zip(&[("directions.npy", directions), ("origins.npy", origins)], false)
    };
    vec![
        ("id.npy", id("<u4", &pixels(zero, zero))),
        ("small-id.npy", npy("<u4", false, "(1, 2)", &[0; 8])),
        ("float-id.npy", id("<f4", &pixels(zero, zero))),
        ("short-id.npy", id("<i2", &[0; 2 * PIXELS])),
        ("native-id.npy", id("=i4", &pixels(zero, zero))),
        ("flat-id.npy", npy("<u4", false, "(1200,)", &pixels(zero, zero))),
        ("negative-id.npy", id(">i4", &pixels(zero, (-7_i32).to_be_bytes()))),
        ("beyond-id.npy", id(">i4", &pixels(zero, 1_i32.to_be_bytes()))),
        ("large-id.npy", id("<u8", &pixels([0; 8], 5_000_000_000_u64.to_le_bytes()))),
        ("u32-miss-id.npy", id("<i8", &pixels([0; 8], i64::from(u32::MAX).to_le_bytes()))),
        ("small-depth.npy", npy("<f4", false, "(1, 2)", &[0; 8])),
        ("integer-depth.npy", id("<i4", &pixels(zero, zero))),
        ("half-depth.npy", id("<f2", &[0; 2 * PIXELS])),
        ("nan-depth.npy", depth(f32::NAN)),
        ("negative-depth.npy", depth(-0.5)),
        ("infinite-depth.npy", depth(f32::INFINITY)),
        ("nan-normal.npy", vectors_of([0.0, 0.0, 1.0], [f32::NAN; 3])),
        ("depth.npy", depth(1.0)),
        ("long-rays.npz", rays(&vectors_of(along, [0.0, 0.0, -1.1]), &origins)),
        ("small-rays.npz", rays(&npy("<f4", false, "(1, 2, 3)", &[0; 24]), &origins)),
        ("point-rays.npz", rays(&directions, &npy("<f4", false, "(2, 3)", &[0; 24]))),
        ("no-origins.npz", zip(&[("directions.npy", &directions)], false)),
        ("nan-rays.npz", rays(&directions, &npy("<f4", false, "(3,)", &[0xff; 12]))),
    ]
}

pub(super) fn certify() -> Vec<Case> {
    lines(
        "certify scene.toml
         certify scene.toml --id no.npy
         certify scene.toml --id text.npy
         certify scene.toml --id small-id.npy
         certify spheres.npy --size 8x6 --id small-id.npy
         certify scene.toml --id float-id.npy
         certify scene.toml --id short-id.npy
         certify scene.toml --id native-id.npy
         certify scene.toml --id flat-id.npy
         certify scene.toml --id negative-id.npy
         certify scene.toml --id beyond-id.npy
         certify scene.toml --id large-id.npy
         certify scene.toml --id u32-miss-id.npy
         certify scene.toml --id id.npy --depth small-depth.npy
         certify scene.toml --id id.npy --depth integer-depth.npy
         certify scene.toml --id id.npy --depth half-depth.npy
         certify scene.toml --id id.npy --depth nan-depth.npy
         certify scene.toml --id id.npy --depth negative-depth.npy
         certify scene.toml --id id.npy --depth infinite-depth.npy
         certify scene.toml --id id.npy --depth-is z
         certify scene.toml --id id.npy --depth depth.npy --depth-is w
         certify scene.toml --id id.npy --depth depth.npy --depth-is z --camera panorama
         certify scene.toml --id id.npy --depth depth.npy --depth-is z --rays long-rays.npz
         certify scene.toml --id id.npy --normal depth.npy
         certify scene.toml --id id.npy --normal nan-normal.npy
         certify scene.toml --id id.npy --rays id.npy
         certify scene.toml --id id.npy --rays long-rays.npz
         certify scene.toml --id id.npy --rays small-rays.npz
         certify scene.toml --id id.npy --rays point-rays.npz
         certify scene.toml --id id.npy --rays no-origins.npz
         certify scene.toml --id id.npy --rays nan-rays.npz
         certify scene.toml --id id.npy --rays long-rays.npz --fov 30
         certify scene.toml --id id.npy --at-most 0
         certify scene.toml --id id.npy --at-most nan
         certify scene.toml --id id.npy --at-most many
         certify scene.toml --id id.npy --json no/a.json
         certify scene.toml --id id.npy --json id.npy
         certify no.toml --id id.npy",
    )
}
