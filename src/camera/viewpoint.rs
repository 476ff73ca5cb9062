//! Named directions of view.

use std::fmt;
use std::str::FromStr;

use glam::{DQuat, DVec3};

/// The direction from the scene to a camera: one side of the scene, or an azimuth and an elevation.
///
/// The text is `x`, `-x`, `y`, `-y`, `z`, `-z`, `iso` (azimuth 45, elevation 35.26: all three axes are equally
/// foreshortened), a side such as `front` (azimuth 0) or `top`, a plane that is seen straight on (`xy`, `xz`, `yz`), or
/// `AZIMUTH,ELEVATION` in degrees. With +y up, the azimuth is counted from +z towards +x, and the
/// elevation from the horizon upwards. Molecule viewers begin with `z`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(try_from = "String", into = "String")]
#[non_exhaustive]
pub enum Viewpoint {
    /// On the positive or negative side of an axis (0, 1 or 2) of the world.
    Axis {
        /// Index of the axis: 0 is x, 1 is y, 2 is z.
        axis: usize,
        /// Whether the camera stands on the negative side.
        is_negative: bool,
    },
    /// At two angles in degrees, for any `up` direction.
    Angles {
        /// The angle about the `up` direction, counter-clockwise seen from above.
        azimuth: f64,
        /// The angle above the horizon, from -90 to 90.
        elevation: f64,
    },
}

/// An error for a text that is not a viewpoint.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "write x, -x, y, -y, z, -z, iso, front, back, left, right, top, bottom, xy, xz, yz, or AZIMUTH,ELEVATION in degrees, \
     such as 30,20, with an elevation from -90 to 90"
)]
#[non_exhaustive]
pub struct ViewpointError;

/// The names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The names of sides and planes, with the texts of the same viewpoints.
const SIDES: [(&str, &str); 9] = [
    ("front", "0,0"),
    ("back", "180,0"),
    ("left", "-90,0"),
    ("right", "90,0"),
    ("top", "0,90"),
    ("bottom", "0,-90"),
    ("xy", "z"),
    ("xz", "-y"),
    ("yz", "x"),
];

impl Viewpoint {
    /// An oblique view with azimuth 30 and elevation 20, which shows the shape of three-dimensional data.
    pub const OBLIQUE: Self = Self::Angles { azimuth: 30.0, elevation: 20.0 };

    /// The view in which all three axes are equally foreshortened.
    pub const ISOMETRIC: Self = Self::Angles { azimuth: 45.0, elevation: 35.264_389_682_754_654 };

    /// The direction of view of a camera at this viewpoint, and its `up` direction in the picture, after a turn by
    /// `turn` degrees about `up`, counter-clockwise seen from above. The second is `up`, except in a view from straight
    /// above or below. There it is the horizontal direction away from the azimuth.
    #[must_use]
    pub fn axes(self, up: DVec3, turn: f64) -> [DVec3; 2] {
        let up = up.normalize_or(DVec3::Y);
        let turned = DQuat::from_axis_angle(up, turn.to_radians());
        let from_y = DQuat::from_rotation_arc(DVec3::Y, up);
        let [place, front] = match self {
            Self::Axis { axis, is_negative } => {
                let place = DVec3::AXES[axis.min(2)] * if is_negative { -1.0 } else { 1.0 };
                [if turn == 0.0 { place } else { turned * place }, turned * (from_y * DVec3::Z)]
            }
            Self::Angles { azimuth, elevation } => {
                let (sine, cosine) = (azimuth + turn).to_radians().sin_cos();
                let front = from_y * DVec3::new(sine, 0.0, cosine);
                let (sine, cosine) = elevation.to_radians().sin_cos();
                [cosine * front + sine * up, front]
            }
        };
        let is_vertical = place.cross(up).length() < 1e-9;
        let upward = if is_vertical { -front * place.dot(up).signum() } else { up };
        [-place, upward]
    }
}

