//! Texts that users read, word for word: the help of every command, and the error line for every kind of wrong input.
//!
//! The files in `snapshots/` are the list of cases: a help file is named after its command, and the others hold command
//! lines, the files that they read, and the expected text. After an intended change, or after you added a command line
//! without its text, rewrite them and read the difference before you commit it:
//!
//! ```sh
//! PINHOLE_UPDATE_SNAPSHOTS=1 cargo test -p pinhole-cli --test program snapshots
//! ```
//!
//! The inputs are written into an empty folder and no adapter is used, so the text does not depend on paths, drivers
//! or the machine. Help has the same lines in every terminal, because clap is built without its feature `wrap_help`.

use std::path::Path;

use pinhole_data::load::{FORMATS, Format};
use similar::TextDiff;

use crate::cases::{Case, answered};
use crate::support::Folder;

mod files;

const SNAPSHOTS: &str = "tests/program/snapshots";

const UPDATE: &str = "PINHOLE_UPDATE_SNAPSHOTS";

/// Compares the files in a folder that a test concerns with the results of `find` for their names and texts, or
/// writes them.
#[track_caller]
fn compare(folder: &str, is_about: impl Fn(&str) -> bool, find: impl Fn(&str, &str) -> String + Sync) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let compared = |name: &str| {
        let file = folder.join(name).with_extension("txt");
        // On Windows, Git may have written \r\n.
        let expected = std::fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
        let found = find(name, &expected);
        if std::env::var_os(UPDATE).is_some_and(|value| value == "1") {
            std::fs::write(file, found).unwrap();
            return String::new();
        }
        let diff = TextDiff::from_lines(&*expected, &*found);
        diff.unified_diff().context_radius(2).header(&format!("{name}.txt"), "found").to_string()
    };
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name());
    let names = files.filter_map(|file| file.to_str()?.strip_suffix(".txt").map(str::to_owned));
    let names: Vec<String> = names.filter(|name| is_about(name)).collect();
    assert!(!names.is_empty(), "there is nothing to compare");
    let differences: String = std::thread::scope(|scope| {
        let compared = &compared;
        let threads: Vec<_> = names.iter().map(|name| scope.spawn(move || compared(name))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(
        differences.is_empty(),
        "what the program says differs from the text files:\n\n{differences}\n\
         if the change is intended, rewrite the files:\n    \
         {UPDATE}=1 cargo test -p pinhole-cli --test program snapshots\n"
    );
}

#[test]
#[cfg_attr(not(feature = "gpu"), ignore = "without the feature `gpu` there are fewer commands")]
fn help() {
    let folder = Folder::new();
    let of_render = folder.run("render --help").succeeded().stdout;
    let of_render = without_formats(String::from_utf8(of_render).unwrap());
    compare(
        SNAPSHOTS,
        |name| name.starts_with("help") || name == BRIEF,
        |name, _| {
            let (start, flag) = if name == BRIEF { (BRIEF, "render -h") } else { ("help", "--help") };
            let command = name[start.len()..].replace('-', " ");
            let run = folder.run(&format!("{command} {flag}")).succeeded();
            assert_eq!(run.stderr, "", "{command}");
            let text = String::from_utf8(run.stdout).unwrap();
            let text = without_formats(text);
            if ["help", "help-render", BRIEF].contains(&name) {
                return text;
            }
            // The flags that a command shares with `render` are in that file alone.
            let is_own = |part: &&str| part.starts_with("Usage") || !of_render.contains(part.trim_end());
            text.split("\n\n").filter(is_own).collect::<Vec<_>>().join("\n\n")
        },
    );
}

/// The short help of `render`, which fits on a screen.
const BRIEF: &str = "brief-render";

/// Each command must end with one line on standard error, and leave no new file.
#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "some lines quote the system, which is Linux")]
fn errors() {
    let other_build = if cfg!(feature = "gpu") { "without_gpu" } else { "devices" };
    compare(
        SNAPSHOTS,
        |name| !name.starts_with("help") && ![other_build, "kernels", BRIEF].contains(&name),
        |_, text| answered(text, refused),
    );
}

/// Files that readers refuse. The tests of the readers' packages read them too.
#[test]
fn refused_files() {
    for package in ["data", "figure"] {
        let folder = format!("../crates/{package}/tests/files/refused");
        compare(&folder, |_| true, |_, text| answered(text, refused));
    }
}

/// Runs a command in a new folder and returns its exit code and its error.
fn refused(Case { files, arguments }: &Case<'_>) -> String {
    let folder = files::folder(arguments);
    for (name, contents) in files {
        std::fs::write(folder.path(name), contents).unwrap();
    }
    let before = folder.files();
    let run = folder.run_without_drivers(arguments);
    assert_eq!(run.stderr.lines().count(), 1, "{arguments}: {}", run.stderr);
    assert!(run.stderr.starts_with("error: "), "{arguments}: {}", run.stderr);
    assert!(run.stdout.is_empty(), "{arguments}: something on standard output");
    assert_eq!(folder.files(), before, "{arguments}");
    let stderr = run.stderr.replace(&*folder.path("").to_string_lossy(), "");
    without_formats(format!("exit code {}\n{stderr}", run.code))
}

/// Writes words for the lists that follow from the table of formats, so that a new format is not a change of texts.
fn without_formats(mut text: String) -> String {
    let extensions = |is_wanted: fn(&Format) -> bool| Format::extensions_of(is_wanted);
    for (list, words) in [
        (extensions(|_| true), "EXTENSIONS"),
        (extensions(Format::has_frames), "EXTENSIONS OF TRAJECTORIES"),
        (extensions(|format| format.may_lack_radii), "EXTENSIONS OF DATA THAT MAY LACK RADII"),
        (FORMATS.iter().map(|format| format.name).collect::<Vec<_>>().join(", "), "NAMES OF FORMATS"),
    ] {
        text = text.replace(&list, words);
    }
    // The help has a line for each.
    let is_format = |line: &&str| {
        let name = line.trim_start().strip_prefix("- ").and_then(|line| line.split_once(':'));
        name.is_some_and(|(name, _)| FORMATS.iter().any(|format| format.name == name))
    };
    text.split_inclusive('\n').filter(|line| !is_format(line)).collect()
}

/// No adapter is needed.
#[test]
#[cfg(feature = "gpu")]
fn every_kernel_is_written() {
    let folder = Folder::new();
    let run = folder.run_without_drivers("info --dump-shaders kernels").succeeded();
    let names = std::fs::read_dir(folder.path("kernels")).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    compare(SNAPSHOTS, |name| name == "kernels", |_, _| names.join("\n") + "\n");
    let pipelines = String::from_utf8(folder.read("kernels/pipelines.txt")).unwrap();
    let text = String::from_utf8(run.stdout).unwrap();
    let (kernels, of) = (names.len() - 1, pipelines.lines().count());
    let expected = format!("kernels: {kernels} kernels, and pipelines.txt with the constants of {of} pipelines\n");
    assert_eq!(text, expected);
    for name in names.into_iter().filter(|name| name != "pipelines.txt") {
        assert!(pipelines.lines().any(|line| line.split(' ').next() == Some(&name)), "{name}");
        let source = String::from_utf8(folder.read(&format!("kernels/{name}"))).unwrap();
        let entry_point = name.split(['-', '.']).next().unwrap();
        assert!(source.contains(&format!("fn {entry_point}(")), "{name}");
        assert!(source.starts_with("//// "), "{name}");
    }
    // The kernels are written again into the existing folder.
    folder.run("info --dump-shaders kernels").succeeded();
}
