//! Tests of good and bad input, beyond the cases in `snapshots/`.

use crate::npy_files::{npy, zip};
use crate::support::{Folder, SCENE, WATER, decode};

/// Two spheres side by side.
const ROWS: [[f32; 4]; 2] = [[-2.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0]];

fn folder() -> Folder {
    let folder = Folder::new();
    let bytes = |columns: usize| -> Vec<u8> {
        ROWS.iter().flat_map(|row| row[..columns].to_vec()).flat_map(f32::to_le_bytes).collect()
    };
    let wide: Vec<u8> = ROWS.as_flattened().iter().flat_map(|x| f64::from(*x).to_be_bytes()).collect();
    let whole = npy("<f4", false, "(2, 4)", &bytes(4));
    for (name, contents) in [
        ("a.npy", whole.clone()),
        ("wide.npy", npy(">f8", false, "(2, 4)", &wide)),
        ("xyz.npy", npy("<f4", false, "(2, 3)", &bytes(3))),
        ("none.npy", npy("<f4", false, "(0, 4)", b"")),
        ("a.npz", zip(&[("arr_0.npy", &whole)], true)),
        ("a.bin", bytes(4)),
    ] {
        std::fs::write(folder.path(name), contents).unwrap();
    }
    folder
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
    let words = "large.npy: reading 8796093022208 bytes needs 19114.7 GiB of memory, but only ";
    folder.refuses("render large.npy -o out.png --backend cpu", 1, words);
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
        "a.npy --color #4c86b8",
        "a.npy --fov 30 --view 30,20 --up 0,0,1 --camera pinhole",
    ] {
        assert_eq!(picture(&folder, arguments), expected, "{arguments}");
    }
    assert_ne!(picture(&folder, "a.npy --color red"), expected);
    let none = folder.run("render none.npy -o none.png --backend cpu --size 24x16").succeeded();
    assert_eq!(none.stderr, "note: none.npy: the file has no spheres, so the picture shows only the background\n");
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
    // A scene file has its own light and view.
    let gray = "--color #cccccc --up 0,1,0";
    let expected = picture(&folder, &format!("a.npy {gray} --style fast --direction 0,0,-1"));
    let second = npy("<f4", false, "(1, 4)", &ROWS[1].map(f32::to_le_bytes).concat());
    std::fs::write(folder.path("b.npz"), zip(&[("x.npy", &second)], false)).unwrap();
    for arguments in ["1.toml", "2.toml", "3.toml", "4.toml --radius 1", "5.toml"] {
        assert_eq!(picture(&folder, arguments), expected, "{arguments}");
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
        assert_eq!(picture(&folder, &format!("a.npy --color #ccc {flags}")), expected, "{flags}");
        assert_ne!(picture(&folder, "a.npy --color #ccc"), expected);
        // Flags replace the whole camera of a scene.
        assert_eq!(picture(&folder, &format!("fov.toml {flags}")), expected, "{flags}");
    }
    let scene = "style = 'default'\ndata = 'a.npy'\n[camera.orthographic]\neye = [0, 0, -5]\ndirection = [0, 0, 1]\n\
                 half_extent = [6, 4]\n";
    std::fs::write(folder.path("parallel.toml"), scene).unwrap();
    let flags = "--camera orthographic --eye 0,0,-5 --direction 0,0,1 --half-extent 6,4";
    assert_eq!(picture(&folder, &format!("a.npy --color #ccc {flags}")), picture(&folder, "parallel.toml"));
}

#[test]
fn the_demo_writes_a_scene_and_its_picture() {
    let folder = Folder::new();
    let run = folder.run("demo --backend cpu --size 90x45").succeeded();
    assert_eq!(folder.files(), ["demo.png", "demo.toml"]);
    assert!(run.stdout.is_empty());
    assert!(run.stderr.contains("demo.png"), "{}", run.stderr);

    let (width, height, pixels) = decode(&folder.read("demo.png"));
    assert_eq!((width, height), (90, 45));
    assert_eq!(pixels[..3], [0xf3, 0xf4, 0xf6], "the background");
    // Both strands are visible: red and blue.
    assert!(pixels.chunks(3).any(|p| p[0] > 150 && p[2] < 90), "nothing is red");
    assert!(pixels.chunks(3).any(|p| p[2] > 120 && p[0] < 70), "nothing is blue");

    // The scene file that the demo wrote gives the same picture, and a second demo changes nothing.
    folder.run("render demo.toml -o again.png --backend cpu --size 90x45").succeeded();
    assert_eq!(folder.read("again.png"), folder.read("demo.png"));
    folder.run("demo --backend cpu --size 90x45").succeeded();
}

