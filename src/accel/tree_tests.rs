//! Tests that `validate` finds damage, and of the depth of trees.

use glam::Vec3;

use super::outliers::{Crowd, Margins};
use super::query::{Nearest, RayF32};
use super::sphere::intersect_sphere;
use super::statistics::SceneStatistics;
use super::tree_check::TreeError;
use super::wide_tree::{WIDE_LEVELS, WideTree};
use super::wide_tree_build::levels_by_halves;

const MARGIN: f32 = 1e-5;

fn spheres(count: usize) -> Vec<[f32; 4]> {
    let mut random = fastrand::Rng::with_seed(7);
    (0..count).map(|_| [random.f32(), random.f32(), random.f32(), 0.02]).collect()
}

fn found_in_wide(plant: impl Fn(&mut WideTree)) -> Result<(), TreeError> {
    let spheres = spheres(2_000);
    let mut tree = WideTree::build(&spheres, MARGIN);
    assert_eq!(tree.validate(&spheres), Ok(()));
    plant(&mut tree);
    tree.validate(&spheres)
}

/// A node, and two of its slots that both hold leaves or inner children.
fn two_slots(tree: &WideTree, inner: bool) -> (usize, usize, usize) {
    (0..tree.nodes.len())
        .find_map(|n| {
            let node = &tree.nodes[n];
            let of_kind = |slot: &usize| match inner {
                true => node.inner_mask() >> slot & 1 == 1,
                false => node.byte(6, *slot) != 0,
            };
            let mut slots = (0..8).filter(of_kind);
            Some((n, slots.next()?, slots.next()?))
        })
        .unwrap()
}

fn swap_bytes(tree: &mut WideTree, n: usize, words: usize, a: usize, b: usize) {
    let node = &mut tree.nodes[n];
    let (x, y) = (node.byte(words, a), node.byte(words, b));
    node.set_byte(words, a, y);
    node.set_byte(words, b, x);
}

#[test]
fn damage_to_a_wide_tree_is_found() {
    for inner in [false, true] {
        for words in [8, 10, 12] {
            let shrunk = found_in_wide(|tree| {
                let (n, slot, _) = two_slots(tree, inner);
                let byte = tree.nodes[n].byte(words, slot);
                tree.nodes[n].set_byte(words, slot, byte + 1);
            });
            assert!(matches!(shrunk, Err(TreeError::Box { .. })), "{inner} {words}: {shrunk:?}");
            let shrunk = found_in_wide(|tree| {
                let (n, slot, _) = two_slots(tree, inner);
                let byte = tree.nodes[n].byte(words + 6, slot);
                tree.nodes[n].set_byte(words + 6, slot, byte - 1);
            });
            assert!(matches!(shrunk, Err(TreeError::Box { .. })), "{inner} {words}: {shrunk:?}");
        }
        let swapped = found_in_wide(|tree| {
            let (n, a, b) = two_slots(tree, inner);
            for words in [8, 10, 12, 14, 16, 18] {
                swap_bytes(tree, n, words, a, b);
            }
        });
        assert!(matches!(swapped, Err(TreeError::Box { .. })), "{inner}: {swapped:?}");
    }
    let swapped = found_in_wide(|tree| {
        let (n, a, b) = two_slots(tree, false);
        swap_bytes(tree, n, 6, a, b);
    });
    assert!(matches!(swapped, Err(TreeError::Box { .. })), "{swapped:?}");

    let dropped = found_in_wide(|tree| {
        let (n, slot, _) = two_slots(tree, false);
        tree.nodes[n].set_byte(6, slot, 0);
    });
    assert!(matches!(dropped, Err(TreeError::Sphere { .. })), "{dropped:?}");
    let dropped = found_in_wide(|tree| {
        let (n, slot, _) = two_slots(tree, true);
        tree.nodes[n].0[3] &= !(1 << (24 + slot));
    });
    assert!(dropped.is_err());

    for word in [4, 5] {
        for wrong in [0, 1, u32::MAX] {
            let offset = found_in_wide(|tree| {
                let (n, ..) = two_slots(tree, word == 4);
                // A wrong value is replaced by its neighbour if it happens to be right.
                let right = tree.nodes[n].0[word];
                tree.nodes[n].0[word] = if right == wrong { wrong + 1 } else { wrong };
            });
            assert!(offset.is_err(), "word {word} as {wrong}");
        }
    }
    let order = found_in_wide(|tree| tree.ids.swap(0, 1));
    assert!(order.is_err());
    let twice = found_in_wide(|tree| tree.ids[0] = tree.ids[1]);
    assert!(matches!(twice, Err(TreeError::Sphere { .. })), "{twice:?}");
    let understated = found_in_wide(|tree| tree.levels -= 1);
    assert!(matches!(understated, Err(TreeError::Levels { .. })), "{understated:?}");
    let more = found_in_wide(|tree| tree.nodes.push(tree.nodes[0]));
    assert!(more.is_err());
}

/// The depths of trees are proven; this checks the arithmetic.
#[test]
fn no_number_of_spheres_needs_more_levels_than_a_stack_serves() {
    assert_eq!([1, 24, 25, 192, 193].map(levels_by_halves), [1, 1, 2, 2, 3]);
    assert!(levels_by_halves(u32::MAX as usize) <= 11);
    const { assert!(WIDE_LEVELS >= 11) };
}

/// Rays from afar graze spheres by more than the margin of the crowd; boxes that are not wider for them lose some.
#[test]
fn boxes_must_be_wider_for_rays_from_afar() {
    let mut random = fastrand::Rng::with_seed(8);
    // The first points of many are less far apart than numbers at the rays' origins.
    let mut place = || 1e-3 * random.f32();
    let mut spheres: Vec<_> = (0..2_000).map(|_| [place(), place(), place(), 0.02]).collect();
    spheres.push([1e4, 0.5, 0.5, 0.02]);
    let statistics = SceneStatistics::of(&spheres);
    let crowd = Crowd::find(&spheres, &statistics);
    assert!(crowd.is_some());
    let wider = WideTree::build_with(&spheres, Margins { all: statistics.margin(), crowd });
    assert_eq!(wider.validate(&spheres), Ok(()));
    let mut not_wider = wider.clone();
    not_wider.margins = Margins::one(0.0);
    let sorted: Vec<[f32; 4]> = wider.ids.iter().map(|id| spheres[*id as usize]).collect();
    let mut lost = 0;
    for _ in 0..2_000 {
        let [x, y, z, radius] = spheres[random.usize(..2_000)];
        let origin = 5e3 * Vec3::new(1.0 + random.f32(), random.f32(), -random.f32());
        // Where the sphere touches its box.
        let along = Vec3::new(x + radius, y, z) - origin;
        let ray = RayF32 { origin, direction: along / along.length() };
        let mut expected = Nearest::NONE;
        for (id, sphere) in (0..).zip(&spheres) {
            expected.offer(intersect_sphere(&ray, *sphere), id);
        }
        let found = |tree: &WideTree| {
            let mut nearest = Nearest::NONE;
            tree.find_nearest(&sorted, &tree.ids, &ray, &mut nearest);
            nearest.t.to_bits()
        };
        assert_eq!(found(&wider), expected.t.to_bits(), "{ray:?}");
        lost += u32::from(found(&not_wider) != expected.t.to_bits());
    }
    assert!(lost > 0);
}
