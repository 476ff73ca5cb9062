//! Tests of `render --profile`, without an adapter.

use serde_json::Value;

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

/// Every value is what the Chrome trace event format says.
#[test]
fn a_trace_is_an_array_of_complete_events() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let arguments =
        "render scene.toml -o out.exr --layer id=id.npy --backend cpu --profile=a.json -q";
    let run = folder.run(arguments).succeeded();
    assert!(run.stderr.contains("profile: "), "it was asked for: {}", run.stderr);
    let trace: Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
    let events = trace.as_array().unwrap();
    let (names, spans): (Vec<_>, Vec<_>) = events.iter().partition(|event| event["ph"] == "M");
    assert_eq!(names.len(), 1);
    assert_eq!(names[0]["name"], "thread_name");
    assert_eq!(names[0]["args"]["name"], "host");
    let mut last = 0.0;
    for span in &spans {
        assert_eq!(span["ph"], "X");
        assert_eq!((&span["pid"], &span["tid"]), (&names[0]["pid"], &names[0]["tid"]));
        assert!(span["name"].is_string() && span["cat"] == "host");
        let [start, length] = ["ts", "dur"].map(|key| span[key].as_f64().unwrap());
        assert!(start >= last && length >= 0.0, "{span}");
        last = start;
    }
    assert!(spans.iter().any(|span| span["name"] == "render on the CPU"), "{trace}");
}

#[test]
fn a_trace_that_cannot_be_written_is_refused_before_the_work() {
    let folder = Folder::with(&[("scene.toml", SCENE), ("data.json", "x,y,z,radius\n0,0,0,1\n")]);
    let cases = [
        (
            "scene.toml --profile=a.txt",
            "a.txt: a profile is written as .json; change the extension",
        ),
        ("scene.toml --profile=no/a.json", "no/a.json: the folder no does not exist"),
        ("data.json --format csv --profile=data.json", "data.json: this output is also an input"),
        ("scene.toml --print-scene --profile", "cannot be used with"),
        ("scene.toml --print-scene --keep-partial", "cannot be used with"),
    ];
    for (arguments, message) in cases {
        let output = if arguments.contains("--print-scene") { "" } else { " -o out.png" };
        let run = folder.run(&format!("render {arguments}{output} --backend cpu"));
        assert_eq!(run.code, 2, "{arguments}: {}", run.stderr);
        assert!(run.stderr.contains(message), "{arguments}: {}", run.stderr);
        assert_eq!(folder.files(), ["data.json", "scene.toml"], "{arguments}");
    }
}

/// Frames are read and written by threads of their own.
#[test]
fn a_movie_has_threads_beside_the_one_that_renders() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let run =
        folder.run("render scene.toml -o f%02d.png --turntable 3 --backend cpu --profile=a.json");
    let text = run.succeeded().stderr;
    assert!(text.contains("host, other threads"), "{text}");
    let trace: Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
    let count = |name: &str| {
        let events = trace.as_array().unwrap().iter();
        events.filter(|event| event["name"] == name).count()
    };
    assert_eq!((count("render on the CPU"), count("encode"), count("thread_name")), (3, 3, 2));
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
