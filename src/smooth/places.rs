//! The spheres of a scene, and where they are.

use super::cells::Cells;
use super::levels::Levels;

/// The spheres of a scene in cells and, as far as light needs them one by one, by size and place.
#[derive(Debug)]
pub(super) struct Places<'a> {
    pub(super) spheres: &'a [[f32; 4]],
    pub(super) cells: Cells,
    pub(super) levels: Levels,
}

impl<'a> Places<'a> {
    pub(super) fn new(spheres: &'a [[f32; 4]], needs_levels: impl Fn(&Cells) -> bool) -> Self {
        let cells = Cells::new(spheres);
        let sorted = if needs_levels(&cells) { spheres } else { &[] };
        Self { spheres, levels: Levels::new(&cells, sorted), cells }
    }
}
