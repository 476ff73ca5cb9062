//! Reads the table `[camera_path]` of a scene file, and files that hold nothing else.

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use super::span::{Lines, Number, SceneFileError, Span, explain};
use pinhole::camera::{CameraKey, CameraPath, KeyPlace, PathClock, Viewpoint};
use pinhole::internals::exact::{self, Table};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraPathTable {
    #[serde(default = "yes")]
    ease: bool,
    #[serde(default)]
    keys: Vec<Spanned<Table<KeyTable>>>,
}

fn yes() -> bool {
    true
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct KeyTable {
    frame: Option<Number>,
    time: Option<Number>,
    #[serde(default, deserialize_with = "exact::optional_array")]
    eye: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "exact::optional_array")]
    look_at: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "exact::optional_array")]
    up: Option<[f64; 3]>,
    view: Option<Spanned<String>>,
    turn: Option<Number>,
    vertical_fov: Option<Number>,
    zoom: Option<Number>,
}

/// Parses the text of a file that holds a camera path: the keys of the table `[camera_path]` of a scene file, at the top
/// level.
///
/// # Errors
/// Returns the first error in the text, with its line and column.
pub fn parse_camera_path(text: &str) -> Result<CameraPath, SceneFileError> {
    let lines = Lines::of(text);
    let table: CameraPathTable = toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        lines.span(start).error(explain(error.message()))
    })?;
    table.path(&lines)
}

impl CameraPathTable {
    pub(super) fn path(self, lines: &Lines<'_>) -> Result<CameraPath, SceneFileError> {
        let spans: Vec<Span> = self.keys.iter().map(|key| lines.span(key.span().start)).collect();
        let (mut keys, mut clock) = (Vec::new(), None);
        for (table, span) in self.keys.into_iter().zip(&spans) {
            let (key, its_clock) = table.into_inner().0.key(*span, lines)?;
            if *clock.get_or_insert(its_clock) != its_clock {
                return Err(span.error(
                    "some keys have a `frame` and others a `time`; give all keys of a path the same",
                ));
            }
            keys.push(key);
        }
        let clock = clock.unwrap_or(PathClock::Frames);
        CameraPath::new(keys, clock, self.ease).map_err(|error| {
            let span = error.key.and_then(|key| spans.get(key)).or(spans.last());
            span.copied().unwrap_or(Span::START).error(error)
        })
    }
}

impl KeyTable {
    fn key(self, span: Span, lines: &Lines<'_>) -> Result<(CameraKey, PathClock), SceneFileError> {
        let (time, clock) = match (&self.frame, &self.time) {
            (Some(frame), None) => (*frame.get_ref(), PathClock::Frames),
            (None, Some(time)) => (*time.get_ref(), PathClock::Seconds),
            (Some(_), Some(_)) => {
                return Err(span.error("`frame` and `time` exclude each other; keep one"));
            }
            (None, None) => {
                return Err(span.error("a key needs a `frame`, or a `time` in seconds"));
            }
        };
        let is_view = self.view.is_some() || self.turn.is_some();
        let place = match (self.eye, self.look_at) {
            (Some(_), _) | (_, Some(_)) if is_view => {
                return Err(span.error(
                    "`eye` with `look_at`, and `view` with `turn`, exclude each other; keep one pair",
                ));
            }
            (Some(eye), Some(look_at)) => KeyPlace::Point {
                eye: eye.into(),
                look_at: look_at.into(),
                up: self.up.map(DVec3::from),
            },
            (None, None) if is_view => {
                if self.up.is_some() {
                    return Err(span.error("`up` applies only to a key with an `eye`; remove it"));
                }
                if self.vertical_fov.is_some() {
                    return Err(span.error(
                        "`vertical_fov` applies only to a key with an `eye`; use `zoom` with a `view`",
                    ));
                }
                self.view_place(lines)?
            }
            _ => {
                return Err(
                    span.error("a key needs an `eye` and a `look_at`, or a `view`, or a `turn`")
                );
            }
        };
        let number = |number: Option<Number>| number.map(Spanned::into_inner);
        let fov_radians = number(self.vertical_fov).map(f64::to_radians);
        Ok((CameraKey { time, place, fov_radians, zoom: number(self.zoom) }, clock))
    }

    fn view_place(&self, lines: &Lines<'_>) -> Result<KeyPlace, SceneFileError> {
        let viewpoint = match &self.view {
            None => Viewpoint::OBLIQUE,
            Some(view) => view
                .get_ref()
                .parse()
                .map_err(|error| lines.span(view.span().start).error(error))?,
        };
        let turn = self.turn.as_ref().map_or(0.0, |turn| *turn.get_ref());
        Ok(KeyPlace::View { viewpoint, turn })
    }
}
