//! Tests of bad input: one line that names the file, the position and the remedy; an exit code; no output file.

use crate::support::{Folder, SCENE, WATER};

/// Runs a bad command in a folder with a scene, a data file and the given files.
#[track_caller]
fn refused(files: &[(&str, &str)], arguments: &str, code: i32, words: &[&str]) {
    let mut all = vec![("scene.toml", SCENE), ("water.xyz", WATER)];
    all.extend(files);
    let folder = Folder::with(&all);
    let before = folder.files();
    let run = folder.run(arguments);
    assert_eq!(run.code, code, "{arguments}: {}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1, "{arguments}: {}", run.stderr);
    assert!(run.stderr.starts_with("error: "), "{arguments}: {}", run.stderr);
    for word in words {
        assert!(run.stderr.contains(word), "{arguments}: {} lacks {word}", run.stderr);
    }
    assert!(run.stdout.is_empty(), "{arguments}");
    assert_eq!(folder.files(), before, "{arguments}");
}

#[test]
fn files_that_cannot_be_read() {
    refused(&[], "render no.toml -o out.png", 1, &["no.toml", "cannot be read", "No such file"]);
    refused(&[], "render no.xyz -o out.png", 1, &["no.xyz", "cannot be read"]);
    refused(
        &[("bad.toml", "data = 'no.xyz'\n")],
        "render bad.toml -o out.png",
        1,
        &["bad.toml: `data`: no.xyz"],
    );
    let folder = Folder::new();
    std::fs::create_dir(folder.path("folder.toml")).unwrap();
    let run = folder.run("render folder.toml -o out.png");
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("folder.toml: this is a folder"), "{}", run.stderr);
    std::fs::write(folder.path("binary.toml"), [0xff, 0xfe, 0x00]).unwrap();
    let run = folder.run("render binary.toml -o out.png");
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("binary.toml: this is not UTF-8 text"), "{}", run.stderr);
}

#[test]
fn scene_files_with_errors() {
    let scene = |text: &str, words: &[&str]| {
        refused(&[("bad.toml", text)], "render bad.toml -o out.png --backend cpu", 1, words);
    };
    scene("[film\nwidth = 3\n", &["bad.toml", "line 1, column 6"]);
    scene("[film]\nwidht = 3\n", &["bad.toml", "line 2, column 1", "did you mean `width`?"]);
    let sphere = |radius| format!("[[spheres]]\ncenter = [0, 0, 0]\nradius = {radius}\n");
    for radius in ["nan", "inf", "-inf", "0", "-1.5"] {
        let text = format!("{}{}", sphere("1"), sphere(radius));
        scene(&text, &["bad.toml", "line 4", "sphere 1: its radius is"]);
    }
    scene("[film]\nwidth = 0\n", &["bad.toml", "0x600 has no pixel"]);
    scene("data = 'scene.toml'\n", &["bad.toml: `data`", "another scene file"]);
    scene("data = 'data.doc'\n", &["bad.toml: `data`", "data.doc", ".xyz"]);
    scene("data = 'water.xyz'\nframe = 5\n", &["water.xyz", "there is no frame 5"]);
}

#[test]
fn pdb_files_with_errors() {
    let atom = "ATOM      1  N   VAL A   1       6.204  16.869   4.854  1.00 49.05           N\n";
    let data = |text: &str, words: &[&str]| {
        refused(&[("bad.pdb", text)], "render bad.pdb -o out.png --backend cpu", 1, words);
    };
    data("", &["bad.pdb", "no ATOM or HETATM records"]);
    data(&atom[..40], &["bad.pdb", "line 1", "columns 39-46", "the line ends after 40 columns"]);
    data(&atom.replace("16.869", "16,869"), &["bad.pdb", "line 1, columns 39-46", "`16,869`"]);
    data("data_4HHB\n", &["bad.pdb", "mmCIF"]);
    let mixed = format!("{atom}MODEL        1\n{atom}ENDMDL\n");
    data(&mixed, &["bad.pdb", "line 1: mixed models", "line 2"]);
    refused(
        &[("one.pdb", atom)],
        "render one.pdb -o out.png --frame 2 --backend cpu",
        1,
        &["one.pdb: there is no frame 2; the file has 1 frame"],
    );
}