#[test]
#[cfg_attr(
    not(all(target_os = "linux", feature = "gpu")),
    ignore = "needs the feature `gpu`, and only a Vulkan loader can be told that there are no drivers"
)]
fn without_a_driver_the_reference_renders_and_says_so_in_one_line() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let run = folder.run_without_drivers("render scene.toml -o out.png").succeeded();
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    assert!(run.stderr.contains("CPU reference"), "{}", run.stderr);
    folder.run("render scene.toml -o cpu.png --backend cpu").succeeded();
    assert_eq!(folder.read("out.png"), folder.read("cpu.png"));

    let run = folder.run_without_drivers("render scene.toml -o gpu.png --backend gpu");
    run.refused(1, "no Vulkan, Metal or DX12 adapter");
    assert!(!folder.path("gpu.png").exists());
    let run = folder.run_without_drivers("demo --backend gpu");
    assert_eq!(run.code, 1);
    assert_eq!(folder.files(), ["cpu.png", "out.png", "scene.toml"], "a failed demo leaves nothing");

    let run = folder.run_without_drivers("info").succeeded();
    let text = String::from_utf8(run.stdout).unwrap();
    assert!(text.contains("no Vulkan, Metal or DX12 adapter"), "{text}");
    assert!(text.contains("mesa-vulkan-drivers") && text.contains("CPU reference"), "{text}");
}

/// A name in the environment chooses among adapters. Without adapters it has no effect.
#[test]
fn without_a_driver_a_name_in_the_environment_does_not_matter() {
    if !cfg!(target_os = "linux") {
        return;
    }
    let folder = Folder::new();
    let mut command = folder.command("demo --size 90x45");
    command.env("VK_DRIVER_FILES", folder.path("no-driver.json"));
    command.env("VK_ICD_FILENAMES", folder.path("no-driver.json"));
    command.env("WGPU_ADAPTER_NAME", "llvmpipe");
    assert!(command.output().unwrap().status.success());
    assert_eq!(folder.files(), ["demo.png", "demo.toml"]);
}

#[test]
fn frames_of_a_trajectory() {
    let text = format!("{WATER}1\nlone\nC 0 0 0\n");
    let scene = "style = 'default'\ndata = 'two.xyz'\nframe = 1\n[film]\nwidth = 32\nheight = 32\n";
    let folder = Folder::with(&[("two.xyz", &text), ("scene.toml", scene)]);
    let render = |arguments: &str| {
        folder.run(&format!("render {arguments} --size 32x32 --backend cpu --view iso --up 0,1,0")).succeeded();
    };
    render("two.xyz -o first.png --kind plain");
    render("two.xyz -o second.png --frame 1 --kind plain");
    assert_ne!(folder.read("first.png"), folder.read("second.png"));
    render("scene.toml -o of-scene.png");
    assert_eq!(folder.read("of-scene.png"), folder.read("second.png"));
    render("scene.toml -o of-flag.png --frame 0");
    assert_eq!(folder.read("of-flag.png"), folder.read("first.png"));
}

#[test]
fn data_is_found_beside_its_scene() {
    let folder = Folder::with(&[]);
    std::fs::create_dir(folder.path("sub")).unwrap();
    std::fs::write(folder.path("sub/water.xyz"), WATER).unwrap();
    std::fs::write(folder.path("sub/scene.toml"), "data = 'water.xyz'\n").unwrap();
    folder.run("render sub/scene.toml -o out.png --size 8x8 --backend cpu").succeeded();
}

#[test]
fn a_dash_writes_the_picture_to_standard_output() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let run = folder.run("render scene.toml -o - --backend cpu").succeeded();
    assert_eq!(decode(&run.stdout).0, 40);
    assert_eq!(folder.files(), ["scene.toml"]);
}

