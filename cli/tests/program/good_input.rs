//! Tests of good input.

use npyz::NpyFile;

use crate::support::{Folder, SCENE, WATER, decode};

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
    // Both strands: red and blue.
    assert!(pixels.chunks(3).any(|p| p[0] > 150 && p[2] < 90), "nothing is red");
    assert!(pixels.chunks(3).any(|p| p[2] > 120 && p[0] < 70), "nothing is blue");

    // The scene that it wrote gives the same picture, and a second demo changes nothing.
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
    assert_eq!(run.code, 1);
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    assert!(run.stderr.contains("no Vulkan, Metal or DX12 adapter"), "{}", run.stderr);
    assert!(!folder.path("gpu.png").exists());
    let run = folder.run_without_drivers("demo --backend gpu");
    assert_eq!(run.code, 1);
    assert_eq!(
        folder.files(),
        ["cpu.png", "out.png", "scene.toml"],
        "a failed demo leaves nothing"
    );

    let run = folder.run_without_drivers("info").succeeded();
    let text = String::from_utf8(run.stdout).unwrap();
    assert!(text.contains("no Vulkan, Metal or DX12 adapter"), "{text}");
    assert!(text.contains("mesa-vulkan-drivers") && text.contains("CPU reference"), "{text}");
}

/// A name in the environment chooses among adapters. It has no effect if there are none.
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
fn a_molecule_is_framed_by_itself() {
    let folder = Folder::with(&[("water.xyz", WATER)]);
    let run =
        folder.run("render water.xyz -o water.png --size 90x60 --backend cpu --view z").succeeded();
    assert_eq!(run.stderr, "");
    let (width, height, pixels) = decode(&folder.read("water.png"));
    assert_eq!((width, height), (90, 60));
    let at = |x: usize, y: usize| &pixels[(y * 90 + x) * 3..][..3];
    assert_eq!(at(0, 0), [0xf3, 0xf4, 0xf6], "background");
    let middle = at(45, 30);
    assert!(middle[0] > 200 && middle[1] < 40, "oxygen is red: {middle:?}");
    let left = at(16, 30);
    let spread = left.iter().max().unwrap() - left.iter().min().unwrap();
    assert!(spread < 16, "hydrogen is white or grey: {left:?}");
}

#[test]
fn frames_of_a_trajectory() {
    let text = format!("{WATER}1\nlone\nC 0 0 0\n");
    let scene = "style = 'default'\ndata = 'two.xyz'\nframe = 1\n[film]\nwidth = 32\nheight = 32\n";
    let folder = Folder::with(&[("two.xyz", &text), ("scene.toml", scene)]);
    let render = |arguments: &str| {
        folder
            .run(&format!("render {arguments} --size 32x32 --backend cpu --view iso"))
            .succeeded();
    };
    render("two.xyz -o first.png");
    render("two.xyz -o second.png --frame 1");
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
fn layers_are_numpy_arrays() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    folder
        .run(
            "render scene.toml -o out.png --backend cpu --layer depth=depth.npy \
             --layer id=id.npy --layer normal=normal.npy --layer color=color.npy",
        )
        .succeeded();
    let shape = |name: &str| {
        let bytes = folder.read(name);
        let npy = NpyFile::new(&bytes[..]).unwrap();
        assert_eq!(npy.order(), npyz::Order::C);
        (npy.shape().to_vec(), npy.dtype().descr())
    };
    assert_eq!(shape("depth.npy"), (vec![30, 40], "'<f4'".to_owned()));
    assert_eq!(shape("id.npy"), (vec![30, 40], "'<u4'".to_owned()));
    assert_eq!(shape("normal.npy"), (vec![30, 40, 3], "'<f4'".to_owned()));
    assert_eq!(shape("color.npy"), (vec![30, 40, 3], "'<f4'".to_owned()));

    let bytes = folder.read("depth.npy");
    let depth: Vec<f32> = NpyFile::new(&bytes[..]).unwrap().into_vec().unwrap();
    let bytes = folder.read("id.npy");
    let id: Vec<u32> = NpyFile::new(&bytes[..]).unwrap().into_vec().unwrap();
    assert_eq!((depth[0], id[0]), (f32::INFINITY, u32::MAX));
    let middle = 15 * 40 + 20;
    assert!(depth[middle].is_finite());
    assert_eq!(id[middle], 0);
}

#[test]
fn a_dash_writes_the_picture_to_standard_output() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let run = folder.run("render scene.toml -o - --backend cpu").succeeded();
    assert_eq!(decode(&run.stdout).0, 40);
    assert_eq!(folder.files(), ["scene.toml"]);
}

#[test]
fn a_new_picture_takes_the_place_of_an_old_one() {
    let folder = Folder::with(&[("scene.toml", SCENE), ("out.png", "old")]);
    folder.run("render scene.toml -o out.png --backend cpu").succeeded();
    assert_eq!(decode(&folder.read("out.png")).0, 40);
    assert_eq!(folder.files(), ["out.png", "scene.toml"]);
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

#[test]
fn species_that_are_not_elements_are_drawn_and_noted() {
    let folder = Folder::with(&[("beads.xyz", "3\n\nXx 0 0 0\nYy 5 0 0\nO 9 0 0\n")]);
    let run = folder.run("render beads.xyz -o out.png --size 20x10 --backend cpu").succeeded();
    assert_eq!(run.stderr.lines().count(), 1);
    assert!(run.stderr.contains("beads.xyz") && run.stderr.contains("Xx, Yy"), "{}", run.stderr);

    let atoms: String = (0..1000).map(|i| format!("bead{i} {i} 0 0\n")).collect();
    let folder = Folder::with(&[("many.xyz", &format!("1001\n\n{atoms}O 0 9 0\n"))]);
    let run = folder.run("render many.xyz -o out.png --size 2x2 --backend cpu").succeeded();
    assert!(run.stderr.contains("bead4 and 995 more"), "{}", run.stderr);

    // Where no species is an element, names say nothing about radii.
    let folder = Folder::with(&[("kinds.xyz", "2\n\nXx 0 0 0\nYy 5 0 0\n")]);
    let run = folder.run("render kinds.xyz -o out.png --size 20x10 --backend cpu").succeeded();
    assert!(run.stderr.contains("all spheres have the radius 2.5"), "{}", run.stderr);
}

#[test]
fn info_is_json_on_request() {
    let folder = Folder::new();
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

#[test]
fn help_and_version_go_to_standard_output() {
    let folder = Folder::new();
    for arguments in
        ["--help", "render --help", "demo --help", "generate --help", "info --help", "--version"]
    {
        let run = folder.run(arguments).succeeded();
        assert!(!run.stdout.is_empty() && run.stderr.is_empty(), "{arguments}");
    }
}

/// Files of other programs have all kinds of names.
#[test]
fn the_content_shows_the_format_where_the_name_does_not() {
    let folder = Folder::with(&[
        ("water.xyz", WATER),
        ("water.dat", WATER),
        ("water", WATER),
        (
            "scene.toml",
            "style = \"default\"\ndata = \"water.dat\"\n[camera.pinhole]\ndirection = [0, -1, 0]\n",
        ),
    ]);
    folder.run("render water.xyz -o wanted.png --backend cpu --size 20x16").succeeded();
    for file in ["water.dat", "water", "scene.toml"] {
        folder.run(&format!("render {file} -o a.png --backend cpu --size 20x16")).succeeded();
        assert_eq!(folder.read("a.png"), folder.read("wanted.png"), "{file}");
    }
}