#[test]
fn xyz_files_with_errors() {
    let data = |text: &str, words: &[&str]| {
        refused(&[("bad.xyz", text)], "render bad.xyz -o out.png --backend cpu", 1, words);
    };
    data("", &["bad.xyz", "empty", "number of its atoms"]);
    data("4\n\nO 0 0 0\n", &["bad.xyz", "line 1", "declares 4 atoms", "ends after 1"]);
    data("1\n\nO 0 0 0\nO 1 1 1\n", &["bad.xyz", "line 4", "declares 1 atom "]);
    data("1\n\nO 0 x 0\n", &["bad.xyz", "line 3, column 3: y is `x`"]);
    data(
        "1\nProperties=species:S:1:pos:R:3:radius:R:1\nO 0 0 0 -2\n",
        &["bad.xyz", "line 3", "radius is -2"],
    );
    refused(&[], "render water.xyz -o out.png --frame 1", 1, &["water.xyz", "no frame 1"]);
}

#[test]
fn sizes() {
    for size in ["0x600", "800x0", "800", "800x", "axb", "-1x5", "99999999999x1", "1.5x2"] {
        refused(&[], &format!("render scene.toml -o out.png --size={size}"), 2, &["size"]);
    }
    for size in ["9000000x1", "4294967295x4294967295"] {
        refused(&[], &format!("render scene.toml -o out.png --size {size}"), 2, &["too large"]);
    }
    // This picture has 16 million million pixels.
    let arguments = "render scene.toml -o out.png --backend cpu --size 4000000x4000000";
    refused(&[], arguments, 1, &["--size", "4000000x4000000", "memory", "smaller"]);
    let large = [("large.toml", "[film]\nwidth = 4000000\nheight = 4000000\n")];
    let arguments = "render large.toml -o out.png --backend cpu";
    refused(&large, arguments, 1, &["large.toml", "memory", "smaller"]);
}

#[test]
fn outputs() {
    let output = |arguments: &str, words: &[&str]| {
        refused(&[], &format!("render scene.toml --backend cpu {arguments}"), 2, words);
    };
    output("-o no/such/out.png", &["no/such/out.png", "the folder no/such does not exist"]);
    output("-o out.jpg", &["out.jpg", ".png"]);
    output("-o out", &["out", ".png"]);
    output("", &["--output"]);
    output("-o out.jpg", &["out.jpg", ".exr"]);
    output("-o out.png --layer depth", &["LAYER=FILE.npy", "depth=depth.npy", ".exr"]);
    output("-o - --layer depth", &["LAYER=FILE.npy", "depth=depth.npy", ".exr"]);
    output("-o out.exr --layer depht", &["no layer `depht`", "position"]);
    output("-o out.exr --layer depth=d.exr", &["d.exr", ".npy"]);
    output("-o no/out.exr", &["no/out.exr", "the folder no does not exist"]);
    output("-o out.png --layer depht=d.npy", &["no layer `depht`", "depth"]);
    output("-o out.png --layer depth=d.exr", &["d.exr", ".npy"]);
    output("-o out.png --layer depth=", &["--layer depth=", "name a file"]);
    output("-o out.png/", &["out.png/", "folder"]);
    output("-o out.png --layer depth=no/d.npy", &["the folder no does not exist"]);
    output("-o out.png --layer depth=d.npy --layer id=d.npy", &["d.npy", "two outputs"]);
}

