//! Styles: named sets of a scene file's tables about light, with values that are chosen from the data.
//!
//! Each style is one commented file `src/style/NAME.toml`, which [`SceneFile`](crate::scene_file::SceneFile) reads where
//! a scene names it with `style = "NAME"`. What such a file cannot say, because it depends on the spheres and the
//! camera, is chosen in one place: `fit.rs`.

mod fit;

pub(crate) use fit::{Given, fit};

/// A named look of a picture: everything about light, lines and the background.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Style {
    /// Soft light without cast shadows, ambient occlusion and thin lines: the style of data files.
    #[default]
    Default,
    /// One ray for each pixel, lit from the eye.
    Fast,
    /// Colours without light, with lines.
    Flat,
    /// Soft shadows and smooth ambient occlusion.
    Studio,
    /// Bright colours and strong lines, as a textbook draws.
    Illustration,
    /// Path tracing under a soft sky and a sun, over a ground.
    Path,
}

impl Style {
    /// All styles.
    pub const ALL: &'static [Self] =
        &[Self::Default, Self::Fast, Self::Flat, Self::Studio, Self::Illustration, Self::Path];

    /// The name in scene files and flags.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Fast => "fast",
            Self::Flat => "flat",
            Self::Studio => "studio",
            Self::Illustration => "illustration",
            Self::Path => "path",
        }
    }

    /// The style of a name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|style| style.name() == name)
    }

    /// The tables of the style, as the text of a scene file.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Default => include_str!("default.toml"),
            Self::Fast => include_str!("fast.toml"),
            Self::Flat => include_str!("flat.toml"),
            Self::Studio => include_str!("studio.toml"),
            Self::Illustration => include_str!("illustration.toml"),
            Self::Path => include_str!("path.toml"),
        }
    }
}
