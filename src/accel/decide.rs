//! The choice of a structure.

use super::brick::Structure;
use super::expected::Expected;
use super::expected_cost::GridShape;
use super::grid::ListLayout;
use super::grid_build::{RADII, first_level_size};
use super::plan::{AccelChoice, AccelPlan};
use super::prices::{Candidate, Prices, cheapest};
use super::statistics::SceneStatistics;

/// The number of spheres up to which no structure is worth its cost.
const FEW: usize = 32;

/// The number of spheres, in a cube of about the smallest cell of a nested grid, above which a tree is better.
const MAX_IN_A_CUBE: f32 = 256.0;

/// The structures that compete for a scene that does not demand one of them.
const COMPETING: [Structure; 3] = [
    Structure::Grid(ListLayout::Referenced),
    Structure::Grid(ListLayout::Balls),
    Structure::WideTree,
];

/// The structure for a choice, and why.
pub(super) fn decide(
    statistics: &SceneStatistics,
    choice: AccelChoice,
    candidates: &[Candidate],
    rays: u64,
) -> (Structure, String) {
    let count = statistics.count;
    let grids: Vec<Candidate> =
        candidates.iter().filter(|one| one.structure != Structure::WideTree).copied().collect();
    let best_of = |candidates: &[Candidate], why: &str| {
        cheapest(candidates, rays).map(|(structure, costs)| (structure, format!("{why}; {costs}")))
    };
    // There is always a candidate of these choices if there are spheres.
    let fallback = (Structure::WideTree, "asked for".to_owned());
    match choice {
        _ if count == 0 => (Structure::List, "there are no spheres".to_owned()),
        AccelChoice::List => (Structure::List, "asked for".to_owned()),
        AccelChoice::Tree => fallback,
        AccelChoice::BinaryTree => (Structure::BinaryTree, "asked for".to_owned()),
        AccelChoice::RayQuery => (Structure::RayQuery, "asked for".to_owned()),
        AccelChoice::Auto if count <= FEW => {
            (Structure::List, format!("for up to {FEW} spheres, no structure is worth its cost"))
        }
        AccelChoice::Auto if statistics.densest > MAX_IN_A_CUBE => (
            Structure::WideTree,
            format!(
                "about {:.0} spheres lie in a cube of 1/4096 of the scene's side, too close together for two levels of cells",
                statistics.densest
            ),
        ),
        AccelChoice::Auto => best_of(candidates, &format!("{count} spheres")).unwrap_or(fallback),
        AccelChoice::Grid => best_of(&grids, "asked for").unwrap_or(fallback),
    }
}

/// What the structures that compete would cost.
pub(super) fn candidates(
    spheres: &[[f32; 4]],
    statistics: &SceneStatistics,
    choice: AccelChoice,
    binding_bytes: u64,
    prices: &Prices,
) -> Vec<Candidate> {
    let count = statistics.count;
    let is_few = choice == AccelChoice::Auto && count <= FEW;
    let never_competes =
        matches!(choice, AccelChoice::List | AccelChoice::BinaryTree | AccelChoice::RayQuery);
    if count == 0 || is_few || never_competes {
        return Vec::new();
    }
    let plans = COMPETING.map(|structure| {
        AccelPlan::of_structure(*statistics, structure, String::new(), binding_bytes)
    });
    let stride = count.div_ceil(RADII);
    let radii: Vec<f32> = spheres.iter().step_by(stride).map(|sphere| sphere[3]).collect();
    let shape = |plan: &AccelPlan, layout| {
        let per_brick = count.div_ceil(plan.brick_count);
        // Bricks are about equal parts of the box.
        let part = (1.0 / plan.brick_count as f32).cbrt();
        let extent = (statistics.max - statistics.min) * part;
        let size = first_level_size(&radii, per_brick, extent, layout, plan.budget);
        GridShape { size: size.into(), layout }
    };
    let [referenced, balls, _] = &plans;
    let shapes = [shape(referenced, ListLayout::Referenced), shape(balls, ListLayout::Balls)];
    let expected = Expected::of(spheres, statistics, shapes);
    let expected = [expected.references, expected.balls, expected.tree];
    let priced = [&prices.references, &prices.balls, &prices.tree];
    let candidates = plans.iter().zip(expected).zip(priced);
    candidates
        .map(|((plan, expected), prices_of)| Candidate {
            structure: plan.structure,
            expected,
            ray: prices_of.of_ray(&expected),
            build: prices_of.build * count as f64,
            upload: prices.upload_byte * plan.device_bytes() as f64,
        })
        .collect()
}
