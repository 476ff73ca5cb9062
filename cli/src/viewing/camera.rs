//! A camera that a viewer moves.

use toml::Value;

use crate::flags::camera::{CameraTable, list};
use crate::viewing::ViewError;
use crate::viewing::flags::RenderFlags;
use pinhole::camera::CameraParameters;
use pinhole::geometry::bounds::Bounds;
use pinhole::glam::DVec3;
use pinhole_figure::scene_file::SceneFile;
use pinhole_figure::settings::flags::{FLAGS, Flag, Group};
use pinhole_figure::settings::{Layer, Sources};

/// A camera of any kind that has a position, stored as camera flags that a viewer changes.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewCamera(CameraTable);

impl ViewCamera {
    /// Takes the parameters of a camera, such as [`crate::viewing::Facts::camera`]; `None` if they have no position.
    pub fn new(parameters: &CameraParameters) -> Option<Self> {
        let camera = Self(CameraTable::new(parameters)?);
        camera.place().map(|_| camera)
    }

    /// The eye, the direction of view, which is not normalized, and the direction that is up.
    fn place(&self) -> Option<[DVec3; 3]> {
        let eye = self.0.vector("eye")?;
        let toward = self.0.vector("look_at").map(|point| point - eye);
        Some([eye, toward.or_else(|| self.0.vector("direction"))?, self.0.vector("up")?])
    }

    /// The position of the camera.
    pub fn eye(&self) -> DVec3 {
        self.place().map_or(DVec3::ZERO, |[eye, ..]| eye)
    }

    /// The direction in which the camera looks, of unit length.
    pub fn direction(&self) -> DVec3 {
        self.place().map_or(DVec3::NEG_Z, |[_, direction, _]| direction.normalize_or(DVec3::NEG_Z))
    }

    /// The direction that is up in the picture: perpendicular to the view, of unit length.
    pub fn up(&self) -> DVec3 {
        let up = self.place().map_or(DVec3::Y, |[.., up]| up);
        let forward = self.direction();
        (up - up.dot(forward) * forward).normalize_or(forward.any_orthonormal_vector())
    }

    /// The point at which the camera looks, if it has one.
    pub fn look_at(&self) -> Option<DVec3> {
        self.0.vector("look_at")
    }

    /// Whether far spheres are as large as near ones, so that moving the camera does not enlarge them.
    pub fn is_orthographic(&self) -> bool {
        self.0.kind == "orthographic"
    }

    /// Moves the camera. Numbers are rounded to the precision that a picture can show, so that flags stay short.
    pub fn set_place(&mut self, eye: DVec3, look_at: DVec3, up: DVec3) {
        let scale = eye.distance(look_at);
        let place = |point: DVec3| list(point.to_array().map(|x| rounded(x, 1e-6 * scale)));
        let up = up.normalize_or(DVec3::Y).to_array().map(|x| rounded(x, 1e-6));
        for (key, value) in [("eye", place(eye)), ("look_at", place(look_at)), ("up", list(up))] {
            self.0.set(key, value);
        }
        self.0.table.remove("direction");
    }

    /// Enlarges the picture of an orthographic camera.
    pub fn enlarge(&mut self, factor: f64) {
        let zoom = self.0.table.get("zoom").and_then(Value::as_float).unwrap_or(1.0) * factor;
        let zoom = zoom.clamp(1e-3, 1e3);
        self.0.set("zoom", rounded(zoom, 1e-4 * zoom));
    }

    /// Changes the view plane of a camera, if it has one, to this aspect ratio (width over height), so that
    /// the picture is not stretched. The height stays.
    pub fn set_aspect(&mut self, aspect: f64) {
        let plane = self.0.table.get("half_extent").and_then(Value::as_array);
        if let Some(height) = plane.and_then(|plane| plane.get(1)).and_then(Value::as_float) {
            let [width, height] = [height * aspect, height].map(|side| rounded(side, 1e-6 * height));
            self.0.set("half_extent", list([width, height]));
        }
    }

