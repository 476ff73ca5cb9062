//! Every structure, in one brick and in several. Each sphere is in one brick, and no buffer exceeds the plan.

use pinhole::accel::{Accel, AccelChoice, AccelPlan, Brick, Index, Primitive, Structure};
use pinhole::glam::Vec3;

use crate::support::cones::{crowded, mixed};
use crate::support::spheres::{self, Spheres, crowd_and_outliers};

/// The largest binding of a large device.
const ROOMY: u64 = 1 << 30;

/// A binding for 256 spheres of 16 bytes each.
const TINY: u64 = 4096;

/// A binding for the fixed part of a grid with balls, and for 300 spheres with 68 bytes each.
const TINY_FOR_BALLS: u64 = (1 << 20) + 300 * 68;

/// Every structure of the spheres, each with its plan.
fn all(spheres: &Spheres) -> Vec<(String, AccelPlan, Accel)> {
    let kinds = [
        (Structure::List, TINY),
        (Structure::Grid, TINY_FOR_BALLS),
        (Structure::WideTree, TINY),
        (Structure::RayQuery, TINY),
    ];
    let mut all = Vec::new();
    for (structure, tiny) in kinds {
        for binding_bytes in [ROOMY, tiny] {
            let plan = AccelPlan::of(spheres, structure, binding_bytes);
            check_bindings(&plan, binding_bytes);
            let accel = plan.build(spheres);
            let name = format!("{} in {}", accel.structure().name(), accel.bricks().len());
            all.push((name, plan, accel));
        }
    }
    all
}

/// Checks that no planned binding exceeds the device's, if a brick can hold more than one sphere.
fn check_bindings(plan: &AccelPlan, binding_bytes: u64) {
    if plan.statistics.count.div_ceil(plan.brick_count) <= 1 {
        return;
    }
    for buffer in &plan.buffers {
        assert!(buffer.bytes_per_binding <= binding_bytes, "{plan:?}, {binding_bytes}");
    }
}

/// The bytes of each buffer of a brick, by the names in plans.
fn buffers(brick: &Brick) -> Vec<(&'static str, u64)> {
    let ids = size_of_val(&brick.ids[..]) as u64;
    if brick.primitive == Primitive::Cone {
        let cones = ("cones", size_of_val(&brick.cones[..]) as u64);
        return match &brick.index {
            Index::Grid(grid) => {
                let words = size_of_val(&grid.cells[..]) + size_of_val(&grid.references[..]);
                let capsules = size_of_val(&grid.balls[..]) as u64;
                vec![cones, ("ids, cells and references of cones", ids + words as u64), ("capsules", capsules)]
            }
            Index::WideTree(tree) => {
                vec![cones, ("ids of cones", ids), ("nodes of cones", size_of_val(&tree.nodes[..]) as u64)]
            }
            _ => vec![cones, ("ids of cones", ids)],
        };
    }
    let mut buffers = vec![("spheres", size_of_val(&brick.spheres[..]) as u64)];
    if let Index::Grid(grid) = &brick.index {
        let words = size_of_val(&grid.cells[..]) + size_of_val(&grid.references[..]);
        buffers.push(("ids, cells and references", ids + words as u64));
        buffers.push(("balls", size_of_val(&grid.balls[..]) as u64));
        return buffers;
    }
    buffers.push(("ids", ids));
    match &brick.index {
        Index::List | Index::Grid(_) => {}
        Index::WideTree(tree) => buffers.push(("nodes", size_of_val(&tree.nodes[..]) as u64)),
        Index::RayQuery(boxes) => buffers.push(("boxes", size_of_val(&boxes[..]) as u64)),
        #[cfg(feature = "gpu")]
        Index::Tiles(_) => {}
    }
    buffers
}

/// Checks that no buffer is larger than planned, in any brick and in all together, and that no buffer is unplanned.
fn check_memory(name: &str, plan: &AccelPlan, accel: &Accel) {
    assert!(accel.bricks().len() <= plan.brick_count, "{name}");
    let planned = |buffer: &str| {
        let planned = plan.buffers.iter().find(|planned| planned.name == buffer);
        planned.map_or((0, 0), |planned| (planned.bytes, planned.bytes_per_binding))
    };
    let mut sums = std::collections::BTreeMap::new();
    for brick in accel.bricks() {
        for (buffer, bytes) in buffers(brick) {
            let (_, most) = planned(buffer);
            assert!(bytes <= most, "{name}: a brick has {bytes} bytes of {buffer}, planned {most}");
            *sums.entry(buffer).or_insert(0) += bytes;
        }
    }
    for (buffer, sum) in &sums {
        let (most, _) = planned(buffer);
        assert!(*sum <= most, "{name}: {sum} bytes of {buffer}, planned {most}");
    }
    assert!(sums.values().sum::<u64>() <= plan.device_bytes(), "{name}");
}

