//! Reads good files of every kind, cut off at every length and damaged at random. Each kind is read in a process of its
//! own, so that nothing that one reader does hides the others.
//!
//! ```sh
//! cargo test -p pinhole-fuzz -- ply vtk                      # these kinds
//! PINHOLE_EFFORT=1 PINHOLE_SEED=7 cargo test -p pinhole-fuzz    # other files, and eight times as many
//! ```
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr, reason = "a test may panic, and prints")]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use fastrand::Rng;
use peak_alloc::PeakAlloc;
use pinhole_data::load::{FORMATS, is_compressed};
use pinhole_fuzz::{Target, damage, names};

#[path = "../../tests/support/effort.rs"]
#[expect(dead_code, reason = "other tests use the rest")]
mod effort;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Names the kind for the process that reads it.
const KIND: &str = "PINHOLE_FUZZ";

/// Maximum memory for reading a file of spheres: bytes for each byte of the file, and additional bytes. Zlib expands a
/// byte to at most 1032. A digit of text becomes a number of eight bytes in a list that has doubled.
const BYTES_PER_BYTE: usize = 64;
const MORE_BYTES: usize = 1 << 22;

/// Maximum memory for any other file, and for a compressed one: bzip2 needs 4 MiB for a few bytes, xz what it is told.
const MOST_BYTES: usize = 512 << 20;

const SLOW: Duration = Duration::from_secs(60); // on a busy machine

fn main() {
    if let Ok(kind) = std::env::var(KIND) {
        return read(&kind);
    }
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let is_wanted = |name: &&str| words.is_empty() || words.iter().any(|word| name.contains(&**word));
    let wanted: Vec<&str> = names().filter(is_wanted).collect();
    let (next, failed) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let work = || {
        while let Some(name) = wanted.get(next.fetch_add(1, Ordering::Relaxed)) {
            let mut command = Command::new(std::env::current_exe().unwrap());
            // What the program answers is not looked at.
            let output = command.env(KIND, name).stdout(Stdio::null()).output().unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            let lines: Vec<&str> = said.lines().collect();
            let (last, mark) = (lines.len().saturating_sub(1), if output.status.success() { "ok" } else { "FAILED" });
            let first = if output.status.success() { last } else { last.saturating_sub(20) };
            eprintln!("test damaged::{name} ... {mark}; {}", lines[first..].join("\n"));
            failed.fetch_add(usize::from(!output.status.success()), Ordering::Relaxed);
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    assert_eq!(failed.into_inner(), 0, "so many kinds failed");
}

/// Reads damaged files of one kind.
fn read(kind: &str) {
    let is_format = FORMATS.iter().any(|format| format.name == kind);
    let target = Target::of_name(kind).unwrap();
    assert!(!target.seeds.is_empty(), "give it a file in crates/data/tests/files/good");
    let (start, mut slowest, mut most) = (Instant::now(), (Duration::ZERO, 0), (0, 0));
    let mut check = |number: u64, bytes: &[u8]| {
        MEMORY.reset_peak_usage();
        let (before, began) = (MEMORY.current_usage(), Instant::now());
        let read = catch_unwind(AssertUnwindSafe(|| target.read(bytes)));
        let (memory, taken) = (MEMORY.peak_usage().saturating_sub(before), began.elapsed());
        let is_strict = is_format && !is_compressed(bytes);
        let limit = if is_strict { BYTES_PER_BYTE * bytes.len() + MORE_BYTES } else { MOST_BYTES };
        let problem = match read {
            Err(_) => "it panics".to_owned(),
            Ok(Err(fault)) => fault,
            Ok(Ok(())) if taken > SLOW => format!("it takes {taken:?}"),
            Ok(Ok(())) if memory > limit => format!("{} bytes take {memory} bytes of memory", bytes.len()),
            Ok(Ok(())) => {
                (slowest, most) = (slowest.max((taken, number)), most.max((memory, number)));
                return;
            }
        };
        let path = std::env::temp_dir().join(format!("pinhole-{kind}-{number}"));
        std::fs::write(&path, bytes).unwrap();
        panic!("{}: {problem}", path.display());
    };
    let first = std::env::var("PINHOLE_SEED").map_or(0, |seed| seed.parse::<u64>().unwrap()) << 32;
    let count = effort::tries(target.tries);
    for seed in &target.seeds {
        // All lengths of small files.
        let step = 1 + seed.len() * 100 / target.tries as usize;
        (0..=seed.len()).step_by(step).for_each(|end| check(end as u64, &seed[..end]));
    }
    for number in first..first + u64::from(count) {
        let mut random = Rng::with_seed(number);
        let seed = &target.seeds[number as usize % target.seeds.len()];
        let other = &target.seeds[random.usize(0..target.seeds.len())];
        check(number, &damage::damaged(seed, other, &mut random));
    }
    eprintln!(
        "{count} files in {:.1?}; the slowest, {}, took {:.1?}; the most memory, {} KiB, took {}",
        start.elapsed(),
        slowest.1,
        slowest.0,
        most.0 >> 10,
        most.1
    );
}
