//! Counting what a walk does, on the CPU: the twins of the kernels take the same steps.

use super::brick::{Accel, Brick, Index};
use super::query::{Nearest, RayF32};

/// Is told what a walk does. What a walk tells `()` costs nothing.
pub(super) trait Observer {
    /// A cell or a node is visited.
    fn step(&mut self) {}

    /// The elements of a cell's list are looked at.
    fn elements(&mut self, _count: usize) {}

    /// A sphere is tested.
    fn sphere(&mut self) {}
}

impl Observer for () {}

/// What a ray does, or how many of each all counted rays did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Counts {
    /// Steps from cell to cell in a grid, on both levels, or visits of a tree's nodes.
    pub steps: f64,
    /// Elements of cells' lists, with those that fill a list up to whole vectors. None in trees.
    pub elements: f64,
    /// Tests of a sphere. In a grid whose lists refer to spheres, as many as elements; in a grid with balls, those whose
    /// balls are met; in a tree, those in leaves whose boxes are met.
    pub spheres: f64,
}

impl Counts {
    /// All numbers times a factor, for example to divide by the number of rays.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        let Self { steps, elements, spheres } = self;
        Self { steps: steps * factor, elements: elements * factor, spheres: spheres * factor }
    }

    /// The sum of both.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            steps: self.steps + other.steps,
            elements: self.elements + other.elements,
            spheres: self.spheres + other.spheres,
        }
    }
}

impl Observer for Counts {
    fn step(&mut self) {
        self.steps += 1.0;
    }

    fn elements(&mut self, count: usize) {
        self.elements += count as f64;
    }

    fn sphere(&mut self) {
        self.spheres += 1.0;
    }
}

impl Accel {
    /// Finds the nearest sphere like [`Accel::find_nearest`], and adds what the walks of all bricks did to `counts`.
    /// Nothing is counted in binary trees, and with ray queries only the spheres of the host's search.
    pub fn count_nearest(&self, ray: &RayF32, counts: &mut Counts) -> Nearest {
        let mut nearest = Nearest::NONE;
        for Brick { index, spheres, ids } in self.bricks() {
            match index {
                Index::Grid(grid) => {
                    grid.find_nearest_observed(spheres, ids, ray, &mut nearest, counts);
                }
                Index::WideTree(tree) => {
                    tree.find_nearest_observed(spheres, ids, ray, &mut nearest, counts);
                }
                Index::List | Index::RayQuery(_) => {
                    counts.spheres += spheres.len() as f64;
                    super::list::find_nearest(spheres, ids, ray, &mut nearest);
                }
                Index::BinaryTree(tree) => tree.find_nearest(spheres, ids, ray, &mut nearest),
            }
        }
        nearest
    }
}
