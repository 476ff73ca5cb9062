//! What all frames of a file are together: what the camera frames, and what colors mean.

use super::frame::frame;
use super::numbers::Numbers;
use super::union::{Union, scene_of};
use crate::failure::Failure;
use crate::input::Source;
use crate::progress;
use pinhole::color_by::{ColorBy, JoinedKeys};
use pinhole::scene::{Scene, SceneError};

/// What was found in all frames. It is kept in the folder of a job, so that no part reads all of them again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Overview {
    /// Spheres that reach as far as those of all frames, each x, y, z, radius.
    pub(crate) spheres: Vec<[f64; 4]>,
    /// How many of them, at the end, were added to the data.
    pub(crate) added: usize,
    /// What colors mean.
    pub(crate) colors: JoinedKeys,
    /// The frame whose kinds have colors that no flag asked for.
    pub(crate) kinds_from: Option<usize>,
    /// These colors, if they are known.
    kinds: Option<ColorBy>,
}

impl Overview {
    /// What was found before, without the colors by kind, which are read again from their frame.
    pub(crate) fn stored(
        spheres: Vec<[f64; 4]>,
        added: usize,
        colors: JoinedKeys,
        kinds_from: Option<usize>,
    ) -> Self {
        Self { spheres, added, colors, kinds_from, kinds: None }
    }

    /// Reads all frames that the camera frames.
    pub(super) fn of(source: &mut Source, numbers: &Numbers) -> Result<Self, Failure> {
        let framed = numbers.framed.as_ref().unwrap_or(&numbers.all);
        let (mut union, mut overview) = (Union::default(), Self::default());
        for (index, &number) in framed.iter().enumerate() {
            progress::frames(format!("looking at frame {} of {}", index + 1, framed.len()));
            let contents = frame(source, number)?;
            contents.color_key().into_iter().for_each(|key| overview.colors.add(key));
            if let (None, Some(kinds)) = (&overview.kinds, contents.kinds()) {
                (overview.kinds, overview.kinds_from) = (Some(kinds.clone()), Some(number));
            }
            union.add(&contents.scene);
        }
        (overview.spheres, overview.added) = union.into_spheres();
        Ok(overview)
    }

    /// The colors by kind that no flag asked for.
    pub(super) fn kinds(&self, source: &mut Source) -> Result<Option<ColorBy>, Failure> {
        match (&self.kinds, self.kinds_from) {
            (None, Some(number)) => Ok(frame(source, number)?.kinds().cloned()),
            (kinds, _) => Ok(kinds.clone()),
        }
    }

    /// The spheres as a scene, which the camera frames.
    pub(super) fn scene(&self) -> Result<Scene, SceneError> {
        scene_of(&self.spheres, self.added)
    }
}
