//! The camera of a view as flags, and the flags as a camera.

use pinhole::geometry::bounds::Bounds;
use pinhole::glam::DVec3;
use toml::Value;

use super::ViewError;
use super::camera::{ViewCamera, list, rounded};
use super::flags::RenderFlags;
use crate::camera::CameraArgs;

impl ViewCamera {
    /// Writes the camera into flags, in place of all flags of the camera that were there.
    pub fn write_to(&self, flags: &mut RenderFlags) {
        flags.remove_camera();
        if self.kind != "pinhole" {
            flags.set("camera", &self.kind);
        }
        for (key, flag, _) in CameraArgs::default().keys() {
            let value = match key.split_once('.') {
                None => self.table.get(key),
                Some((table, key)) => {
                    self.table.get(table).and_then(Value::as_table).and_then(|inner| inner.get(key))
                }
            };
            if let Some(value) = value.and_then(text) {
                flags.set(flag.trim_start_matches('-'), &value);
            }
        }
    }

    /// Writes flags that let the camera keep its direction and frame the whole scene.
    pub fn write_fit_to(&self, flags: &mut RenderFlags) {
        let round = |v: DVec3| list(v.to_array().map(|x| rounded(x, 1e-6)));
        let mut fit = self.clone();
        fit.table.insert("direction".to_owned(), round(self.direction()));
        fit.table.insert("up".to_owned(), round(self.up()));
        for key in ["eye", "look_at", "zoom", "half_extent", "distance"] {
            fit.table.remove(key);
        }
        fit.write_to(flags);
    }
}

impl RenderFlags {
    /// The camera of the flags, if they say where it is.
    ///
    /// # Errors
    /// If the flags do not make a camera.
    pub fn camera(&self) -> Result<Option<ViewCamera>, ViewError> {
        if self.get("eye").is_none() {
            return Ok(None);
        }
        let flags = self.render_args("-")?.input.view.camera.flags()?;
        let parameters = flags.parameters(None, DVec3::Y).map_err(ViewError::usage)?;
        // A camera with an eye depends on no spheres, so that these are any.
        let any = Bounds::of_sphere(DVec3::ZERO, 1.0);
        let placed = parameters.placed(1.0, &(&any).into());
        Ok(ViewCamera::new(&placed.map_err(|error| ViewError::usage(error.to_string()))?))
    }
}

/// The value of a flag. Numbers are written such that they are read back to the bit.
fn text(value: &Value) -> Option<String> {
    match value {
        Value::Float(number) => Some(number.to_string()),
        Value::Integer(number) => Some(number.to_string()),
        Value::Array(numbers) => {
            Some(numbers.iter().map(text).collect::<Option<Vec<_>>>()?.join(","))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pinhole::camera::CameraParameters;

    fn parameters(table: &str) -> CameraParameters {
        toml::from_str(table).unwrap()
    }

    /// Flags written by a camera make the same camera again, to the bit.
    #[test]
    fn a_camera_survives_its_flags() {
        for table in [
            "[pinhole]\neye = [1.0, 2.0, 0.1]\ndirection = [0.3, -0.1, -1.0]\nup = [0.0, 1.0, 0.0]\nvertical_fov = 20.1\nzoom = 1.3",
            "[orthographic]\neye = [1e-7, 2.5, 3e5]\nlook_at = [0.1, 0.2, 0.3]\nup = [0.0, 1.0, 0.0]\nhalf_extent = [4.0, 3.0]",
            "[thin-lens]\neye = [9.0, 0.0, 0.0]\nlook_at = [0.1, 0.2, 0.3]\nup = [0.0, 1.0, 0.0]\naperture_radius = 0.1\nfocus_distance = 8.0",
            "[pinhole]\neye = [9.0, 0.0, 0.0]\nlook_at = [0.0, 0.0, 0.0]\nup = [0.0, 1.0, 0.0]\nstereo = { separation = 0.1, convergence = 9.0 }",
        ] {
            let parameters = parameters(table);
            let camera = ViewCamera::new(&parameters).unwrap();
            let mut flags = RenderFlags::parse(["a.pdb", "--view=x", "--style=flat"]).unwrap();
            camera.write_to(&mut flags);
            assert_eq!((flags.get("view"), flags.get("style")), (None, Some("flat")));
            let read = flags.camera().unwrap().unwrap();
            assert_eq!(read, camera, "{flags:?}");
            assert_eq!(read.parameters().unwrap(), parameters);
        }
    }

    #[test]
    fn a_moved_camera_has_short_numbers() {
        let mut camera = ViewCamera::new(&parameters(
            "[pinhole]\neye = [0.0, 0.0, 50.0]\ndirection = [0.0, 0.0, -1.0]\nup = [0.0, 1.0, 0.0]",
        ))
        .unwrap();
        camera.set_place(
            DVec3::new(100.0 / 3.0, -1e-9, 7.0),
            DVec3::new(0.1, 0.2, 0.3),
            DVec3::new(0.0, 3.0, 0.0),
        );
        let mut flags = RenderFlags::parse(["a.pdb"]).unwrap();
        camera.write_to(&mut flags);
        assert_eq!(
            flags.words()[1..],
            ["--eye=33.33333,0,7", "--look-at=0.1,0.2,0.3", "--up=0,1,0"]
        );
        camera.write_fit_to(&mut flags);
        assert_eq!(flags.get("eye"), None);
        assert!(flags.get("direction").is_some() && flags.check().is_ok());
    }
}
