//! Rules of ARCHITECTURE.md that a search of the text can check.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use super::sources::{ROOT, sources};

/// The sources of all crates.
const CRATES: [&str; 6] = ["src", "crates/data/src", "crates/figure/src", "cli/src", "python/src", "viewer/src"];

/// Checks that files below `folder` contain none of the words, except files whose paths end with one of `except`.
fn assert_absent(folder: &str, words: &[&str], except: &[&str]) {
    for (path, text) in sources(folder) {
        if except.iter().any(|end| path.ends_with(end)) {
            continue;
        }
        for word in words {
            assert!(!text.contains(word), "{} contains {word}", path.display());
        }
    }
}

/// Lines of code below `folder`, but not comments, that contain one of the words.
fn assert_code_is_without(folder: &str, words: &[&str]) {
    for (path, text) in sources(folder) {
        for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
            let named = words.iter().any(|word| line.contains(word));
            assert!(!named, "{}: {line}", path.display());
        }
    }
}

#[test]
fn the_reference_and_the_gpu_do_not_know_each_other() {
    assert_absent("src/cpu", &["gpu", "wgpu", "wgsl::"], &[]);
    assert_absent("src/gpu", &["crate::cpu", "cpu::"], &[]);
}

/// The test of every sphere is the standard for all comparisons, so it must not depend on a structure.
#[test]
fn the_reference_knows_no_structure() {
    let except = ["cpu/search.rs", "cpu/search_tests.rs"];
    assert_absent("src/cpu", &["crate::accel"], &except);
}

/// The checker shares no code with the structures and renderers that it checks.
#[test]
fn the_checker_knows_no_structure_and_no_renderer() {
    assert_code_is_without("src/verify", &["crate::accel", "crate::cpu", "crate::gpu"]);
}

#[test]
fn only_the_gpu_module_names_wgpu() {
    for (path, text) in sources("src") {
        let allowed = path.components().any(|c| c.as_os_str() == "gpu");
        // The crate's documentation mentions wgpu for embedders.
        assert!(allowed || path.ends_with("lib.rs") || !text.contains("wgpu"), "{}", path.display());
    }
}

#[test]
fn only_headless_submits_polls_and_waits() {
    let calls = [".submit(", ".poll(", "map_async", "on_submitted_work_done"];
    assert_absent("src", &calls, &["gpu/headless/mod.rs", "gpu/headless/waiting.rs"]);
    // Blocking functions are separate from the asynchronous ones that they call.
    let but = ["src/gpu/headless/waiting.rs"];
    assert_absent("src", &["pollster::"], &but);
}

#[test]
fn readers_and_writers_touch_no_files() {
    // The crate's documentation has an example that writes a picture.
    let but = ["kernels/tests.rs", "kernels/page_tests.rs", "load/source.rs", "load/file_rows.rs", "src/lib.rs"];
    for folder in ["src", "crates/data/src", "crates/figure/src"] {
        assert_absent(folder, &["std::fs", "fs::File"], &but);
    }
    let program = [
        "bricks/read.rs",
        "bricks/writer.rs",
        "read_file.rs",
        "output/files.rs",
        "generate.rs",
        "interrupt.rs",
        "jobs/files.rs",
        "memory.rs",
    ];
    assert_absent("cli/src", &["std::fs"], &program);
}

#[test]
fn only_the_program_sees_clap() {
    for folder in CRATES.into_iter().filter(|folder| *folder != "cli/src") {
        assert_absent(folder, &["clap::"], &[]);
    }
}

/// What devices compute with is defined below those who compute and those who judge.
#[test]
fn recordings_know_neither_the_renderer_nor_the_checker() {
    assert_code_is_without("src/recording", &["crate::gpu", "crate::verify"]);
    for folder in ["src/gpu/host", "src/gpu/passes", "src/gpu/scene", "src/gpu/shader"] {
        assert_code_is_without(folder, &["crate::verify"]);
    }
}

/// The engine knows no file format, and what reads formats knows no settings.
#[test]
fn packages_use_only_those_below() {
    // The crate's documentation has an example that reads a file.
    assert_absent("src", &["pinhole_data", "pinhole_figure"], &["src/lib.rs"]);
    assert_absent("crates/data/src", &["pinhole_figure"], &[]);
    for folder in ["crates/data/src", "crates/figure/src", "python/src"] {
        assert_absent(folder, &["pinhole_cli"], &[]);
    }
    for folder in ["crates/data", "crates/figure"] {
        assert_absent(folder, &["pinhole::gpu", "wgpu"], &[]);
    }
}

#[test]
fn files_are_short() {
    for (path, text) in CRATES.into_iter().flat_map(sources) {
        let lines = text.lines().count();
        assert!(lines <= 450, "{} has {lines} lines; one idea per file", path.display());
    }
}

#[test]
fn folders_are_small() {
    let mut folders = std::collections::BTreeMap::<_, usize>::new();
    for (path, _) in CRATES.into_iter().flat_map(sources) {
        *folders.entry(path.parent().unwrap().to_owned()).or_default() += 1;
    }
    for (folder, files) in folders {
        assert!(files <= 24, "{} has {files} files; make rooms", folder.display());
    }
}

/// Every shader named in a comment exists, by its path below `shaders` or by its file name.
#[test]
fn shaders_that_are_named_exist() {
    let root = Path::new(ROOT).join("shaders");
    let mut known = BTreeSet::new();
    for folder in fs::read_dir(&root).unwrap().map(|entry| entry.unwrap().path()) {
        if folder.is_dir() {
            for file in fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
                known.insert(file.strip_prefix(&root).unwrap().to_str().unwrap().replace('\\', "/"));
                known.insert(file.file_name().unwrap().to_str().unwrap().to_owned());
            }
        }
    }
    let mut count = 0;
    for (path, text) in sources("src").into_iter().chain(sources("tests")) {
        for line in text.lines().filter(|line| line.trim_start().starts_with("//")) {
            for word in line.split(|c: char| c.is_whitespace() || "`,;()[]\"".contains(c)) {
                let word = word.trim_end_matches(['.', ':']).trim_start_matches("shaders/");
                if word.ends_with(".wgsl") && word.len() > 5 {
                    let place = path.display();
                    let is_example = word.contains("NAME") || word.contains('#');
                    assert!(is_example || known.contains(word), "{place}: {word} is not there");
                    count += 1;
                }
            }
        }
    }
    assert!(count > 60, "{count}");
}
