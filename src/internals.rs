//! What tests, benchmarks and the program need of the inside. It may change in any version.

pub use crate::accel::grid::Grid;
pub use crate::accel::slab::SMALLEST_COMPONENT;
pub use crate::accel::wide_tree::{WideNode, WideTree};
pub use crate::cpu::light::live::{LiveFrame, LiveReference};
pub use crate::geometry::cone::ConeInFrame;
pub use crate::geometry::cone_crossing::intersect as intersect_cone;
#[cfg(feature = "gpu")]
pub use crate::gpu::edit::{KernelRewrite, ShaderEdit};
pub use crate::recording::NO_HIT;
pub use crate::recording::cone_rays::{ConeAnswer, RayAndCone, rays_and_cones};
pub use crate::recording::lit::{
    PathState, PixelSums, RecordedFilm, RecordedSurface, StudioLight, UploadedLighting, UploadedSky,
};
pub use crate::verify::cone::{LegalConeHit, LegalConeHits};

/// Lists and tables of settings, read more strictly than serde does.
pub mod exact {
    pub use crate::exact::*;
}

/// Loops on all cores.
pub mod parallel {
    pub use crate::parallel::*;
}

/// Foreign text in messages.
pub mod text {
    pub use crate::text::*;
}
