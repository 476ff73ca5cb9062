//! What tests, benchmarks and the program need of the inside. It may change in any version.

pub use crate::accel::grid::{Grid, GridStatistics};
pub use crate::accel::grid_build::{BuiltGrid, GridBudget, build_grid};
pub use crate::accel::grid_check::GridError;
pub use crate::accel::query::{NO_HIT, Nearest, RayF32};
pub use crate::accel::slab::SMALLEST_COMPONENT;
pub use crate::accel::sphere::intersect_sphere;
pub use crate::accel::tree_check::{TreeError, TreeStatistics};
pub use crate::accel::wide_node::{WIDE_LEAF, WideNode};
pub use crate::accel::wide_tree::{WIDE_LEVELS, WideTree};
pub use crate::cpu::live::{LiveFrame, LiveReference};
#[cfg(feature = "gpu")]
pub use crate::gpu::edit::{KernelRewrite, ShaderEdit};
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
pub use crate::gpu::edited_composite;
pub use crate::verify::lit::{PathState, PixelSums, RecordedFilm, UploadedLighting, UploadedSky};
pub use crate::verify::paths::{RecordedSample, RecordedSurface};
pub use crate::verify::studio::{StudioLight, StudioSample, StudioSurface};

/// Walks of a list of spheres.
pub mod list {
    pub use crate::accel::list::*;
}

/// Foreign text in messages.
pub mod text {
    pub use crate::text::*;
}
