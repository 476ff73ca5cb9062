//! Spheres among the triangles of a host program: depth in both directions, and picking.
//!
//! Nothing here submits or waits, and nothing is allocated from picture to picture.

pub(in crate::gpu) mod composite;
pub(in crate::gpu) mod composite_options;
pub(in crate::gpu) mod depth_test;
pub(in crate::gpu) mod host_view;
pub(in crate::gpu) mod lit;
pub(in crate::gpu) mod live;
pub(in crate::gpu) mod pick;
pub(in crate::gpu) mod target_textures;

/// The kernels of everything here.
pub(in crate::gpu) fn kernels() -> Vec<crate::gpu::shader::Kernel> {
    use crate::gpu::shader::formats::ColorTarget;
    use composite_options::{Coverage, TargetEncoding};

    let mut kernels = vec![composite::cover_kernel(), depth_test::hide_kernel()];
    kernels.extend(ColorTarget::ALL.iter().map(|color| lit::resolve::resolve_kernel(*color)));
    kernels.extend(depth_test::LIMITED.map(depth_test::limit_kernel));
    for source in [ColorTarget::Srgb8, ColorTarget::Linear16] {
        for encoding in [TargetEncoding::Linear, TargetEncoding::Srgb] {
            for coverage in [None, Some(Coverage::Hits), Some(Coverage::Alpha)] {
                kernels.push(composite::composite_kernel(source, encoding, coverage));
            }
        }
    }
    kernels
}
