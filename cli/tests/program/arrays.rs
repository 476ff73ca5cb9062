//! Tests of arrays of spheres, and of the camera on the command line.

use crate::npy_files::{npy, zip};
use crate::support::{Folder, SCENE, WATER, decode};

/// Two spheres side by side.
const ROWS: [[f32; 4]; 2] = [[-2.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0]];

fn folder() -> Folder {
    let folder = Folder::with(&[("scene.toml", SCENE), ("water.xyz", WATER)]);
    let bytes = |columns: usize| -> Vec<u8> {
        ROWS.iter().flat_map(|row| row[..columns].to_vec()).flat_map(f32::to_le_bytes).collect()
    };
    let wide: Vec<u8> =
        ROWS.as_flattened().iter().flat_map(|x| f64::from(*x).to_be_bytes()).collect();
    let whole = npy("<f4", false, "(2, 4)", &bytes(4));
    for (name, contents) in [
        ("a.npy", whole.clone()),
        ("wide.npy", npy(">f8", false, "(2, 4)", &wide)),
        ("xyz.npy", npy("<f4", false, "(2, 3)", &bytes(3))),
        ("none.npy", npy("<f4", false, "(0, 4)", b"")),
        ("complex.npy", npy("<c8", false, "(1, 4)", &bytes(4))),
        ("cut.npy", whole[..whole.len() - 3].to_vec()),
        ("huge.npy", npy("<f4", false, "(1000000000000000000, 4)", b"")),
        ("bad.npy", npy("<f4", false, "(1, 4)", &[0; 16])),
        ("a.npz", zip(&[("arr_0.npy", &whole)], true)),
        ("two.npz", zip(&[("a.npy", &whole), ("b.npy", &whole)], false)),
        ("a.bin", bytes(4)),
        ("cut.bin", bytes(4)[..20].to_vec()),
    ] {
        std::fs::write(folder.path(name), contents).unwrap();
    }
    folder
}

#[track_caller]
fn refused(folder: &Folder, arguments: &str, code: i32, line: &str) {
    let before = folder.files();
    let run = folder.run(&format!("render {arguments} -o out.png --size 24x16 --backend cpu"));
    assert_eq!(run.stderr, format!("error: {line}\n"), "{arguments}");
    assert_eq!(run.code, code, "{arguments}");
    assert_eq!(folder.files(), before, "{arguments}");
}

/// A sparse file takes no space on the disk, but would take all of the memory.
#[test]
#[cfg(target_os = "linux")]
fn a_file_that_does_not_fit_into_memory() {
    let folder = Folder::new();
    let file = std::fs::File::create(folder.path("large.npy")).unwrap();
    if file.set_len(1 << 43).is_err() {
        return;
    }
    let run = folder.run("render large.npy -o out.png --backend cpu");
    assert_eq!(run.code, 1, "{}", run.stderr);
    let expected =
        "error: large.npy: reading 8796093022208 bytes needs 19114.7 GiB of memory, but only ";
    assert!(run.stderr.starts_with(expected), "{}", run.stderr);
    assert_eq!(folder.files(), ["large.npy"]);
}

/// Renders with some arguments, and returns the RGB bytes of the picture.
#[track_caller]
fn picture(folder: &Folder, arguments: &str) -> Vec<u8> {
    let arguments = format!("render {arguments} -o - --size 24x16 --backend cpu");
    let run = folder.run(&arguments).succeeded();
    assert_eq!(run.stderr, "", "{arguments}");
    decode(&run.stdout).2
}

#[test]
fn the_same_spheres_in_every_format() {
    let folder = folder();
    let expected = picture(&folder, "a.npy");
    assert!(expected.chunks(3).any(|rgb| *rgb != expected[..3]), "there is something to see");
    for arguments in [
        "wide.npy",
        "a.npz",
        "xyz.npy --radius 1",
        "a.bin --format raw-f32x4",
        "a.npy --color #cccccc",
        "a.npy --fov 30 --view 30,20 --up 0,1,0 --camera pinhole",
    ] {
        assert_eq!(picture(&folder, arguments), expected, "{arguments}");
    }
    assert_ne!(picture(&folder, "a.npy --color red"), expected);
    let none = folder.run("render none.npy -o none.png --backend cpu --size 24x16").succeeded();
    assert_eq!(
        none.stderr,
        "note: none.npy: the file has no spheres, so the picture shows only the background\n"
    );
    let (_, _, rgb) = decode(&folder.read("none.png"));
    assert!(rgb.chunks(3).all(|rgb| rgb == [0xf3, 0xf4, 0xf6]));
    for (name, scene) in [
        ("1.toml", "data = 'a.npy'\n"),
        ("2.toml", "data = 'xyz.npy'\nradius = 1\n"),
        ("3.toml", "data = 'xyz.npy'\nradius = 0.5\nradius_scale = 2\ncolor = '#cccccc'\n"),
        ("4.toml", "data = 'xyz.npy'\nradius = 7\n"),
        ("5.toml", "data = 'b.npz'\n[[spheres]]\ncenter = [-2, 0, 0]\nradius = 1\n"),
    ] {
        std::fs::write(folder.path(name), scene).unwrap();
    }
    // A scene file has the light and the view of its own.
    let expected = picture(&folder, "a.npy --style fast --direction 0,0,-1");
    let second = npy("<f4", false, "(1, 4)", &ROWS[1].map(f32::to_le_bytes).concat());
    std::fs::write(folder.path("b.npz"), zip(&[("x.npy", &second)], false)).unwrap();
    for arguments in ["1.toml", "2.toml", "3.toml", "4.toml --radius 1", "5.toml"] {
        assert_eq!(picture(&folder, arguments), expected, "{arguments}");
    }
}

