//! The camera on the command line. Its flags are the keys of a scene file's camera table.

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde::Deserialize;

use super::failure::Failure;
use pinhole::camera::{CameraError, CameraKind, CameraParameters};
use pinhole::geometry::bounds::Bounds;

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
    /// Vertical field of view in degrees (pinhole, thin-lens) [default: 30]
    #[arg(long, help_heading = HEADING, value_name = "DEGREES", allow_hyphen_values = true)]
    fov: Option<f64>,
    /// How far the view plane is from the eye (pinhole, thin-lens), with --half-extent [default: 1]
    #[arg(long, help_heading = HEADING, value_name = "D", allow_hyphen_values = true)]
    distance: Option<f64>,
    /// Half width and half height of the view plane, instead of --fov
    #[arg(long, help_heading = HEADING, value_name = "HX,HY", value_parser = numbers::<2>, allow_hyphen_values = true)]
    half_extent: Option<[f64; 2]>,
    /// Radius of the lens in scene units (thin-lens)
    #[arg(long, help_heading = HEADING, value_name = "R", allow_hyphen_values = true)]
    aperture_radius: Option<f64>,
    /// Focal length over diameter of the lens, with --focal-length, instead of --aperture-radius (thin-lens)
    #[arg(long, help_heading = HEADING, value_name = "N", allow_hyphen_values = true)]
    f_stop: Option<f64>,
    /// In scene units; it only makes --f-stop a length (thin-lens)
    #[arg(long, help_heading = HEADING, value_name = "F", allow_hyphen_values = true)]
    focal_length: Option<f64>,
    /// How far along the view things are sharp (thin-lens) [default: as far as --look-at, or the scene's middle]
    #[arg(long, help_heading = HEADING, value_name = "D", allow_hyphen_values = true)]
    focus_distance: Option<f64>,
    /// A point that is sharp, instead of --focus-distance (thin-lens)
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    focus_on: Option<[f64; 3]>,
    /// The whole angle that the disk spans, in degrees (fisheye) [default: 180]
    #[arg(long, help_heading = HEADING, value_name = "DEGREES", allow_hyphen_values = true)]
    angle: Option<f64>,
    /// Two pictures, for eyes so far apart, in scene units (pinhole, panorama); see --stereo
    #[arg(long, help_heading = HEADING, value_name = "S", allow_hyphen_values = true)]
    separation: Option<f64>,
    /// How far away things seem to lie in the screen, with --separation [default: infinitely far]
    #[arg(long, help_heading = HEADING, value_name = "D", allow_hyphen_values = true)]
    convergence: Option<f64>,
}

impl CameraArgs {
    /// The camera that the flags describe, if there is any, checked as far as it can be without a scene.
    pub(super) fn parameters(&self) -> Result<Option<CameraParameters>, Failure> {
        let mut table = toml::Table::new();
        for (key, _, value) in self.keys() {
            match (value, key.split_once('.')) {
                (None, _) => {}
                (Some(value), None) => {
                    table.insert(key.to_owned(), value);
                }
                (Some(value), Some((name, key))) => {
                    let inner = toml::Value::Table(toml::Table::new());
                    let inner = table.entry(name).or_insert(inner).as_table_mut();
                    inner.map(|inner| inner.insert(key.to_owned(), value));
                }
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
        let bounds = Bounds::of_sphere(pinhole::glam::DVec3::ZERO, 1.0);
        let checked = match parameters.camera(1.0, &bounds) {
            // How far away the focus of a camera without a place is, only the scene says.
            Err(CameraError::Range { .. } | CameraError::Length { .. })
                if kind == CameraKind::ThinLens.name() && self.eye.is_none() =>
            {
                Ok(())
            }
            made => made.and_then(|_| parameters.stereo_pair(1.0, &bounds)).map(drop),
        };
        match checked {
            Ok(()) => Ok(Some(parameters)),
            Err(error) => Err(Failure::usage(self.in_flags(&error))),
        }
    }

    /// Every key of a camera's table, its flag and its value. What a camera does not know, it refuses.
    fn keys(&self) -> [(&'static str, &'static str, Option<toml::Value>); 15] {
        [
            ("eye", "--eye", self.eye.map(list)),
            ("look_at", "--look-at", self.look_at.map(list)),
            ("direction", "--direction", self.direction.map(list)),
            ("up", "--up", self.up.map(list)),
            ("vertical_fov", "--fov", self.fov.map(Into::into)),
            ("distance", "--distance", self.distance.map(Into::into)),
            ("half_extent", "--half-extent", self.half_extent.map(list)),
            ("aperture_radius", "--aperture-radius", self.aperture_radius.map(Into::into)),
            ("f_stop", "--f-stop", self.f_stop.map(Into::into)),
            ("focal_length", "--focal-length", self.focal_length.map(Into::into)),
            ("focus_distance", "--focus-distance", self.focus_distance.map(Into::into)),
            ("focus_on", "--focus-on", self.focus_on.map(list)),
            ("angle", "--angle", self.angle.map(Into::into)),
            ("stereo.separation", "--separation", self.separation.map(Into::into)),
            ("stereo.convergence", "--convergence", self.convergence.map(Into::into)),
        ]
    }

    /// What can be wrong with a table of numbers: it has a key that this camera has not, or of two eyes only half.
    fn unknown(&self, kind: &str, message: &str) -> Failure {
        if message.starts_with("missing field `separation`") {
            return Failure::usage("--convergence needs --separation");
        }
        let is_named = |key: &str| {
            let key = key.split('.').next().unwrap_or_default();
            message.starts_with(&format!("unknown field `{key}`"))
        };
        let given = self.keys().into_iter().filter(|(.., value)| value.is_some());
        match given.into_iter().find(|(key, ..)| is_named(key)) {
            Some((_, flag, _)) => {
                Failure::usage(format!("{flag} does not concern the {kind} camera; drop it"))
            }
            None => Failure::usage(format!("--camera {kind}: {message}")),
        }
    }

    /// The error with flags for keys.
    fn in_flags(&self, error: &CameraError) -> String {
        self.keys().into_iter().fold(error.to_string(), |text, (key, flag, _)| {
            let key = key.rsplit('.').next().unwrap_or_default();
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
