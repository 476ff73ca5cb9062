//! Tests of what ends lit pictures early, on the CPU: a time, a level of noise, and signals.

use std::process::Stdio;
use std::time::Duration;

use crate::support::Folder;

/// A lit scene: a sphere on the ground.
const SCENE: &str = "[film]\nwidth = 64\nheight = 48\n[camera.pinhole]\neye = [0, 1, 6]\nlook_at = [0, 0, 0]\n\
                     [ground]\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'tomato'\n";

const RENDER: &str = "render scene.toml -o out.png --layer samples=s.npy --quiet --backend cpu";

fn folder() -> Folder {
    Folder::with(&[("scene.toml", SCENE)])
}

/// The least and the greatest number of samples of a pixel.
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
        let run = folder.run(&format!("{RENDER} --integrator path {flags}"));
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
    // The picture has the pixels of so many samples.
    let noisy = folder.read("out.png");
    folder.run(&format!("{RENDER} --integrator path --samples 20")).succeeded();
    assert!(folder.read("out.png") == noisy);
}

#[test]
fn a_time_gives_at_least_one_sample() {
    let folder = folder();
    for (flags, most) in [("--time 0.001s --keep-partial", u32::MAX), ("--time 1h --samples 3", 3)]
    {
        let run = folder.run(&format!("{RENDER} {flags}"));
        assert_eq!(run.code, 0, "{}", run.stderr);
        let [least, found] = samples(&folder);
        assert!(least >= 1 && found <= most, "{flags}: {least} to {found}");
    }
    folder.run(&format!("{RENDER} --integrator path --time 1s")).succeeded();
    let [least, most] = samples(&folder);
    assert!(least > 1 && most < 1 << 24, "{least} to {most}");
    // This time is too short for a sample in every pixel.
    std::fs::remove_file(folder.path("out.png")).unwrap();
    let flags = "--integrator path --size 4000x3000 --time 0.02s";
    let run = folder.run(&format!("{RENDER} {flags}"));
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
    folder.run(&format!("{RENDER} --stereo side-by-side --separation 0.1 --time 1s")).succeeded();
    let [least, most] = samples(&folder);
    assert!(least > 1 && most < 1 << 24, "{least} to {most}");
}

#[test]
#[cfg(unix)]
fn a_signal_keeps_the_partial_picture_if_asked() {
    let folder = folder();
    let endless = format!("{RENDER} --integrator path --size 320x240 --samples 10000000");
    let interrupted = |flags: &str, seconds: u64| {
        let mut command = folder.command(&format!("{endless} {flags}"));
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(Duration::from_secs(seconds));
        let id = child.id().to_string();
        let status = std::process::Command::new("kill").args(["-INT", &id]).status().unwrap();
        assert!(status.success());
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
