//! Cameras that move along a path.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result};
use pinhole::camera::{
    CameraMotion, CameraOnPath, CameraParameters, CameraPath, PathClock, PlaceOnPath,
};
use pinhole::color_by::ColorKey;
use pinhole::glam::DVec3;
use pinhole::light::environment::Environment;
use pinhole::scene::Scene;
use pinhole::scene_file::{SceneFile, parse_camera_path};
use serde::Deserialize;
use toml::Value;

use super::turn::up_of;
use super::union::around;
use crate::failure::Failure;
use crate::input::{Framed, Look, Source, read};

/// Most pictures of one scene along a path.
const MOST_PICTURES: usize = 100_000;

/// A camera path, and the file that has it.
#[derive(Clone, Debug)]
pub(super) struct WantedPath {
    pub(super) path: CameraPath,
    pub(super) file: PathBuf,
}

impl WantedPath {
    /// Reads a file that holds a camera path.
    pub(super) fn read(file: &Path) -> Result<Self, Failure> {
        let name = || file.display().to_string();
        let text = String::from_utf8(read(file)?).map_err(|_| {
            anyhow::anyhow!("{}: this is not UTF-8 text; a camera path is TOML text", name())
        })?;
        let path = parse_camera_path(&text).with_context(name)?;
        Ok(Self { path, file: file.to_path_buf() })
    }

    /// How many pictures there are of a scene that has no frames: those up to the last key.
    pub(super) fn count(&self, frames_per_second: u32) -> Result<usize, Failure> {
        let last = match self.path.clock() {
            PathClock::Frames => self.path.end(),
            // A second is a whole number of pictures up to rounding.
            PathClock::Seconds => self.path.end() * f64::from(frames_per_second) + 1e-6,
        };
        let count = last.max(0.0) as usize + 1;
        if count > MOST_PICTURES {
            return Err(Failure::usage(format!(
                "{}: a camera path has at most {MOST_PICTURES} pictures, but the last key is that of picture {}",
                self.file.display(),
                count - 1
            )));
        }
        Ok(count)
    }
}

/// A camera on its way, and what makes the light of each picture.
pub(super) struct Moving {
    motion: CameraMotion,
    clock: PathClock,
    frames_per_second: f64,
    /// The camera before it is moved, with its position.
    base: CameraParameters,
    /// The middle of what it frames, and how far from it the camera is.
    center: DVec3,
    distance: f64,
    /// What light and style are chosen for.
    framed: Scene,
    /// What the legend shows.
    key: Option<ColorKey>,
    file: Arc<SceneFile>,
    sky: Option<Environment>,
}

impl Moving {
    /// Prepares the motion around the spheres of `framed`.
    pub(super) fn new(
        source: &Source,
        wanted: &WantedPath,
        frames_per_second: u32,
        (framed, key): (Scene, Option<ColorKey>),
        file: Arc<SceneFile>,
        sky: Option<Environment>,
    ) -> Result<Self, Failure> {
        // From a distance at which every view fits.
        let whole = around(&framed).with_context(|| source.name())?;
        let base =
            source.look(&file, Framed::new(&whole, key.as_ref()), sky.clone(), None)?.parameters;
        let up = source.up().or_else(|| up_of(&base)).unwrap_or(DVec3::Y);
        let motion = wanted.path.motion(up);
        let motion = motion.with_context(|| wanted.file.display().to_string())?;
        let center = framed.bounds_to_frame().center();
        let distance = eye_of(&base).map_or(1.0, |eye| eye.distance(center));
        let clock = wanted.path.clock();
        let frames_per_second = f64::from(frames_per_second);
        Ok(Self {
            motion,
            clock,
            frames_per_second,
            base,
            center,
            distance,
            framed,
            key,
            file,
            sky,
        })
    }

    fn framed(&self) -> Framed<'_> {
        Framed::new(&self.framed, self.key.as_ref())
    }

    /// Makes the camera and the light of one picture: the frame with this number, which is the picture `index` of the
    /// movie.
    pub(super) fn view(
        &self,
        source: &Source,
        number: usize,
        index: usize,
    ) -> Result<Look, Failure> {
        let time = match self.clock {
            PathClock::Frames => number as f64,
            PathClock::Seconds => index as f64 / self.frames_per_second,
        };
        let on_path = self.motion.at(time);
        let moved = |_: &CameraParameters| {
            moved(&self.base, &on_path, self.center, self.distance)
                .context("the camera cannot follow its path")
        };
        let look = source.look(&self.file, self.framed(), self.sky.clone(), Some(&moved));
        let look = look.map_err(|failure| match failure {
            Failure::Job(error) => Failure::Job(error.context(format!("frame {number}"))),
            other => other,
        })?;
        Ok(look.without_view())
    }
}

/// The camera at a place of its path.
fn moved(
    camera: &CameraParameters,
    on_path: &CameraOnPath,
    center: DVec3,
    distance: f64,
) -> Result<CameraParameters> {
    let (eye, look_at, up) = match on_path.place {
        PlaceOnPath::Point { eye, look_at, up } => (eye, look_at, up),
        PlaceOnPath::View { direction, up } => (center - distance * direction, center, up),
    };
    let mut document = Value::try_from(camera)?;
    for (_, table) in document.as_table_mut().into_iter().flat_map(|kinds| kinds.iter_mut()) {
        let Some(table) = table.as_table_mut() else { continue };
        table.remove("direction");
        let list = |vector: DVec3| Value::from(vector.to_array().to_vec());
        let mut keys = vec![("eye", list(eye)), ("look_at", list(look_at)), ("up", list(up))];
        if let Some(radians) = on_path.fov_radians {
            keys.push(("vertical_fov", radians.to_degrees().into()));
        }
        if let Some(zoom) = on_path.zoom {
            keys.push(("zoom", zoom.into()));
        }
        table.extend(keys.into_iter().map(|(key, value)| (key.to_owned(), value)));
    }
    CameraParameters::deserialize(document)
        .map_err(|error| anyhow::anyhow!(error.message().trim().replace('\n', " ")))
}

/// The position of a camera that has one.
fn eye_of(camera: &CameraParameters) -> Option<DVec3> {
    let document = Value::try_from(camera).ok()?;
    let eye =
        document.as_table()?.values().find_map(|table| super::turn::vector(table.get("eye")?))?;
    Some(eye)
}
