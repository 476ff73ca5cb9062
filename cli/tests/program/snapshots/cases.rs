//! Wrong command lines, and the files that they name.

use super::points::las;
use crate::npy_files::{npy, zip};
use crate::support::{Folder, SCENE, WATER};

/// A command line, and the text file that it reads if [`folder`] does not hold it.
pub(super) struct Case {
    pub(super) input: Option<Input>,
    pub(super) arguments: String,
}

pub(super) struct Input {
    pub(super) name: &'static str,
    pub(super) text: &'static str,
}

/// A folder with all files that command lines name.
pub(super) fn folder() -> Folder {
    let folder = Folder::with(&[
        ("scene.toml", SCENE),
        ("water.xyz", WATER),
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
        ("cut.las", las(2, |bytes| bytes.truncate(250))),
        ("nan-scale.las", las(1, |bytes| bytes[131..139].fill(0xff))),
        ("binary.toml", vec![0xff, 0xfe, 0x00]),
        ("binary.xyz", b"1\n\nO \xff 0 0\n".to_vec()),
        ("cut.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9 +X 9\n".to_vec()),
    ] {
        std::fs::write(folder.path(name), contents).unwrap();
    }
    for (name, contents) in super::certify::files() {
        std::fs::write(folder.path(name), contents).unwrap();
    }
    folder
}

/// Reads command lines, one a line.
pub(super) fn lines(lines: &str) -> Vec<Case> {
    let lines = lines.lines().map(str::trim).filter(|line| !line.is_empty());
    lines.map(|line| Case { input: None, arguments: line.to_owned() }).collect()
}

/// Flags and values that are wrong whatever the files hold.
pub(super) fn arguments() -> Vec<Case> {
    lines(
        "rendr scene.toml
         render
         render scene.toml
         render scene.toml -o out.png --colour red
         render scene.toml -o out.png extra
         render scene.toml -o out.png -o again.png
         render scene.toml -o out.jpg
         render scene.toml -o out
         render scene.toml -o out.png --size 800
         render scene.toml -o out.png --size 0x600
         render scene.toml -o out.png --size 9000000x1
         render scene.toml -o out.png --bits 12
         render scene.toml -o out.png --bits many
         render scene.toml -o out.png --exposure 33
         render scene.toml -o out.png --tone reinhard
         render scene.toml -o out.png --transparent=maybe
         render scene.toml -o out.exr --bits 8
         render scene.toml -o out.png --layer depth
         render scene.toml -o out.png --layer depth=
         render scene.toml -o out.png --layer depht=d.npy
         render scene.toml -o out.png --layer depth=d.exr
         render scene.toml -o out.png --layer depth=d.npy --layer id=./d.npy
         render scene.toml -o out.png --stereo two-files
         render scene.toml -o out.png --frame 0
         render water.xyz -o out.png --frame x
         render spheres.bin -o out.png --format raw-f32x4 --radius 1
         render water.xyz -o out.png --color red
         render spheres.npy -o out.png --color gren
         render spheres.npy -o out.png --frame 0
         render no-radius.npy -o out.png --radius -1
         render scene.toml -o out.png --format doc
         render spheres.npy -o out.png --fov 30 --half-extent 1,1
         render spheres.npy -o out.png --fov -5
         render spheres.npy -o out.png --eye 0,0,5
         render spheres.npy -o out.png --eye 1,2
         render spheres.npy -o out.png --eye 1,1,1 --look-at 1,1,1
         render spheres.npy -o out.png --eye 0,5,0 --look-at 0,0,0 --up 0,1,0
         render spheres.npy -o out.png --eye nan,0,0 --direction 0,0,1
         render spheres.npy -o out.png --camera periscope
         render spheres.npy -o out.png --camera orthographic --fov 30
         render spheres.npy -o out.png --camera thin-lens
         render spheres.npy -o out.png --camera fisheye --angle 361
         render spheres.npy -o out.png --convergence 3
         generate random -o out.npy
         generate cubes -n 10 -o out.npy
         generate random -n 5000000000 -o out.npy
         generate random -n 10 -o out.png
         verify
         verify scene.toml --replay run
         verify --replay run --size 8x6
         demo --backend cpu --size 8
         render scene.toml -o out.png --backend tpu
         render scene.toml -o out.png --backend cpu --adapter x
         render scene.toml -o out.png --backend cpu --accel grid
         render scene.toml -o out.png --accel bvh
         render scene.toml -o out.png --limits none",
    )
}

/// Flags and commands that earlier versions had.
pub(super) fn removed() -> Vec<Case> {
    lines(
        "render scene.toml -o out.png --samples-per-part 4
         job split scene.toml -o job --samples-per-part=4
         job join job 0-3
         job status job --json
         job submit job --slurm
         render scene.toml -o out.png --accel binary-tree
         bench --calibrate
         bench scene.toml --counts
         bench scene.toml --pictures 1",
    )
}

/// Files that are missing, of another kind, or in a place that cannot be written.
pub(super) fn files() -> Vec<Case> {
    lines(
        "render no.toml -o out.png
         render no.xyz -o out.png
         render missing-data.toml -o out.png
         render folder.toml -o out.png
         render binary.toml -o out.png
         render binary.xyz -o out.png
         render unknown.doc -o out.png
         render scene -o out.png
         render spheres.bin -o out.png
         render water.xyz -o out.png --frame 1
         render trajectory.toml -o out.png
         render array.toml -o out.png
         render water.xyz -o out.png --format pdb
         render spheres.bin -o out.png --format npy
         render scene.toml -o no/such/out.png
         render scene.toml -o folder.toml
         render scene.toml -o out.png/
         render spheres.npy -o out.png --layer depth=spheres.npy
         generate random -n 10 -o no/out.npy
         info no.xyz
         info scene
         info folder.toml
         info spheres.bin
         info ten-columns.npy
         info cut.npy
         info water.xyz --frame 1
         info scene.toml --frame 1
         info --frame 1
         verify --replay no
         verify --replay scene.toml
         demo --backend cpu",
    )
}

/// NPY, NPZ and raw numbers.
pub(super) fn arrays() -> Vec<Case> {
    lines(
        "render spheres.npy -o out.png --backend cpu --radius 1
         render complex.npy -o out.png --backend cpu
         render ten-columns.npy -o out.png --backend cpu
         render one-axis.npy -o out.png --backend cpu
         render cut.npy -o out.png --backend cpu
         render long.npy -o out.png --backend cpu
         render huge.npy -o out.png --backend cpu
         render no-header.npy -o out.png --backend cpu
         render bad-header.npy -o out.png --backend cpu
         render zero-radius.npy -o out.png --backend cpu
         render nan.npy -o out.png --backend cpu
         render text.npy -o out.png --backend cpu
         render two.npz -o out.png --backend cpu
         render empty.npz -o out.png --backend cpu
         render complex.npz -o out.png --backend cpu
         render text.npz -o out.png --backend cpu
         render cut.bin -o out.png --backend cpu --format raw-f32x4
         render cut.gsd -o out.png --backend cpu
         render cut.dcd -o out.png --backend cpu
         render cut.dcd -o out.png --backend cpu --topology no.pdb
         render cut.dcd -o out.png --backend cpu --topology water.xyz
         render cut.xtc -o out.png --backend cpu --topology water.xyz
         render cut.trr -o out.png --backend cpu --topology water.xyz --frame 1
         render water.xyz -o out.png --backend cpu --topology water.xyz",
    )
}

/// Light, by flags.
pub(super) fn light() -> Vec<Case> {
    lines(
        "render scene.toml -o out.png --backend cpu --samples 0
         render scene.toml -o out.png --backend cpu --ao=0
         render scene.toml -o out.png --backend cpu --outline 0.1
         render scene.toml -o out.png --backend cpu --noise 0
         render scene.toml -o out.png --backend cpu --time 0s
         render scene.toml -o out.png --backend cpu --integrator patth
         render scene.toml -o out.png --backend cpu --filter triangle
         render scene.toml -o out.png --backend cpu --ao --integrator path
         render scene.toml -o out.png --backend cpu --integrator primary --samples 4
         render scene.toml -o out.png --backend cpu --keep-partial
         render bright.toml -o out.png --backend cpu",
    )
}

/// Commands that need an adapter, on a machine without drivers.
pub(super) fn devices() -> Vec<Case> {
    lines(
        "render scene.toml -o out.png --backend gpu
         render scene.toml -o out.png --adapter x
         plan scene.toml
         plan scene.toml --layer depht
         bench R1M
         bench R2M
         bench R1M --reps 0
         bench R1M --accel octree
         verify scene.toml
         verify scene.toml --save a --json ./a
         verify scene.toml --report water.xyz
         verify scene.toml --paths 2
         info --self-test
         info --adapter name",
    )
}

/// The same, by a program that was built without the feature `gpu`.
pub(super) fn without_gpu() -> Vec<Case> {
    lines(
        "render scene.toml -o out.png --backend gpu
         render scene.toml -o out.png --adapter x
         plan scene.toml
         bench R1M
         verify scene.toml
         info --self-test",
    )
}
