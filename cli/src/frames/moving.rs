//! Cameras that move along a path or turn about an axis.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result};

use crate::flags::camera::{CameraTable, list};
use crate::input::{FramedScene, Look, Source, read};
use crate::terminal::failure::Failure;
use pinhole::camera::{CameraMotion, CameraOnPath, CameraParameters, CameraPath, PathClock, PlaceOnPath};
use pinhole::glam::{DQuat, DVec3};
use pinhole::light::environment::Environment;
use pinhole::scene::Scene;
use pinhole_figure::color_by::ColorKey;
use pinhole_figure::framing::around;
use pinhole_figure::scene_file::{SceneFile, parse_camera_path};

/// The most pictures of one scene along a path.
const MOST_PICTURES: usize = 100_000;

#[derive(Clone, Debug)]
pub(crate) struct PathRequest {
    pub(crate) path: CameraPath,
    pub(crate) file: PathBuf,
}

impl PathRequest {
    pub(crate) fn read(file: &Path) -> Result<Self, Failure> {
        let name = || file.display().to_string();
        let text = String::from_utf8(read(file)?)
            .map_err(|_| anyhow::anyhow!("{}: this is not UTF-8 text; a camera path is TOML text", name()))?;
        let path = parse_camera_path(&text).with_context(name)?;
        Ok(Self { path, file: file.to_path_buf() })
    }

