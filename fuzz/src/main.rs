//! Hands the bytes of LLVM's fuzzer to the target that `PINHOLE_FUZZ` names, and writes its good files into the folder
//! `PINHOLE_CORPUS` before.
#![no_main]
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test")]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use pinhole_fuzz::{Target, names};

static TARGET: LazyLock<Target> = LazyLock::new(|| {
    let name = std::env::var("PINHOLE_FUZZ").unwrap_or_default();
    Target::of_name(&name).unwrap_or_else(|| {
        names().for_each(|name| println!("{name}"));
        std::process::exit(0)
    })
});

fuzz_target!(
    init: {
        LazyLock::force(&TARGET);
        if let Some(corpus) = std::env::var_os("PINHOLE_CORPUS") {
            std::fs::create_dir_all(&corpus).unwrap();
            for (number, seed) in TARGET.seeds.iter().enumerate() {
                std::fs::write(std::path::Path::new(&corpus).join(format!("good-{number}")), seed).unwrap();
            }
        }
    },
    |bytes: &[u8]| TARGET.read(bytes).unwrap()
);