#[test]
fn arrays_that_are_refused() {
    let folder = folder();
    let refused = |arguments: &str, code, line: &str| refused(&folder, arguments, code, line);
    refused(
        "a.npy --radius 1",
        2,
        "a.npy: the array has the shape (2, 4) with radii; remove the radius that is given for all spheres",
    );
    for radius in ["0", "-1", "inf"] {
        let line = format!("--radius {radius}: a radius must be finite and greater than 0");
        refused(&format!("xyz.npy --radius {radius}"), 2, &line);
    }
    refused(
        "complex.npy",
        1,
        "complex.npy: the array has the type <c8, but it must be of floating-point numbers or integers; save it as \
         a.astype('float32')",
    );
    refused(
        "cut.npy",
        1,
        "cut.npy: an array of shape (2, 4) and type <f4 takes 32 bytes, but 29 bytes follow the header; \
         the file is cut off",
    );
    refused(
        "huge.npy",
        1,
        "huge.npy: an array of shape (1000000000000000000, 4) and type <f4 takes 16000000000000000000 bytes, \
         but 0 bytes follow the header; the file is cut off",
    );
    refused(
        "two.npz",
        1,
        "two.npz: the archive has the arrays `a`, `b`; name the one with the centers `positions`, or `spheres` if it \
         has radii as well",
    );
    refused(
        "a.bin",
        2,
        "a.bin: the extension .bin does not show the format; if the file has x, y, z, radius in little-endian f32, \
         add --format raw-f32x4",
    );
    refused(
        "cut.bin --format raw-f32x4",
        1,
        "cut.bin: the file has 20 bytes, which are 1 × 16 + 4, but each sphere takes 16 bytes \
         (x, y, z, radius in little-endian f32); the file is cut off or has another format",
    );
    refused(
        "a.bin --format npy",
        1,
        "a.bin: this is not an .npy file: it does not start with \\x93NUMPY; write the file with numpy.save",
    );
    let run = folder.run("render bad.npy -o out.png --backend cpu");
    assert!(
        run.stderr.starts_with("error: bad.npy: sphere 0: its radius is 0.0; "),
        "{}",
        run.stderr
    );
    assert_eq!((run.code, run.stderr.lines().count()), (1, 1));
}

#[test]
fn flags_that_do_not_apply_to_the_data() {
    let folder = folder();
    std::fs::write(folder.path("data.toml"), "data = 'a.npy'\nframe = 2\n").unwrap();
    for (arguments, code, line) in [
        (
            "a.npy --frame 0",
            2,
            "--frame applies only to trajectories (.xyz, .extxyz, .pdb, .ent, .lammpstrj, .dump, .cif, .mmcif, .gsd, .dcd, .trr, .xtc); remove it",
        ),
        (
            "a.bin --format raw-f32x4 --radius 1",
            2,
            "--radius applies only to data that can lack radii (.xyz, .extxyz, .lammpstrj, .dump, .data, .lmp, .las, .gsd, .npy, .npz, .csv, .tsv, .ply, .vtp, .vtu); remove it",
        ),
        (
            "water.xyz --color red",
            2,
            "--color applies only to data without colors; remove it, because atoms have the colors of their elements",
        ),
        (
            "a.npy --color gren",
            2,
            "--color: `gren` is not a valid color; write a CSS name, \"#rrggbb\" or a linear triple [r, g, b]",
        ),
        (
            "scene.toml --radius 1",
            2,
            "scene.toml: --radius applies to the `data` of a scene, but this scene has no `data`; remove --radius",
        ),
        (
            "data.toml",
            1,
            "data.toml: `data`: frame applies only to trajectories (.xyz, .extxyz, .pdb, .ent, .lammpstrj, .dump, .cif, .mmcif, .gsd, .dcd, .trr, .xtc); remove it",
        ),
    ] {
        refused(&folder, arguments, code, line);
    }
}

