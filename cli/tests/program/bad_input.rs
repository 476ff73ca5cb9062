//! Bad input beyond the cases in `snapshots/`: what depends on the machine, on links and pipes, or on what is done after
//! an error.

use crate::support::{Folder, SCENE};

/// Runs a bad command in a folder with a scene and the given files.
#[track_caller]
fn refused(files: &[(&str, &str)], arguments: &str, code: i32, words: &[&str]) {
    let folder = Folder::with(&[&[("scene.toml", SCENE)], files].concat());
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

/// How much memory is free depends on the machine.
#[test]
fn pictures_beyond_the_memory() {
    // This picture has 16 million million pixels.
    let arguments = "render scene.toml -o out.png --backend cpu --size 4000000x4000000";
    refused(&[], arguments, 1, &["--size", "4000000x4000000", "memory", "smaller"]);
    let large = [("large.toml", "[film]\nwidth = 4000000\nheight = 4000000\n")];
    let arguments = "render large.toml -o out.png --backend cpu";
    refused(&large, arguments, 1, &["large.toml", "memory", "smaller"]);
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

/// The folder of the snapshots has a scene of the demo that was changed.
#[test]
#[cfg_attr(not(feature = "gpu"), ignore = "needs the feature `gpu`")]
fn a_demo_on_an_unknown_adapter() {
    let arguments = "demo --adapter no-such-adapter";
    refused(&[], arguments, 2, &["no-such-adapter", "adapter"]);
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
fn without_arguments_there_is_help() {
    let run = Folder::new().run("");
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("Usage"), "{}", run.stderr);
}
