//! `pinhole job submit --slurm`: scripts for Slurm, which are submitted. Nothing is asked of its accounting.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use anyhow::{Context, anyhow};

use super::SubmitArgs;
use super::files;
use super::folder::Folder;
use super::merge::absolute_layer;
use super::units::ranges;
use crate::failure::Failure;
use crate::output::{name_all, unnamed};
use crate::shell::in_quotes;
use crate::speak::{answer, tell};

/// The folder of the scripts in the folder of a job.
const SCRIPTS: &str = "slurm";

/// The most tasks of an array: one less than what Slurm allows unless its `MaxArraySize` is set.
const MOST_TASKS: usize = 1000;

/// The scripts of one submission.
struct Scripts {
    /// One line of indices for each task of the array.
    lists: (PathBuf, String),
    array: (PathBuf, String),
    merge: Option<(PathBuf, String)>,
    tasks: usize,
}

pub(super) fn run(args: &SubmitArgs) -> Result<(), Failure> {
    let folder = Folder::open(&args.job)?;
    let found = folder.glance();
    let missing: Vec<usize> = (0..found.len()).filter(|unit| found[*unit].is_err()).collect();
    let program = std::env::current_exe().context("the place of this program is not known")?;
    let scripts = Scripts::new(args, &folder, &program, &missing)?;
    if args.print {
        return Ok(answer(scripts.text().as_bytes()).context("standard output: cannot be written")?);
    }
    if missing.is_empty() && scripts.merge.is_none() {
        tell(format_args!("{}: all parts are there; nothing is submitted", args.job.display()));
        return Ok(());
    }
    check_sbatch()?;
    scripts.write(&folder)?;
    let array = match missing.is_empty() {
        true => None,
        false => Some(sbatch(scripts.array_arguments(args), &scripts.array.0)?),
    };
    if let Some(id) = &array {
        tell(format_args!("array {id}: {} tasks for {} units", scripts.tasks, missing.len()));
    }
    if let Some((script, _)) = &scripts.merge {
        let mut arguments = Vec::new();
        if let Some(id) = &array {
            // If a task fails, the merge would wait for ever.
            arguments.push(format!("--dependency=afterok:{id}"));
            arguments.push("--kill-on-invalid-dep=yes".to_owned());
        }
        arguments.extend(args.partition.iter().map(|name| format!("--partition={name}")));
        let id = sbatch(arguments, script)?;
        tell(format_args!("merge {id}: after all tasks have succeeded"));
    }
    tell(format_args!(
        "say how far it is with `pinhole job status {0}`; if tasks fail, submit again: only what is missing is rendered",
        args.job.display()
    ));
    Ok(())
}