#[test]
fn how_pictures_are_written() {
    let flags = |flags: &str, words: &[&str]| {
        refused(&[], &format!("render scene.toml --backend cpu {flags}"), 2, words);
    };
    flags("-o out.png --bits 12", &["--bits", "12", "must be 8 or 16"]);
    flags("-o out.png --bits many", &["--bits", "many"]);
    flags("-o out.png --exposure 33", &["--exposure", "33", "between -32 and 32"]);
    flags("-o out.png --exposure nan", &["--exposure", "NaN", "between -32 and 32"]);
    flags("-o out.png --exposure bright", &["--exposure", "bright"]);
    flags("-o out.png --tone reinhard", &["--tone", "reinhard", "filmic", "agx"]);
    flags("-o out.png --transparent=maybe", &["--transparent", "maybe", "true, false"]);
    for flag in ["--bits 8", "--exposure 1", "--tone none"] {
        let name = flag.split(' ').next().unwrap();
        flags(&format!("-o out.exr {flag}"), &[name, "applies only to PNG", "remove"]);
    }
    let scene = |text: &str, words: &[&str]| {
        let text = format!("[output]\n{text}\n");
        let arguments = "render bad.toml -o out.png --backend cpu";
        refused(&[("bad.toml", &text)], arguments, 1, words);
    };
    scene("bits = 10", &["bad.toml: line 2, column 8", "`bits` is 10", "8 or 16"]);
    scene("bits = -8", &["bad.toml: line 2", "whole number"]);
    scene("exposure = 40.5", &["bad.toml: line 2, column 12", "`exposure` is 40.5", "-32 and 32"]);
    scene("exposure = nan", &["bad.toml: line 2", "`exposure` is NaN"]);
    scene("exposure = true", &["bad.toml: line 2", "expected a number"]);
    scene("tone = 'agxx'", &["bad.toml: line 2", "did you mean `agx`?"]);
    scene("transparent = 1", &["bad.toml: line 2", "expected a boolean"]);
    scene("exposition = 1", &["bad.toml: line 2", "did you mean `exposure`?"]);
    let list = [("bad.toml", "output = [1]\n")];
    refused(&list, "render bad.toml -o out.png", 1, &["bad.toml: line 1", "a table"]);
}

/// A layer cannot be written after everything was rendered, because its name is longer than file systems allow.
#[test]
fn a_failed_layer_leaves_no_picture() {
    let layer = format!("{}.npy", "a".repeat(300));
    let arguments = format!("render scene.toml -o out.png --backend cpu --layer depth={layer}");
    refused(&[], &arguments, 1, &["aaa.npy", "cannot be written"]);
}

/// The error appears before anything is rendered, because this size would take minutes. In /proc not even the superuser
/// can create a file.
#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_cannot_be_written() {
    let arguments = "render scene.toml -o /proc/out.png --backend cpu --size 9000x9000";
    refused(&[], arguments, 1, &["/proc/out.png: cannot be written"]);
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    let text = "\"\\u001b[31mred\" = 1\n";
    let arguments = "render bad.toml -o out.png";
    refused(&[("bad.toml", text)], arguments, 1, &["bad.toml", "\\u{1b}"]);
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

#[test]
fn one_file_by_two_names() {
    let output = "--layer depth=d.npy --layer id=./d.npy";
    let arguments = format!("render scene.toml --backend cpu -o out.png {output}");
    refused(&[], &arguments, 2, &["./d.npy", "two outputs"]);
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
        let run = folder.run(&format!("render scene.toml --backend cpu -o out.png {output}"));
        assert_eq!(run.code, 2, "{}", run.stderr);
        assert!(run.stderr.contains("two outputs"), "{}", run.stderr);
        assert_eq!(folder.path("d.npy").exists(), is_there);
    }
}