    /// The number of pictures of a scene without frames: pictures up to the last key.
    pub(crate) fn count(&self, frames_per_second: u32) -> Result<usize, Failure> {
        let last = match self.path.clock() {
            PathClock::Frames => self.path.end(),
            // A second has a whole number of pictures, apart from rounding.
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

/// The scene that a moving camera sees, and the data from which the light of each picture is made.
pub(crate) struct Stage {
    /// The spheres that the camera frames, and for which light and style are chosen.
    pub(crate) framed: Scene,
    /// The meaning of colours for the legend.
    pub(crate) key: Option<ColorKey>,
    pub(crate) file: Arc<SceneFile>,
    pub(crate) sky: Option<Environment>,
}

/// A camera with another position in each picture.
pub(crate) struct MovingCamera {
    pub(crate) course: Course,
    pub(crate) stage: Stage,
}

#[expect(clippy::large_enum_variant, reason = "a job has one of them")]
pub(crate) enum Course {
    /// Turned about an axis, once around over all pictures.
    Turn { count: usize, axis: Axis },
    Path {
        motion: CameraMotion,
        clock: PathClock,
        frames_per_second: f64,
        /// The camera, with its position, before it moves.
        base: CameraParameters,
        /// The middle of the framed spheres, and the distance of the camera from it.
        center: DVec3,
        distance: f64,
    },
}

impl MovingCamera {
    /// Prepares the motion along a path around the spheres of a stage. `up` is the direction that is up, if it is not that of
    /// the camera.
    pub(crate) fn on_path(
        source: &Source,
        wanted: &PathRequest,
        frames_per_second: u32,
        stage: Stage,
        up: Option<DVec3>,
    ) -> Result<Self, Failure> {
        // The camera starts at a distance from which every view fits.
        let whole = around(&stage.framed).with_context(|| source.name())?;
        let framed = FramedScene::new(&whole, stage.key.as_ref());
        let base = source.look(&stage.file, framed, stage.sky.clone(), None)?.parameters;
        let up = up.or_else(|| up_of(&base)).unwrap_or(DVec3::Y);
        let motion = wanted.path.motion(up);
        let motion = motion.with_context(|| wanted.file.display().to_string())?;
        let center = stage.framed.bounds_to_frame().center();
        let eye = CameraTable::new(&base).and_then(|camera| camera.vector("eye"));
        let distance = eye.map_or(1.0, |eye| eye.distance(center));
        let (clock, frames_per_second) = (wanted.path.clock(), f64::from(frames_per_second));
        let course = Course::Path { motion, clock, frames_per_second, base, center, distance };
        Ok(Self { course, stage })
    }

    /// Makes the camera and the light of one picture. It shows the frame `number`, and is the picture `index` of the
    /// movie.
    pub(crate) fn view(&self, source: &Source, number: usize, index: usize) -> Result<Look, Failure> {
        let Stage { framed, key, file, sky } = &self.stage;
        let look = |moved: &dyn Fn(&CameraParameters) -> Result<CameraParameters>| {
            source.look(file, FramedScene::new(framed, key.as_ref()), sky.clone(), Some(moved))
        };
        match &self.course {
            Course::Turn { count, axis } => look(&|camera| turned(camera, *axis, number as f64 / *count as f64)),
            Course::Path { motion, clock, frames_per_second, base, center, distance } => {
                let on_path = motion.at(match clock {
                    PathClock::Frames => number as f64,
                    PathClock::Seconds => index as f64 / frames_per_second,
                });
                let moved = |_: &CameraParameters| {
                    moved(base, &on_path, *center, *distance).context("the camera cannot follow its path")
                };
                let look = look(&moved).map_err(|failure| in_frame(failure, number))?;
                // No flag would give this view.
                Ok(Look { view: None, ..look })
            }
        }
    }
}

/// Adds the number of the frame to a failure.
pub(crate) fn in_frame(failure: Failure, number: usize) -> Failure {
    match failure {
        Failure::Job(error) => Failure::Job(error.context(format!("frame {number}"))),
        other => other,
    }
}

fn moved(camera: &CameraParameters, on_path: &CameraOnPath, center: DVec3, distance: f64) -> Result<CameraParameters> {
    let (eye, look_at, up) = match on_path.place {
        PlaceOnPath::Point { eye, look_at, up } => (eye, look_at, up),
        PlaceOnPath::View { direction, up } => (center - distance * direction, center, up),
    };
    let mut camera = CameraTable::new(camera).context("this camera has no table")?;
    camera.table.remove("direction");
    for (key, vector) in [("eye", eye), ("look_at", look_at), ("up", up)] {
        camera.set(key, list(vector.to_array()));
    }
    if let Some(radians) = on_path.fov_radians {
        camera.set("vertical_fov", radians.to_degrees());
    }
    if let Some(zoom) = on_path.zoom {
        camera.set("zoom", zoom);
    }
    camera.parameters().map_err(|message| anyhow::anyhow!(message.trim().replace('\n', " ")))
}

/// The axis about which a camera turns, and a point on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub(crate) direction: DVec3,
    pub(crate) center: DVec3,
}

/// Turns a camera that has a position by a part of a full turn, counter-clockwise as seen from above.
pub(crate) fn turned(camera: &CameraParameters, axis: Axis, part: f64) -> Result<CameraParameters> {
    let turn = DQuat::from_axis_angle(axis.direction, TAU * part);
    let mut camera = CameraTable::new(camera).context("this camera cannot be turned")?;
    for (key, center) in [
        ("eye", axis.center),
        ("look_at", axis.center),
        ("focus_on", axis.center),
        ("direction", DVec3::ZERO),
        ("up", DVec3::ZERO),
    ] {
        if let Some(vector) = camera.vector(key) {
            camera.set(key, list((center + turn * (vector - center)).to_array()));
        }
    }
    camera.parameters().map_err(|message| anyhow::anyhow!("this camera cannot be turned: {message}"))
}

/// The direction that is up for a camera that has a position.
pub(crate) fn up_of(camera: &CameraParameters) -> Option<DVec3> {
    CameraTable::new(camera)?.vector("up")?.try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_moves_the_eye_from_z_to_x() {
        let table = "[pinhole]\neye = [1.0, 2.0, 5.0]\ndirection = [0.0, 0.0, -1.0]\nup = [0.0, 1.0, 0.0]";
        let camera: CameraParameters = toml::from_str(table).unwrap();
        let axis = Axis { direction: DVec3::Y, center: DVec3::new(1.0, 0.0, 0.0) };
        let turned = turned(&camera, axis, 0.25).unwrap();
        let turned = CameraTable::new(&turned).unwrap();
        let near = |key: &str, expected: [f64; 3]| {
            let found = turned.vector(key).unwrap();
            assert!((found - DVec3::from(expected)).length() < 1e-12, "{key} {found}");
        };
        near("eye", [6.0, 2.0, 0.0]);
        near("direction", [-1.0, 0.0, 0.0]);
        near("up", [0.0, 1.0, 0.0]);
        assert_eq!(up_of(&camera), Some(DVec3::Y));
    }
}
