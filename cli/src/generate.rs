//! `pinhole generate`: writes a file of generated spheres.

use std::path::Path;

use clap::builder::PossibleValuesParser;

use super::args::GenerateArgs;
use super::failure::Failure;
use super::memory;
use super::output::{self, SpheresFormat};
use super::progress;
use super::speak::tell;
use super::threads;
use pinhole::generate::{BYTES_PER_SPHERE, GenerateError, Kind, MAX_COUNT};

pub(super) fn run(args: &GenerateArgs) -> Result<(), Failure> {
    let Some(kind) = Kind::ALL.iter().copied().find(|kind| kind.name() == args.kind) else {
        return Err(Failure::usage(format!("{}: this is not a valid kind", args.kind)));
    };
    let count = args.count;
    if count > MAX_COUNT {
        return Err(Failure::usage(format!("-n {count}: {}", GenerateError::TooMany { count })));
    }
    let path: &Path = &args.output;
    let format = SpheresFormat::of(path)?;
    let bytes = count * BYTES_PER_SPHERE;
    memory::check_bytes(&format!("-n {count}: {count} spheres need"), bytes, "fewer spheres")
        .map_err(anyhow::Error::msg)?;
    tell(format_args!("{}: {count} spheres, {bytes} bytes", path.display()));
    threads::start()?;
    progress::stage("generating spheres");
    let spheres = kind.spheres(count, args.seed).map_err(|error| Failure::Job(error.into()))?;
    progress::stage("writing");
    Ok(output::write_spheres(path, format, &spheres)?)
}

/// Returns a parser that accepts the names of the kinds.
pub(super) fn kinds() -> PossibleValuesParser {
    PossibleValuesParser::new(Kind::ALL.iter().map(|kind| kind.name()))
}
