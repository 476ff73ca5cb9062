//! `pinhole job status --missing`: lists the units that are to be rendered.

use anyhow::Context;

use super::StatusArgs;
use super::folder::Folder;
use crate::failure::Failure;
use crate::speak::answer;
use crate::threads;

pub(super) fn run(args: &StatusArgs) -> Result<(), Failure> {
    let folder = Folder::open(&args.job)?;
    threads::start()?;
    let found = if args.check { folder.check() } else { folder.glance() };
    let missing = (0..found.len()).filter(|unit| found[*unit].is_err());
    let text: String = missing.map(|unit| format!("{unit}\n")).collect();
    Ok(answer(text.as_bytes()).context("standard output: cannot be written")?)
}
