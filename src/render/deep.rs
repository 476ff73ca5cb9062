//! Whether so many translucent surfaces lie behind each other that a picture leaves out some.

use std::f64::consts::PI;

use crate::scene::Scene;

/// Whether it is likely that some ray meets more than `most` translucent surfaces, and that what lies behind them could
/// be seen. That is an estimate from the sizes of the spheres and of the whole scene, because to know it, one has to
/// trace the picture.
pub(super) fn may_exceed(scene: &Scene, most: u32) -> bool {
    let bounds = scene.bounds_to_frame();
    let [x, y, z] = (bounds.max() - bounds.min()).to_array();
    // The mean of a box's shadows over all directions, and what of it is the shadow of an ellipsoid in the box.
    let shadow = 0.5 * (x * y + y * z + z * x) * PI / 6.0;
    let (mut area, mut clearness) = (0.0, 0.0);
    for (id, [.., radius]) in (0_u32..).zip(scene.spheres()) {
        let opacity = f64::from(scene.surface(id).opacity);
        if opacity < 1.0 {
            let own = PI * f64::from(*radius).powi(2);
            area += own;
            clearness += own * (1.0 - opacity).ln();
        }
    }
    // A ray enters each sphere and leaves it, and in the middle of a ball it meets 1.5 times as many as on average.
    let met = 1.5 * 2.0 * area / shadow;
    let left = (clearness / area * f64::from(most)).exp();
    met > f64::from(most) && left > 1.0 / 256.0
}