#[test]
#[cfg(unix)]
fn a_link_and_permissions_stay() {
    use std::os::unix::fs::PermissionsExt;

    let folder = Folder::with(&[("scene.toml", SCENE), ("real.png", "old")]);
    let private = std::fs::Permissions::from_mode(0o600);
    std::fs::set_permissions(folder.path("real.png"), private).unwrap();
    std::os::unix::fs::symlink("real.png", folder.path("link.png")).unwrap();
    folder.run("render scene.toml -o link.png --backend cpu").succeeded();
    assert!(folder.path("link.png").is_symlink());
    assert_eq!(decode(&folder.read("real.png")).0, 40);
    let mode = std::fs::metadata(folder.path("real.png")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
}

/// If no species is an element, names say nothing about radii.
#[test]
fn kinds_that_are_no_elements_have_one_radius() {
    let folder = Folder::with(&[("kinds.xyz", "2\n\nXx 0 0 0\nYy 5 0 0\n")]);
    let run = folder.run("render kinds.xyz -o out.png --size 20x10 --backend cpu").succeeded();
    assert!(run.stderr.contains("all spheres have the radius 2.5"), "{}", run.stderr);
}

#[test]
fn what_is_asked_for_goes_to_standard_output() {
    let folder = Folder::new();
    let run = folder.run("--version").succeeded();
    assert!(!run.stdout.is_empty() && run.stderr.is_empty());
    let run = folder.run("");
    assert!(run.code == 2 && run.stderr.contains("Usage"), "{}", run.stderr);
    let run = folder.run("info --json").succeeded();
    let info: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!(info["version"], env!("CARGO_PKG_VERSION"));
    let adapters = info["adapters"].as_array().unwrap();
    for adapter in adapters {
        assert!(adapter["name"].is_string());
        assert!(adapter["limits"]["max_storage_buffer_binding_size"].as_u64().unwrap() > 0);
        assert!(adapter["features"]["timestamp_query"].is_boolean());
    }
}

#[test]
#[cfg_attr(
    not(all(target_os = "linux", feature = "gpu")),
    ignore = "needs the feature `gpu`, and only a Vulkan loader can be told that there are no drivers"
)]
fn a_self_test_without_an_adapter_is_a_failed_job() {
    let run = Folder::new().run_without_drivers("info --self-test");
    assert_eq!((run.code, run.stdout.len()), (1, 0));
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    assert!(run.stderr.contains("no Vulkan, Metal or DX12 adapter"), "{}", run.stderr);
}

/// Files of other programs have all kinds of names.
#[test]
fn the_content_shows_the_format_where_the_name_does_not() {
    let folder = Folder::with(&[
        ("water.xyz", WATER),
        ("water.dat", WATER),
        ("water", WATER),
        ("scene.toml", "style = \"default\"\ndata = \"water.dat\"\n[camera.pinhole]\ndirection = [0, -1, 0]\n"),
    ]);
    folder.run("render water.xyz -o wanted.png --kind plain --up 0,1,0 --backend cpu --size 20x16").succeeded();
    for (file, plain) in
        [("water.dat", "--kind plain --up 0,1,0"), ("water", "--kind plain --up 0,1,0"), ("scene.toml", "")]
    {
        folder.run(&format!("render {file} {plain} -o a.png --backend cpu --size 20x16")).succeeded();
        assert_eq!(folder.read("a.png"), folder.read("wanted.png"), "{file}");
    }
}

/// The free memory depends on the machine. These pictures have 16 million million pixels.
#[test]
fn pictures_beyond_the_memory() {
    let large = ("large.toml", "[film]\nwidth = 4000000\nheight = 4000000\n");
    let folder = Folder::with(&[("scene.toml", SCENE), large]);
    let flags = "-o out.png --backend cpu";
    folder.refuses(&format!("render scene.toml {flags} --size 4000000x4000000"), 1, "memory");
    folder.refuses(&format!("render large.toml {flags}"), 1, "large.toml");
}

/// The layer's name is longer than file systems allow, so writing it fails after everything was rendered.
#[test]
fn a_failed_layer_leaves_no_picture() {
    let layer = format!("--layer depth={}.npy", "a".repeat(300));
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let arguments = format!("render scene.toml -o out.png --backend cpu {layer}");
    folder.refuses(&arguments, 1, "aaa.npy: cannot be written");
}

/// The error appears before anything is rendered, because this size would take minutes. In /proc not even the superuser
/// can create a file.
#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_cannot_be_written() {
    let arguments = "render scene.toml -o /proc/out.png --backend cpu --size 9000x9000";
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    folder.refuses(arguments, 1, "/proc/out.png: cannot be written");
}

/// The folder has a changed scene of the demo.
#[test]
#[cfg_attr(not(feature = "gpu"), ignore = "needs the feature `gpu`")]
fn a_demo_on_an_unknown_adapter() {
    Folder::new().refuses("demo --adapter no-such-adapter", 2, "no-such-adapter");
}

#[test]
#[cfg_attr(not(feature = "gpu"), ignore = "needs the feature `gpu`")]
fn an_unknown_backend_is_named() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let mut command = folder.command("render scene.toml -o out.png");
    let output = command.env("WGPU_BACKEND", "nonsense").output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.contains("WGPU_BACKEND=nonsense"), "{stderr}");
    // `info` reports the same error.
    let info = folder.command("info").env("WGPU_BACKEND", "nonsense").output().unwrap();
    let text = String::from_utf8(info.stdout).unwrap();
    assert!(text.contains("`render` refuses: WGPU_BACKEND=nonsense"), "{text}");
    assert!(!text.contains("CPU reference"), "{text}");
    assert_eq!(folder.files(), ["scene.toml"]);
}

