//! Notes about several pictures.

use std::collections::HashSet;

use crate::speak::tell;

/// Notes that were told, each of them once.
pub(crate) struct Notes {
    told: HashSet<String>,
    quiet: bool,
}

impl Notes {
    pub(super) fn new(quiet: bool) -> Self {
        Self { told: HashSet::new(), quiet }
    }

    pub(crate) fn tell(&mut self, note: String) {
        if !self.quiet && !self.told.contains(&note) {
            tell(format_args!("note: {note}"));
            self.told.insert(note);
        }
    }
}
