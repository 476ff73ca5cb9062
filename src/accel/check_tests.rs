//! Checks every structure against its spheres by brute force. Each sphere is in it once. No walk misses a sphere, runs
//! for ever or needs more than a kernel's stack. A cell or box within the margin of a sphere's surface has the sphere.
//! Damage is found. `cpu/search_tests.rs` and `tests/gpu/structures.rs` check that rays find their spheres.

use fastrand::Rng;
use glam::DVec3;

use super::ball::{BALLS_PER_VECTOR, PartInCell};
use super::bricks::{Brick, Index};
use super::grid::{Grid, GridBudget, LAST, MAX_CELLS, word};
use super::grid_build::{BuiltGrid, build_grid};
use super::plan::AccelPlan;
use super::structure::Structure;
use super::wide_tree::{Slot, WIDE_LEAF, WIDE_LEVELS, WideTree};
use super::wide_tree_build::levels_by_halves;

#[allow(dead_code, clippy::duplicate_mod, reason = "some of its scenes are for other tests")]
#[path = "../../tests/support/spheres.rs"]
mod spheres;

use spheres::Spheres;

/// The share of a grid's margin that rounding leaves, and how far a listed sphere may be from its cell, in margins.
const MUST_LIST: f64 = 0.8;
const MAY_LIST: f64 = 2.0;

/// Fails with a message if a condition does not hold.
fn ensure(holds: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(what()) }
}

/// Checks a brick of a plan with the given margin.
fn check(brick: &Brick, margin: f32) -> Result<(), String> {
    let Brick { index, spheres, ids, .. } = brick;
    ensure(spheres.len() == ids.len(), || "a sphere without an id".to_owned())?;
    match index {
        Index::Grid(grid) => GridCheck { grid, spheres, ids, margin: margin.into() }.all(),
        Index::WideTree(tree) => check_tree(tree, spheres, ids),
        Index::List | Index::RayQuery(_) => Ok(()),
        #[cfg(feature = "gpu")]
        Index::Tiles(_) => Ok(()),
    }
}

fn centre([x, y, z, _]: [f32; 4]) -> DVec3 {
    DVec3::new(x.into(), y.into(), z.into())
}

struct GridCheck<'a> {
    grid: &'a Grid,
    spheres: &'a [[f32; 4]],
    ids: &'a [u32],
    margin: f64,
}

/// A cell: its word, its corner and its side.
struct Cell {
    word: u32,
    corner: DVec3,
    side: f64,
}

