//! Faults of shaders that the checker must find. Each changes a picture, but by little more than necessary.

mod hits;
mod rays;
mod search;

use pinhole::accel::AccelChoice;

use crate::support::View;

/// A shader edit that is a fault, with a view in which it is visible.
pub(crate) struct Fault {
    pub(crate) name: &'static str,
    pub(crate) view: fn() -> View,
    pub(crate) how: How,
    pub(crate) file: &'static str,
    pub(crate) find: &'static str,
    pub(crate) replace: &'static str,
}

/// The structure in which a fault is tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct How {
    pub(crate) choice: AccelChoice,
    pub(crate) binding_bytes: u64,
}

const fn how(choice: AccelChoice) -> How {
    How { choice, binding_bytes: 1 << 27 }
}

pub(crate) const LIST: How = how(AccelChoice::List);
const GRID: How = how(AccelChoice::Grid);
const TREE: How = how(AccelChoice::Tree);
/// A size of bindings so small that there are several bricks.
pub(crate) const BRICKS: How = How { binding_bytes: 16 * 100, ..LIST };

type Row = (&'static str, fn() -> View, How, &'static str, &'static str, &'static str);

pub(crate) fn all() -> Vec<Fault> {
    [
        rays::CAMERA,
        rays::OTHER_CAMERAS,
        rays::ENTRY,
        hits::SPHERE,
        hits::SHADE,
        search::TIES,
        search::GRIDS,
        search::TREES,
        search::SCHEDULE,
    ]
    .into_iter()
    .flatten()
    .map(|&(name, view, how, file, find, replace)| Fault { name, view, how, file, find, replace })
    .collect()
}
