//! Colours of data that gives none, but says of what kinds its spheres are.

use super::ColorBy;
use crate::load::Loaded;

/// Names of the columns of kinds, of which the first is taken.
const KINDS: [&str; 2] = ["species", "type"];

/// More kinds than this cannot be told apart by colour.
const MOST_KINDS: usize = 32;

impl ColorBy {
    /// Colours by the kinds of spheres that have no colours: by the column `species` or else `type`, if it is text, and
    /// there are from 2 to 32 kinds to tell apart. `None` if the data gives colours or says no kinds.
    #[must_use]
    pub fn of_kinds(loaded: &Loaded) -> Option<Self> {
        if loaded.colors.is_some() {
            return None;
        }
        let are_kinds = |name: &&str| {
            loaded.labels(name).is_some_and(|labels| (2..=MOST_KINDS).contains(&labels.names.len()))
        };
        KINDS.into_iter().find(are_kinds).map(Self::column)
    }
}