impl GridCheck<'_> {
    fn all(&self) -> Result<(), String> {
        let Grid { cells, cell_counts, references, balls, .. } = self.grid;
        let first_level = self.grid.first_level_len();
        let is_box = (1..=MAX_CELLS).contains(&first_level) && cells.len() >= first_level;
        ensure(is_box, || format!("{cell_counts:?} cells with {} words", cells.len()))?;
        ensure(balls.len() == references.len(), || "a reference without a ball".to_owned())?;
        let mut cell_at = Vec::new();
        for (index, own) in cells[..first_level].iter().enumerate() {
            let counts = cell_counts.map(|count| count as usize);
            let place = [index % counts[0], index / counts[0] % counts[1]];
            let place = [place[0], place[1], index / (counts[0] * counts[1])];
            let side = f64::from(self.grid.cell_size);
            let corner = self.grid.min.as_dvec3() + side * DVec3::from(place.map(|x| x as f64));
            let cell = Cell { word: *own, corner, side };
            match cell.word & word::KIND {
                word::GRID => {
                    let level = word::level(cell.word);
                    let (first, inner) = (word::first_inner(cell.word), 1_usize << level);
                    let words = cells.get(first..first + inner.pow(3));
                    let words = words.ok_or_else(|| format!("cell {index} has no inner words"))?;
                    for (number, word) in words.iter().enumerate() {
                        let place = [number % inner, number / inner % inner, number / inner / inner];
                        let side = cell.side / inner as f64;
                        let corner = cell.corner + side * DVec3::from(place.map(|x| x as f64));
                        let kind = word & word::KIND;
                        let is_leaf = kind == word::LIST || *word == word::EMPTY;
                        ensure(is_leaf, || format!("inner cell {number} of {index} is odd"))?;
                        cell_at.push(Cell { word: *word, corner, side });
                    }
                }
                word::EMPTY => {
                    self.check_reach(place, cell.word)?;
                    cell_at.push(cell);
                }
                word::LIST => cell_at.push(cell),
                _ => return Err(format!("cell {index} is of no kind")),
            }
        }
        cell_at.iter().try_for_each(|cell| self.check_cell(cell))
    }

    /// Checks how many cells ahead an empty word declares empty.
    fn check_reach(&self, place: [usize; 3], empty: u32) -> Result<(), String> {
        let counts = self.grid.cell_counts.map(|count| count as usize);
        for octant in 0..8 {
            let reach = (empty >> (word::REACH_BITS * octant) & word::REACH) as usize;
            let along = |axis: usize| {
                let is_back = octant >> axis & 1 == 1;
                let (from, to) = (place[axis].saturating_sub(reach), place[axis] + reach);
                if is_back { from..=place[axis] } else { place[axis]..=to.min(counts[axis] - 1) }
            };
            for (z, y) in along(2).flat_map(|z| along(1).map(move |y| (z, y))) {
                for x in along(0) {
                    let word = self.grid.cells[(z * counts[1] + y) * counts[0] + x];
                    ensure(word & word::KIND == word::EMPTY, || {
                        format!("the empty cell {place:?} reaches too far in octant {octant}")
                    })?;
                }
            }
        }
        Ok(())
    }

    /// Checks that a cell's list has every sphere near the cell and no other.
    fn check_cell(&self, cell: &Cell) -> Result<(), String> {
        let Grid { references, balls, .. } = self.grid;
        let at: Vec<usize> = match cell.word & word::KIND {
            word::LIST => self.grid.list(cell.word & !word::KIND).collect(),
            _ => Vec::new(),
        };
        if let (Some(first), Some(last)) = (at.first(), at.last()) {
            let is_end = |words: &[u32], at: usize| words[at] & LAST != 0;
            let is_ended = is_end(references, *last) && at.iter().all(|at| is_end(balls, *at) == (at == last));
            let is_whole = first.is_multiple_of(BALLS_PER_VECTOR) && at.len().is_multiple_of(BALLS_PER_VECTOR);
            ensure(is_ended && is_whole, || format!("the list at {first} does not end"))?;
        } else {
            let is_empty = cell.word & word::KIND == word::EMPTY;
            ensure(is_empty, || "a list without elements".to_owned())?;
        }
        let listed: Vec<usize> = at.iter().map(|at| (references[*at] & !LAST) as usize).collect();
        let is_known = listed.iter().all(|shape_index| *shape_index < self.spheres.len());
        ensure(is_known, || "a reference to no sphere".to_owned())?;
        let id = |shape_index: &usize| self.ids[*shape_index];
        let ascends = listed.is_sorted_by_key(id);
        ensure(ascends, || "a list whose ids do not ascend".to_owned())?;
        for (at, shape_index) in at.iter().zip(&listed) {
            let sphere = self.spheres[*shape_index];
            let is_near = cell.is_near(sphere, MAY_LIST * self.margin);
            ensure(is_near, || format!("sphere {} is listed far away", id(shape_index)))?;
            let is_met = cell.meets(balls[*at], sphere, MUST_LIST * self.margin);
            ensure(is_met, || format!("the ball of sphere {} is too small", id(shape_index)))?;
        }
        for (shape_index, sphere) in self.spheres.iter().enumerate() {
            // A long list keeps only the first of equal spheres.
            let is_there = || {
                let bits = |sphere: &[f32; 4]| sphere.map(f32::to_bits);
                let same = |other: &usize| bits(&self.spheres[*other]) == bits(sphere);
                listed.contains(&shape_index)
                    || listed.iter().find(|o| same(o)).is_some_and(|o| id(o) < id(&shape_index))
            };
            let is_needed = cell.is_near(*sphere, MUST_LIST * self.margin);
            let is_right = !is_needed || is_there();
            ensure(is_right, || format!("sphere {} is missing in a cell", id(&shape_index)))?;
        }
        Ok(())
    }
}

