//! Jobs survive faults of processes, disks and clocks. Submitted again, they complete with the same bytes.

use std::fs::{self, File};
use std::os::unix::fs::PermissionsExt;
use std::process::Stdio;
use std::time::{Duration, Instant, SystemTime};

use sha2::{Digest, Sha256};

use crate::jobs::{folder, missing, part, through_parts};
use crate::support::{Folder, send};

const SPLIT: &str = "a.xyz --frames :4 --tiles 2x2 --size 120x90 --samples 6";

/// The bytes of the pictures that one machine renders.
fn rendered(folder: &Folder) -> Vec<Vec<u8>> {
    let flags = SPLIT.replace("--tiles 2x2", "");
    folder.run(&format!("render {flags} --backend cpu -o r%d.png -q")).succeeded();
    (0..4).map(|frame| folder.read(&format!("r{frame}.png"))).collect()
}

fn split_frames(folder: &Folder) {
    folder.run(&format!("job split {SPLIT} --backend cpu -o job -q")).succeeded();
}

/// Renders the remaining parts, merges, and compares.
#[track_caller]
fn assert_completed(folder: &Folder, wanted: &[Vec<u8>]) {
    folder.run("job part job 0-15 -q").succeeded();
    folder.run("job merge job -o m%d.png -q").succeeded();
    for (frame, wanted) in wanted.iter().enumerate() {
        assert!(folder.read(&format!("m{frame}.png")) == *wanted, "frame {frame}");
    }
}

/// A job that is killed at 100 random moments never has an incomplete part.
#[test]
fn killed_parts_are_rendered_again() {
    let folder = folder();
    let wanted = rendered(&folder);
    split_frames(&folder);
    let mut random = fastrand::Rng::with_seed(7);
    for _ in 0..100 {
        // There are two parts, so that the first may be whole when the second is not.
        let first = random.usize(..15);
        let mut command = folder.command(&format!("job part job {first}-{} -q", first + 1));
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_micros(random.u64(..150_000)));
        child.kill().unwrap();
        child.wait().unwrap();
        if random.u8(..4) == 0 {
            // Some parts are removed, so that there is always something to do.
            let _ = fs::remove_file(part(&folder, first));
        }
    }
    let is_there = |unit: &usize| part(&folder, *unit).exists();
    let not_there: Vec<usize> = (0..16).filter(|unit| !is_there(unit)).collect();
    assert_eq!(missing(&folder), not_there);
    assert_completed(&folder, &wanted);
}

/// Wherever the disk becomes full, there is one line, exit code 1, and no part.
#[test]
fn a_full_disk_leaves_no_part() {
    let folder = folder();
    let wanted = rendered(&folder);
    let limited = |blocks: u32, arguments: &str| {
        folder.run_with_blocks(blocks, arguments).refused(1, "");
    };
    // A job is split as a whole or not at all.
    for blocks in [0, 1] {
        limited(blocks, &format!("job split {SPLIT} --backend cpu -o job -q"));
        assert!(!folder.path("job").exists());
    }
    split_frames(&folder);
    // A part has 3,600 bytes for each number of a pixel; files may have this many blocks of 512 or 1024 bytes.
    for blocks in [0, 1, 2, 4, 8, 16, 24] {
        limited(blocks, "job part job 0 -q");
        let parts: Vec<_> = fs::read_dir(folder.path("job/parts")).unwrap().collect();
        assert!(parts.is_empty(), "{blocks}: {parts:?}");
    }
    assert_eq!(missing(&folder).len(), 16);
    assert_completed(&folder, &wanted);
}

#[test]
fn two_at_once_write_the_same_part() {
    let folder = folder();
    let wanted = rendered(&folder);
    split_frames(&folder);
    let start = |_| folder.command("job part job 0-15 -q").spawn().unwrap();
    let mut both: Vec<_> = (0..3).map(start).collect();
    assert!(both.iter_mut().all(|child| child.wait().unwrap().success()));
    assert_completed(&folder, &wanted);
}

/// A part becomes visible only after a while, as on a network file system.
#[test]
fn merge_waits_for_parts_that_are_not_seen_yet() {
    let folder = folder();
    let wanted = rendered(&folder);
    split_frames(&folder);
    folder.run("job part job 0-15 -q").succeeded();
    let (seen, hidden) = (part(&folder, 5), folder.path("hidden"));
    fs::rename(&seen, &hidden).unwrap();
    let started = Instant::now();
    folder.refuses("job merge job -o m%d.png --wait 0.3", 1, "missing 5");
    assert!(started.elapsed() >= Duration::from_millis(300));
    let child = folder.command("job merge job -o m%d.png --wait 60 -q").spawn().unwrap();
    std::thread::sleep(Duration::from_millis(700));
    fs::rename(&hidden, &seen).unwrap();
    assert!(child.wait_with_output().unwrap().status.success());
    assert_completed(&folder, &wanted);
}

