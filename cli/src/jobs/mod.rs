//! Pictures that many machines render: `split` divides them into units, `part` renders units, `status` lists those that
//! are missing, and `merge` joins the parts. Schedulers hand units to machines: `docs/how-to/clusters.md` has recipes.
//!
//! The machines share only a folder. `job.json` is written once. Every part is a file that appears whole or not at all,
//! and names its job by the digest of `job.json`. No other coordination is needed.

use self::folder::Folder;
pub(super) use crate::jobs::args::JobArgs;
use crate::jobs::args::{JobCommand, StatusArgs};
use crate::terminal::failure::Failure;
use crate::terminal::progress::answer;
use crate::terminal::threads;

mod args;
mod files;
mod folder;
mod manifest;
mod merge;
mod part;
mod part_file;
mod split;

pub(super) fn run(args: &JobArgs) -> Result<(), Failure> {
    match &args.command {
        JobCommand::Split(args) => split::run(args),
        JobCommand::Part(args) => part::run(args),
        JobCommand::Status(args) => status(args),
        JobCommand::Merge(args) => merge::run(args),
    }
}

fn status(args: &StatusArgs) -> Result<(), Failure> {
    let folder = Folder::open(&args.job)?;
    threads::start()?;
    let found = if args.check { folder.check() } else { folder.glance() };
    let missing = (0..found.len()).filter(|unit| found[*unit].is_err());
    let text: String = missing.map(|unit| format!("{unit}\n")).collect();
    Ok(answer(text.as_bytes())?)
}
