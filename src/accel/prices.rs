//! Prices: how long a device takes for each thing that a ray does in a structure, and to build and copy the structure.

use super::brick::Structure;
use super::count::Counts;
use super::grid::ListLayout;

/// The prices of a device, in nanoseconds. Those of steps and tests are for one ray while all of the device is busy: the
/// time of a picture divided by the number of its rays.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Prices {
    /// Prices of grids whose lists refer to spheres.
    pub references: StructurePrices,
    /// Prices of grids whose lists have balls.
    pub balls: StructurePrices,
    /// Prices of the 8-wide tree.
    pub tree: StructurePrices,
    /// The time to copy a byte to the device.
    pub upload_byte: f64,
}

/// The prices of a structure, in nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct StructurePrices {
    /// The time of a ray apart from what it does in the structure.
    pub ray: f64,
    /// A step from cell to cell, or the visit of a node.
    pub step: f64,
    /// Looking at an element of a list: a quarter of a vector of balls. References are not looked at without a test of
    /// the sphere, whose price includes this.
    pub element: f64,
    /// The test of a sphere.
    pub sphere: f64,
    /// Building, for each sphere, on the host.
    pub build: f64,
}

impl StructurePrices {
    /// The time of a ray that does what was counted, in nanoseconds.
    #[must_use]
    pub fn of_ray(&self, counts: &Counts) -> f64 {
        let Counts { steps, elements, spheres } = counts;
        self.ray + self.step * steps + self.element * elements + self.sphere * spheres
    }

    /// These prices for a device on which tracing and building take other times by these factors.
    #[must_use]
    pub fn scaled(&self, tracing: f64, building: f64) -> Self {
        Self {
            ray: self.ray * tracing,
            step: self.step * tracing,
            element: self.element * tracing,
            sphere: self.sphere * tracing,
            build: self.build * building,
        }
    }
}

impl Prices {
    /// Prices of software devices, fitted to measurements with Mesa's lavapipe on two cores; `docs/performance.md` has
    /// both.
    pub const SOFTWARE: Self = Self {
        references: StructurePrices {
            ray: 16.0,
            step: 6.0,
            element: 0.0,
            sphere: 3.4,
            build: 132.0,
        },
        balls: StructurePrices { ray: 10.0, step: 5.0, element: 2.1, sphere: 6.4, build: 152.0 },
        tree: StructurePrices { ray: 13.0, step: 17.0, element: 0.0, sphere: 3.4, build: 155.0 },
        upload_byte: 0.28,
    };

    /// Prices of GPUs. No GPU has been measured: they are predictions for a large one, from the instructions of the
    /// kernels (32 for a step from cell to cell, 67 for the test of a sphere, 240 for a node) at 16,896 lanes of 1.7 GHz
    /// that issue two fifths of the time, of which divergence leaves half. Only their ratios decide, and the host
    /// builds, so that a smaller GPU chooses the same for many rays.
    pub const GPU: Self = Self {
        references: StructurePrices {
            ray: 0.01,
            step: 0.006,
            element: 0.0,
            sphere: 0.012,
            build: Self::SOFTWARE.references.build,
        },
        balls: StructurePrices {
            ray: 0.01,
            step: 0.009,
            element: 0.004,
            sphere: 0.015,
            build: Self::SOFTWARE.balls.build,
        },
        tree: StructurePrices {
            ray: 0.01,
            step: 0.042,
            element: 0.0,
            sphere: 0.012,
            build: Self::SOFTWARE.tree.build,
        },
        upload_byte: 0.1,
    };

    /// The prices of a structure; `None` for those that are only built if they are asked for.
    #[must_use]
    pub const fn of(&self, structure: Structure) -> Option<&StructurePrices> {
        match structure {
            Structure::Grid(ListLayout::Referenced)
            | Structure::NestedGrid(ListLayout::Referenced) => Some(&self.references),
            Structure::Grid(ListLayout::Balls) | Structure::NestedGrid(ListLayout::Balls) => {
                Some(&self.balls)
            }
            Structure::WideTree => Some(&self.tree),
            Structure::List | Structure::BinaryTree | Structure::RayQuery => None,
        }
    }
}

/// A structure that could be built for a scene, with what it is expected to cost.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Candidate {
    /// The structure.
    pub structure: Structure,
    /// What a ray is expected to do, as a mean over rays that meet the scene's box.
    pub expected: Counts,
    /// The time of a ray, in nanoseconds.
    pub ray: f64,
    /// The time to build the structure, in nanoseconds.
    pub build: f64,
    /// The time to copy it to the device, in nanoseconds.
    pub upload: f64,
}

