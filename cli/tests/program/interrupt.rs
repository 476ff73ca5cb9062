//! Tests of events during rendering: signals, the end of a time, a level of noise, and the report of profiles.

use std::process::Stdio;
#[cfg(unix)]
use std::process::{Child, Command};
use std::time::Duration;

#[cfg(unix)]
use crate::support::send;
use crate::support::{Folder, SCENE};

/// A delay after which the program is working, even on a slow machine.
#[cfg(unix)]
const LATER: Duration = Duration::from_millis(700);

/// A command that takes the CPU reference hours.
#[cfg(unix)]
const LONG: &str = "render many.npy -o out.png --layer id=id.npy --backend cpu --size 4000x4000 --samples 999";

#[cfg(unix)]
fn start(folder: &Folder, arguments: &str) -> Child {
    let mut command = folder.command(arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
#[cfg(unix)]
fn the_reference_is_stopped() {
    let folder = Folder::new();
    folder.run("generate random -n 20000 -o many.npy").succeeded();
    for signal in ["-INT", "-TERM"] {
        let child = start(&folder, LONG);
        std::thread::sleep(LATER);
        send(signal, &child);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{signal}");
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(stderr, "stopped; nothing was written\n", "{signal}");
        assert!(output.stdout.is_empty());
        assert_eq!(folder.files(), ["many.npy"], "{signal}");
    }
}

/// After a signal at any moment, the file is complete or absent, and no temporary file is left.
#[test]
#[cfg(unix)]
fn files_are_complete_or_absent_after_a_signal() {
    let folder = Folder::new();
    for delay in [5, 20, 40, 80, 120, 200, 400] {
        let child = start(&folder, "generate random -n 3000000 -o big.bin");
        std::thread::sleep(Duration::from_millis(delay));
        // The program may have ended already, so the result of `kill` does not matter.
        let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).output().unwrap();
        let output = child.wait_with_output().unwrap();
        let files = folder.files();
        match output.status.code() {
            Some(0) => {
                assert_eq!(files, ["big.bin"]);
                assert_eq!(std::fs::metadata(folder.path("big.bin")).unwrap().len(), 48_000_000);
                std::fs::remove_file(folder.path("big.bin")).unwrap();
            }
            // The signal itself ends the program if it is not handled yet.
            None => assert!(files.is_empty(), "{files:?}"),
            Some(code) => {
                let stderr = String::from_utf8(output.stderr).unwrap();
                assert_eq!(code, 130, "{stderr}");
                if stderr.contains("all files were already complete") {
                    assert_eq!(files, ["big.bin"]);
                    std::fs::remove_file(folder.path("big.bin")).unwrap();
                } else {
                    assert!(stderr.ends_with("stopped; nothing was written\n"), "{stderr}");
                    assert!(files.is_empty(), "{files:?}");
                }
            }
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn nohup_keeps_the_program_alive() {
    let folder = Folder::new();
    folder.run("generate random -n 20000 -o many.npy").succeeded();
    let mut command = Command::new("nohup");
    command.arg(env!("CARGO_BIN_EXE_pinhole")).args(LONG.split(' '));
    command.current_dir(folder.path("")).stdin(Stdio::null());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(LATER);
    send("-HUP", &child);
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(child.try_wait().unwrap(), None);
    // The program still handles other signals.
    send("-TERM", &child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

/// A lit scene: a sphere on the ground.
const LIT: &str = "[film]\nwidth = 64\nheight = 48\n[camera.pinhole]\neye = [0, 1, 6]\nlook_at = [0, 0, 0]\n\
                     [ground]\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'tomato'\n";

const LIT_RENDER: &str = "render scene.toml -o out.png --layer samples=s.npy --quiet --backend cpu";

fn folder() -> Folder {
    Folder::with(&[("scene.toml", LIT)])
}

/// The least and the greatest number of samples in a pixel.
fn samples(folder: &Folder) -> [u32; 2] {
    let bytes = folder.read("s.npy");
    let samples: Vec<u32> = npyz::NpyFile::new(&bytes[..]).unwrap().into_vec().unwrap();
    assert_eq!(samples.len() % 64, 0);
    [*samples.iter().min().unwrap(), *samples.iter().max().unwrap()]
}

#[test]
fn noise_decides_how_many_samples_there_are() {
    let folder = folder();
    let render = |flags: &str| {
        let run = folder.run(&format!("{LIT_RENDER} --integrator path {flags}"));
        assert_eq!(run.code, 0, "{}", run.stderr);
        let [least, most] = samples(&folder);
        assert_eq!(least, most);
        (most, run.stderr)
    };
    let (few, said) = render("--noise 0.05");
    assert!(few >= 16 && said.is_empty(), "{few}: {said}");
    let (more, _) = render("--noise 0.02");
    assert!(more > few, "{more} after {few}");
    assert_eq!(render("--noise 0.05").0, few);
    let (most, said) = render("--noise 1e-9 --samples 20");
    assert_eq!(most, 20);
    let is_told = said.starts_with("note: the noise is 0.") && said.contains("after 20 samples");
    assert!(is_told, "{said}");
    // The pixels of the picture are those for this number of samples.
    let noisy = folder.read("out.png");
    folder.run(&format!("{LIT_RENDER} --integrator path --samples 20")).succeeded();
    assert!(folder.read("out.png") == noisy);
}

#[test]
fn a_time_gives_at_least_one_sample() {
    let folder = folder();
    for (flags, most) in [("--time 0.001s --keep-partial", u32::MAX), ("--time 1h --samples 3", 3)] {
        let run = folder.run(&format!("{LIT_RENDER} {flags}"));
        assert_eq!(run.code, 0, "{}", run.stderr);
        let [least, found] = samples(&folder);
        assert!(least >= 1 && found <= most, "{flags}: {least} to {found}");
    }
    folder.run(&format!("{LIT_RENDER} --integrator path --time 1s")).succeeded();
    let [least, most] = samples(&folder);
    assert!(least > 1 && most < 1 << 24, "{least} to {most}");
    // This time is too short for a sample in every pixel.
    std::fs::remove_file(folder.path("out.png")).unwrap();
    let flags = "--integrator path --size 4000x3000 --time 0.02s";
    let run = folder.run(&format!("{LIT_RENDER} {flags}"));
    assert_eq!(run.code, 1, "{}", run.stderr);
    let words = "nothing was written; give more time or a smaller --size, or wait for it with --keep-partial\n";
    let is_told = run.stderr.starts_with("error: --time: after 0.020 s only ");
    assert!(is_told && run.stderr.ends_with(words), "{}", run.stderr);
    assert!(!folder.path("out.png").exists());
}

/// Both pictures of a stereo camera share the time.
#[test]
fn two_eyes_share_the_time() {
    let folder = folder();
    folder.run(&format!("{LIT_RENDER} --stereo side-by-side --separation 0.1 --time 1s")).succeeded();
    let [least, most] = samples(&folder);
    assert!(least > 1 && most < 1 << 24, "{least} to {most}");
}

#[test]
#[cfg(unix)]
fn a_signal_keeps_the_partial_picture_if_asked() {
    let folder = folder();
    let endless = format!("{LIT_RENDER} --integrator path --size 320x240 --samples 10000000");
    let interrupted = |flags: &str, seconds: u64| {
        let mut command = folder.command(&format!("{endless} {flags}"));
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(Duration::from_secs(seconds));
        send("-INT", &child);
        let output = child.wait_with_output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, said) = interrupted("", 1);
    assert_eq!((code, &*said), (Some(130), "stopped; nothing was written\n"));
    assert!(!folder.path("out.png").exists());
    // Nothing can be kept before the work begins, so later signals are tried until a picture is written.
    for seconds in [1, 2, 4, 8, 16] {
        let (code, said) = interrupted("--keep-partial", seconds);
        if code == Some(0) {
            let [least, most] = samples(&folder);
            let last = format!("stopped; the picture has {least} samples per pixel");
            assert_eq!(said.lines().last(), Some(&*last), "{said}");
            assert!(least >= 1 && most < 10_000_000, "{least} to {most}");
            assert!(image::open(folder.path("out.png")).is_ok());
            return;
        }
        assert_eq!(code, Some(130), "{said}");
        assert!(!folder.path("out.png").exists());
    }
    panic!("whenever it is stopped, nothing is kept");
}

/// The rows of the table of `--profile`: name, and share in percent.
#[cfg(feature = "gpu")]
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
#[cfg(feature = "gpu")]
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

/// Frames are read and written on separate threads.
#[test]
#[cfg(feature = "gpu")]
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
