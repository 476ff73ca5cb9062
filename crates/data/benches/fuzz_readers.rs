//! Reads damaged files of every format, and fails if one panics, takes long, or takes much memory.
//!
//! ```sh
//! cargo bench --bench fuzz_readers -- 1000000           # so many files in total
//! cargo bench --bench fuzz_readers -- 100000 ply vtk    # of these formats
//! cargo bench --bench fuzz_readers -- 100000 ply 7      # other files, from another seed
//! ```
//!
//! A file that fails is written into the current folder as `fuzz-FORMAT-NUMBER`.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic, reason = "a benchmark may panic, and prints")]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use fastrand::Rng;
use peak_alloc::PeakAlloc;
use pinhole_data::load::{FORMATS, Format};
use tempfile::TempDir;

#[allow(dead_code, reason = "the tests of the readers use all of it")]
#[path = "../tests/support/binary_files/mod.rs"]
mod binary_files;
#[path = "../tests/support/damage.rs"]
mod damage;
#[path = "../tests/support/seeds.rs"]
mod seeds;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Maximum memory for reading a file: bytes for each byte of the file, and additional bytes. Zlib expands a byte to at
/// most 1032. A digit of text becomes a number of eight bytes in a list that has doubled.
const BYTES_PER_BYTE: usize = 64;
const MORE_BYTES: usize = 1 << 22;

/// Maximum number of failing files of each format that are written.
const SHOWN: u64 = 3;

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let numbers: Vec<u64> = wanted.iter().filter_map(|word| word.parse().ok()).collect();
    let (count, first) = (numbers.first().copied().unwrap_or(20_000), numbers.get(1).copied().unwrap_or(0));
    let formats: Vec<_> = FORMATS
        .iter()
        .filter(|format| wanted.len() == numbers.len() || wanted.iter().any(|word| word == format.name))
        .collect();
    let each = count.div_ceil(formats.len().max(1) as u64);
    println!("{each} damaged files of each format, from seed {first}");
    let failed: u64 = formats.into_iter().map(|format| run(format, each, first)).sum();
    assert_eq!(failed, 0, "so many files failed");
}

/// Reads damaged files of one format, and returns the number of failures.
fn run(format: &'static Format, count: u64, first: u64) -> u64 {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("file");
    let seeds = seeds::of(format, folder.path());
    assert!(!seeds.is_empty(), "{}: give it a file in tests/files/good", format.name);
    let start = Instant::now();
    let mut failed = 0;
    let (mut slowest, mut most) = ((Duration::ZERO, 0), (0, 0));
    for number in 0..count {
        let mut random = Rng::with_seed((first << 40) + number);
        let seed = &seeds[number as usize % seeds.len()];
        let other = &seeds[random.usize(0..seeds.len())].bytes;
        let bytes = damage::damaged(&seed.bytes, other, &mut random);
        MEMORY.reset_peak_usage();
        let before = MEMORY.current_usage();
        let read =
            catch_unwind(AssertUnwindSafe(|| damage::read_all(format, &bytes, &seed.options, &file, &mut random)));
        let memory = MEMORY.peak_usage().saturating_sub(before);
        let is_much = memory > BYTES_PER_BYTE * bytes.len() + MORE_BYTES;
        let (taken, problem) = match read {
            Ok(Ok(taken)) if taken > damage::SLOW => (taken, Some(format!("it takes {taken:?}"))),
            Ok(Ok(taken)) if is_much => (taken, Some(format!("{} bytes take {memory} bytes of memory", bytes.len()))),
            Ok(Ok(taken)) => (taken, None),
            Ok(Err(what)) => (Duration::ZERO, Some(what)),
            Err(_) => (Duration::ZERO, Some("it panics".to_owned())),
        };
        if let Some(problem) = problem {
            failed += 1;
            if failed <= SHOWN {
                let path = format!("fuzz-{}-{number}", format.name);
                std::fs::write(&path, &bytes).unwrap();
                println!("{path}, of seed {first}: {problem}");
            }
        }
        slowest = slowest.max((taken, number));
        most = most.max((memory, number));
    }
    println!(
        "{:10} {count} files, of which {failed} failed, in {:.1?}; the slowest, {}, took {:.1?}; the most memory, {} KiB, took {}",
        format.name,
        start.elapsed(),
        slowest.1,
        slowest.0,
        most.0 >> 10,
        most.1
    );
    failed
}
