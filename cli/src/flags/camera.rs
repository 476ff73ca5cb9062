//! The camera flags of the command line. They correspond to the keys of a scene file's camera table.

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde::Deserialize;

use crate::terminal::failure::Failure;
use pinhole::camera::{CameraError, CameraKind, CameraParameters, Viewpoint, turned};
use pinhole::geometry::bounds::Bounds;
use pinhole::glam::DVec3;

/// Heading of these flags in the help. It is set on each flag, because clap would put later flags under a heading that
/// is set once.
pub(crate) const HEADING: &str = "Camera (any of these flags replaces the camera of the scene)";

#[derive(Clone, Debug, Default, Args)]
pub(crate) struct CameraArgs {
    /// Kind of the camera [default: pinhole]
    #[arg(long, help_heading = HEADING, value_name = "KIND", value_parser = kinds())]
    camera: Option<String>,
    /// Position of the camera; without it, the camera frames the scene
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    eye: Option<[f64; 3]>,
    /// Point that the camera looks at
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    look_at: Option<[f64; 3]>,
    /// Direction in which the camera looks, instead of --look-at [default without --eye: 0,0,-1]
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    direction: Option<[f64; 3]>,
    /// Where the camera stands when it frames the scene: x, -x, y, -y, z, -z, iso, or AZIMUTH,ELEVATION in degrees
    /// [default for data files: 30,20, or straight on where all spheres lie in one plane]
    #[arg(
        long, help_heading = HEADING, value_name = "VIEW", allow_hyphen_values = true,
        conflicts_with_all = ["eye", "look_at", "direction"]
    )]
    view: Option<Viewpoint>,
    /// Turn the camera about the direction that is up, by this angle in degrees; counter-clockwise seen from above
    #[arg(long, help_heading = HEADING, value_name = "DEGREES", allow_hyphen_values = true, conflicts_with = "eye")]
    turn: Option<f64>,
    /// Free part of the picture on each side of a framed scene: 0.1 or 10% (pinhole, thin-lens, orthographic)
    /// [default: 7.5%]
    #[arg(long, help_heading = HEADING, value_name = "PART", value_parser = part, allow_hyphen_values = true)]
    margin: Option<f64>,
    /// Enlarge the picture about its middle (pinhole, thin-lens, orthographic)
    #[arg(long, help_heading = HEADING, value_name = "FACTOR", allow_hyphen_values = true)]
    zoom: Option<f64>,
    /// Direction that is up in the picture [default: 0,0,1 for LAMMPS, GSD and LAS files and 0,1,0 for others, or another one in a view along it]
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    up: Option<[f64; 3]>,
    /// Vertical field of view in degrees (pinhole, thin-lens) [default: 30]
    #[arg(long, help_heading = HEADING, value_name = "DEGREES", allow_hyphen_values = true)]
    fov: Option<f64>,
    /// Distance from the eye to the view plane in scene units, with --half-extent (pinhole, thin-lens) [default: 1]
    #[arg(long, help_heading = HEADING, value_name = "D", allow_hyphen_values = true)]
    distance: Option<f64>,
    /// Half width and half height of the view plane in scene units, instead of --fov (pinhole, thin-lens,
    /// orthographic)
    #[arg(long, help_heading = HEADING, value_name = "HX,HY", value_parser = numbers::<2>, allow_hyphen_values = true)]
    half_extent: Option<[f64; 2]>,
    /// Radius of the lens in scene units (thin-lens)
    #[arg(long, help_heading = HEADING, value_name = "R", allow_hyphen_values = true)]
    aperture_radius: Option<f64>,
    /// F-number of the lens: focal length over diameter, with --focal-length, instead of --aperture-radius (thin-lens)
    #[arg(long, help_heading = HEADING, value_name = "N", allow_hyphen_values = true)]
    f_stop: Option<f64>,
    /// Focal length of the lens in scene units, used only to turn --f-stop into an aperture (thin-lens)
    #[arg(long, help_heading = HEADING, value_name = "F", allow_hyphen_values = true)]
    focal_length: Option<f64>,
    /// Distance along the direction of view at which things are sharp, in scene units (thin-lens) [default: that of
    /// --look-at, or of the middle of the scene]
    #[arg(long, help_heading = HEADING, value_name = "D", allow_hyphen_values = true)]
    focus_distance: Option<f64>,
    /// Point that is sharp, instead of --focus-distance (thin-lens)
    #[arg(long, help_heading = HEADING, value_name = "X,Y,Z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    focus_on: Option<[f64; 3]>,
    /// Full angle of view across the disk in degrees (fisheye) [default: 180]
    #[arg(long, help_heading = HEADING, value_name = "DEGREES", allow_hyphen_values = true)]
    angle: Option<f64>,
    /// Distance between two eyes in scene units, which renders a stereo pair (pinhole, panorama); see --stereo
    #[arg(long, help_heading = HEADING, value_name = "S", allow_hyphen_values = true)]
    separation: Option<f64>,
    /// Distance in scene units at which things appear at the depth of the screen, with --separation [default: infinite]
    #[arg(long, help_heading = HEADING, value_name = "D", allow_hyphen_values = true)]
    convergence: Option<f64>,
}

