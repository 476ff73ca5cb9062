//! What drivers are known to compute wrongly, and what is done about it. `docs/drivers.md` has the evidence.

use wgpu::AdapterInfo;

use crate::accel::{AccelChoice, AccelPlan, Structure};
use crate::scene::Scene;

/// Plans with what suits the data, unless the driver is known to get that wrong.
///
/// `SwiftShader`, of Chromium 156: where invocations that run together leave a loop by `break` at different times,
/// those that left first lose what they found in it. Grids are walked in such loops; trees are not.
pub(super) fn plan(
    info: &AdapterInfo,
    scene: &Scene,
    choice: AccelChoice,
    plan: impl Fn(AccelChoice) -> AccelPlan,
) -> AccelPlan {
    let planned = plan(choice);
    let is_grid = matches!(planned.structure, Structure::Grid(_) | Structure::NestedGrid(_));
    if choice == AccelChoice::Auto && is_grid && info.name.starts_with("SwiftShader") {
        let mut tree = plan(AccelChoice::Tree);
        tree.reason = format!("{} spheres, and this driver computes grids wrongly", scene.len());
        return tree;
    }
    planned
}
