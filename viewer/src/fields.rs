//! What the user types.

use crate::state::State;

/// What the user types, until it becomes a flag.
pub(crate) struct Fields {
    pub(crate) select: String,
    pub(crate) range: String,
    pub(crate) background: String,
    /// Any flags, as on a command line.
    pub(crate) others: String,
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Whether the window closes when it has saved a picture.
    pub(crate) closes: bool,
}

impl Fields {
    pub(crate) fn of(state: &State) -> Self {
        let text = |name| state.flags.get(name).unwrap_or_default().to_owned();
        let [width, height] = state.size.unwrap_or([1600, 1200]);
        Self {
            select: text("select"),
            range: text("range"),
            background: text("background"),
            others: String::new(),
            width,
            height,
            closes: false,
        }
    }
}