#[cfg(unix)]
#[test]
fn one_file_by_a_link() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    std::os::unix::fs::symlink("d.npy", folder.path("link.npy")).unwrap();
    let output = "--layer depth=d.npy --layer id=link.npy";
    for is_there in [false, true] {
        if is_there {
            std::fs::write(folder.path("d.npy"), "old").unwrap();
        }
        folder.refuses(&format!("render scene.toml --backend cpu -o out.png {output}"), 2, "two outputs");
        assert_eq!(folder.path("d.npy").exists(), is_there);
    }
}

#[test]
fn inputs_are_not_overwritten() {
    let folder = Folder::with(&[("scene.toml", "data = 'in.npy'\n")]);
    folder.run("generate random -n 10 -o in.npy").succeeded();
    let spheres = folder.read("in.npy");
    for arguments in
        ["render in.npy -o out.png --layer depth=in.npy", "render scene.toml -o out.png --layer id=./in.npy"]
    {
        let words = "in.npy: this output is also an input";
        folder.refuses(&format!("{arguments} --backend cpu"), 2, words);
        assert_eq!(folder.read("in.npy"), spheres);
    }
    let sky = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n@@@\x7f";
    let lit = format!("integrator = 'path'\n[sky]\nkind = 'image'\nimage = 'sky.npy'\n{SCENE}");
    let folder = Folder::with(&[("sky.npy", sky), ("lit.toml", &lit)]);
    let arguments = "render lit.toml -o out.png --layer id=sky.npy --samples 1 --backend cpu";
    folder.refuses(arguments, 2, "sky.npy: this output is also an input");
    assert_eq!(folder.read("sky.npy"), sky.as_bytes());
}

#[cfg(unix)]
#[test]
fn a_pipe_is_not_replaced_by_a_file() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let made = std::process::Command::new("mkfifo").arg(folder.path("out.png")).status();
    assert!(made.unwrap().success());
    folder.refuses("render scene.toml --backend cpu -o out.png", 2, "not a regular file");
    assert!(!folder.path("out.png").is_file());
}

#[test]
#[cfg(target_os = "linux")]
fn a_stream_that_cannot_be_written_changes_no_exit_code() {
    let folder = Folder::new();
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let code = |arguments: &str| {
        let status = folder.command(arguments).stderr(full()).stdout(full()).status().unwrap();
        status.code().unwrap()
    };
    assert_eq!(code("render no.toml -o out.png"), 1);
    assert_eq!(code("render"), 2);
    assert_eq!(code("--help"), 1);
}

#[test]
fn files_are_the_same_each_time_and_can_be_rendered() {
    let folder = Folder::new();
    for kind in ["random", "lattice", "clusters", "sphereflake"] {
        let run = folder.run(&format!("generate {kind} -n 30 -o a.npy --seed 3")).succeeded();
        assert_eq!(run.stderr, "a.npy: 30 spheres, 480 bytes\n");
        folder.run(&format!("generate {kind} -n 30 -o b.npy --seed 3")).succeeded();
        folder.run(&format!("generate {kind} -n 30 -o c.bin --seed 3")).succeeded();
        let file = folder.read("a.npy");
        assert_eq!(file, folder.read("b.npy"));
        let raw = folder.read("c.bin");
        assert_eq!(raw.len(), 480);
        assert!(file.ends_with(&raw));
        let view = "-o a.png --size 9x9 --backend cpu";
        folder.run(&format!("render a.npy {view}")).succeeded();
        let picture = folder.read("a.png");
        folder.run(&format!("render c.bin --format raw-f32x4 {view}")).succeeded();
        assert_eq!(picture, folder.read("a.png"));
    }
    folder.run("generate random -n 0 -o none.npy").succeeded();
    folder.run("render none.npy -o none.png --size 2x2 --backend cpu").succeeded();
    assert_eq!(folder.files(), ["a.npy", "a.png", "b.npy", "c.bin", "none.npy", "none.png"]);
}

/// A data file need not have a name that is text.
#[cfg(target_os = "linux")]
#[test]
fn names_that_are_not_text() {
    use std::os::unix::ffi::OsStrExt;

    let folder = folder();
    let name = std::ffi::OsStr::from_bytes(b"a\xff.npy");
    std::fs::copy(folder.path("a.npy"), folder.path("").join(name)).unwrap();
    let flags = "render --backend cpu --style fast --size 8x6 -o out.png";
    let output = folder.command(flags).arg(name).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(decode(&folder.read("out.png")).0, 8);
}