#[test]
fn inputs_are_not_overwritten() {
    let folder = Folder::with(&[("scene.toml", "data = 'in.npy'\n")]);
    folder.run("generate random -n 10 -o in.npy").succeeded();
    let spheres = folder.read("in.npy");
    for arguments in [
        "render in.npy -o out.png --layer depth=in.npy",
        "render scene.toml -o out.png --layer id=./in.npy",
    ] {
        let run = folder.run(&format!("{arguments} --backend cpu"));
        assert_eq!(run.code, 2, "{}", run.stderr);
        assert!(run.stderr.contains("in.npy: this output is also an input"), "{}", run.stderr);
        assert_eq!(folder.read("in.npy"), spheres);
        assert_eq!(folder.files(), ["in.npy", "scene.toml"]);
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_is_not_replaced_by_a_file() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let made = std::process::Command::new("mkfifo").arg(folder.path("out.png")).status();
    assert!(made.unwrap().success());
    let run = folder.run("render scene.toml --backend cpu -o out.png");
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(run.stderr.contains("not a regular file"), "{}", run.stderr);
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
fn usage() {
    refused(&[], "render data.doc -o out.png", 2, &["data.doc", ".toml", ".xyz"]);
    refused(&[], "render scene -o out.png", 2, &["scene", ".toml"]);
    refused(&[], "render scene.toml -o out.png --backend tpu", 2, &["tpu", "auto", "gpu", "cpu"]);
    refused(&[], "render scene.toml -o out.png --frame 0", 2, &["--frame", "`data`"]);
    refused(&[], "render scene.toml -o out.png --frame=-1", 2, &["--frame"]);
    refused(&[], "render scene.toml -o out.png --backend cpu --adapter x", 2, &["--adapter"]);
    refused(&[], "render scene.toml -o out.png --colour red", 2, &["--colour"]);
    for flag in ["--accel grid", "--accel auto", "--limits webgpu"] {
        let arguments = format!("render scene.toml -o out.png --backend cpu {flag}");
        refused(
            &[],
            &arguments,
            2,
            &[flag.split(' ').next().unwrap(), "--backend cpu", "remove one"],
        );
    }
    refused(&[], "render scene.toml -o out.png --accel bvh", 2, &["bvh", "grid", "tree"]);
    refused(&[], "render scene.toml -o out.png --limits none", 2, &["none", "adapter", "webgpu"]);
    refused(&[], "rendr scene.toml", 2, &["rendr", "render"]);
}

#[test]
#[cfg_attr(not(feature = "gpu"), ignore = "needs the feature `gpu`")]
fn usage_with_adapters() {
    refused(&[], "plan scene.doc", 2, &["scene.doc", ".toml"]);
    refused(&[], "plan scene.toml --layer depht", 2, &["--layer depht", "depth"]);
    refused(&[], "plan no.toml", 1, &["no.toml", "cannot be read"]);
    refused(&[], "bench R2M", 2, &["R2M", "R1M", "a file"]);
    refused(&[], "bench R1M --reps 0", 2, &["--reps", "0"]);
    refused(&[], "bench R1M --size 5", 2, &["--size 5", "WIDTHxHEIGHT"]);
    refused(&[], "bench R1M --accel octree", 2, &["octree", "tree"]);
    let name = "no-such-adapter";
    for backend in ["auto", "gpu"] {
        let arguments =
            format!("render scene.toml -o out.png --adapter {name} --backend {backend}");
        refused(&[], &arguments, 2, &[name, "adapter"]);
    }
    refused(&[], &format!("demo --adapter {name}"), 2, &[name, "adapter"]);
    refused(&[], &format!("info --self-test --adapter {name}"), 2, &[name, "adapter"]);
    refused(&[], &format!("info --adapter {name}"), 2, &["--adapter", "add --self-test"]);
}

#[test]
fn the_demo_does_not_overwrite_a_changed_scene() {
    let files = [("demo.toml", "# mine\n")];
    refused(&files, "demo --backend cpu", 2, &["demo.toml", "rename it"]);
}

#[test]
fn without_arguments_there_is_help() {
    let run = Folder::new().run("");
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("Usage"), "{}", run.stderr);
}