impl Scripts {
    fn new(
        args: &SubmitArgs,
        folder: &Folder,
        program: &Path,
        missing: &[usize],
    ) -> Result<Self, Failure> {
        let inside = folder.path().join(SCRIPTS);
        let number = (1..).find(|number| !inside.join(format!("array-{number}.sh")).exists());
        let number = number.unwrap_or(1);
        let each = match args.units_per_task {
            Some(each) => each as usize,
            None => missing.len().div_ceil(MOST_TASKS).max(1),
        };
        let tasks = missing.chunks(each);
        let count = tasks.len();
        let lists: String = tasks.map(|units| ranges(units) + "\n").collect();
        let list = inside.join(format!("units-{number}.txt"));
        let log = |name: &str| quoted(&inside.join(name));
        let (program, job) = (quoted(program)?, quoted(folder.path())?);
        let array = format!(
            "#!/bin/bash\n\
             #SBATCH --job-name=pinhole-part\n\
             #SBATCH --requeue\n\
             #SBATCH --output={}\n\
             # Each task renders the units of one line. Those that are there already take no time.\n\
             units=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" {})\n\
             for try in 1 2 3; do\n    \
                 {program} job part {job} \"$units\" && exit 0\n    \
                 status=$?\n    \
                 # Wrong usage stays wrong.\n    \
                 [ \"$status\" -ne 2 ] || break\n\
             done\n\
             exit \"$status\"\n",
            log("array-%A_%a.log")?,
            quoted(&list)?
        );
        let merge = match &args.output {
            None => None,
            Some(output) => {
                let output = std::path::absolute(output).context("-o: this path has no meaning")?;
                let layers =
                    args.layers.iter().map(|text| layer(text)).collect::<Result<String, _>>()?;
                let text = format!(
                    "#!/bin/bash\n\
                     #SBATCH --job-name=pinhole-merge\n\
                     #SBATCH --output={}\n\
                     {program} job merge {job} -o {}{layers} --wait 120\n",
                    log("merge-%j.log")?,
                    quoted(&output)?
                );
                Some((inside.join(format!("merge-{number}.sh")), text))
            }
        };
        let array = (inside.join(format!("array-{number}.sh")), array);
        Ok(Self { lists: (list, lists), array, merge, tasks: count })
    }

    /// All scripts, for people.
    fn text(&self) -> String {
        let files = [Some(&self.lists), Some(&self.array), self.merge.as_ref()];
        let text = files.into_iter().flatten();
        text.map(|(path, text)| format!("# {}\n{text}\n", path.display())).collect()
    }

    fn write(&self, folder: &Folder) -> Result<(), Failure> {
        let inside = folder.path().join(SCRIPTS);
        files::ensure_folder(&inside)
            .with_context(|| format!("{}: cannot be created", inside.display()))?;
        let all = [Some(&self.lists), Some(&self.array), self.merge.as_ref()];
        let files = all.into_iter().flatten();
        let files = files.map(|(path, text)| Ok((path, unnamed(path, text.as_bytes())?)));
        Ok(name_all(files.collect::<anyhow::Result<_>>()?)?)
    }

    fn array_arguments(&self, args: &SubmitArgs) -> Vec<String> {
        let limit = args.array_limit.map_or(String::new(), |limit| format!("%{limit}"));
        let mut arguments = vec![format!("--array=0-{}{limit}", self.tasks.saturating_sub(1))];
        arguments.extend(args.partition.iter().map(|name| format!("--partition={name}")));
        arguments.extend(args.sbatch.iter().cloned());
        arguments
    }
}

/// A path for a shell.
fn quoted(path: &Path) -> Result<String, Failure> {
    let text = path.to_str().with_context(|| format!("{}: this is not UTF-8", path.display()))?;
    Ok(in_quotes(text))
}

/// The flag for a layer, with an absolute path.
fn layer(text: &str) -> Result<String, Failure> {
    Ok(format!(" --layer {}", in_quotes(&absolute_layer(text)?)))
}

fn check_sbatch() -> Result<(), Failure> {
    match Command::new("sbatch").arg("--version").output() {
        Ok(Output { status, .. }) if status.success() => Ok(()),
        _ => Err(Failure::usage(
            "the program sbatch of Slurm is not on PATH; run this where Slurm is installed (Debian: the package \
             slurm-client), or add --print to get the scripts",
        )),
    }
}

/// Submits a script and returns the number of the job.
fn sbatch<S: AsRef<OsStr>>(arguments: Vec<S>, script: &Path) -> Result<String, Failure> {
    let mut command = Command::new("sbatch");
    command.arg("--parsable").args(arguments).arg(script);
    let Output { status, stdout, stderr } = command.output().context("sbatch cannot be started")?;
    let said = String::from_utf8_lossy(&stderr);
    // With several clusters, the name of one follows.
    let id = String::from_utf8_lossy(&stdout);
    let id = id.trim().split(';').next().unwrap_or_default().to_owned();
    if status.success() && !id.is_empty() {
        return Ok(id);
    }
    let why =
        said.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or("it says nothing");
    Err(Failure::Job(anyhow!("{}: sbatch refused it: {why}", script.display())))
}
