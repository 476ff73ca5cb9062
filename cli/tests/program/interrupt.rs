//! Tests of signals: one line, exit code 130 and no file.
#![cfg(unix)]

use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::support::Folder;

/// A delay after which the program is at work, even on a slow machine.
const LATER: Duration = Duration::from_millis(700);

/// A command that takes the CPU reference hours.
const LONG: &str =
    "render many.npy -o out.png --layer id=id.npy --backend cpu --size 4000x4000 --samples 999";

fn start(folder: &Folder, arguments: &str) -> Child {
    let mut command = folder.command(arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn send(signal: &str, to: &Child) {
    let status = Command::new("kill").args([signal, &to.id().to_string()]).status().unwrap();
    assert!(status.success());
}

#[test]
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

/// Whenever the signal comes, there is the complete file or none, and never a temporary file.
#[test]
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
            // The signal itself ends the program if it does not listen yet.
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