    /// The parameters of the camera.
    pub fn parameters(&self) -> Result<CameraParameters, ViewError> {
        self.0.clone().parameters().map_err(ViewError::usage)
    }
}

/// Rounds a number to a power of ten of about this step.
fn rounded(number: f64, step: f64) -> f64 {
    let digits = -step.log10().floor();
    if !digits.is_finite() {
        return number;
    }
    // The shortest text that is near enough is read back as the same number.
    let digits = digits.clamp(0.0, 17.0) as usize;
    let text = format!("{number:.digits$}");
    let number = text.parse::<f64>().unwrap_or(number);
    if number == 0.0 { 0.0 } else { number }
}

impl ViewCamera {
    /// Writes the camera into flags, and removes all other flags of the camera.
    pub fn write_to(&self, flags: &mut RenderFlags) {
        flags.remove_camera();
        if self.0.kind != "pinhole" {
            flags.set("camera", &self.0.kind);
        }
        let is_camera = |flag: &&Flag| flag.group == Group::Camera && flag.key != "camera";
        for Flag { key, flag, .. } in FLAGS.iter().filter(is_camera) {
            let key = key.trim_start_matches("camera.*.");
            let value = match key.split_once('.') {
                None => self.0.table.get(key),
                Some((table, key)) => {
                    self.0.table.get(table).and_then(Value::as_table).and_then(|inner| inner.get(key))
                }
            };
            if let Some(value) = value.and_then(text) {
                flags.set(flag.trim_start_matches('-'), &value);
            }
        }
    }

    /// Writes flags that keep the direction of the camera and frame the whole scene.
    pub fn write_fit_to(&self, flags: &mut RenderFlags) {
        let round = |v: DVec3| list(v.to_array().map(|x| rounded(x, 1e-6)));
        let mut fit = self.clone();
        fit.0.set("direction", round(self.direction()));
        fit.0.set("up", round(self.up()));
        for key in ["eye", "look_at", "zoom", "half_extent", "distance"] {
            fit.0.table.remove(key);
        }
        fit.write_to(flags);
    }
}

impl RenderFlags {
    /// Returns the camera of the flags, if they give its position.
    pub fn camera(&self) -> Result<Option<ViewCamera>, ViewError> {
        if self.get("eye").is_none() {
            return Ok(None);
        }
        let layers = self.render_args("-")?.input.view.given.layers()?;
        let layers: Vec<Layer> = layers.into_iter().filter(|l| l.text.starts_with("camera.")).collect();
        let file = SceneFile::read(&Sources { flags: &layers, ..Sources::default() });
        let file = file.map_err(|error| ViewError::usage(error.to_string()))?;
        let parameters = file.camera_parameters();
        // A camera with an eye does not depend on the spheres, so any bounds will do.
        let any = Bounds::of_sphere(DVec3::ZERO, 1.0);
        let placed = parameters.placed(1.0, &(&any).into());
        Ok(ViewCamera::new(&placed.map_err(|error| ViewError::usage(error.to_string()))?))
    }
}

/// Formats the value of a flag. Numbers are read back to the bit.
fn text(value: &Value) -> Option<String> {
    match value {
        Value::Float(number) => Some(number.to_string()),
        Value::Integer(number) => Some(number.to_string()),
        Value::Array(numbers) => Some(numbers.iter().map(text).collect::<Option<Vec<_>>>()?.join(",")),
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

    /// Flags written by a camera give the same camera again, to the bit.
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
        camera.set_place(DVec3::new(100.0 / 3.0, -1e-9, 7.0), DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.0, 3.0, 0.0));
        let mut flags = RenderFlags::parse(["a.pdb"]).unwrap();
        camera.write_to(&mut flags);
        assert_eq!(flags.words()[1..], ["--eye=33.33333,0,7", "--look-at=0.1,0.2,0.3", "--up=0,1,0"]);
        camera.write_fit_to(&mut flags);
        assert_eq!(flags.get("eye"), None);
        assert!(flags.get("direction").is_some() && flags.check().is_ok());
    }
}