impl Cell {
    /// Whether the surface of a sphere is within `margin` of the cell.
    fn is_near(&self, sphere: [f32; 4], margin: f64) -> bool {
        let (low, high) = (self.corner, self.corner + self.side);
        let (centre, radius) = (centre(sphere), f64::from(sphere[3]));
        let near = (centre - centre.clamp(low, high)).length();
        let far = (centre - low).abs().max((centre - high).abs()).length();
        near <= radius + margin && far >= radius - margin
    }

    /// Whether points of the cell near a sphere's surface are in its ball.
    fn meets(&self, ball: u32, sphere: [f32; 4], margin: f64) -> bool {
        let towards = [0.0, 0.5, 1.0].map(|share| self.corner + share * self.side);
        let corners = (0..27).map(|i| DVec3::new(towards[i % 3].x, towards[i / 3 % 3].y, towards[i / 9].z));
        corners.chain([centre(sphere)]).all(|towards| {
            let from = centre(sphere);
            let along = (towards - from).normalize_or(DVec3::X);
            let on_surface = from + (f64::from(sphere[3]) + margin) * along;
            let place = (on_surface - self.corner) / self.side;
            let is_inside = place.cmpge(DVec3::ZERO).all() && place.cmple(DVec3::ONE).all();
            let part = PartInCell::new(place.as_vec3(), glam::Vec3::X, 0.0);
            !is_inside || part.meets_four(&[ball; BALLS_PER_VECTOR]) != 0
        })
    }
}

fn check_tree(tree: &WideTree, spheres: &[[f32; 4]], ids: &[u32]) -> Result<(), String> {
    let mut is_visited = vec![false; tree.nodes.len()];
    let mut is_there = vec![false; spheres.len()];
    let mut deepest = 0;
    let everywhere = [DVec3::MIN, DVec3::MAX];
    let mut waiting = vec![(0_u32, 1_u32, everywhere)];
    while let Some((index, level, [low, high])) = waiting.pop() {
        let node = tree.nodes.get(index as usize).ok_or_else(|| format!("no node {index}"))?;
        let was_visited = std::mem::replace(&mut is_visited[index as usize], true);
        ensure(!was_visited, || format!("node {index} has two parents"))?;
        deepest = deepest.max(level);
        for slot in 0..8 {
            let [below, above] = node.slot_box(slot).map(DVec3::from);
            let within = [low.max(below), high.min(above)];
            match node.slot(slot) {
                Slot::Empty => {}
                Slot::Inner(child) => waiting.push((child, level + 1, within)),
                Slot::Leaf(first, count) => {
                    let (first, count) = (first as usize, count as usize);
                    let is_leaf = count <= WIDE_LEAF && first + count <= spheres.len();
                    ensure(is_leaf, || format!("node {index} has an odd leaf"))?;
                    let own = first..first + count;
                    ensure(ids[own.clone()].is_sorted(), || format!("ids of node {index}"))?;
                    for place in own {
                        let reach = f64::from(spheres[place][3]) + f64::from(tree.margins.of(&spheres[place]));
                        let at = centre(spheres[place]);
                        let is_inside = within[0].cmple(at - reach).all() && within[1].cmpge(at + reach).all();
                        ensure(is_inside, || format!("a box around sphere {} is small", ids[place]))?;
                        let twice = std::mem::replace(&mut is_there[place], true);
                        ensure(!twice, || format!("sphere {} is in two leaves", ids[place]))?;
                    }
                }
            }
        }
    }
    ensure(is_there.iter().all(|is_there| *is_there), || "a sphere is in no leaf".to_owned())?;
    ensure(is_visited.iter().all(|visited| *visited), || "a node has no parent".to_owned())?;
    let is_level = deepest == tree.levels && deepest <= WIDE_LEVELS;
    ensure(is_level, || format!("{deepest} levels, not {}", tree.levels))
}

