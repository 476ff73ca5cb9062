//! The files that are inputs of several cases.

use crate::npy_files::{npy, zip};
use crate::support::{Folder, SCENE, WATER};

/// A file of one sphere in each frame.
const MOVING: &str = "1\n\nO 0 0 0\n1\n\nO 2 0 0\n1\n\nO 4 0 0\n1\n\nO 6 0 0\n1\n\nO 8 0 0\n";

/// Spheres in a row, each with a number and a text, in a cell.
const ROW: &str = "4\nLattice=\"8 0 0 0 2 0 0 0 2\" Properties=species:S:1:pos:R:3:radius:R:1:charge:R:1:site:S:1\n\
                   C 0 0 0 1 -1 a\nC 2 0 0 1 0 b\nC 4 0 0 1 0.5 a\nC 6 0 0 1 3 c\n";

/// A camera path that shows one sphere from the right, from the front and from the left.
const PATH: &str = "[[keys]]\nframe = 0\neye = [-4, 0, 20]\nlook_at = [-4, 0, 0]\n\
                    [[keys]]\nframe = 2\neye = [4, 0, 20]\nlook_at = [4, 0, 0]\n";

/// A folder with all files that these arguments may name.
pub(super) fn folder(arguments: &str) -> Folder {
    let folder = Folder::with(&[
        ("scene.toml", SCENE),
        ("water.xyz", WATER),
        ("moving.xyz", MOVING),
        ("row.xyz", ROW),
        ("path.toml", PATH),
        ("text.bricks", "x,y,z\n1,2,3\n"),
        ("unknown.doc", "Hello\n"),
        ("missing-data.toml", "data = 'no.xyz'\n"),
        ("trajectory.toml", "data = 'water.xyz'\nframe = 5\n"),
        ("array.toml", "data = 'spheres.npy'\nframe = 2\n"),
        ("bright.toml", "data = 'spheres.npy'\ncolor = [2, 2, 2]\n[studio]\n"),
        ("demo.toml", "# mine\n"),
    ]);
    std::fs::create_dir(folder.path("folder.toml")).unwrap();
    let bytes = |numbers: &[f32]| numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let spheres = bytes(&[-2.0, 0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 1.0]);
    let array = npy("<f4", false, "(2, 4)", &spheres);
    let huge = "(1000000000000000000, 4)";
    for (name, contents) in [
        ("spheres.npy", array.clone()),
        ("no-radius.npy", npy("<f4", false, "(2, 3)", &spheres[..24])),
        ("complex.npy", npy("<c8", false, "(1, 4)", &spheres)),
        ("ten-columns.npy", npy("<f4", false, "(1, 10)", &[0; 40])),
        ("one-axis.npy", npy("<f4", false, "(8,)", &spheres)),
        ("cut.npy", array[..array.len() - 3].to_vec()),
        ("long.npy", [&*array, &[0; 4]].concat()),
        ("huge.npy", npy("<f4", false, huge, b"")),
        ("no-header.npy", array[..20].to_vec()),
        ("bad-header.npy", [&array[..10], &[b'?'; 118], &spheres[..]].concat()),
        ("zero-radius.npy", npy("<f4", false, "(1, 4)", &bytes(&[0.0; 4]))),
        ("nan.npy", npy("<f4", false, "(1, 4)", &bytes(&[0.0, f32::NAN, 0.0, 1.0]))),
        ("text.npy", b"1 2 3 4\n".to_vec()),
        ("two.npz", zip(&[("a.npy", &array), ("b.npy", &array)], false)),
        ("empty.npz", zip(&[], false)),
        ("complex.npz", zip(&[("spheres.npy", &npy("<c8", false, "(1, 4)", &spheres))], true)),
        ("text.npz", b"1 2 3 4\n".to_vec()),
        ("spheres.bin", spheres.clone()),
        ("cut.bin", spheres[..20].to_vec()),
        ("cut.gsd", vec![0xdf; 300]),
        ("cut.dcd", b"\x54\0\0\0CORD".to_vec()),
        ("cut.xtc", vec![0, 0, 7, 0xcb, 0, 0]),
        ("cut.trr", vec![0; 99]),
        ("no-header.las", b"LASF".to_vec()),
        ("text.las", b"0 0 0\n".to_vec()),
        ("format.las", las(1, |bytes| bytes[104] = 11)),
        ("length.las", las(1, |bytes| bytes[105] = 20)),
        ("compressed.las", las(1, |bytes| bytes[104] |= 0x80)),
        ("start.las", las(1, |bytes| bytes[99] = 0xff)),
        ("cut.las", las(2, |bytes| bytes.truncate(250))),
        ("nan-scale.las", las(1, |bytes| bytes[131..139].fill(0xff))),
        ("binary.toml", vec![0xff, 0xfe, 0x00]),
        ("binary.xyz", b"1\n\nO \xff 0 0\n".to_vec()),
        ("cut.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9 +X 9\n".to_vec()),
    ] {
        std::fs::write(folder.path(name), contents).unwrap();
    }
    for (name, contents) in arrays_to_certify() {
        std::fs::write(folder.path(name), contents).unwrap();
    }
    let is_named = |name| arguments.split(' ').any(|word| word == name);
    if is_named("a.bricks") {
        folder.run("sort spheres.npy -o a.bricks -q --bricks 2").succeeded();
    }
    if is_named("made") {
        let flags = "--frames :2 --tiles 2x1 --size 40x30 --samples 2 --backend cpu -q";
        folder.run(&format!("job split moving.xyz -o made {flags}")).succeeded();
    }
    for name in ["pipe.xyz", "pipe.toml", "pipe.bricks"].into_iter().filter(|name| is_named(name)) {
        assert!(std::process::Command::new("mkfifo").arg(folder.path(name)).status().unwrap().success());
    }
    folder
}

/// A file of LAS 1.2 with points of 26 bytes, which `change` damages.
fn las(points: u32, change: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
    let mut bytes = vec![0; 227 + 26 * points as usize];
    let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
    put(0, b"LASF");
    put(24, &[1, 2]);
    put(94, &227_u16.to_le_bytes());
    put(96, &227_u32.to_le_bytes());
    put(104, &[2]);
    put(105, &26_u16.to_le_bytes());
    put(107, &points.to_le_bytes());
    (0..3).for_each(|axis| put(131 + 8 * axis, &0.01_f64.to_le_bytes()));
    change(&mut bytes);
    bytes
}

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

/// The arrays that the command lines name. Good arrays are those of one sphere that fills the picture.
fn arrays_to_certify() -> Vec<(&'static str, Vec<u8>)> {
    let (size, of_vectors) = ("(30, 40)", "(30, 40, 3)");
    let id = |dtype: &str, bytes: &[u8]| npy(dtype, false, size, bytes);
    let zero = [0; 4];
    let depth = |other: f32| npy("<f4", false, size, &pixels(1_f32.to_le_bytes(), other.to_le_bytes()));
    let vectors_of = |value, other| npy("<f4", false, of_vectors, &vectors(value, other));
    let along = [0.0, 0.0, -1.0];
    let directions = vectors_of(along, along);
    let origins = npy("<f4", false, "(3,)", &[0; 12]);
    let rays =
        |directions: &[u8], origins: &[u8]| zip(&[("directions.npy", directions), ("origins.npy", origins)], false);
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
