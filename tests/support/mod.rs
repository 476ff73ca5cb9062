//! Shared by the CPU and the GPU tests.

#[allow(dead_code, reason = "each test program uses some of it")]
pub(crate) mod appearances;
pub(crate) mod compare;
#[allow(dead_code, reason = "each test program uses some of it")]
pub(crate) mod effort;
#[allow(dead_code, reason = "each test program uses some of it")]
pub(crate) mod hosts;
#[allow(dead_code, reason = "each test program uses some of them")]
pub(crate) mod maps;
#[allow(dead_code, reason = "each test program uses some of them")]
pub(crate) mod random_light;
#[allow(dead_code, reason = "each test program uses some of them")]
pub(crate) mod spheres;
mod view;

use pinhole::{Integrator, LinearRgb, RenderSettings, Shading};

pub(crate) use view::View;

/// Primary rays, shaded over a background.
#[allow(dead_code, reason = "each test program uses some of them")]
pub(crate) fn shaded(shading: Shading, background: LinearRgb) -> RenderSettings {
    let integrator = Integrator::Primary(shading);
    RenderSettings { integrator, background, ..RenderSettings::default() }
}
