//! A camera that a viewer moves.

use pinhole::camera::CameraParameters;
use pinhole::glam::DVec3;
use serde::Deserialize;
use toml::{Table, Value};

use super::ViewError;

/// A camera of any kind, with its place in the world: the flags of the camera as a viewer changes them.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewCamera {
    pub(super) kind: String,
    /// The table of this kind in a scene file.
    pub(super) table: Table,
}

impl ViewCamera {
    /// Takes the parameters of a camera that has its place, as [`super::Shown::camera`] has. `None` if it has no place.
    #[must_use]
    pub fn new(parameters: &CameraParameters) -> Option<Self> {
        let Ok(Value::Table(document)) = Value::try_from(parameters) else { return None };
        let (kind, Value::Table(table)) = document.into_iter().next()? else { return None };
        let camera = Self { kind, table };
        camera.place().map(|_| camera)
    }

    /// The eye, the direction of view, which is no unit vector, and the direction that is up.
    fn place(&self) -> Option<[DVec3; 3]> {
        let eye = self.vector("eye")?;
        let toward = self.vector("look_at").map(|point| point - eye);
        Some([eye, toward.or_else(|| self.vector("direction"))?, self.vector("up")?])
    }

    fn vector(&self, key: &str) -> Option<DVec3> {
        let numbers = self.table.get(key)?.as_array()?;
        let numbers: Vec<f64> = numbers.iter().filter_map(Value::as_float).collect();
        <[f64; 3]>::try_from(numbers).ok().map(DVec3::from)
    }

    /// The position of the camera.
    #[must_use]
    pub fn eye(&self) -> DVec3 {
        self.place().map_or(DVec3::ZERO, |[eye, ..]| eye)
    }

    /// The direction in which the camera looks, of unit length.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.place().map_or(DVec3::NEG_Z, |[_, direction, _]| direction.normalize_or(DVec3::NEG_Z))
    }

    /// The direction that is up in the picture: perpendicular to the view, of unit length.
    #[must_use]
    pub fn up(&self) -> DVec3 {
        let up = self.place().map_or(DVec3::Y, |[.., up]| up);
        let forward = self.direction();
        (up - up.dot(forward) * forward).normalize_or(forward.any_orthonormal_vector())
    }

    /// The point at which the camera looks, if it has one.
    #[must_use]
    pub fn look_at(&self) -> Option<DVec3> {
        self.vector("look_at")
    }

    /// Whether what is far is as large as what is near, so that the camera comes no nearer by moving.
    #[must_use]
    pub fn is_orthographic(&self) -> bool {
        self.kind == "orthographic"
    }

    /// Moves the camera. Numbers are rounded to what a picture can show, so that flags stay short.
    pub fn set_place(&mut self, eye: DVec3, look_at: DVec3, up: DVec3) {
        let scale = eye.distance(look_at);
        let place = |point: DVec3| list(point.to_array().map(|x| rounded(x, 1e-6 * scale)));
        self.table.insert("eye".to_owned(), place(eye));
        self.table.insert("look_at".to_owned(), place(look_at));
        self.table.insert(
            "up".to_owned(),
            list(up.normalize_or(DVec3::Y).to_array().map(|x| rounded(x, 1e-6))),
        );
        self.table.remove("direction");
    }

    /// Enlarges the picture of an orthographic camera.
    pub fn enlarge(&mut self, factor: f64) {
        let zoom = self.table.get("zoom").and_then(Value::as_float).unwrap_or(1.0) * factor;
        let zoom = zoom.clamp(1e-3, 1e3);
        self.table.insert("zoom".to_owned(), rounded(zoom, 1e-4 * zoom).into());
    }

    /// Lets a camera with a given view plane fill a picture of this aspect ratio (width over height) without
    /// stretching it: the height stays.
    pub fn set_aspect(&mut self, aspect: f64) {
        let plane = self.table.get("half_extent").and_then(Value::as_array);
        if let Some(height) = plane.and_then(|plane| plane.get(1)).and_then(Value::as_float) {
            let [width, height] =
                [height * aspect, height].map(|side| rounded(side, 1e-6 * height));
            self.table.insert("half_extent".to_owned(), vec![width, height].into());
        }
    }

    /// The parameters of the camera.
    ///
    /// # Errors
    /// If a key does not belong to this kind of camera, which does not happen for parameters that were taken.
    pub fn parameters(&self) -> Result<CameraParameters, ViewError> {
        let document = Table::from_iter([(self.kind.clone(), Value::Table(self.table.clone()))]);
        CameraParameters::deserialize(Value::Table(document))
            .map_err(|error| ViewError::usage(error.message()))
    }
}

pub(super) fn list(numbers: [f64; 3]) -> Value {
    numbers.to_vec().into()
}

/// Rounds to a power of ten of about this step.
pub(super) fn rounded(number: f64, step: f64) -> f64 {
    let digits = -step.log10().floor();
    if !digits.is_finite() {
        return number;
    }
    // The shortest text that is near enough, which is read back as the same number.
    let digits = digits.clamp(0.0, 17.0) as usize;
    let text = format!("{number:.digits$}");
    let number = text.parse::<f64>().unwrap_or(number);
    if number == 0.0 { 0.0 } else { number }
}
