//! Tests of spheres among the triangles of a host program.
#![allow(clippy::float_cmp, reason = "depths to which a host clears are exact")]

mod blended;
mod depth;
mod limit;
mod lit;
mod live;
mod overlay;
mod same_picture;
mod stage;
mod triangle;

use libtest_mimic::Trial;

pub(crate) fn trials() -> Vec<Trial> {
    [
        same_picture::trials(),
        depth::trials(),
        overlay::trials(),
        triangle::trials(),
        limit::trials(),
        blended::trials(),
        lit::trials(),
        live::trials(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
