//! Workarounds for drivers that are known to compute wrong results. `docs/drivers.md` contains the evidence.

use wgpu::AdapterInfo;

use crate::accel::{AccelChoice, AccelPlan, Structure};
use crate::scene::Scene;

/// Plans the structure that suits the data, or another one if the driver is known to compute wrong results with it.
///
/// `SwiftShader` of Chromium 156 has this defect: where invocations that run together leave a loop by `break` at
/// different times, those that left first lose the values that they assigned in the loop. Grids are traversed in such
/// loops; trees are not.
pub(super) fn plan(
    info: &AdapterInfo,
    scene: &Scene,
    choice: AccelChoice,
    plan: impl Fn(AccelChoice) -> AccelPlan,
) -> AccelPlan {
    let planned = plan(choice);
    let is_grid = matches!(planned.structure, Structure::Grid | Structure::NestedGrid);
    if choice == AccelChoice::Auto && is_grid && info.name.starts_with("SwiftShader") {
        let mut tree = plan(AccelChoice::Tree);
        tree.reason = format!("{} spheres, and this driver computes grids wrongly", scene.len());
        return tree;
    }
    planned
}
