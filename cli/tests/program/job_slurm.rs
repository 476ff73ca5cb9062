//! Tests of what is handed to Slurm, with programs in the place of Slurm's. tests/cluster has the real one.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Output;

use crate::job::{folder, part, status};
use crate::support::Folder;

/// An `sbatch` that notes its arguments and runs the script at once, for an array every task of it.
const SBATCH: &str = r#"#!/bin/sh
[ "$1" = --version ] && exit 0
echo "$@" >> "$PINHOLE_TEST_LOG"
for word; do case $word in --array=*) array=${word#--array=};; esac; script=$word; done
if [ -n "$array" ]; then
    range=${array%\%*}
    for task in $(seq ${range%-*} ${range#*-}); do SLURM_ARRAY_TASK_ID=$task bash "$script"; done
else
    bash "$script"
fi
echo "17;cluster"
"#;

fn with_sbatch(text: &str) -> Folder {
    let folder = folder();
    fs::create_dir(folder.path("bin")).unwrap();
    fs::write(folder.path("bin/sbatch"), text).unwrap();
    fs::set_permissions(folder.path("bin/sbatch"), fs::Permissions::from_mode(0o755)).unwrap();
    folder
        .run("job split a.xyz --frames : --tiles 2x1 --backend cpu --size 40x30 -o job -q")
        .succeeded();
    folder
}

fn submit(folder: &Folder, arguments: &str) -> Output {
    let path = format!("{}:{}", folder.path("bin").display(), std::env::var("PATH").unwrap());
    let mut command = folder.command(&format!("job submit job --slurm {arguments}"));
    command.env("PATH", path).env("PINHOLE_TEST_LOG", folder.path("log")).output().unwrap()
}

#[test]
fn an_array_and_a_merge_are_submitted() {
    let folder = with_sbatch(SBATCH);
    let flags =
        "-o m%d.png --array-limit 3 --units-per-task 3 --partition main -- --mem=1G --time=5";
    let output = submit(&folder, flags);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("array 17: 4 tasks for 10 units\n"), "{said}");
    let log = String::from_utf8(folder.read("log")).unwrap();
    let lines: Vec<&str> = log.lines().collect();
    let array = "--parsable --array=0-3%3 --partition=main --mem=1G --time=5 ";
    assert!(lines[0].starts_with(array), "{log}");
    let merge = "--parsable --dependency=afterok:17 --kill-on-invalid-dep=yes --partition=main ";
    assert!(lines[1].starts_with(merge), "{log}");
    assert_eq!(status(&folder)["complete"], true);
    folder.run("render a.xyz --frames : --backend cpu --size 40x30 -o r%d.png -q").succeeded();
    for frame in 0..5 {
        assert!(folder.read(&format!("m{frame}.png")) == folder.read(&format!("r{frame}.png")));
    }
}

#[test]
fn only_what_is_missing_is_submitted_again() {
    let folder = with_sbatch(SBATCH);
    folder.run("job part job 0-9 -q").succeeded();
    fs::remove_file(part(&folder, 4)).unwrap();
    fs::write(part(&folder, 7), "x").unwrap();
    assert!(submit(&folder, "").status.success());
    assert_eq!(folder.read("job/slurm/units-1.txt"), b"4\n7\n");
    assert_eq!(status(&folder)["complete"], true);
    let output = submit(&folder, "");
    assert_eq!(
        String::from_utf8(output.stderr).unwrap(),
        "job: all parts are there; nothing is submitted\n"
    );
    // Only the merge is left.
    assert!(submit(&folder, "-o m%d.png").status.success());
    let log = String::from_utf8(folder.read("log")).unwrap();
    assert!(log.lines().last().unwrap().starts_with("--parsable /"), "{log}");
    assert!(folder.path("m4.png").is_file());
}

#[test]
fn a_scheduler_that_is_not_there_or_refuses_is_one_line() {
    let folder = with_sbatch(
        "#!/bin/sh\n[ \"$1\" = --version ] && exit 0\necho 'sbatch: error: no' >&2\nexit 1\n",
    );
    let output = submit(&folder, "");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.ends_with("array-1.sh: sbatch refused it: sbatch: error: no\n"), "{said}");
    fs::remove_file(folder.path("bin/sbatch")).unwrap();
    let mut command = folder.command("job submit job --slurm -o m%d.png");
    let output = command.env("PATH", folder.path("bin")).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("the package slurm-client") && said.contains("--print"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    let output = submit(&folder, "-o m%d.png --print");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("job part ") && text.contains("job merge ") && text.contains("--requeue"),
        "{text}"
    );
    let output = folder.command("job submit job").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}
