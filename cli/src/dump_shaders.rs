//! `pinhole info --dump-shaders`: every kernel as a device is given it, for readers and for other compilers of WGSL.

use std::path::{Path, PathBuf};

use anyhow::Context;
use pinhole::gpu::composed_kernels;

use super::failure::Failure;
use super::output::{NewFolder, name_all, unnamed};
use super::speak::answer;

/// Writes all kernels into a folder, or none.
pub(super) fn dump(folder: &Path) -> Result<(), Failure> {
    let kernels: Vec<(PathBuf, String)> = composed_kernels()
        .map(|kernel| (folder.join(file_name(&kernel.name)), kernel.source))
        .collect();
    let first = kernels.first().map(|(path, _)| path.clone()).unwrap_or_default();
    NewFolder::new(folder, &first.file_name().unwrap_or_default().to_string_lossy())?.with(
        || {
            let files =
                kernels.iter().map(|(path, source)| Ok((path, unnamed(path, source.as_bytes())?)));
            name_all(files.collect::<anyhow::Result<Vec<_>>>()?)
        },
    )?;
    let text = format!("{}: {} kernels\n", folder.display(), kernels.len());
    Ok(answer(text.as_bytes()).context("standard output: cannot be written")?)
}

/// What distinguishes a kernel, as the name of a file.
fn file_name(kernel: &str) -> String {
    kernel.replace([' ', '#'], "-") + ".wgsl"
}
