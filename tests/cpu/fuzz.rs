//! Damaged files of every format: no panic, no wait, and one line that says what is wrong.
//! `cargo bench --bench fuzz_readers` does the same with more of them, and measures memory.

use fastrand::Rng;
use pinhole::load::{self, FORMATS};
use tempfile::TempDir;

use crate::damage::{SLOW, damaged, read_all};
use crate::seeds;
use crate::support::effort::tries;

#[test]
fn every_format_has_good_files() {
    let folder = TempDir::new().unwrap();
    for format in FORMATS {
        let seeds = seeds::of(format, folder.path());
        assert!(!seeds.is_empty(), "{}: give it a row in tests/support/seeds/mod.rs", format.name);
        for (index, seed) in seeds.into_iter().enumerate() {
            let options = seed.options.with_format(format);
            let loaded = load::from_bytes(&seed.bytes, "", &options);
            let loaded = loaded.unwrap_or_else(|e| panic!("{} {index}: {e}", format.name));
            assert!(!loaded.spheres.is_empty(), "{} {index}", format.name);
        }
    }
}

#[test]
fn damaged_files_end_with_spheres_or_one_line() {
    let each = u64::from(tries(8_000));
    let folder = TempDir::new().unwrap();
    for format in FORMATS {
        let seeds = seeds::of(format, folder.path());
        for number in 0..each {
            let mut random = Rng::with_seed(number);
            let seed = &seeds[number as usize % seeds.len()];
            let other = &seeds[random.usize(0..seeds.len())].bytes;
            let bytes = damaged(&seed.bytes, other, &mut random);
            let file = folder.path().join("file");
            let taken = read_all(format, &bytes, &seed.options, &file, &mut random);
            let taken = taken.unwrap_or_else(|e| panic!("{}, input {number}: {e}", format.name));
            // A busy machine may be slow, but what hangs is slower. The long run in `benches` measures.
            assert!(taken < 60 * SLOW, "{}, input {number}: {taken:?}", format.name);
        }
    }
}
