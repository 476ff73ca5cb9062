//! Devices that are lost, hang or have little memory: the Vulkan layer of `cli/tests/faults` is placed between the
//! program and the driver.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use libtest_mimic::Trial;
use pinhole::gpu::wgpu::Backend;
use pinhole::gpu::{Headless, HeadlessOptions, SelfTestExtent, Wait};
use tempfile::TempDir;

use crate::harness::trial_unless;
use crate::{command, command_on, succeed};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial_of_vulkan("faults::a_part_whose_device_is_lost_ends_and_is_rendered_again", lost_part),
        trial_of_vulkan("faults::a_picture_whose_device_is_lost_is_not_written", lost_picture),
        trial_of_vulkan("faults::with_little_memory_nothing_is_written", little_memory),
        trial_of_vulkan("faults::a_driver_that_hangs_ends_in_time", hangs),
        trial_of_vulkan("faults::the_library_returns_errors_and_waits_for_nothing", library),
    ]
}

/// A trial for Vulkan on systems whose loader finds layers in folders.
fn trial_of_vulkan(name: &str, test: fn(&'static Headless)) -> Trial {
    let lacking = |headless: &Headless| {
        let is_vulkan = headless.adapter_info().backend == Backend::Vulkan;
        (!is_vulkan || !cfg!(unix)).then(|| "the layer is for Vulkan's loader on Unix".to_owned())
    };
    trial_unless(name, lacking, move |headless| {
        test(headless);
        Ok(())
    })
}

const SCENE: &str = "[film]\nwidth = 200\nheight = 150\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'red'\n\
                     [[spheres]]\ncenter = [1, 0.5, -1]\nradius = 0.7\n";

const LIGHT: &str = "--integrator path --samples 12";

/// A folder with a scene, a picture of it, and a job of two tiles.
fn prepared(headless: &Headless) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), SCENE).unwrap();
    let layer = "--layer depth";
    let split = format!("job split a.toml --tiles 2x1 -o job -q {layer} {LIGHT}");
    succeed(&mut command_on(headless, &folder, &split));
    let render = format!("render a.toml -o good.png {layer}=good.npy -q {LIGHT}");
    succeed(&mut command_on(headless, &folder, &render));
    folder
}

/// Places the layer between a program and its driver.
fn with_fault(command: &mut Command, fault: &str) -> TempDir {
    let program = std::env::current_exe().unwrap();
    let name = format!("{}pinhole_test_faults{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let library = program.with_file_name(name);
    assert!(library.exists(), "{}", library.display());
    let layers = tempfile::tempdir().unwrap();
    let manifest = format!(
        "{{\"file_format_version\": \"1.1.2\", \"layer\": {{\"name\": \"VK_LAYER_PINHOLE_faults\", \"type\": \"GLOBAL\", \
         \"library_path\": {library:?}, \"api_version\": \"1.3.0\", \"implementation_version\": \"1\", \
         \"description\": \"faults\"}}}}"
    );
    fs::write(layers.path().join("faults.json"), manifest).unwrap();
    command.env("VK_LAYER_PATH", layers.path());
    command.env("VK_INSTANCE_LAYERS", "VK_LAYER_PINHOLE_faults");
    command.env("PINHOLE_TEST_FAULT", fault);
    layers
}

/// Runs a command with a fault. A command that takes longer than a minute fails the test.
fn run(mut command: Command, fault: &str) -> Output {
    let _layers = with_fault(&mut command, fault);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let started = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if started.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            panic!("{fault}: {command:?} hangs");
        }
        sleep(Duration::from_millis(5));
    }
    child.wait_with_output().unwrap()
}

/// Checks that the run failed with one line.
#[track_caller]
fn assert_fails(output: &Output, code: i32, fault: &str, line: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{fault}: {said}");
    let is_one = said.starts_with("error: ") && said.ends_with('\n') && said.lines().count() == 1;
    assert!(is_one && said.contains(line), "{fault}: {said}");
}

fn names(folder: impl AsRef<Path>) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn assert_same(folder: &TempDir, made: &str, good: &str) {
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read(made) == read(good), "{made}");
}

const LOST: &str = "the device was lost: Device is lost; try again";

/// The device is lost at any submission, from the first to the last.
fn lost_part(headless: &'static Headless) {
    let folder = prepared(headless);
    let at = |path: &str| folder.path().join(path);
    for kind in ["lost-submit", "lost-wait"] {
        let mut parts_left = Vec::new();
        for number in 1.. {
            for name in names(at("job/parts")) {
                fs::remove_file(at("job/parts").join(name)).unwrap();
            }
            let fault = format!("{kind}={number}");
            let output = run(command(&folder, "job part job 0-1 -q"), &fault);
            if output.status.success() {
                break;
            }
            assert_fails(&output, 5, &fault, LOST);
            let parts = names(at("job/parts"));
            assert!(parts.is_empty() || parts == ["000000.part"], "{fault}: {parts:?}");
            parts_left.push(parts.len());
        }
        // Some devices are lost in each of the two units.
        let lost_in = |unit| parts_left.iter().filter(|left| **left == unit).count();
        assert!(lost_in(0) > 2 && lost_in(1) > 2, "{kind}: {parts_left:?}");

        // The first part exists, and the second was lost, so only the second is rendered again.
        fs::remove_file(at("job/parts/000001.part")).unwrap();
        // The number of submissions of a unit depends on its speed, so the device is lost well before the last.
        let fault = format!("{kind}={}", lost_in(0) / 2);
        let output = run(command(&folder, "job part job 1 -q"), &fault);
        assert_fails(&output, 5, &fault, LOST);
        succeed(&mut command(&folder, "job part job 0-1 -q"));
        succeed(&mut command(&folder, "job merge job -o m.png --layer depth=m.npy -q"));
        assert_same(&folder, "m.png", "good.png");
        assert_same(&folder, "m.npy", "good.npy");
    }
}

