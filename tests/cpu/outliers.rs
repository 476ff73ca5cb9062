//! Scenes with outliers: the plan knows them, and what is built has every sphere and keeps to the plan. `structures::outliers`
//! of `tests/gpu` sees that no sphere is lost from near and from afar.

use pinhole::accel::{AccelChoice, AccelPlan, Structure};

use crate::support::spheres::{self, Spheres, crowd_and_outliers};

const ROOMY: u64 = 1 << 30;

/// Bindings for about a thousand spheres.
const TINY: u64 = 1 << 14;

fn check(name: &str, spheres: &Spheres) {
    let build = |choice, bytes| {
        let plan = AccelPlan::new(spheres, choice, bytes);
        let accel = plan.build(spheres);
        (format!("{name}, {choice} of {bytes} bytes"), plan, accel)
    };
    let built = [
        build(AccelChoice::Auto, ROOMY),
        build(AccelChoice::Tree, ROOMY),
        build(AccelChoice::Tree, TINY),
        build(AccelChoice::Grid, ROOMY),
    ];
    assert!(built[2].2.bricks().len() > 1, "{name}");
    for (name, plan, accel) in &built {
        let held: u64 = accel.bricks().iter().map(|brick| 16 * brick.spheres.len() as u64).sum();
        let nodes = accel.bricks().iter().map(|brick| match &brick.index {
            pinhole::accel::Index::WideTree(tree) => {
                let own: Spheres = brick.ids.iter().map(|id| spheres[*id as usize]).collect();
                // The brick's spheres are those of the tree, in another order.
                assert_eq!(own, brick.spheres, "{name}");
                size_of_val(tree.nodes()) as u64
            }
            _ => 0,
        });
        assert!(held + nodes.sum::<u64>() <= plan.device_bytes(), "{name}");
    }
}

#[test]
fn outliers_at_all_distances() {
    for (outliers, far) in [(1, 1e2), (1, 1e4), (4, 1e6), (3, 1e3), (4, 1e9)] {
        for is_in_line in [false, true] {
            let spheres = crowd_and_outliers(4_000, outliers, far, is_in_line);
            check(&format!("{outliers} at {far}, {is_in_line}"), &spheres);
        }
    }
    check("none", &crowd_and_outliers(4_000, 0, 1.0, false));
}

/// Beside a crowd of equal spheres, and beside one that is far from the origin of the frame.
#[test]
fn crowds_of_equal_spheres_and_crowds_elsewhere() {
    let mut equal: Spheres = vec![[0.25, 0.5, 0.75, 0.02]; 3_000];
    equal.push([1e4, 0.0, 0.0, 0.02]);
    check("equal", &equal);
    let moved = |[x, y, z, radius]: [f32; 4]| [x + 1e4, y, z - 3e3, radius];
    let elsewhere: Spheres =
        crowd_and_outliers(4_000, 4, 1e4, false).into_iter().map(moved).collect();
    check("elsewhere", &elsewhere);
    let outliers = vec![[-1e4, 1e4, 1e4, 0.5]; 4];
    let mut same = spheres::random(4_000, 31, |_| 0.01);
    same.extend(outliers);
    check("equal outliers", &same);
}

/// The plan says what it knows, and takes a tree where a grid's margin would be too large.
#[test]
fn plans_know_outliers() {
    let plan = |spheres: &Spheres, choice| AccelPlan::new(spheres, choice, ROOMY);
    let none = plan(&crowd_and_outliers(20_000, 0, 1.0, false), AccelChoice::Auto);
    assert_eq!(none.crowd, None);
    assert!(none.structure == Structure::Grid, "{}", none.reason);
    for outliers in [1, 20] {
        let spheres = crowd_and_outliers(20_000, outliers, 1e4, false);
        let auto = plan(&spheres, AccelChoice::Auto);
        assert_eq!(auto.crowd.map(|crowd| crowd.outliers), Some(outliers));
        assert_eq!(auto.structure, Structure::WideTree);
        let says = format!("{outliers} of {} spheres lie far away", spheres.len());
        assert!(auto.reason.contains(&says), "{}", auto.reason);
        assert_eq!(plan(&spheres, AccelChoice::Grid).structure, Structure::Grid);
        // One brick, as for any tree of so many.
        assert_eq!(auto.build(&spheres).bricks().len(), 1);
    }
}