/// Turns a direction about `up` by some degrees, counter-clockwise seen from above.
#[must_use]
pub fn turned(direction: DVec3, up: DVec3, degrees: f64) -> DVec3 {
    DQuat::from_axis_angle(up.normalize_or(DVec3::Y), degrees.to_radians()) * direction
}

impl fmt::Display for Viewpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Axis { axis, is_negative } => {
                let sign = if is_negative { "-" } else { "" };
                write!(f, "{sign}{}", AXES[axis.min(2)])
            }
            _ if *self == Self::ISOMETRIC => f.write_str("iso"),
            Self::Angles { azimuth, elevation } => write!(f, "{azimuth},{elevation}"),
        }
    }
}

impl From<Viewpoint> for String {
    fn from(view: Viewpoint) -> Self {
        view.to_string()
    }
}

impl TryFrom<String> for Viewpoint {
    type Error = ViewpointError;

    fn try_from(text: String) -> Result<Self, ViewpointError> {
        text.parse()
    }
}

impl FromStr for Viewpoint {
    type Err = ViewpointError;

    fn from_str(text: &str) -> Result<Self, ViewpointError> {
        let text = text.trim();
        let text = SIDES.iter().find(|(side, _)| *side == text).map_or(text, |(_, text)| text);
        if text == "iso" {
            return Ok(Self::ISOMETRIC);
        }
        let (is_negative, name) = match text.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        if let Some(axis) = AXES.iter().position(|axis| *axis == name) {
            return Ok(Self::Axis { axis, is_negative });
        }
        let number = |text: &str| text.trim().parse::<f64>().map_err(|_| ViewpointError);
        let (azimuth, elevation) = text.split_once(',').ok_or(ViewpointError)?;
        let (azimuth, elevation) = (number(azimuth)?, number(elevation)?);
        let is_near = azimuth.abs() <= 36e3 && elevation.abs() <= 90.0;
        if is_near { Ok(Self::Angles { azimuth, elevation }) } else { Err(ViewpointError) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(text: &str, up: DVec3, turn: f64) -> [DVec3; 2] {
        text.parse::<Viewpoint>().unwrap().axes(up, turn)
    }

    #[test]
    fn texts_round_trip() {
        for text in ["x", "-x", "y", "-y", "z", "-z", "iso", "30,20", "-120.5,-90"] {
            assert_eq!(text.parse::<Viewpoint>().unwrap().to_string(), text);
        }
        for (name, text) in [("top", "0,90"), ("left", "-90,0"), ("xz", "-y")] {
            assert_eq!(name.parse::<Viewpoint>().unwrap().to_string(), text);
        }
        for text in ["", "w", "--x", "30", "30,91", "nan,0", "1,2,3", "inf,0"] {
            assert_eq!(text.parse::<Viewpoint>(), Err(ViewpointError), "{text}");
        }
    }

    #[test]
    fn names_and_angles_are_the_same_places() {
        for (name, angles) in
            [("z", "0,0"), ("x", "90,0"), ("-z", "180,0"), ("-x", "-90,0"), ("y", "0,90"), ("-y", "0,-90")]
        {
            for turn in [0.0, 35.0] {
                let [a, b] = [axes(name, DVec3::Y, turn), axes(angles, DVec3::Y, turn)];
                assert!(a.iter().zip(b).all(|(a, b)| (*a - b).length() < 1e-12), "{name} {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn up_is_never_parallel_to_the_view() {
        for up in [DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::new(1.0, 2.0, -0.5)] {
            for text in ["x", "-x", "y", "-y", "z", "-z", "iso", "0,90", "10,-90"] {
                let [direction, upward] = axes(text, up, 20.0);
                assert!(direction.cross(upward).length() > 0.1, "{text} {up}");
            }
        }
        // From above, with z up, x is to the right and y up in the picture, as on a map.
        let [direction, upward] = axes("z", DVec3::Z, 0.0);
        assert!((direction - DVec3::NEG_Z).length() < 1e-12 && (upward - DVec3::Y).length() < 1e-12);
    }
}