/// Checks that each input sphere is in one brick, and that boxes for ray queries contain their spheres.
fn check_bricks(name: &str, accel: &Accel, spheres: &Spheres, margin: f32) {
    let (low, high) = accel.bounds();
    for [x, y, z, radius] in spheres {
        let (center, reach) = (Vec3::new(*x, *y, *z), radius + margin);
        let is_inside = low.cmple(center - reach).all() && high.cmpge(center + reach).all();
        assert!(is_inside, "{name}: a sphere reaches beyond the box of the scene");
    }
    let mut seen = vec![false; spheres.len()];
    for brick in accel.bricks() {
        let mut own = brick.ids.clone();
        own.sort_unstable();
        own.dedup();
        for id in &own {
            let seen = &mut seen[*id as usize];
            assert!(!std::mem::replace(seen, true), "{name}: sphere {id} is in two bricks");
        }
        if let Index::WideTree(_) = &brick.index {
            // The brick's spheres are those of the tree, in another order.
            let own: Spheres = brick.ids.iter().map(|id| spheres[*id as usize]).collect();
            assert_eq!(own, brick.spheres, "{name}");
        }
        if let Index::RayQuery(boxes) = &brick.index {
            let boxes = boxes.iter().zip(&brick.spheres);
            for ([x0, y0, z0, x1, y1, z1], [x, y, z, radius]) in boxes {
                let reach = f64::from(radius + margin);
                let holds = |low: &f32, center: &f32, high: &f32| {
                    let center = f64::from(*center);
                    f64::from(*low) <= center - reach && f64::from(*high) >= center + reach
                };
                assert!(holds(x0, x, x1) && holds(y0, y, y1) && holds(z0, z, z1), "{name}");
            }
        }
    }
}

/// Cones of one brick and of several, with every structure: no buffer exceeds the plan, and each is in one brick.
#[test]
fn cones_are_as_planned() {
    for scene in [mixed(50, 3000, 0.1, 2), mixed(0, 700, 1.0, 3), crowded(4), mixed(0, 1, 0.5, 5)] {
        for choice in [AccelChoice::Auto, AccelChoice::Grid, AccelChoice::Tree, AccelChoice::List] {
            for binding_bytes in [ROOMY, 1 << 19] {
                let plan = AccelPlan::new(scene.spheres(), choice, binding_bytes);
                let plan = plan.with_cones(scene.cones(), binding_bytes);
                check_bindings(&plan, binding_bytes);
                let accel = plan.bricks(scene.spheres()).with_cones(scene.cones()).build();
                let name = format!("{} cones, {choice}, {binding_bytes} bytes", scene.cones().len());
                let bricks = accel.bricks().iter();
                let of_cones: Vec<&Brick> = bricks.filter(|brick| brick.primitive == Primitive::Cone).collect();
                assert_eq!(of_cones.len(), plan.cones.map_or(0, |cones| cones.brick_count), "{name}");
                let mut sums = std::collections::BTreeMap::new();
                let mut ids: Vec<u32> = of_cones.iter().flat_map(|brick| &brick.ids).copied().collect();
                ids.sort_unstable();
                let all = scene.spheres().len() as u32..scene.shape_count() as u32;
                assert!(ids.into_iter().eq(all), "{name}");
                for brick in of_cones {
                    for (buffer, bytes) in buffers(brick) {
                        let planned = plan.buffers.iter().find(|planned| planned.name == buffer).unwrap();
                        let sum = sums.entry(buffer).or_insert(0);
                        *sum += bytes;
                        assert!(bytes <= planned.bytes_per_binding && *sum <= planned.bytes, "{name}: {buffer}");
                    }
                }
            }
        }
    }
}

fn check(scene: &str, spheres: &Spheres) {
    for (name, plan, accel) in all(spheres) {
        let name = format!("{scene}, {name}");
        check_memory(&name, &plan, &accel);
        check_bricks(&name, &accel, spheres, plan.statistics.margin());
    }
}

