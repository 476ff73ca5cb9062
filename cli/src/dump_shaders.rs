//! `pinhole info --dump-shaders`: every kernel as a device is given it, for readers and for other compilers of WGSL.

use std::path::{Path, PathBuf};

use anyhow::Context;
use pinhole::gpu::composed_kernels;

use super::failure::Failure;
use super::output::{NewFolder, name_all, unnamed};
use super::speak::answer;

/// The list of pipelines: the file of the kernel, and the values of its `override` constants.
const PIPELINES: &str = "pipelines.txt";

/// Writes all kernels and the list of pipelines into a folder, or none.
pub(super) fn dump(folder: &Path) -> Result<(), Failure> {
    let mut kernels: Vec<(PathBuf, String)> = Vec::new();
    let mut pipelines = String::new();
    for kernel in composed_kernels() {
        let file = file_name(&kernel.name);
        for constants in &kernel.pipelines {
            let constants = constants.iter().map(|(name, value)| format!(" {name}={value}"));
            pipelines += &format!("{file}{}\n", constants.collect::<String>());
        }
        kernels.push((folder.join(file), kernel.source));
    }
    let text = format!(
        "{}: {} kernels, and {PIPELINES} with the constants of {} pipelines\n",
        folder.display(),
        kernels.len(),
        pipelines.lines().count(),
    );
    kernels.push((folder.join(PIPELINES), pipelines));
    let first = kernels.first().map(|(path, _)| path.clone()).unwrap_or_default();
    NewFolder::new(folder, &first.file_name().unwrap_or_default().to_string_lossy())?.with(
        || {
            let files =
                kernels.iter().map(|(path, source)| Ok((path, unnamed(path, source.as_bytes())?)));
            name_all(files.collect::<anyhow::Result<Vec<_>>>()?)
        },
    )?;
    Ok(answer(text.as_bytes()).context("standard output: cannot be written")?)
}

/// What distinguishes a kernel, as the name of a file.
fn file_name(kernel: &str) -> String {
    kernel.replace([' ', '#'], "-") + ".wgsl"
}
