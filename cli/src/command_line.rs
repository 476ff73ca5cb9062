//! The whole command line, with all commands.

use clap::{Parser, Subcommand};

#[cfg(feature = "gpu")]
use crate::bench::args::BenchArgs;
use crate::bricks::SortArgs;
use crate::commands::generate::{DemoArgs, GenerateArgs};
use crate::commands::info::InfoArgs;
#[cfg(feature = "gpu")]
use crate::commands::plan::PlanArgs;
use crate::commands::view::ViewArguments;
use crate::flags::render::RenderArgs;
use crate::jobs::JobArgs;
use crate::proof::certify::CertifyArgs;
use crate::proof::verify::args::VerifyArgs;

/// Ray traces spheres with compute shaders, without a display, and checks its pictures.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, disable_help_subcommand = true)]
#[command(after_help = "Exit codes: 0 done; 1 the job failed or does not fit; 2 wrong usage; 3 a check failed; \
    4 a check could not decide; 5 the device was lost or did not answer; 130 stopped by a signal.")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a picture of a scene file or a data file
    Render(Box<RenderArgs>),
    /// Show a file in a window, from all sides, and give the command that renders what is seen
    View(Box<ViewArguments>),
    /// Render on an adapter, and check for every pixel whether a conforming device may have made it
    Verify(Box<VerifyArgs>),
    /// Check the ids, depths and normals that any renderer made of a scene
    Certify(Box<CertifyArgs>),
    /// Show how much memory a render would need on the device and the machine, and whether it fits
    #[cfg(feature = "gpu")]
    Plan(Box<PlanArgs>),
    /// Measure how fast an adapter traces rays with different acceleration structures
    #[cfg(feature = "gpu")]
    Bench(BenchArgs),
    /// Render on many machines: divide pictures into parts, render each, see what is done, and join them
    Job(JobArgs),
    /// Sort the spheres of a data file into compact bricks, for data that does not fit into memory
    Sort(SortArgs),
    /// Write an example scene file into the current folder and render it
    Demo(DemoArgs),
    /// Write a file of generated spheres, for tests and measurements
    Generate(GenerateArgs),
    /// Say what a data file or a scene file holds; or list the adapters of this machine with drivers, limits and features
    Info(InfoArgs),
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    /// Arguments that a recording contains must be excluded beside it. The test finds forgotten flags.
    #[test]
    fn recordings_exclude_all_arguments_that_they_contain() {
        let arguments = Arguments::command();
        let command = arguments.find_subcommand("verify").unwrap();
        let replay = command.get_arguments().find(|one| one.get_id() == "replay").unwrap();
        let excluded = command.get_arg_conflicts_with(replay);
        for one in command.get_arguments() {
            let is_excluded = excluded.iter().any(|other| other.get_id() == one.get_id());
            let is_other = ["json", "report", "replay", "help"].contains(&one.get_id().as_str());
            assert!(is_excluded != is_other, "{}", one.get_id());
        }
    }
}