/// The limits of the grids in these checks: fewer cells than plans allow, because each is compared with each sphere.
fn budget(spheres: &Spheres) -> GridBudget {
    GridBudget { listed: 10 * spheres.len() + 64, cells: 16 * spheres.len() + 64 }
}

/// Builds the only brick of a scene in a structure. Returns it with the margin.
fn built(spheres: &Spheres, structure: Structure) -> (Brick, f32) {
    let plan = AccelPlan::of(spheres, structure, 1 << 30);
    let margin = plan.statistics.margin();
    if structure == Structure::Grid {
        let ids: Vec<u32> = (0..spheres.len() as u32).collect();
        let BuiltGrid { grid, spheres, ids } = build_grid(spheres, &ids, margin, budget(spheres));
        return (Brick { index: Index::Grid(grid), spheres, ids, ..Brick::default() }, margin);
    }
    let mut bricks: Vec<Brick> = plan.bricks(spheres).collect();
    assert_eq!(bricks.len(), 1);
    (bricks.remove(0), margin)
}

/// Crowded spheres, for grids inside cells, and spheres in a corner, for first-level lists and empty cells around them.
fn mixed() -> Spheres {
    let mut spheres = spheres::clusters(5, 200);
    spheres.extend(spheres::scaled(&spheres::random(150, 21, |_| 0.03), 40.0));
    spheres
}

#[test]
fn every_structure_has_its_spheres() {
    let mut nested = 0;
    for (name, spheres) in [
        ("one", vec![[1.0, 2.0, 3.0, 0.5]]),
        ("few", spheres::random(33, 1, |_| 0.2)),
        ("random", spheres::random(800, 1, |_| 0.02)),
        ("sparse", spheres::random(500, 3, |_| 0.001)),
        ("four decades", spheres::four_decades(500)),
        ("coincident", spheres::coincident(800)),
        ("concentric", spheres::concentric(300)),
        ("twice", spheres::twice(700)),
        ("line", spheres::line(500)),
        ("nested", spheres::nested(300)),
        ("geometric", spheres::geometric(500)),
        ("lattice", spheres::lattice(8)),
        ("one around all", spheres::one_around_all(800)),
        ("clusters", spheres::clusters(8, 120)),
        ("mixed", mixed()),
        ("far", spheres::far(800)),
        ("flat", spheres::flat(800)),
        ("needle", spheres::needle(800)),
        ("outlier", spheres::outlier(800)),
        ("crowd", spheres::crowd_and_outliers(1_100, 1, 1e4, false)),
        ("long", spheres::scaled(&spheres::four_decades(500), 2_f32.powi(50))),
        ("short", spheres::scaled(&spheres::four_decades(500), 2_f32.powi(-50))),
    ] {
        for structure in [Structure::Grid, Structure::WideTree] {
            let (brick, margin) = built(&spheres, structure);
            check(&brick, margin).unwrap_or_else(|error| panic!("{name}, {structure:?}: {error}"));
            nested += u32::from(brick.is_nested());
            let again = built(&spheres, structure).0;
            let is_same = match (&brick.index, &again.index) {
                (Index::Grid(a), Index::Grid(b)) => a == b,
                (Index::WideTree(a), Index::WideTree(b)) => a == b,
                _ => false,
            };
            assert!(is_same && brick.ids == again.ids, "{name}");
            if let Index::Grid(grid) = &brick.index {
                let budget = budget(&spheres);
                assert!(grid.references.len() <= budget.listed, "{name}");
                assert!(grid.cells.len() <= budget.cells, "{name}");
            }
        }
    }
    assert!(nested > 1, "{nested}");
}

/// Damages a grid, given the index of the last element of a list.
type Damage = fn(&mut Grid, usize);

