//! Tests of spheres among the triangles of a host program.
#![allow(clippy::float_cmp, reason = "depths to which a host clears are exact")]

mod blended;
mod depth_in;
mod depth_out;
mod limit;
mod lit;
mod live;
mod overlay;
mod pick;
mod same_picture;
mod stage;
mod triangle;

use libtest_mimic::Trial;

pub(crate) fn trials() -> Vec<Trial> {
    [
        same_picture::trials(),
        depth_out::trials(),
        overlay::trials(),
        triangle::trials(),
        depth_in::trials(),
        limit::trials(),
        blended::trials(),
        pick::trials(),
        lit::trials(),
        live::trials(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