impl Candidate {
    /// The time until a number of rays are traced, with building and copying, in nanoseconds.
    #[must_use]
    pub fn total(&self, rays: u64) -> f64 {
        self.build + self.upload + self.ray * rays as f64
    }

    fn words(&self) -> &'static str {
        match self.structure {
            Structure::Grid(ListLayout::Referenced)
            | Structure::NestedGrid(ListLayout::Referenced) => "a grid of references",
            Structure::Grid(ListLayout::Balls) | Structure::NestedGrid(ListLayout::Balls) => {
                "a grid with balls"
            }
            Structure::WideTree => "a tree",
            Structure::BinaryTree => "a binary tree",
            Structure::List => "a list",
            Structure::RayQuery => "ray queries",
        }
    }
}

/// The cheapest candidate, and a part of a sentence that says how much cheaper it is; `None` without candidates. For
/// [`u64::MAX`] rays only the time of a ray counts.
pub(super) fn cheapest(candidates: &[Candidate], rays: u64) -> Option<(Structure, String)> {
    let is_many = rays == u64::MAX;
    let cost = |candidate: &Candidate| if is_many { candidate.ray } else { candidate.total(rays) };
    let best = candidates.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
    let in_words = |candidate: &Candidate| {
        let cost = cost(candidate);
        if is_many { nanoseconds(cost) } else { format!("{:.0} ms", cost * 1e-6) }
    };
    let others: Vec<String> = candidates
        .iter()
        .filter(|candidate| candidate.structure != best.structure)
        .map(|other| format!("{} in {}", in_words(other), other.words()))
        .collect();
    let others = match &others[..] {
        [] => String::new(),
        [other] => format!(" and {other}"),
        [first @ .., last] => format!(", {} and {last}", first.join(", ")),
    };
    let what = if is_many {
        "for many pictures, a ray takes about".to_owned()
    } else {
        format!("building, copying and tracing {rays} rays take about")
    };
    Some((best.structure, format!("{what} {} in {}{others}", in_words(best), best.words())))
}

/// Nanoseconds with two digits or more.
fn nanoseconds(time: f64) -> String {
    if time < 1.0 {
        format!("{time:.2} ns")
    } else if time < 10.0 {
        format!("{time:.1} ns")
    } else {
        format!("{time:.0} ns")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(structure: Structure, build: f64, ray: f64) -> Candidate {
        let expected = Counts::default();
        Candidate { structure, expected, ray, build, upload: 1e6 }
    }

    #[test]
    fn few_rays_take_what_is_built_soon_and_many_what_is_traced_soon() {
        let candidates = [
            candidate(Structure::Grid(ListLayout::Referenced), 99e6, 60.0),
            candidate(Structure::Grid(ListLayout::Balls), 149e6, 40.0),
            candidate(Structure::WideTree, 299e6, 5.25),
        ];
        let chosen = |rays| cheapest(&candidates, rays).unwrap();
        assert_eq!(
            chosen(1_000_000),
            (
                Structure::Grid(ListLayout::Referenced),
                "building, copying and tracing 1000000 rays take about 160 ms in a grid of references, 190 ms in a \
                 grid with balls and 305 ms in a tree"
                    .to_owned()
            )
        );
        assert_eq!(chosen(3_000_000).0, Structure::Grid(ListLayout::Balls));
        assert_eq!(chosen(10_000_000).0, Structure::WideTree);
        assert_eq!(
            chosen(u64::MAX).1,
            "for many pictures, a ray takes about 5.2 ns in a tree, 60 ns in a grid of references and 40 ns in a grid \
             with balls"
        );
        assert_eq!(cheapest(&[], 1), None);
    }

    #[test]
    fn a_ray_costs_the_sum_of_what_it_does() {
        let prices = StructurePrices { ray: 1.0, step: 2.0, element: 3.0, sphere: 4.0, build: 5.0 };
        let counts = Counts { steps: 1.0, elements: 10.0, spheres: 100.0 };
        assert!((prices.of_ray(&counts) - 433.0).abs() < 1e-9);
        let scaled = prices.scaled(2.0, 3.0);
        assert!((scaled.of_ray(&counts) - 866.0).abs() < 1e-9);
        assert!((scaled.build - 15.0).abs() < 1e-9);
    }
}
