//! What users read, word for word: the help of every command, and the error line for every kind of wrong input.
//!
//! The files in `snapshots/` hold the expected text. After an intended change, rewrite them and read the difference
//! before you commit it:
//!
//! ```sh
//! PINHOLE_UPDATE_SNAPSHOTS=1 cargo test -p pinhole-cli --test program snapshots
//! ```
//!
//! The inputs are written into an empty folder and no adapter is used, so the text does not depend on paths, drivers
//! or the machine. Help has the same lines in every terminal, because clap is built without its feature `wrap_help`.

use std::fmt::Write;
use std::path::Path;

use similar::TextDiff;

use crate::support::Folder;

mod cases;
mod certify;
mod contents;
mod points;

use cases::{Case, Input};

const UPDATE: &str = "PINHOLE_UPDATE_SNAPSHOTS";

/// Compares text with a file in `snapshots/`, or writes that file.
#[track_caller]
fn compare(name: &str, found: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/snapshots");
    let file = folder.join(name).with_extension("txt");
    if std::env::var_os(UPDATE).is_some_and(|value| value == "1") {
        return std::fs::write(file, found).unwrap();
    }
    // A missing file counts as an empty one. On Windows, Git may have written \r\n.
    let expected = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    if expected != found {
        let diff = TextDiff::from_lines(&*expected, found);
        let diff = diff.unified_diff().context_radius(2).header("expected", "found").to_string();
        panic!(
            "what the program says differs from cli/tests/program/snapshots/{name}.txt:\n\n{diff}\n\
             if the change is intended, rewrite the file:\n    \
             {UPDATE}=1 cargo test -p pinhole-cli --test program snapshots\n"
        );
    }
}

#[test]
#[cfg_attr(not(feature = "gpu"), ignore = "without the feature `gpu` there are fewer commands")]
fn help() {
    let folder = Folder::new();
    let jobs = ["job", "job split", "job part", "job status", "job merge"];
    let others =
        ["", "render", "verify", "certify", "plan", "bench", "demo", "generate", "info", "sort"];
    for command in others.into_iter().chain(jobs) {
        let run = folder.run(&format!("{command} --help")).succeeded();
        assert_eq!(run.stderr, "", "{command}");
        let name = format!("help-{command}").replace(' ', "-");
        compare(name.trim_end_matches('-'), &String::from_utf8(run.stdout).unwrap());
    }
}

/// Runs cases, each in a new folder with the same files, and compares what they print with a snapshot. Each must end
/// with one line on standard error and leave no new file.
#[track_caller]
fn errors(name: &str, cases: Vec<Case>) {
    let mut texts = Vec::new();
    for Case { input, arguments } in cases {
        let folder = cases::folder();
        let mut text = String::new();
        if let Some(Input { name, text: contents }) = input {
            std::fs::write(folder.path(name), contents).unwrap();
            write!(text, "$ cat {name}\n{}", printable(contents)).unwrap();
        }
        let before = folder.files();
        let run = folder.run_without_drivers(&arguments);
        assert_eq!(run.stderr.lines().count(), 1, "{arguments}: {}", run.stderr);
        assert!(run.stderr.starts_with("error: "), "{arguments}: {}", run.stderr);
        assert!(run.stdout.is_empty(), "{arguments}: something on standard output");
        assert_eq!(folder.files(), before, "{arguments}");
        write!(text, "$ pinhole {arguments}\nexit code {}\n{}", run.code, run.stderr).unwrap();
        texts.push(text);
    }
    compare(name, &texts.join("\n"));
}

/// The text with control characters escaped.
fn printable(text: &str) -> String {
    let shown = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.into() };
    text.lines().flat_map(|line| line.chars().map(shown).chain(["\n".to_owned()])).collect()
}

macro_rules! areas {
    ($($(#[$attribute:meta])* $module:ident::$area:ident)*) => {$(
        #[test]
        #[cfg_attr(not(target_os = "linux"), ignore = "some lines quote the system, which is Linux")]
        $(#[$attribute])*
        fn $area() {
            errors(stringify!($area), $module::$area());
        }
    )*};
}

areas!(
    cases::arguments
    #[cfg_attr(not(feature = "gpu"), ignore = "needs the feature `gpu`")]
    cases::removed
    cases::files
    cases::arrays
    certify::certify
    cases::light
    contents::scene_files
    contents::lit_scene_files
    contents::atoms
    points::points
    #[cfg_attr(not(feature = "gpu"), ignore = "needs the feature `gpu`")]
    cases::devices
    #[cfg_attr(feature = "gpu", ignore = "concerns the program without the feature `gpu`")]
    cases::without_gpu
);
