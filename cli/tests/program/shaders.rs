//! `pinhole info --dump-shaders`: every kernel, without an adapter.

use crate::support::Folder;

/// A line for each kernel. Rewritten with `PINHOLE_UPDATE_SNAPSHOTS=1`.
const KERNELS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program/snapshots/kernels.txt");

#[test]
fn every_kernel_is_written() {
    let folder = Folder::new();
    let run = folder.run_without_drivers("info --dump-shaders kernels").succeeded();
    let names: Vec<String> = std::fs::read_dir(folder.path("kernels"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let pipelines = String::from_utf8(folder.read("kernels/pipelines.txt")).unwrap();
    let mut sorted = names.clone();
    sorted.sort();
    let list = sorted.join("\n") + "\n";
    if std::env::var_os("PINHOLE_UPDATE_SNAPSHOTS").is_some() {
        std::fs::write(KERNELS, &list).unwrap();
    }
    let expected = std::fs::read_to_string(KERNELS).unwrap();
    assert_eq!(
        list, expected,
        "PINHOLE_UPDATE_SNAPSHOTS=1 rewrites tests/program/snapshots/kernels.txt"
    );
    let text = String::from_utf8(run.stdout).unwrap();
    let (kernels, of) = (names.len() - 1, pipelines.lines().count());
    let expected = format!(
        "kernels: {kernels} kernels, and pipelines.txt with the constants of {of} pipelines\n"
    );
    assert_eq!(text, expected);
    for name in names.into_iter().filter(|name| name != "pipelines.txt") {
        assert!(pipelines.lines().any(|line| line.split(' ').next() == Some(&name)), "{name}");
        let source = String::from_utf8(folder.read(&format!("kernels/{name}"))).unwrap();
        let entry_point = name.split(['-', '.']).next().unwrap();
        assert!(source.contains(&format!("fn {entry_point}(")), "{name}");
        assert!(source.starts_with("//// "), "{name}");
    }
    // Once more into the folder that is there now.
    folder.run("info --dump-shaders kernels").succeeded();
}

#[test]
fn bad_places_for_kernels_are_refused() {
    let folder = Folder::with(&[("file", "")]);
    for (arguments, expected) in [
        ("info --dump-shaders file", "error: file: this is a file; name a folder\n"),
        ("info --dump-shaders none/kernels", "the folder none does not exist; create it first\n"),
    ] {
        let run = folder.run(arguments);
        assert_eq!(run.code, 2, "{}", run.stderr);
        assert!(run.stderr.ends_with(expected), "{}", run.stderr);
    }
    assert_eq!(folder.files(), ["file"]);
}
