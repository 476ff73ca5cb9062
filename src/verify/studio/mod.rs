//! The checker of studios decides whether a conforming device may have taken their samples.
//!
//! The stages are: the camera ray of a sample; the stages of each surface that a ray passes; and the sums of the
//! samples. The stages of a surface are the nearest hit, the parts of its look that need no search for light, which
//! lights are hidden and the light of the others, and the same for directions of ambient light. Rays towards lights are
//! not stored. The surface determines each of them up to the error of its direction (`studio/search.rs`).

mod forward;
pub(super) mod light;
pub(super) mod search;
pub(super) mod surface;
