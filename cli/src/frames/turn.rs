//! Cameras that turn about an axis.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use pinhole::camera::CameraParameters;
use pinhole::glam::{DQuat, DVec3};
use serde::Deserialize;
use toml::Value;

/// The axis about which a camera turns, and a point on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub(super) direction: DVec3,
    pub(super) center: DVec3,
}

/// Turns a camera that has its position by a part of a full turn, counter-clockwise seen from above.
pub(super) fn turned(camera: &CameraParameters, axis: Axis, part: f64) -> Result<CameraParameters> {
    let turn = DQuat::from_axis_angle(axis.direction, TAU * part);
    let mut document = Value::try_from(camera).context("this camera cannot be turned")?;
    for table in document.as_table_mut().into_iter().flat_map(|kinds| kinds.iter_mut()) {
        let Some(table) = table.1.as_table_mut() else { continue };
        for (key, value) in table {
            let is_point = matches!(key.as_str(), "eye" | "look_at" | "focus_on");
            let is_direction = matches!(key.as_str(), "direction" | "up");
            if let (true, Some(vector)) = (is_point || is_direction, vector(value)) {
                let center = if is_point { axis.center } else { DVec3::ZERO };
                let turned = center + turn * (vector - center);
                *value = Value::from(turned.to_array().to_vec());
            }
        }
    }
    CameraParameters::deserialize(document).context("this camera cannot be turned")
}

/// The direction that is up for a camera that has its position.
pub(super) fn up_of(camera: &CameraParameters) -> Option<DVec3> {
    let document = Value::try_from(camera).ok()?;
    let up = document.as_table()?.values().find_map(|table| vector(table.get("up")?))?;
    up.try_normalize()
}

pub(super) fn vector(value: &Value) -> Option<DVec3> {
    let numbers: Vec<f64> = value.as_array()?.iter().filter_map(Value::as_float).collect();
    Some(DVec3::from(<[f64; 3]>::try_from(numbers).ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_moves_the_eye_from_z_to_x() {
        let table =
            "[pinhole]\neye = [1.0, 2.0, 5.0]\ndirection = [0.0, 0.0, -1.0]\nup = [0.0, 1.0, 0.0]";
        let camera: CameraParameters = toml::from_str(table).unwrap();
        let axis = Axis { direction: DVec3::Y, center: DVec3::new(1.0, 0.0, 0.0) };
        let turned = turned(&camera, axis, 0.25).unwrap();
        let turned = Value::try_from(turned).unwrap();
        let near = |key: &str, expected: [f64; 3]| {
            let found = vector(&turned["pinhole"][key]).unwrap();
            assert!((found - DVec3::from(expected)).length() < 1e-12, "{key} {found}");
        };
        near("eye", [6.0, 2.0, 0.0]);
        near("direction", [-1.0, 0.0, 0.0]);
        near("up", [0.0, 1.0, 0.0]);
        assert_eq!(up_of(&camera), Some(DVec3::Y));
    }
}
