//! The list of all kernels, and tests of all of them.

use std::collections::{BTreeMap, BTreeSet};

use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::CameraKind;
use crate::gpu::shader::formats::ColorTarget;
use crate::gpu::shader::{BrickPass, Kernel, probe_kernel, shade_kernel, trace_kernel};

#[cfg(test)]
mod constant_tests;
#[cfg(test)]
mod declarations;
#[cfg(test)]
mod page_tests;
#[cfg(test)]
mod tests;

/// A composed kernel, as it is passed to a device.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ComposedKernel {
    /// Name of the kernel, which is unique: its entry point and the parts that distinguish it from other kernels with
    /// the same entry point, separated by spaces.
    pub name: String,
    /// WGSL of all parts. A comment before each part names its file in the folder `shaders`.
    pub source: String,
    /// The values of the `override` constants by name, for each pipeline made from this source.
    /// Values of the type `bool` are 0 or 1.
    pub pipelines: BTreeSet<Vec<(&'static str, u32)>>,
}

/// Returns all kernels of this crate that need nothing but WGSL, ordered by name, for readers and for other compilers.
/// Kernels with ray queries, which are an extension of wgpu, are left out.
pub fn composed_kernels() -> impl Iterator<Item = ComposedKernel> {
    let core = all_kernels().into_iter().filter(|kernel| !kernel.has_ray_queries());
    let mut composed = BTreeMap::new();
    for kernel in core {
        let (name, source) = (kernel.name(), kernel.source());
        let new = ComposedKernel { name: name.clone(), source, pipelines: BTreeSet::new() };
        composed.entry(name).or_insert(new).pipelines.insert(kernel.constants);
    }
    composed.into_values()
}

/// All kernels that can be composed, with one set of constants for each source.
#[cfg(test)]
pub(crate) fn all_sources() -> Vec<Kernel> {
    let mut names = BTreeSet::new();
    all_kernels().into_iter().filter(|kernel| names.insert(kernel.name())).collect()
}

/// All kernels of which pipelines are made. Many have the same source and differ in constants.
pub(crate) fn all_kernels() -> Vec<Kernel> {
    let mut kernels = ["arithmetic", "exact", "cones", "loops"].map(|probe| Kernel::new(probe, &[])).to_vec();
    for &camera in CameraKind::ALL {
        for kind in BrickKind::of(Structure::WITH_KERNELS, Primitive::ALL) {
            for brick_pass in [BrickPass::First, BrickPass::Later] {
                for keeps_rays in [false, true] {
                    kernels.push(trace_kernel(camera, kind, brick_pass, keeps_rays));
                }
            }
        }
        for kind in BrickKind::of(&[Structure::Tiles], Primitive::ALL) {
            for brick_pass in [BrickPass::First, BrickPass::Later] {
                kernels.push(trace_kernel(camera, kind, brick_pass, false));
            }
        }
        for &primitive in Primitive::ALL {
            for &color in ColorTarget::ALL {
                for (data_layers, keeps_rays) in [(false, false), (true, false), (true, true)] {
                    kernels.push(shade_kernel(camera, primitive, color, data_layers, keeps_rays));
                }
            }
        }
    }
    kernels.push(probe_kernel());
    kernels.extend(crate::gpu::passes::lit::all_kernels());
    kernels.push(crate::gpu::headless::denoise::denoise_kernel());
    kernels.push(crate::gpu::scene::recolor::recolor_kernel());
    kernels.extend(crate::gpu::host::kernels());
    kernels
}
