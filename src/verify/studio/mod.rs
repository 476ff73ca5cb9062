//! The checker of studios decides whether a conforming device may have taken their samples.
//!
//! The stages are: the camera ray of a sample; for each surface that a ray passes the nearest hit, what is seen of the
//! surface without searching for light, whether lights are hidden and the light of those that are not, the same for
//! directions of ambient light; and the sums of the samples. Rays towards lights are not stored; each is known from
//! where the surface is up to the error of its direction (`studio/search.rs`).

pub(super) mod light;
pub(super) mod search;
pub(super) mod surface;