#[test]
fn a_camera_on_the_command_line() {
    let folder = folder();
    let pinhole = "[camera.pinhole]\neye = [-1, 2, 8]\nlook_at = [0, 0, 0]\nup = [0, 1, 0.5]\n";
    let scenes = [
        ("fov", "--eye -1,2,8 --look-at 0,0,0 --up 0,1,0.5 --fov 40", "vertical_fov = 40\n"),
        (
            "plane",
            "--camera pinhole --eye -1,2,8 --look-at 0,0,0 --up 0,1,.5 --distance 2 --half-extent 0.9,0.6",
            "distance = 2\nhalf_extent = [0.9, 0.6]\n",
        ),
    ];
    for (name, flags, keys) in scenes {
        let scene = format!("style = 'default'\ndata = 'a.npy'\n{pinhole}{keys}");
        std::fs::write(folder.path(&format!("{name}.toml")), scene).unwrap();
        let expected = picture(&folder, &format!("{name}.toml"));
        assert_eq!(picture(&folder, &format!("a.npy {flags}")), expected, "{flags}");
        assert_ne!(picture(&folder, "a.npy"), expected);
        // Flags replace the whole camera of a scene.
        assert_eq!(picture(&folder, &format!("fov.toml {flags}")), expected, "{flags}");
    }
    let scene = "style = 'default'\ndata = 'a.npy'\n[camera.orthographic]\neye = [0, 0, -5]\ndirection = [0, 0, 1]\n\
                 half_extent = [6, 4]\n";
    std::fs::write(folder.path("parallel.toml"), scene).unwrap();
    let flags = "--camera orthographic --eye 0,0,-5 --direction 0,0,1 --half-extent 6,4";
    assert_eq!(picture(&folder, &format!("a.npy {flags}")), picture(&folder, "parallel.toml"));
}

#[test]
fn cameras_that_are_refused() {
    let folder = folder();
    for (flags, line) in [
        ("--fov 30 --half-extent 1,1", "`--fov` and `--half-extent` exclude each other; keep one"),
        (
            "--camera orthographic --distance 2",
            "--distance does not apply to the orthographic camera; remove it",
        ),
        (
            "--camera orthographic --fov 30",
            "--fov does not apply to the orthographic camera; remove it",
        ),
        ("--eye 0,0,5", "an `--eye` needs a `--look-at` point or a `--direction`"),
        ("--distance 2", "`--distance` needs a `--half-extent`; a field of view needs neither"),
        (
            "--eye 1,1,1 --look-at 1,1,1",
            "the eye and the look-at point are both at [1.0, 1.0, 1.0]; move one of them",
        ),
        (
            "--camera fisheye --angle 361",
            "the `--angle` in degrees is 361.0; it must lie between 0.0 and 360.0",
        ),
        ("--camera panorama --fov 30", "--fov does not apply to the panorama camera; remove it"),
        (
            "--camera thin-lens --f-stop 2",
            "`--f-stop` and `--focal-length` need each other: together they give the aperture radius",
        ),
        (
            "--camera thin-lens",
            "a lens needs an `--aperture-radius`, or an `--f-stop` with a `--focal-length`",
        ),
        (
            "--camera thin-lens --aperture-radius 1 --separation 1",
            "--separation does not apply to the thin-lens camera; remove it",
        ),
        ("--convergence 3", "--convergence needs --separation; add --separation"),
        (
            "--stereo two-files",
            "--stereo applies only to a camera with two eyes; add --separation, or `stereo` to the scene's camera",
        ),
        ("--fov -5", "the vertical field of view is -5 degrees; it must lie between 0 and 180"),
    ] {
        for input in ["a.npy", "scene.toml"] {
            refused(&folder, &format!("{input} {flags}"), 2, line);
        }
    }
    for (flags, words) in [
        ("--eye 1,2", "write 3 numbers with commas between them, such as 0,1,-8"),
        ("--eye a,b,c", "write 3 numbers"),
        ("--half-extent -1", "write 2 numbers"),
        ("--camera periscope", "orthographic"),
        ("--eye nan,0,0 --direction 0,0,1", "every component must be finite"),
    ] {
        let run = folder.run(&format!("render a.npy -o out.png {flags}"));
        assert_eq!((run.code, run.stderr.lines().count()), (2, 1), "{}", run.stderr);
        assert!(run.stderr.contains(words), "{}", run.stderr);
    }
}