impl CameraArgs {
    /// Returns the camera that the flags describe, checked as far as is possible without a scene.
    pub(crate) fn flags(&self) -> Result<CameraFlags, Failure> {
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
        if let Some(turn) = self.turn.filter(|turn| !turn.is_finite()) {
            return Err(Failure::usage(format!("--turn {turn}: it must be a finite angle")));
        }
        let is_any = self.camera.is_some() || self.view.is_some() || self.turn.is_some();
        let flags =
            CameraFlags { args: self.clone(), is_given: is_any || !table.is_empty(), table };
        self.check(&flags)?;
        Ok(flags)
    }

    fn check(&self, flags: &CameraFlags) -> Result<(), Failure> {
        let kind = flags.kind();
        // Data is seen from here, with any direction up; of scene files, the real check comes later.
        let parameters = flags
            .parameters(Some(Viewpoint::OBLIQUE), DVec3::Y)
            .map_err(|message| self.unknown(kind, &message))?;
        // An error in the flags themselves shows with any scene, so these bounds are arbitrary.
        let subject = &Bounds::of_sphere(DVec3::ZERO, 1.0).into();
        let checked = match parameters.camera(1.0, subject) {
            // For a camera without an eye position, the distance of the focus depends on the scene.
            Err(CameraError::Range { parameter, .. })
                if parameter == "`aperture_radius`" && self.eye.is_none() =>
            {
                Ok(())
            }
            Err(CameraError::Length { .. })
                if kind == CameraKind::ThinLens.name() && self.eye.is_none() =>
            {
                Ok(())
            }
            made => made.and_then(|_| parameters.stereo_pair(1.0, subject)).map(drop),
        };
        checked.map_err(|error| Failure::usage(self.in_flags(&error)))
    }

