//! Rules of ARCHITECTURE.md that a text search can guard.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

fn sources(folder: &str) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                found.push((path, text));
            }
        }
    }
    assert!(!found.is_empty(), "no sources in {folder}");
    found
}

/// Files below `folder` that contain one of the words, but for those that end with `except`.
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

#[test]
fn the_reference_and_the_gpu_do_not_know_each_other() {
    assert_absent("src/cpu", &["gpu", "wgpu", "wgsl::"], &[]);
    assert_absent("src/gpu", &["crate::cpu", "cpu::"], &[]);
}

/// What judges shares nothing with what is judged, and nothing with what judged it before.
#[test]
fn the_checker_knows_no_structure_and_no_renderer() {
    for (path, text) in sources("src/verify") {
        for line in text.lines() {
            let words = ["crate::accel", "crate::cpu", "crate::gpu"];
            let names = words.iter().any(|word| line.contains(word));
            assert!(!names || line.trim_start().starts_with("//"), "{}: {line}", path.display());
        }
    }
}

#[test]
fn only_the_gpu_module_names_wgpu() {
    for (path, text) in sources("src") {
        let allowed = path.components().any(|c| c.as_os_str() == "gpu");
        // The crate's documentation tells embedders of it.
        assert!(
            allowed || path.ends_with("lib.rs") || !text.contains("wgpu"),
            "{}",
            path.display()
        );
    }
}

/// Who uses whom among the modules of the GPU: a module that uses another is not used by it, directly or otherwise.
#[test]
fn modules_of_the_gpu_do_not_import_each_other_in_circles() {
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/gpu");
    for (path, text) in sources("src/gpu") {
        let parts: Vec<String> = path
            .strip_prefix(&root)
            .unwrap()
            .with_extension("")
            .iter()
            .map(|part| part.to_str().unwrap().to_owned())
            .collect();
        if parts[0] == "mod" {
            continue;
        }
        // From a file in a folder, `super` is that folder, unless it is the folder's own file.
        let is_within = parts.len() > 1 && parts[1] != "mod";
        let to_gpu = if is_within { "use super::super::" } else { "use super::" };
        let text = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        let named = text.lines().filter_map(|line| {
            let line = line.strip_prefix("pub(super) ").unwrap_or(line);
            line.strip_prefix(to_gpu).or_else(|| line.strip_prefix("use crate::gpu::"))
        });
        let modules = named.map(|rest| rest.split([':', ';', ' ']).next().unwrap().to_owned());
        uses.entry(parts[0].clone()).or_default().extend(modules);
    }
    let known: BTreeSet<String> = uses.keys().cloned().collect();
    assert!(known.len() > 20 && uses["headless"].contains("lit"), "{uses:?}");
    // Whoever uses nobody that is left is taken away; a circle stays.
    while let Some(free) = uses
        .iter()
        .find(|(name, of)| of.iter().all(|m| m == *name || !uses.contains_key(m)))
        .map(|(name, _)| name.clone())
    {
        uses.remove(&free);
    }
    assert!(uses.is_empty(), "{uses:#?}");
}

#[test]
fn only_headless_submits_polls_and_waits() {
    assert_absent("src", &[".submit(", ".poll(", "map_async"], &["gpu/headless.rs"]);
}

#[test]
fn readers_and_writers_touch_no_files() {
    // The crate's documentation shows how a picture is written.
    let but = ["kernels/tests.rs", "kernels/page_tests.rs", "load/open.rs", "src/lib.rs"];
    assert_absent("src", &["std::fs", "fs::File"], &but);
    let program = ["input.rs", "output.rs", "demo.rs", "interrupt.rs", "process.rs"];
    assert_absent("cli/src", &["std::fs"], &program);
}

#[test]
fn only_the_program_sees_clap() {
    assert_absent("src", &["clap::"], &[]);
}

#[test]
fn files_are_short() {
    for (path, text) in sources("src").into_iter().chain(sources("cli/src")) {
        let lines = text.lines().count();
        assert!(lines <= 450, "{} has {lines} lines; one idea per file", path.display());
    }
}
