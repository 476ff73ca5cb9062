//! Grids are what their check says, and the check finds what is planted.

use pinhole::accel::{AccelPlan, SceneStatistics, Structure};
use pinhole::internals::{BuiltGrid, Grid, GridBudget, GridError, build_grid};

use crate::support::spheres::{self, Spheres};

// What the two highest bits of a word say; here again, so that a change is noticed.
const KIND: u32 = 3 << 30;
const EMPTY: u32 = 0;
const LIST: u32 = 1 << 30;
const GRID: u32 = 2 << 30;

/// What a plan allows in one brick.
fn budget(spheres: &Spheres) -> GridBudget {
    let plan = AccelPlan::of(spheres, Structure::Grid, 1 << 30);
    assert_eq!((plan.structure, plan.brick_count), (Structure::Grid, 1));
    let words = |name: &str| {
        plan.buffers.iter().find(|buffer| buffer.name == name).unwrap().bytes as usize / 4
    };
    let listed = words("balls");
    GridBudget { listed, cells: words("ids, cells and references") - spheres.len() - listed }
}

struct Built {
    input: Spheres,
    margin: f32,
    of: BuiltGrid,
}

impl Built {
    fn new(input: Spheres) -> Self {
        let ids: Vec<u32> = (0..input.len() as u32).collect();
        let margin = SceneStatistics::of(&input).margin();
        let of = build_grid(&input, &ids, margin, budget(&input));
        Self { input, margin, of }
    }

    fn check(&self) -> Result<(), GridError> {
        self.of.grid.validate(&self.of.spheres, &self.of.ids, &self.input, self.margin)
    }

    /// The first word of the first level that the predicate holds for.
    fn find(&self, is_it: impl Fn(&Self, usize, u32) -> bool) -> usize {
        let cells = &self.of.grid.cells[..self.of.grid.first_level_len()];
        (0..cells.len()).find(|i| is_it(self, *i, cells[*i])).unwrap()
    }

    /// The elements of a cell's list, some of which may repeat the last one.
    fn list(&self, cell: usize) -> std::ops::Range<usize> {
        let start = (self.of.grid.cells[cell] & !KIND) as usize;
        let is_last = |at: &usize| self.of.grid.references[*at] >> 31 == 1;
        start..(start..).find(is_last).unwrap() + 1
    }

    /// The first cell whose list has so many spheres or more.
    fn cell_with(&self, len: usize) -> usize {
        self.find(|built, cell, word| {
            word & KIND == LIST && {
                let list = &built.of.grid.references[built.list(cell)];
                let last = list[list.len() - 1] << 1;
                let others = list.iter().filter(|reference| **reference << 1 != last).count();
                others + 1 >= len
            }
        })
    }

    fn mark(&mut self, at: usize, is_last: bool) {
        let mark = |word: &mut u32| *word = *word << 1 >> 1 | u32::from(is_last) << 31;
        mark(&mut self.of.grid.references[at]);
        mark(&mut self.of.grid.balls[at]);
    }
}

/// Crowds, for grids inside cells, and spheres in a corner, for lists in the first level and empty cells around.
fn mixed() -> Spheres {
    let mut spheres = spheres::clusters(10, 400);
    spheres.extend(spheres::scaled(&spheres::random(1_500, 21, |_| 0.03), 40.0));
    spheres
}

