//! `pinhole generate`: writes a file of generated spheres.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::failure::Failure;
use super::memory;
use super::output::{self, SpheresFormat};
use super::progress;
use super::speak::tell;
use super::threads;
use pinhole::generate::{BYTES_PER_SPHERE, GenerateError, Kind, MAX_COUNT};

#[derive(Debug, Args)]
pub(super) struct GenerateArgs {
    /// Arrangement of the spheres
    #[arg(value_name = "KIND", value_parser = kinds())]
    pub(super) kind: String,
    /// Number of spheres
    #[arg(short = 'n', value_name = "N")]
    pub(super) count: u64,
    /// File for the spheres: a NumPy array (.npy) or raw little-endian f32 (.bin) of x, y, z, radius
    #[arg(short, long, value_name = "OUT.npy")]
    pub(super) output: PathBuf,
    /// Seed of the random numbers: the same kind, number and seed give the same file on every machine
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(super) seed: u64,
}

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
fn kinds() -> PossibleValuesParser {
    PossibleValuesParser::new(Kind::ALL.iter().map(|kind| kind.name()))
}
