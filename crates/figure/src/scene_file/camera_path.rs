//! Reads the table `[camera_path]` of a scene file, and files that hold nothing else.

use serde::{Deserialize, Serialize};
use toml::de::DeTable;

use super::span::{KeyError, Lines, SceneFileError};
use crate::settings::places::{Keys, Places};
use pinhole::camera::{CameraKey, CameraPath, KeyPlace, PathClock, Viewpoint};
use pinhole::internals::exact::{List, Table};

/// The table `[camera_path]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraPathTable {
    /// Whether the camera starts and stops gently.
    #[serde(default = "yes")]
    ease: bool,
    /// Where the camera is at some times.
    #[serde(default)]
    keys: Vec<Table<KeyTable>>,
}

fn yes() -> bool {
    true
}

/// A table of the list `keys`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct KeyTable {
    /// The picture, counted from 0.
    frame: Option<f64>,
    /// The time in seconds, instead of `frame`.
    time: Option<f64>,
    /// The position of the camera.
    eye: Option<List<3>>,
    /// The point that the camera looks at.
    look_at: Option<List<3>>,
    /// The direction that is up in the picture.
    up: Option<List<3>>,
    /// Where the camera stands, instead of `eye` and `look_at`; see `view` of a camera.
    view: Option<Viewpoint>,
    /// The angle in degrees by which the camera is turned about the direction that is up.
    turn: Option<f64>,
    /// Vertical field of view in degrees.
    vertical_fov: Option<f64>,
    /// Factor by which the picture is enlarged.
    zoom: Option<f64>,
}

/// Parses the text of a file that holds a camera path: the keys of the table `[camera_path]` of a scene file, at the top
/// level.
///
/// # Errors
/// Returns the first error in the text, with its line and column.
pub fn parse_camera_path(text: &str) -> Result<CameraPath, SceneFileError> {
    let mut lines = Lines::default();
    lines.add(text, None);
    let keys = DeTable::parse(text).map(|table| Keys::with_lists(table.get_ref()));
    let places = Places { lines, keys: keys.unwrap_or_default() };
    let table: CameraPathTable = toml::from_str(text).map_err(|error| places.explained(&error, |_, _| None))?;
    table.path("", &places)
}

impl CameraPathTable {
    /// The path. `table` is the name of the table of these keys.
    pub(super) fn path(&self, table: &str, places: &Places<'_>) -> Result<CameraPath, SceneFileError> {
        let path_of = |index: usize| format!("{table}keys.{index}");
        let (mut keys, mut clock) = (Vec::new(), None);
        for (index, Table(key)) in self.keys.iter().enumerate() {
            let refused = |error: KeyError| places.refused(&path_of(index), error);
            let (key, its_clock) = key.key().map_err(refused)?;
            if *clock.get_or_insert(its_clock) != its_clock {
                return Err(refused(
                    "some keys have a `frame` and others a `time`; give all keys of a path the same".into(),
                ));
            }
            keys.push(key);
        }
        let clock = clock.unwrap_or(PathClock::Frames);
        CameraPath::new(keys, clock, self.ease).map_err(|error| {
            let last = self.keys.len().saturating_sub(1);
            places.span(&path_of(error.key.unwrap_or(last))).error(error)
        })
    }
}

impl KeyTable {
    fn key(&self) -> Result<(CameraKey, PathClock), KeyError> {
        let (time, clock) = match (self.frame, self.time) {
            (Some(frame), None) => (frame, PathClock::Frames),
            (None, Some(time)) => (time, PathClock::Seconds),
            (Some(_), Some(_)) => {
                return Err("`frame` and `time` exclude each other; keep one".into());
            }
            (None, None) => return Err("a key needs a `frame`, or a `time` in seconds".into()),
        };
        let is_view = self.view.is_some() || self.turn.is_some();
        let place = match (self.eye, self.look_at) {
            (Some(_), _) | (_, Some(_)) if is_view => {
                return Err("`eye` with `look_at`, and `view` with `turn`, exclude each other; keep one pair".into());
            }
            (Some(eye), Some(look_at)) => {
                KeyPlace::Point { eye: eye.0.into(), look_at: look_at.0.into(), up: self.up.map(|up| up.0.into()) }
            }
            (None, None) if is_view => {
                if self.up.is_some() {
                    return Err("`up` applies only to a key with an `eye`; remove it".into());
                }
                if self.vertical_fov.is_some() {
                    return Err("`vertical_fov` applies only to a key with an `eye`; use `zoom` with a `view`".into());
                }
                KeyPlace::View { viewpoint: self.view.unwrap_or(Viewpoint::OBLIQUE), turn: self.turn.unwrap_or(0.0) }
            }
            _ => {
                return Err("a key needs an `eye` and a `look_at`, or a `view`, or a `turn`".into());
            }
        };
        let fov_radians = self.vertical_fov.map(f64::to_radians);
        Ok((CameraKey { time, place, fov_radians, zoom: self.zoom }, clock))
    }
}
