//! Devices into whose shaders a fault is planted.

use std::path::Path;

use libtest_mimic::Failed;
use pinhole::gpu::{Headless, HeadlessOptions};
use pinhole::internals::ShaderEdit;

/// Opens a device one part of whose shaders is edited. `file` may name a variant: `file.wgsl#variant`.
pub(crate) fn faulty(file: &str, find: &str, replace: &str) -> Result<Headless, Failed> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("shaders")
        .join(file.split('#').next().unwrap_or(file));
    if !std::fs::read_to_string(path)?.contains(find) {
        return Err(format!("{file} has no `{find}`").into());
    }
    let edit = ShaderEdit { file: file.into(), find: find.into(), replace: replace.into() };
    Ok(Headless::open(&HeadlessOptions { edits: vec![edit], ..HeadlessOptions::default() })?)
}
