//! A generated molecule.

use std::f64::consts::TAU;

use glam::DVec3;
use pinhole::{LinearRgb, Scene, Sphere};

use crate::Outcome;

/// Two strands with rungs between them, twisted about each other along a trefoil knot: 3,420 spheres, within about 3.6 of
/// the origin.
pub fn molecule() -> Outcome<Scene> {
    const RUNGS: u32 = 180;
    const TWISTS: f64 = 18.0;
    let knot =
        |t: f64| DVec3::new(t.sin() + 2.0 * (2.0 * t).sin(), t.cos() - 2.0 * (2.0 * t).cos(), -1.3 * (3.0 * t).sin());
    let strands = [[214, 84, 60], [58, 110, 185]].map(LinearRgb::from_srgb8);
    let bases = [[240, 196, 84], [122, 176, 106], [210, 205, 195], [150, 120, 180]].map(LinearRgb::from_srgb8);
    let mut spheres = Vec::new();
    for rung in 0..RUNGS {
        let t = TAU * f64::from(rung) / f64::from(RUNGS);
        let along = (knot(t + 1e-4) - knot(t - 1e-4)).normalize_or(DVec3::X);
        let side = along.cross(DVec3::Z).normalize_or(DVec3::X);
        let (sine, cosine) = (TWISTS * t).sin_cos();
        let across = cosine * side + sine * side.cross(along);
        for step in -5..=5_i32 {
            let color = bases[(rung as usize * 7 + usize::from(step > 0) * 2) % bases.len()];
            let center = knot(t) + 0.085 * f64::from(step) * across;
            spheres.push(Sphere::new(center.to_array(), 0.075, color));
        }
        for (end, color) in [-0.52, 0.52].into_iter().zip(strands) {
            for step in 0..4_u8 {
                // Strands follow the knot between two rungs, too.
                let t = t + TAU / f64::from(RUNGS) * f64::from(step) / 4.0;
                let (sine, cosine) = (TWISTS * t).sin_cos();
                let across = cosine * side + sine * side.cross(along);
                let center = knot(t) + end * across;
                spheres.push(Sphere::new(center.to_array(), 0.13, color));
            }
        }
    }
    Ok(Scene::new(&spheres)?)
}