#[test]
fn every_scene_has_a_grid_that_a_kernel_may_walk() {
    let scenes = [
        ("one", vec![[1.0, 2.0, 3.0, 0.5]]),
        ("random", spheres::random(5_000, 1, |_| 0.01)),
        // More cells than one task makes.
        ("many", spheres::random(60_000, 2, |_| 0.004)),
        ("many crowds", spheres::clusters(40, 1_000)),
        ("sparse", spheres::random(5_000, 3, |_| 0.001)),
        ("four decades", spheres::four_decades(3_000)),
        ("coincident", spheres::coincident(20_000)),
        ("concentric", spheres::concentric(500)),
        ("twice", spheres::twice(2_000)),
        ("line", spheres::line(1_000)),
        ("nested", spheres::nested(300)),
        ("geometric", spheres::geometric(1_000)),
        ("lattice", spheres::lattice(16)),
        ("one around all", spheres::one_around_all(3_000)),
        ("clusters", spheres::clusters(20, 300)),
        ("mixed", mixed()),
        ("far", spheres::far(2_000)),
        ("flat", spheres::flat(3_000)),
        ("needle", spheres::needle(3_000)),
        ("outlier", spheres::outlier(3_000)),
        ("long", spheres::scaled(&spheres::four_decades(1_000), 2_f32.powi(50))),
        ("short", spheres::scaled(&spheres::four_decades(1_000), 2_f32.powi(-50))),
    ];
    let mut nested = 0;
    for (name, input) in scenes {
        let built = Built::new(input.clone());
        let Grid { cells, references, .. } = &built.of.grid;
        built.check().unwrap_or_else(|error| panic!("{name}: {error}"));
        let budget = budget(&input);
        let listed = references.len();
        assert!(cells.len() <= budget.cells, "{name}: {} cells", cells.len());
        assert!(listed <= budget.listed, "{name}: {listed} listed");
        if name == "coincident" {
            let longest = built.of.grid.statistics().longest_list;
            assert!(longest <= 32, "{longest} of the same in one list");
        }
        nested += built.of.grid.statistics().grids;
    }
    assert!(nested > 0, "no scene has grids inside cells");
}