#[test]
fn clocks_that_differ_do_no_harm() {
    let folder = folder();
    split_frames(&folder);
    let day = Duration::from_secs(86_400);
    // Files that a killed process left long ago are removed.
    let [old, new] = ["old", "new"].map(|name| folder.path(&format!("job/parts/.pinhole-{name}")));
    File::create(&old).unwrap().set_modified(SystemTime::now() - day).unwrap();
    File::create(&new).unwrap();
    folder.run("job part job 0-15 -q").succeeded();
    assert!(!old.exists() && new.exists());
    // Parts are kept, whatever their age.
    let old = File::options().write(true).open(part(&folder, 0)).unwrap();
    old.set_modified(SystemTime::UNIX_EPOCH).unwrap();
    assert_eq!(missing(&folder), [0_usize; 0]);
}

#[test]
fn a_part_that_hangs_ends_with_a_code_of_its_own() {
    let folder = folder();
    folder.run("generate random -n 20000 -o many.npy").succeeded();
    folder.run("job split many.npy --backend cpu --size 3000x3000 --samples 99 -o job -q").succeeded();
    let words = "error: unit 0 did not end within 0.5 s; the device may hang: try again\n";
    folder.refuses("job part job 0 --timeout 0.5 -q", 5, words);
    assert!(fs::read_dir(folder.path("job/parts")).unwrap().next().is_none());
}

#[test]
fn a_signal_leaves_whole_parts_alone() {
    let folder = folder();
    folder.run("generate random -n 20000 -o many.npy").succeeded();
    folder.run("job split many.npy --backend cpu --size 2000x2000 --samples 99 -o job -q").succeeded();
    let child = folder.command("job part job 0").stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(700));
    send("-TERM", &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.starts_with("stopped; the parts that were written are complete"), "{said}");
    assert!(fs::read_dir(folder.path("job/parts")).unwrap().next().is_none());
}

/// Gives a part another device, with a digest that fits.
fn set_device(folder: &Folder, unit: usize, device: &str) {
    let bytes = fs::read(part(folder, unit)).unwrap();
    let (start, rest) = bytes.split_at(15);
    let (length, rest) = rest.split_at(8);
    let length = u64::from_le_bytes(length.try_into().unwrap()) as usize;
    let mut header: serde_json::Value = serde_json::from_slice(&rest[..length]).unwrap();
    header["device"] = device.into();
    let header = serde_json::to_vec(&header).unwrap();
    let mut other = start.to_vec();
    other.extend((header.len() as u64).to_le_bytes());
    other.extend(&header);
    other.extend(&rest[length..rest.len() - 32]);
    let digest = Sha256::digest(&other);
    other.extend(digest);
    fs::write(part(folder, unit), other).unwrap();
}

#[test]
fn parts_of_different_devices_are_merged_only_if_that_is_allowed() {
    let folder = folder();
    through_parts(&folder, SPLIT, "-o good%d.png");
    set_device(&folder, 3, "\u{1b}]0;evil\u{7}\u{9b}2J\u{202e}");
    folder.run("job merge job -o m%d.png").refused(1, r"\u{1b}]0;evil\u{7}\u{9b}2J\u{202e} 3");
    set_device(&folder, 3, "Another GPU (driver 1.2)");
    let run = folder.run("job merge job -o m%d.png");
    run.refused(1, "Another GPU (driver 1.2) 3, CPU (");
    run.refused(1, "add --allow-mixed-adapters\n");
    assert!(!folder.path("m0.png").exists());
    folder.run("job merge job -o m%d.png --allow-mixed-adapters -q").succeeded();
    assert!(folder.read("m0.png") == folder.read("good0.png"));
}

/// The folder of a job may be that of a stranger.
#[test]
fn no_link_in_the_folder_of_a_job_is_followed() {
    let folder = folder();
    split_frames(&folder);
    folder.run("job part job 1 -q").succeeded();
    fs::write(folder.path("mine"), "mine").unwrap();
    let words = "this is a link or a special file, which the folder of a job must not have";
    for name in
        ["parts", "parts/000000.part", "parts/000001.part", "parts/.pinhole-job-0.png", "job.json", "overview.bin"]
    {
        let (place, elsewhere) = (folder.path("job").join(name), folder.path("elsewhere"));
        let was_there = fs::rename(&place, &elsewhere).is_ok();
        let target = folder.path(if was_there { "elsewhere" } else { "mine" });
        std::os::unix::fs::symlink(target, &place).unwrap();
        folder.refuses("job part job 0-3 -q", 1, words);
        if name.starts_with("parts") {
            folder.refuses("job status job --missing", 1, words);
            folder.refuses("job merge job -o m%d.png", 1, words);
        }
        fs::remove_file(&place).unwrap();
        let _ = fs::rename(&elsewhere, &place);
        assert_eq!(folder.read("mine"), b"mine");
    }
    let make_pipe = |path| assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
    make_pipe(part(&folder, 0));
    folder.refuses("job part job 0 -q", 1, words);
    fs::remove_file(part(&folder, 0)).unwrap();
    // An input that became a pipe is not waited for.
    fs::remove_file(folder.path("a.xyz")).unwrap();
    make_pipe(folder.path("a.xyz"));
    folder.refuses("job part job 0 -q", 1, "a.xyz: cannot be read: this is not a regular file");
}

