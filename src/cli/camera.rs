//! The camera on the command line. Its flags are the keys of a scene file's camera table.

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde::Deserialize;

use super::failure::Failure;
use crate::bounds::Bounds;
use crate::camera::{CameraError, CameraKind, CameraParameters};

/// Of each flag, because clap puts whatever follows below a heading that is set once.
const HEADING: &str = "Camera (any of these takes the place of the scene's camera)";

#[derive(Debug, Args)]
pub(super) struct CameraArgs {
    /// Which camera [default: pinhole]
    #[arg(long, help_heading = HEADING, value_name = "KIND", value_parser = kinds())]
    camera: Option<String>,
    /// Where the camera is; without it, the camera frames the scene
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    eye: Option<[f64; 3]>,
    /// The point it looks at
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    look_at: Option<[f64; 3]>,
    /// The direction it looks in, instead of --look-at [default without --eye: 0,0,-1]
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    direction: Option<[f64; 3]>,
    /// Which way is up [default: 0,1,0]
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    up: Option<[f64; 3]>,
    /// Vertical field of view in degrees (pinhole) [default: 30]
    #[arg(long, help_heading = HEADING, value_name = "DEGREES", allow_hyphen_values = true)]
    fov: Option<f64>,
    /// How far the view plane is from the eye (pinhole), with --half-extent [default: 1]
    #[arg(long, help_heading = HEADING, value_name = "D", allow_hyphen_values = true)]
    distance: Option<f64>,
    /// Half width and half height of the view plane, instead of --fov
    #[arg(long, help_heading = HEADING, value_name = "HX,HY", value_parser = numbers::<2>, allow_hyphen_values = true)]
    half_extent: Option<[f64; 2]>,
}

impl CameraArgs {
    /// The camera that the flags describe, if there is any, checked as far as it can be without a scene.
    pub(super) fn parameters(&self) -> Result<Option<CameraParameters>, Failure> {
        let mut table = toml::Table::new();
        for (key, _, value) in self.keys() {
            if let Some(value) = value {
                table.insert(key.to_owned(), value);
            }
        }
        let kind = match &self.camera {
            Some(kind) => kind.as_str(),
            None if table.is_empty() => return Ok(None),
            None => CameraKind::ALL[0].name(),
        };
        let document = toml::Table::from_iter([(kind.to_owned(), toml::Value::Table(table))]);
        let parameters = CameraParameters::deserialize(toml::Value::Table(document))
            .map_err(|error| self.unknown(kind, error.message()))?;
        // What the flags say by themselves is wrong for any scene.
        let bounds = Bounds::of_sphere(glam::DVec3::ZERO, 1.0);
        match parameters.camera(1.0, &bounds) {
            Ok(_) => Ok(Some(parameters)),
            Err(error) => Err(Failure::usage(self.in_flags(&error))),
        }
    }

    /// Every key of a camera's table, its flag and its value. What a camera does not know, it refuses.
    fn keys(&self) -> [(&'static str, &'static str, Option<toml::Value>); 7] {
        [
            ("eye", "--eye", self.eye.map(list)),
            ("look_at", "--look-at", self.look_at.map(list)),
            ("direction", "--direction", self.direction.map(list)),
            ("up", "--up", self.up.map(list)),
            ("vertical_fov", "--fov", self.fov.map(Into::into)),
            ("distance", "--distance", self.distance.map(Into::into)),
            ("half_extent", "--half-extent", self.half_extent.map(list)),
        ]
    }

    /// The only thing that can be wrong with a table of numbers: it has a key that this camera has not.
    fn unknown(&self, kind: &str, message: &str) -> Failure {
        let is_named = |key: &str| message.starts_with(&format!("unknown field `{key}`"));
        match self.keys().into_iter().find(|(key, ..)| is_named(key)) {
            Some((_, flag, _)) => {
                Failure::usage(format!("{flag} does not concern the {kind} camera; drop it"))
            }
            None => Failure::usage(format!("--camera {kind}: {message}")),
        }
    }

    /// The error with flags for keys.
    fn in_flags(&self, error: &CameraError) -> String {
        self.keys().into_iter().fold(error.to_string(), |text, (key, flag, _)| {
            text.replace(&format!("`{key}`"), &format!("`{flag}`"))
        })
    }
}

fn kinds() -> PossibleValuesParser {
    PossibleValuesParser::new(CameraKind::ALL.iter().map(|kind| kind.name()))
}

/// Numbers as a table has them.
fn list<const N: usize>(numbers: [f64; N]) -> toml::Value {
    numbers.to_vec().into()
}

/// `N` numbers with commas between them.
fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let wanted = || format!("write {N} numbers with commas between them, such as {}", example(N));
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    numbers.map_err(|_| wanted())?.try_into().map_err(|_| wanted())
}

fn example(numbers: usize) -> &'static str {
    if numbers == 2 { "1,0.75" } else { "0,1,-8" }
}
