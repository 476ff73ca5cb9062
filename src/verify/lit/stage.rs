//! The stages of a sample that are judged.

/// A stage of a sample, along a path or in a studio: a kernel, or a part of its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LitStage {
    /// The camera ray of a sample.
    Start,
    /// The nearest hit of a ray.
    Extend,
    /// The surface at the hit: its point, side and material.
    Vertex,
    /// The light that the path hits at its end or at an emissive surface.
    Radiance,
    /// The sampled light at a surface.
    Light,
    /// The scattered ray, and the throughput of the path.
    Scatter,
    /// Whether a surface occludes the sampled light.
    Occlude,
    /// The surface that a ray of a studio hits: its colour and lobe, and the light that needs no search.
    Surface,
    /// Whether a light is hidden from a surface of a studio.
    Shadow,
    /// The light that lights add to a surface of a studio.
    Illuminate,
    /// Whether something is near in a direction of ambient light.
    Ambient,
    /// The ambient light that directions add to a surface of a studio.
    Gather,
    /// The sums of the samples of a pixel.
    Accumulate,
}

impl LitStage {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Extend => "extend",
            Self::Vertex => "vertex",
            Self::Radiance => "radiance",
            Self::Light => "light",
            Self::Scatter => "scatter",
            Self::Occlude => "occlude",
            Self::Surface => "surface",
            Self::Shadow => "shadow",
            Self::Illuminate => "illuminate",
            Self::Ambient => "ambient",
            Self::Gather => "gather",
            Self::Accumulate => "accumulate",
        }
    }
}