    /// Returns every key of a camera table with its flag and its value. Each camera refuses keys that it does not have.
    pub(crate) fn keys(&self) -> [(&'static str, &'static str, Option<toml::Value>); 17] {
        [
            ("eye", "--eye", self.eye.map(list)),
            ("look_at", "--look-at", self.look_at.map(list)),
            ("direction", "--direction", self.direction.map(list)),
            ("up", "--up", self.up.map(list)),
            ("margin", "--margin", self.margin.map(Into::into)),
            ("zoom", "--zoom", self.zoom.map(Into::into)),
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

    /// Returns the failure for a key that this kind of camera does not have, or for a stereo camera without separation.
    fn unknown(&self, kind: &str, message: &str) -> Failure {
        if message.starts_with("missing field `separation`") {
            return Failure::usage("--convergence needs --separation; add --separation");
        }
        let is_named = |key: &str| {
            let key = key.split('.').next().unwrap_or_default();
            message.starts_with(&format!("unknown field `{key}`"))
        };
        let given = self.keys().into_iter().filter(|(.., value)| value.is_some());
        match given.into_iter().find(|(key, ..)| is_named(key)) {
            Some((_, flag, _)) => {
                Failure::usage(format!("{flag} does not apply to the {kind} camera; remove it"))
            }
            None => Failure::usage(format!("--camera {kind}: {message}")),
        }
    }

    /// Returns the message of an error, with flags in place of keys.
    fn in_flags(&self, error: &CameraError) -> String {
        self.keys().into_iter().fold(error.to_string(), |text, (key, flag, _)| {
            let key = key.rsplit('.').next().unwrap_or_default();
            text.replace(&format!("`{key}`"), &format!("`{flag}`"))
        })
    }
}

/// The camera flags that were given, checked.
#[derive(Clone, Debug, Default)]
pub(crate) struct CameraFlags {
    args: CameraArgs,
    /// Whether there is any flag, so that the camera takes the place of the scene's.
    pub(crate) is_given: bool,
    table: toml::Table,
}

impl CameraFlags {
    fn kind(&self) -> &str {
        self.args.camera.as_deref().unwrap_or(CameraKind::ALL[0].name())
    }

    pub(crate) fn up(&self) -> Option<DVec3> {
        self.args.up.map(DVec3::from)
    }

    /// Returns the viewpoint: that of `--view`, or else `automatic` for a camera that stands outside the scene and has
    /// no eye and no direction.
    pub(crate) fn viewpoint(&self, automatic: Option<Viewpoint>) -> Option<Viewpoint> {
        let is_outside = ["panorama", "fisheye"].iter().all(|kind| *kind != self.kind());
        let automatic = automatic
            .filter(|_| is_outside && self.args.eye.is_none() && self.args.direction.is_none());
        self.args.view.or(automatic)
    }

    /// Returns the flags that show how the camera is turned, to be used again; `None` if there is nothing to say.
    pub(crate) fn view_in_flags(&self, automatic: Option<Viewpoint>) -> Option<String> {
        let turn = match self.args.turn.unwrap_or(0.0) {
            0.0 => String::new(),
            turn => format!(" --turn {turn}"),
        };
        let direction = |[x, y, z]: [f64; 3]| format!("--direction {x},{y},{z}{turn}");
        let named = self.viewpoint(automatic).map(|view| format!("--view {view}{turn}"));
        named.or(self.args.direction.filter(|_| self.args.eye.is_none()).map(direction))
    }

    /// Returns the parameters of the camera, which stands at the `automatic` viewpoint if no flag says where, and whose
    /// viewpoint has `default_up` up if no flag says what is.
    pub(crate) fn parameters(
        &self,
        automatic: Option<Viewpoint>,
        default_up: DVec3,
    ) -> Result<CameraParameters, String> {
        let mut table = self.table.clone();
        let (up, turn) = (self.up().unwrap_or(default_up), self.args.turn.unwrap_or(0.0));
        if let Some(view) = self.viewpoint(automatic) {
            let [direction, up] = view.axes(up, turn);
            table.insert("direction".to_owned(), list(direction.to_array()));
            table.insert("up".to_owned(), list(up.to_array()));
        } else if turn != 0.0 {
            let direction = self.args.direction.map_or(DVec3::NEG_Z, DVec3::from);
            let direction = turned(direction, up, turn);
            table.insert("direction".to_owned(), list(direction.to_array()));
        }
        CameraTable { kind: self.kind().to_owned(), table }.parameters()
    }
}

/// A camera of any kind, as the table of this kind in a scene file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CameraTable {
    pub(crate) kind: String,
    pub(crate) table: toml::Table,
}

impl CameraTable {
    pub(crate) fn new(parameters: &CameraParameters) -> Option<Self> {
        let toml::Value::Table(document) = toml::Value::try_from(parameters).ok()? else {
            return None;
        };
        let (kind, toml::Value::Table(table)) = document.into_iter().next()? else { return None };
        Some(Self { kind, table })
    }

    pub(crate) fn vector(&self, key: &str) -> Option<DVec3> {
        let numbers = self.table.get(key)?.as_array()?;
        let numbers: Vec<f64> = numbers.iter().filter_map(toml::Value::as_float).collect();
        <[f64; 3]>::try_from(numbers).ok().map(DVec3::from)
    }

    pub(crate) fn set(&mut self, key: &str, value: impl Into<toml::Value>) {
        self.table.insert(key.to_owned(), value.into());
    }

    /// The parameters of the camera, or why it has none, in words.
    pub(crate) fn parameters(self) -> Result<CameraParameters, String> {
        let document = toml::Table::from_iter([(self.kind, toml::Value::Table(self.table))]);
        CameraParameters::deserialize(toml::Value::Table(document))
            .map_err(|error| error.message().to_owned())
    }
}

/// Parses a part of a whole, such as 0.1 or 10%.
fn part(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number, 100.0),
        None => (text, 1.0),
    };
    let number = number.trim().parse::<f64>();
    number.map(|number| number / unit).map_err(|_| "write a part such as 0.1 or 10%".to_owned())
}

fn kinds() -> PossibleValuesParser {
    PossibleValuesParser::new(CameraKind::ALL.iter().map(|kind| kind.name()))
}

/// Converts numbers to a TOML array.
pub(crate) fn list<const N: usize>(numbers: [f64; N]) -> toml::Value {
    numbers.to_vec().into()
}

/// Parses `N` numbers that are separated by commas.
fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let wanted = || format!("write {N} numbers with commas between them, such as {}", example(N));
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    numbers.map_err(|_| wanted())?.try_into().map_err(|_| wanted())
}

fn example(numbers: usize) -> &'static str {
    if numbers == 2 { "1,0.75" } else { "0,1,-8" }
}