#[test]
fn damage_to_a_grid_is_found() {
    let damages: [(&str, Damage); 8] = [
        ("no end of a list", |grid, end| grid.references[end] &= !LAST),
        ("no end of balls", |grid, end| grid.balls[end] &= !LAST),
        ("another sphere", |grid, end| grid.references[end] = LAST),
        ("a reference to nothing", |grid, end| grid.references[end] |= LAST >> 1),
        ("small balls", |grid, _| grid.balls.iter_mut().for_each(|ball| *ball &= !(127 << 24))),
        ("a list that is not there", |grid, end| {
            let is_it = |word: &&mut u32| **word & word::KIND == word::LIST && **word & !word::KIND <= end as u32;
            *grid.cells.iter_mut().rfind(is_it).unwrap() = word::EMPTY;
        }),
        ("a reach too far", |grid, _| {
            let len = grid.first_level_len();
            let mut words = grid.cells[..len].iter_mut();
            *words.find(|word| **word < word::LIST && **word & 7 == 0).unwrap() |= word::REACH;
        }),
        ("another inner grid", |grid, _| {
            let is_it = |word: &&mut u32| **word & word::KIND == word::GRID;
            *grid.cells.iter_mut().find(is_it).unwrap() += 1;
        }),
    ];
    for (name, damage) in damages {
        let (mut brick, margin) = built(&mixed(), Structure::Grid);
        let Index::Grid(grid) = &mut brick.index else { panic!("no grid") };
        let end = grid.references.iter().rposition(|reference| reference & LAST != 0).unwrap();
        damage(grid, end);
        assert!(check(&brick, margin).is_err(), "{name}");
    }
}

#[test]
fn damage_to_a_tree_is_found() {
    let mut rng = Rng::with_seed(7);
    let (brick, margin) = built(&spheres::random(2_000, 7, |_| 0.02), Structure::WideTree);
    let damaged = |damage: &mut dyn FnMut(&mut WideTree)| {
        let mut brick = brick.clone();
        let Index::WideTree(tree) = &mut brick.index else { panic!("no tree") };
        damage(tree);
        check(&brick, margin)
    };
    assert_eq!(damaged(&mut |_| {}), Ok(()));
    // Boxes are as small as the cells of their grids allow, so most become too small if they lose one cell.
    let mut small = 0;
    for _ in 0..200 {
        let (slot, axis, is_high) = (rng.usize(0..8), rng.usize(0..3), rng.bool());
        small += u32::from(
            damaged(&mut |tree| {
                let count = tree.nodes.len();
                let node = &mut tree.nodes[rng.usize(0..count)];
                let word = if is_high { 14 + 2 * axis } else { 8 + 2 * axis };
                let byte = node.byte(word, slot);
                let byte = if is_high { byte.saturating_sub(2) } else { byte.saturating_add(2) };
                node.set_byte(word, slot, byte);
            })
            .is_err(),
        );
    }
    assert!(small > 60, "{small}");
    for word in [3, 4] {
        assert!(damaged(&mut |tree| tree.nodes[0].0[word] ^= 1 << 24).is_err(), "{word}");
    }
    assert!(damaged(&mut |tree| tree.levels -= 1).is_err());
    assert!(damaged(&mut |tree| tree.nodes.push(tree.nodes[0])).is_err());
    let Index::WideTree(tree) = &brick.index else { panic!("no tree") };
    let leaf = tree.nodes.iter().position(|node| node.0[6] & 255 != 0).unwrap();
    assert!(damaged(&mut |tree| tree.nodes[leaf].0[6] &= !255).is_err());
    assert!(damaged(&mut |tree| tree.nodes[leaf].0[5] += 1).is_err());
}

/// A proof bounds the depths of trees. This checks its arithmetic.
#[test]
fn no_number_of_spheres_needs_more_levels_than_a_stack_serves() {
    assert_eq!([1, 24, 25, 192, 193].map(levels_by_halves), [1, 1, 2, 2, 3]);
    assert!(levels_by_halves(u32::MAX as usize) <= 11);
    const { assert!(WIDE_LEVELS >= 11) };
}
