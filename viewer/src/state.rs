//! The state of the window: flags of `pinhole render`, and the size of the picture.

use pinhole_cli::viewing::{RenderFlags, ViewError};

use crate::worker::Request;

/// The flags of a view, without the size of the picture, and the sizes of the window and of the saved picture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    /// All flags except `--size`.
    pub(crate) flags: RenderFlags,
    /// The number of this state, which every change increases.
    pub(crate) number: u64,
    pub(crate) window: [u32; 2],
    /// The size of the saved picture, if it differs from that in the window.
    pub(crate) size: Option<[u32; 2]>,
    pub(crate) output: String,
}

impl State {
    pub(crate) fn new(mut flags: RenderFlags) -> Self {
        let size = flags.get("size").and_then(sides);
        flags.remove("size");
        let path = std::path::Path::new(flags.path());
        let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
        // `4hhb.pdb.gz` becomes `4hhb.png`.
        let stem = stem.split('.').find(|part| !part.is_empty()).unwrap_or("picture").to_owned();
        Self { flags, number: 1, window: [800, 600], size, output: format!("{stem}.png") }
    }

    pub(crate) fn saved_size(&self) -> [u32; 2] {
        self.size.unwrap_or(self.window)
    }

    /// Changes the flags if the result is valid. Returns whether something changed.
    pub(crate) fn change(&mut self, change: impl FnOnce(&mut RenderFlags)) -> Result<bool, ViewError> {
        let mut flags = self.flags.clone();
        change(&mut flags);
        if flags == self.flags {
            return Ok(false);
        }
        flags.check()?;
        self.flags = flags;
        self.number += 1;
        Ok(true)
    }

    /// Fits the picture in the window to a size. Returns whether the size changed.
    pub(crate) fn resize(&mut self, window: [u32; 2]) -> bool {
        let is_new = self.window != window;
        self.window = window;
        self.number += u64::from(is_new);
        is_new
    }

    fn sized(&self, size: [u32; 2]) -> RenderFlags {
        let mut flags = self.flags.clone();
        if flags.get("half-extent").is_some()
            && let Ok(Some(mut camera)) = flags.camera()
        {
            camera.set_aspect(f64::from(size[0]) / f64::from(size[1]));
            camera.write_to(&mut flags);
        }
        flags.set("size", &format!("{}x{}", size[0], size[1]));
        flags
    }

    pub(crate) fn request(&self, still: bool) -> Request {
        Request { state: self.number, flags: self.sized(self.window), still }
    }

    pub(crate) fn saved(&self) -> RenderFlags {
        self.sized(self.saved_size())
    }

    pub(crate) fn command(&self) -> String {
        self.saved().command_line(&self.output)
    }
}

pub(crate) fn sides(text: &str) -> Option<[u32; 2]> {
    pinhole_figure::settings::size_of(text).ok()
}

/// Texts that the user types, before they become flags.
pub(crate) struct Fields {
    pub(crate) select: String,
    pub(crate) range: String,
    pub(crate) background: String,
    /// Further flags, written as on a command line.
    pub(crate) others: String,
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Whether the window closes after it has saved a picture.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn state(words: &[&str]) -> State {
        State::new(RenderFlags::parse(words).unwrap())
    }

    #[test]
    fn a_command_makes_the_same_state() {
        let words = ["4hhb.pdb.gz", "--style=path", "--eye=1,2,3.25", "--look-at=0,0,0", "--up=0,1,0", "--size=90x60"];
        let first = state(&words);
        assert_eq!((first.saved_size(), first.output.as_str()), ([90, 60], "4hhb.png"));
        let again = State::new(RenderFlags::parse(first.saved().words()).unwrap());
        assert_eq!(again, first);
        assert!(first.command().ends_with("--size=90x60 -o 4hhb.png"), "{}", first.command());
    }

    #[test]
    fn changes_count_only_if_they_change_something() {
        let mut state = state(&["a.pdb"]);
        assert!(state.change(|flags| flags.set("style", "path")).unwrap());
        assert!(!state.change(|flags| flags.set("style", "path")).unwrap());
        state.change(|flags| flags.set("style", "none")).unwrap_err();
        assert_eq!((state.flags.get("style"), state.number), (Some("path"), 2));
        assert!(state.resize([9, 9]) && !state.resize([9, 9]));
        assert_eq!(state.request(true).flags.get("size"), Some("9x9"));
    }

    /// A picture with another aspect ratio shows the same height.
    #[test]
    fn a_view_plane_is_not_stretched() {
        let mut state =
            state(&["a.pdb", "--camera=orthographic", "--eye=0,0,9", "--look-at=0,0,0", "--half-extent=4,3"]);
        state.resize([100, 100]);
        assert_eq!(state.request(true).flags.get("half-extent"), Some("3,3"));
        state.size = Some([200, 100]);
        assert_eq!(state.saved().get("half-extent"), Some("6,3"));
    }
}