/// Few, random, equal and sorted spheres, of uneven size and density, far away, and very long and very short scenes.
#[test]
fn every_scene_in_every_structure() {
    let decades = spheres::four_decades(1_000);
    let few = [1, 2, 3, 31, 33].map(|count| spheres::random(count, 1, |_| 0.2));
    few.iter().for_each(|few| check(&few.len().to_string(), few));
    for (name, spheres) in [
        ("none", Vec::new()),
        ("random", spheres::random(3_000, 2, |_| 0.02)),
        ("sparse", spheres::random(3_000, 3, |_| 0.002)),
        ("four decades", spheres::four_decades(2_000)),
        ("1,000 equal", vec![[1.0, 2.0, 3.0, 0.5]; 1_000]),
        ("twice", spheres::twice(1_000)),
        ("concentric", spheres::concentric(500)),
        ("line", spheres::line(1_000)),
        ("nested", spheres::nested(300)),
        ("geometric", spheres::geometric(1_000)),
        ("lattice", spheres::lattice(14)),
        ("one around all", spheres::one_around_all(2_000)),
        ("clusters", spheres::clusters(10, 300)),
        ("outlier", spheres::outlier(2_000)),
        ("flat", spheres::flat(2_000)),
        ("distant sheet", spheres::distant_sheet(2_000)),
        ("needle", spheres::needle(2_000)),
        ("far", spheres::far(1_500)),
        ("times 2^50", spheres::scaled(&decades, 2_f32.powi(50))),
        ("times 2^-50", spheres::scaled(&decades, 2_f32.powi(-50))),
    ] {
        check(name, &spheres);
    }
}

/// Bindings for a few spheres each give many bricks.
#[test]
fn many_small_bricks() {
    let spheres = spheres::random(60, 22, |_| 0.1);
    let binding_bytes = TINY / 4;
    let plan = AccelPlan::of(&spheres, Structure::Grid, binding_bytes);
    check_bindings(&plan, binding_bytes);
    let accel = plan.build(&spheres);
    assert!(accel.bricks().len() >= 15, "{}", accel.bricks().len());
    check_memory("many bricks", &plan, &accel);
}

/// The scenes lead to every structure.
#[test]
fn every_structure_is_met() {
    let mut met: Vec<Structure> = [spheres::clusters(10, 300), spheres::random(2_000, 2, |_| 0.02)]
        .iter()
        .flat_map(|spheres| all(spheres).into_iter().map(|(_, _, accel)| accel.structure()))
        .collect();
    met.sort_by_key(|structure| structure.name());
    met.dedup();
    assert_eq!(met.len(), 5, "{met:?}");
}

/// Spheres in one place. Lists keep the one that counts, and building ends.
#[test]
fn a_million_coincident_centres() {
    for count in [100_000, 1_000_000] {
        let spheres = spheres::coincident(count);
        for structure in [Structure::Grid, Structure::WideTree] {
            let plan = AccelPlan::of(&spheres, structure, ROOMY);
            let accel = plan.build(&spheres);
            let name = format!("{count} coincident, {}", accel.structure().name());
            check_memory(&name, &plan, &accel);
        }
    }
}

/// A binding for about a thousand spheres.
const FOR_A_THOUSAND: u64 = 1 << 14;

fn check_crowd(name: &str, spheres: &Spheres) {
    for (choice, bytes) in [
        (AccelChoice::Auto, ROOMY),
        (AccelChoice::Tree, ROOMY),
        (AccelChoice::Tree, FOR_A_THOUSAND),
        (AccelChoice::Grid, ROOMY),
    ] {
        let plan = AccelPlan::new(spheres, choice, bytes);
        let accel = plan.build(spheres);
        let name = format!("{name}, {choice} of {bytes} bytes");
        check_memory(&name, &plan, &accel);
        check_bricks(&name, &accel, spheres, plan.statistics.margin());
        assert!(bytes == ROOMY || accel.bricks().len() > 1, "{name}");
    }
}

#[test]
fn outliers_at_all_distances() {
    for (outliers, far) in [(1, 1e2), (1, 1e4), (4, 1e6), (3, 1e3), (4, 1e9)] {
        for is_in_line in [false, true] {
            let spheres = crowd_and_outliers(4_000, outliers, far, is_in_line);
            check_crowd(&format!("{outliers} at {far}, {is_in_line}"), &spheres);
        }
    }
    check_crowd("none", &crowd_and_outliers(4_000, 0, 1.0, false));
}

/// Outliers beside a crowd of equal spheres, and beside a crowd far from the origin of the frame.
#[test]
fn crowds_of_equal_spheres_and_crowds_elsewhere() {
    let mut equal: Spheres = vec![[0.25, 0.5, 0.75, 0.02]; 3_000];
    equal.push([1e4, 0.0, 0.0, 0.02]);
    check_crowd("equal", &equal);
    let moved = |[x, y, z, radius]: [f32; 4]| [x + 1e4, y, z - 3e3, radius];
    let elsewhere: Spheres = crowd_and_outliers(4_000, 4, 1e4, false).into_iter().map(moved).collect();
    check_crowd("elsewhere", &elsewhere);
    let outliers = vec![[-1e4, 1e4, 1e4, 0.5]; 4];
    let mut same = spheres::random(4_000, 31, |_| 0.01);
    same.extend(outliers);
    check_crowd("equal outliers", &same);
}

/// The plan reports outliers, and chooses a tree if a grid's margin would be too large.
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
        // One brick, as for any tree with as many spheres.
        assert_eq!(auto.build(&spheres).bricks().len(), 1);
    }
}
