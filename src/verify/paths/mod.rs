//! The checker of light paths decides whether a conforming device may have followed them.
//!
//! The stages are: the camera ray of a sample, the nearest hit of a ray, the shading of the hit, the occlusion of a
//! light, and the sums of the samples. The shading kernel is evaluated for every combination of its open decisions: the
//! lobe, reflection or refraction, the texel, and whether the path ends.

mod bsdf;
mod forward;
pub(super) mod kernel;
mod light;
