//! Spheres among the triangles of a host program: depth in both directions, and picking.
//!
//! Nothing here submits or waits, and nothing is allocated from picture to picture.

pub(crate) mod composite;
pub(crate) mod depth_test;
pub(crate) mod host_view;
mod lit_cursor;
pub(crate) mod lit_picture;
pub(crate) mod lit_renderer;
pub(crate) mod live_picture;
pub(crate) mod pick;
mod tickets;

/// All kernels for host programs.
pub(crate) fn kernels() -> Vec<crate::gpu::shader::Kernel> {
    use crate::gpu::shader::formats::ColorTarget;
    use composite::{Coverage, TargetEncoding};

    let mut kernels = vec![composite::cover_kernel(), depth_test::hide_kernel()];
    kernels.extend(ColorTarget::ALL.iter().map(|color| lit_renderer::resolve_kernel(*color)));
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
