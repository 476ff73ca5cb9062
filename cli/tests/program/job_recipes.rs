//! Tests of the scripts for Slurm in docs/scale.md, with a program in the place of `sbatch`. tests/cluster has the real one.

use std::fs;
use std::os::unix::fs::PermissionsExt;

use crate::job::{folder, missing, part};
use crate::support::Folder;

/// An `sbatch` that notes its arguments and runs the script at once, for an array every task of it.
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
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/scale.md");
    let page = fs::read_to_string(page).unwrap().replace("\r\n", "\n");
    for name in ["part.sh", "submit.sh"] {
        let (_, script) = page.split_once(&format!("```bash\n# {name}: ")).unwrap();
        let (script, _) = script.split_once("```").unwrap();
        fs::write(folder.path(name), format!("#!/bin/bash\n# {script}")).unwrap();
    }
    fs::create_dir(folder.path("bin")).unwrap();
    fs::write(folder.path("bin/sbatch"), SBATCH).unwrap();
    fs::set_permissions(folder.path("bin/sbatch"), fs::Permissions::from_mode(0o755)).unwrap();
    folder
        .run("job split a.xyz --frames : --tiles 2x1 --backend cpu --size 40x30 -o JOB -q")
        .succeeded();
    fs::rename(folder.path("JOB"), folder.path("job")).unwrap();
    std::os::unix::fs::symlink("job", folder.path("JOB")).unwrap();
    folder
}

/// Runs the script, and returns the lines of arguments that `sbatch` had.
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
    // Only what is missing is submitted again.
    fs::remove_file(part(&folder, 4)).unwrap();
    fs::write(part(&folder, 7), "x").unwrap();
    let lines = submit(&folder);
    assert!(lines[0].contains("--array=1-1%") && lines.len() == 2, "{lines:?}");
    assert_eq!(folder.read("job/units.txt"), b"4,7\n");
    assert_eq!(missing(&folder), [0_usize; 0]);
    // Only the merge is left.
    let lines = submit(&folder);
    assert!(lines.len() == 1 && !lines[0].contains("--dependency"), "{lines:?}");
}