fn lost_picture(headless: &'static Headless) {
    let folder = prepared(headless);
    let before = names(&folder);
    for kind in ["lost-submit", "lost-wait"] {
        let mut lost = 0;
        for number in 1.. {
            let fault = format!("{kind}={number}");
            let render = format!("render a.toml -o r.png --layer depth=r.npy -q {LIGHT}");
            let output = run(command_on(headless, &folder, &render), &fault);
            if output.status.success() {
                break;
            }
            assert_fails(&output, 5, &fault, LOST);
            assert_eq!(names(&folder), before, "{fault}");
            lost += 1;
        }
        assert!(lost > 4, "{kind}: {lost}");
        assert_same(&folder, "r.png", "good.png");
        assert_same(&folder, "r.npy", "good.npy");
        for name in ["r.png", "r.npy"] {
            fs::remove_file(folder.path().join(name)).unwrap();
        }
    }
}

/// Memory goes from almost none to enough: first nothing is written, and then everything.
fn little_memory(headless: &'static Headless) {
    let folder = prepared(headless);
    let split = format!("job split a.toml -o whole -q {LIGHT}");
    succeed(&mut command_on(headless, &folder, &split));
    let mut refused = 0;
    for step in 0..60 {
        let fault = format!("memory={:.0}", 1e6 * 1.2_f64.powi(step));
        let part = run(command(&folder, "job part whole 0 -q"), &fault);
        if part.status.success() {
            break;
        }
        assert_fails(&part, 1, &fault, "emory");
        assert!(names(folder.path().join("whole/parts")).is_empty(), "{fault}");
        let render = format!("render a.toml -o r.png -q {LIGHT}");
        let picture = run(command_on(headless, &folder, &render), &fault);
        assert_fails(&picture, 1, &fault, "emory");
        assert!(!folder.path().join("r.png").exists(), "{fault}");
        refused += 1;
    }
    assert!(refused > 0);
    succeed(&mut command(&folder, "job merge whole -o m.png -q"));
    assert_same(&folder, "m.png", "good.png");
}

/// The driver hangs in the self-test, which is the first submission, and within a unit.
fn hangs(headless: &'static Headless) {
    let folder = prepared(headless);
    let lines = [
        (1, "no device was ready within 2 s; the device may hang: try again"),
        (2, "unit 0 did not end within 2 s; the device may hang: try again"),
        (6, "unit 0 did not end within 2 s; the device may hang: try again"),
    ];
    for (number, line) in lines {
        let fault = format!("hang={number}");
        let output = run(command(&folder, "job part job 0 --timeout 2 -q"), &fault);
        assert_fails(&output, 5, &fault, line);
        assert!(names(folder.path().join("job/parts")).is_empty(), "{fault}");
    }
}

/// The environment variable with the form of call in a child process: `blocking` or `async`.
const CHILD: &str = "PINHOLE_TEST_CHILD";

/// Runs this program again with the layer. It drops its device after the error.
fn library(_: &'static Headless) {
    for form in ["blocking", "async"] {
        for (fault, error) in [
            ("lost-submit=1", "DeviceLost { message: \"Device is lost\" }"),
            ("lost-wait=1", "DeviceLost { message: \"Device is lost\" }"),
            ("hang=1", "Timeout { waited: 1s }"),
        ] {
            let mut child = Command::new(std::env::current_exe().unwrap());
            child.env(CHILD, form);
            let output = run(child, fault);
            let said = String::from_utf8_lossy(&output.stdout);
            assert_eq!(said.trim(), error, "{form}, {fault}: {output:?}");
        }
    }
}

/// Whether this process is a child of this kind, which has then printed an error of the library.
pub(crate) fn is_child() -> bool {
    let Ok(form) = std::env::var(CHILD) else {
        return false;
    };
    let timeout = Duration::from_secs(1);
    let headless = Headless::open(&HeadlessOptions { timeout, ..Default::default() }).wait().unwrap();
    let tested = match form.as_str() {
        "blocking" => headless.self_test(SelfTestExtent::Quick).wait(),
        _ => pollster::block_on(headless.self_test(SelfTestExtent::Quick)),
    };
    drop(headless);
    println!("{:?}", tested.unwrap_err());
    true
}