/// What a name could do to a script that has it is refused, and a hint can be copied.
#[test]
fn names_of_jobs_are_no_commands() {
    let folder = folder();
    let split = |job: &str| folder.command("job split a.xyz --backend cpu -o").arg(job).output().unwrap();
    for name in ["K\ntouch PWNED1\n", "a\rb", "a\u{1b}]0;x\u{7}", "a\u{9b}2J", "a\u{202e}b"] {
        let output = split(name);
        assert_eq!(output.status.code(), Some(2));
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(": this name has control characters, ") && said.lines().count() == 1, "{said}");
    }
    let said = String::from_utf8(split("K;touch PWNED2").stderr).unwrap();
    assert!(said.ends_with("render them with `pinhole job part 'K;touch PWNED2' 0-0`\n"), "{said}");
}

/// A stand-in for `sbatch` that logs its arguments and runs the script at once, once for each task of an array.
const SBATCH: &str = r#"#!/bin/bash
echo "$@" >>log
array=
for word; do case $word in --array=*) array=${word#--array=};; esac; done
if [ -n "$array" ]; then
    range=${array%\%*}
    for task in $(seq "${range%-*}" "${range#*-}"); do SLURM_ARRAY_TASK_ID=$task bash "${!#}"; done
else
    bash -c "${!#}"
fi
echo 17
"#;

/// A folder with a job, the scripts of the page, and `sbatch`.
fn with_scripts() -> Folder {
    let folder = folder();
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/how-to/clusters.md");
    let page = fs::read_to_string(page).unwrap().replace("\r\n", "\n");
    for name in ["part.sh", "submit.sh"] {
        let (_, script) = page.split_once(&format!("```bash\n# {name}: ")).unwrap();
        let (script, _) = script.split_once("```").unwrap();
        fs::write(folder.path(name), format!("#!/bin/bash\n# {script}")).unwrap();
    }
    fs::create_dir(folder.path("bin")).unwrap();
    fs::write(folder.path("bin/sbatch"), SBATCH).unwrap();
    fs::set_permissions(folder.path("bin/sbatch"), fs::Permissions::from_mode(0o755)).unwrap();
    folder.run("job split a.xyz --frames : --tiles 2x1 --backend cpu --size 40x30 -o JOB -q").succeeded();
    fs::rename(folder.path("JOB"), folder.path("job")).unwrap();
    std::os::unix::fs::symlink("job", folder.path("JOB")).unwrap();
    folder
}

/// Runs the script, and returns the lines of arguments that `sbatch` received.
fn submit(folder: &Folder) -> Vec<String> {
    let _ = fs::remove_file(folder.path("log"));
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_pinhole")).parent().unwrap();
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{}:{path}", folder.path("bin").display(), program.display());
    let mut script = std::process::Command::new("bash");
    let script = script.arg("submit.sh").current_dir(folder.path(".")).env("PATH", path);
    let output = script.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let log = String::from_utf8(folder.read("log")).unwrap();
    log.lines().map(str::to_owned).collect()
}

#[test]
fn an_array_and_a_merge_are_submitted_and_again_for_what_is_missing() {
    let folder = with_scripts();
    let lines = submit(&folder);
    assert!(lines[0].contains("--array=1-2%"), "{lines:?}");
    assert!(lines[1].contains("--dependency=afterok:17 --kill-on-invalid-dep=yes"), "{lines:?}");
    assert_eq!(missing(&folder), [0_usize; 0]);
    folder.run("render a.xyz --frames : --backend cpu --size 40x30 -o r.apng -q").succeeded();
    assert!(folder.read("movie.apng") == folder.read("r.apng"));
    // Only missing units are submitted again.
    fs::remove_file(part(&folder, 4)).unwrap();
    fs::write(part(&folder, 7), "x").unwrap();
    let lines = submit(&folder);
    assert!(lines[0].contains("--array=1-1%") && lines.len() == 2, "{lines:?}");
    assert_eq!(folder.read("job/units.txt"), b"4,7\n");
    assert_eq!(missing(&folder), [0_usize; 0]);
    // Only the merge remains.
    let lines = submit(&folder);
    assert!(lines.len() == 1 && !lines[0].contains("--dependency"), "{lines:?}");
}
