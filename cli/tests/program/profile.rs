//! Tests of `render --profile`, without an adapter.

use crate::support::{Folder, SCENE};

/// The rows of the table: name, share in percent.
fn rows(stderr: &str) -> Vec<(String, f64)> {
    let lines = stderr.lines().filter_map(|line| line.trim().strip_suffix('%'));
    lines
        .map(|line| {
            let (rest, share) = line.rsplit_once(' ').unwrap();
            let words = rest.split_whitespace().filter(|word| word.parse::<f64>().is_err());
            (words.collect::<Vec<_>>().join(" "), share.parse().unwrap())
        })
        .collect()
}

#[test]
fn a_table_says_where_the_time_went() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    folder.run("render scene.toml -o without.png --backend cpu").succeeded();
    let run = folder.run("render scene.toml -o with.png --backend cpu --profile").succeeded();
    assert_eq!(folder.files(), ["scene.toml", "with.png", "without.png"]);
    assert_eq!(folder.read("with.png"), folder.read("without.png"));
    let text = &run.stderr;
    assert!(text.lines().any(|line| line.starts_with("profile: ")), "{text}");
    let rows = rows(text);
    let wanted = ["read", "build", "render on the CPU", "encode", "write", "other"];
    for name in wanted {
        assert!(rows.iter().any(|(found, _)| found == name), "{name}: {text}");
    }
    let sum: f64 = rows.iter().map(|(_, share)| share).sum();
    assert!((sum - 100.0).abs() < 1.0, "the shares of the host sum to {sum} %: {text}");
}

#[test]
fn a_scene_is_not_printed_with_flags_of_rendering() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    for flag in ["--profile", "--keep-partial"] {
        let run = folder.run(&format!("render scene.toml --print-scene {flag} --backend cpu"));
        assert_eq!(run.code, 2, "{flag}: {}", run.stderr);
        assert!(run.stderr.contains("cannot be used with"), "{flag}: {}", run.stderr);
    }
}

/// Frames are read and written by threads of their own.
#[test]
fn a_movie_has_threads_beside_the_one_that_renders() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let run = folder.run("render scene.toml -o f%02d.png --turntable 3 --backend cpu --profile");
    let text = run.succeeded().stderr;
    let (host, others) = text.split_once("host, other threads").unwrap();
    let has = |rows: &str, name: &str| {
        let words = |row: &str| row.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        rows.lines().any(|row| words(row).join(" ").starts_with(&format!("{name} 3 ")))
    };
    assert!(has(host, "render on the CPU") && has(others, "encode"), "{text}");
}

/// Thousands of threads would take minutes to start.
#[test]
fn far_too_many_threads_are_not_started() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    for (number, notes) in [("2", 0), ("100000", 1), ("99999999999999999999999", 1)] {
        let mut command = folder.command("render scene.toml -o out.png --backend cpu");
        let output = command.env("RAYON_NUM_THREADS", number).output().unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{text}");
        let found = text.lines().filter(|line| line.starts_with("note: RAYON_NUM_THREADS")).count();
        assert_eq!(found, notes, "{number}: {text}");
    }
}