/// A damage, and whether the check said of it what it should.
type Damage = (&'static str, fn(&mut Built), fn(GridError) -> bool);

const DAMAGES: &[Damage] = &[
    ("no size", |built| built.of.grid.cell_size = 0.0, |error| matches!(error, GridError::Shape)),
    (
        "a cell more than there are words",
        |built| built.of.grid.cell_counts[0] *= 1 << 12,
        |error| matches!(error, GridError::Shape),
    ),
    (
        "cells moved by a tenth of one",
        |built| built.of.grid.min.x += 0.1 * built.of.grid.cell_size,
        |error| matches!(error, GridError::Missing { .. } | GridError::Outside { .. }),
    ),
    (
        "a kind that does not exist",
        |built| built.of.grid.cells[0] |= KIND,
        |error| matches!(error, GridError::Kind { cell: 0 }),
    ),
    (
        "a level of none",
        |built| {
            let cell = built.find(|_, _, word| word & KIND == GRID);
            built.of.grid.cells[cell] &= !(7 << 27);
        },
        |error| matches!(error, GridError::Level { level: 0, .. }),
    ),
    (
        "a level too high",
        |built| {
            let cell = built.find(|_, _, word| word & KIND == GRID);
            built.of.grid.cells[cell] |= 7 << 27;
        },
        |error| matches!(error, GridError::Level { level: 7, .. }),
    ),
    (
        "a grid one unit farther",
        |built| {
            let cell = built.find(|_, _, word| word & KIND == GRID);
            built.of.grid.cells[cell] += 1;
        },
        |error| matches!(error, GridError::Link { .. }),
    ),
    (
        "a grid in the first level",
        |built| {
            let cell = built.find(|_, _, word| word & KIND == GRID);
            built.of.grid.cells[cell] &= !0x07ff_ffff;
        },
        |error| matches!(error, GridError::Link { .. }),
    ),
    (
        "grids exchanged",
        |built| {
            let first = built.find(|_, _, word| word & KIND == GRID);
            let level = |word: u32| word >> 27;
            let other = built.find(|built, cell, word| {
                cell > first && level(word) == level(built.of.grid.cells[first])
            });
            built.of.grid.cells.swap(first, other);
        },
        |error| matches!(error, GridError::Missing { .. }),
    ),
    (
        "a reach inside a grid",
        |built| {
            let first_level = built.of.grid.first_level_len().next_multiple_of(8);
            let cells = &mut built.of.grid.cells;
            let inner = (first_level..cells.len()).find(|cell| cells[*cell] == EMPTY).unwrap();
            cells[inner] = 1;
        },
        |error| matches!(error, GridError::Kind { .. }),
    ),
    (
        "a list beyond the arrays",
        |built| {
            let cell = built.cell_with(1);
            built.of.grid.cells[cell] = LIST | (KIND - 1) & !KIND;
        },
        |error| matches!(error, GridError::List { .. }),
    ),
    (
        "a first element dropped",
        |built| {
            let cell = built.cell_with(2);
            built.of.grid.cells[cell] += 1;
        },
        |error| matches!(error, GridError::Missing { .. } | GridError::List { .. }),
    ),
    (
        "a last element dropped",
        |built| {
            let cell = built.cell_with(2);
            let end = built.list(cell).end;
            built.mark(end - 2, true);
        },
        |error| matches!(error, GridError::Missing { .. } | GridError::List { .. }),
    ),
    (
        "an end mark cleared",
        |built| {
            let cell = built.cell_with(1);
            let end = built.list(cell).end;
            built.mark(end - 1, false);
        },
        |error| matches!(error, GridError::List { .. } | GridError::Order { .. }),
    ),
    (
        "the last end mark cleared",
        |built| {
            let listed = built.of.grid.references.len();
            built.mark(listed - 1, false);
        },
        |error| matches!(error, GridError::List { .. }),
    ),
    (
        "a list out of order",
        |built| {
            let cell = built.cell_with(3);
            let start = built.list(cell).start;
            built.of.grid.references.swap(start, start + 1);
        },
        |error| matches!(error, GridError::Order { .. }),
    ),
    (
        "ids exchanged",
        |built| {
            built.of.ids.swap(0, 1);
        },
        |error| matches!(error, GridError::Sphere { shape_index: 0 }),
    ),
    (
        "an id that does not exist",
        |built| built.of.ids[3] = u32::MAX,
        |error| matches!(error, GridError::Sphere { shape_index: 3 }),
    ),
    (
        "a sphere that moved",
        |built| built.of.spheres[5][1] += 0.5,
        |error| matches!(error, GridError::Sphere { shape_index: 5 }),
    ),
    (
        "an id too few",
        |built| {
            built.of.ids.pop();
        },
        |error| matches!(error, GridError::Sphere { .. }),
    ),
    (
        "a list emptied",
        |built| {
            let cell = built.cell_with(1);
            built.of.grid.cells[cell] = EMPTY;
        },
        |error| matches!(error, GridError::Missing { .. } | GridError::Reach { .. }),
    ),
    (
        "a reach one too large",
        |built| {
            // Of the first octant.
            let cell =
                built.find(|_, _, word| word & KIND == EMPTY && (1..7).contains(&(word & 7)));
            built.of.grid.cells[cell] += 1;
        },
        |error| matches!(error, GridError::Reach { .. }),
    ),
    (
        "a reach of nearly everything",
        |built| {
            let cell = built.find(|_, _, word| word & KIND == EMPTY);
            built.of.grid.cells[cell] = LIST - 1;
        },
        |error| matches!(error, GridError::Reach { .. }),
    ),
    (
        "a list in a cell that is empty",
        |built| {
            // A cell's list is moved to one that should have none.
            let full = built.cell_with(1);
            let empty = built.find(|_, cell, word| cell > full && word & KIND == EMPTY);
            built.of.grid.cells[empty] = built.of.grid.cells[full];
            built.of.grid.cells[full] = EMPTY;
        },
        |error| !matches!(error, GridError::List { .. }),
    ),
];

#[test]
fn planted_damage_is_found() {
    for (name, damage, is_right) in DAMAGES {
        let mut built = Built::new(mixed());
        built.check().unwrap();
        damage(&mut built);
        match built.check() {
            Err(error) => assert!(is_right(error), "{name}: {error:?}"),
            Ok(()) => panic!("{name}: not found"),
        }
    }
}

/// A damage of balls, for the elements of a list of five spheres, of which the last three repeat the fifth.
type BallDamage = (&'static str, fn(&mut [u32]), fn(GridError) -> bool);

const BALL_DAMAGES: &[BallDamage] = &[
    (
        "a radius two steps smaller",
        |balls| balls[1] -= 2 << 24,
        |error| matches!(error, GridError::Ball { .. }),
    ),
    (
        "a ball of another sphere",
        |balls| balls[0] = balls[1],
        |error| matches!(error, GridError::Ball { .. }),
    ),
    (
        "a ball that repeats the last, but is elsewhere",
        |balls| balls[5] ^= 1 << 7,
        |error| matches!(error, GridError::Ball { .. }),
    ),
    (
        "an end mark too early",
        |balls| balls[3] |= 1 << 31,
        |error| matches!(error, GridError::List { .. }),
    ),
    ("no end mark", |balls| balls[7] <<= 1, |error| matches!(error, GridError::List { .. })),
];

#[test]
fn planted_damage_of_balls_is_found() {
    for (name, damage, is_right) in BALL_DAMAGES {
        let mut built = Built::new(mixed());
        let cell = (0..built.of.grid.first_level_len())
            .find(|cell| {
                let word = built.of.grid.cells[*cell];
                let list = if word & KIND == LIST { built.list(*cell) } else { 0..0 };
                let references = &built.of.grid.references[list];
                references.len() == 8 && references[4..7].iter().all(|of| *of == references[4])
            })
            .unwrap();
        let list = built.list(cell);
        damage(&mut built.of.grid.balls[list]);
        match built.check() {
            Err(error) => assert!(is_right(error), "{name}: {error:?}"),
            Ok(()) => panic!("{name}: not found"),
        }
    }
    let mut built = Built::new(mixed());
    built.of.grid.balls.pop();
    assert_eq!(built.check(), Err(GridError::Shape));
}

/// A budget is kept however little it leaves for grids inside cells, or for spheres in step with the cells.
#[test]
fn a_tight_budget_is_kept() {
    let scenes = [mixed(), spheres::clusters(20, 300), spheres::lattice(16), spheres::twice(2_000)];
    for input in scenes {
        let ids: Vec<u32> = (0..input.len() as u32).collect();
        let margin = SceneStatistics::of(&input).margin();
        for (listed, cells) in [(1, 2), (2, 2), (3, 2), (4, 2), (4, 4), (8, 1), (16, 8)] {
            let count = input.len();
            let budget = GridBudget { listed: count * listed, cells: count * cells / 2 };
            let BuiltGrid { grid, spheres, ids } = build_grid(&input, &ids, margin, budget);
            grid.validate(&spheres, &ids, &input, margin).unwrap();
            let found = grid.references.len();
            assert!(found <= budget.listed, "{found} listed, {budget:?}");
            assert!(grid.cells.len() <= budget.cells, "{} cells, {budget:?}", grid.cells.len());
        }
    }
}

/// Spheres at the corners of cells: each is listed in eight, where one or two were expected. The size of cells
/// that fits best is then too small.
#[test]
fn a_budget_is_kept_for_spheres_in_step_with_the_cells() {
    let input = spheres::cubic(17);
    let (count, margin) = (input.len(), SceneStatistics::of(&input).margin());
    let ids: Vec<u32> = (0..count as u32).collect();
    // 16 cells along an axis are the most that fit, with the tenth that the builder keeps back.
    let budget = GridBudget { listed: 3 * count, cells: 16 * 16 * 16 * 10 / 9 + 16 };
    let BuiltGrid { grid, spheres, ids } = build_grid(&input, &ids, margin, budget);
    grid.validate(&spheres, &ids, &input, margin).unwrap();
    let listed = grid.references.len();
    assert!(listed <= budget.listed, "{listed} listed");
    assert!(grid.cells.len() <= budget.cells, "{} cells", grid.cells.len());
}

/// What `SceneStatistics::margin` derives: 2⁻¹⁷ of the diagonal, and two neighbours in f32 of the farthest
/// coordinate.
#[test]
fn the_margin_is_what_rounding_needs() {
    for input in [mixed(), spheres::far(2_000), vec![[1e7, 0.0, 0.0, 1e-2]]] {
        let statistics = SceneStatistics::of(&input);
        let margin = f64::from(statistics.margin());
        let diagonal = f64::from((statistics.max - statistics.min).length());
        assert!(margin >= diagonal / 131_073.0, "{margin}");
        let farthest = statistics.min.abs().max(statistics.max.abs()).max_element();
        assert!(margin >= f64::from(farthest) / 4_194_305.0, "{margin}");
    }
}

/// A budget that no grid fits into gives the least grid, and no spheres give one without lists.
#[test]
fn the_least_grid_is_built_whatever_the_budget() {
    let none = GridBudget { listed: 0, cells: 0 };
    let spheres: Vec<[f32; 4]> = (0..100).map(|i| [i as f32, 0.0, 0.0, 0.6]).collect();
    for ids in [&[][..], &[7], &[1, 5, 99]] {
        let built = build_grid(&spheres, ids, 0.01, none);
        assert_eq!(built.grid.cell_counts, [1; 3]);
        assert_eq!(built.ids.len(), ids.len());
    }
}
