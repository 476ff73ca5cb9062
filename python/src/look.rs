//! Makes cameras, settings and encoding for an existing scene from the text of a scene file, which Python writes from
//! its arguments.

use std::io::Read as _;

use pyo3::prelude::*;

use crate::fault::{Fault, Outcome};
use pinhole::camera::{Camera, CameraError};
use pinhole::light::environment::Environment;
use pinhole::{Encoding, Film, LayerSet, RenderSettings, Scene, View};
use pinhole_data::added::ArrowKey;
use pinhole_data::kind::{Kind, Traits};
use pinhole_data::load::open_regular;
use pinhole_figure::annotate::{AnnotationError, Annotations};
use pinhole_figure::color_by::ColorKey;
use pinhole_figure::kind::KindSettings;
use pinhole_figure::read::environment;
use pinhole_figure::scene_file::{IntegratorKind, SceneFile, SceneFileError};

/// The text of a scene file, with the Python argument for each line.
#[derive(Clone, Debug, Default)]
pub(crate) struct SceneText {
    text: String,
    /// The argument of each line, such as `studio` or `studio.outline`; may be empty.
    arguments: Vec<String>,
    /// The kind of data that was asked for.
    kind: Option<Kind>,
}

impl<'py> FromPyObject<'_, 'py> for SceneText {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let (text, arguments, kind): (_, _, Option<String>) = object.extract()?;
        let of_name = |name: String| {
            Kind::of_name(&name).ok_or_else(|| {
                let names: Vec<&str> = Kind::ALL.iter().map(|kind| kind.name()).collect();
                Fault::Input(format!("kind is {name:?}; the kinds are {}", names.join(", ")))
            })
        };
        Ok(Self { text, arguments, kind: kind.map(of_name).transpose()? })
    }
}

impl SceneText {
    pub(crate) fn parse(&self) -> Outcome<SceneFile> {
        SceneFile::parse(&self.text).map_err(|error| self.fault(&error))
    }

    /// The settings of the kind of data, for what the text does not say. `is_given` tells the same for other places.
    pub(crate) fn of_kind(&self, traits: &Traits, is_given: impl Fn(&str) -> bool) -> KindSettings {
        let has = |key: &str| self.arguments.iter().any(|of| of.split(['.', '[']).next() == Some(key));
        KindSettings::new(traits, None, |key| has(key) || is_given(key))
    }

    /// The text with the settings of a kind of data.
    pub(crate) fn with_kind(&self, settings: &KindSettings) -> Self {
        // A text without settings does not name its data either.
        let data = if self.is_empty() && !settings.data.is_empty() { "data = \"spheres\"\n" } else { "" };
        let before = [data, &settings.data].concat();
        let arguments = before.lines().map(|_| String::new()).chain(self.arguments.iter().cloned()).collect();
        Self { text: before + &self.text, arguments, kind: self.kind }
    }

    /// The kind of data that was asked for.
    pub(crate) fn kind(&self) -> Option<Kind> {
        self.kind
    }

    /// Whether there are no settings.
    pub(crate) fn is_empty(&self) -> bool {
        self.text.trim().is_empty()
    }

    /// Makes a fault from an error in the text, with the argument in place of the line.
    pub(crate) fn fault(&self, error: &SceneFileError) -> Fault {
        let argument = self.arguments.get(error.line.saturating_sub(1)).map_or("", String::as_str);
        let message = &error.message;
        Fault::Input(match argument.is_empty() {
            true => message.clone(),
            false => format!("{argument}: {message}"),
        })
    }
}

/// The camera, the settings and the encoding of a scene's picture.
pub(crate) struct Look {
    pub(crate) film: Film,
    /// The camera; for a stereo camera, the view from the middle between the eyes.
    pub(crate) camera: Box<dyn Camera>,
    /// The left and the right eye of a stereo camera.
    pub(crate) eyes: Option<[Box<dyn Camera>; 2]>,
    pub(crate) settings: RenderSettings,
    pub(crate) encoding: Encoding,
    /// Annotations to draw over the picture.
    pub(crate) annotations: Annotations,
    pub(crate) notes: Vec<String>,
}

impl Look {
    /// Reads the text for a scene. `key` has the meaning of colours, and `arrows` that of arrows.
    pub(crate) fn new(
        text: &SceneText,
        scene: &Scene,
        key: Option<&ColorKey>,
        arrows: Option<&ArrowKey>,
    ) -> Outcome<Self> {
        let file = text.parse()?;
        let film = file.film;
        let free_sides = file.annotations.free_sides(key, film);
        let subject = scene.subject().with_free_sides(free_sides);
        let parameters = file.camera_parameters();
        let refused = |error: CameraError| text.fault(&file.at_camera(&error));
        let aspect = film.aspect();
        let camera = parameters.camera(aspect, &subject).map_err(refused)?;
        let eyes = parameters.stereo_pair(aspect, &subject).map_err(refused)?;
        let kind = file.integrator().unwrap_or_default();
        let sky = file.sky_image().filter(|_| kind == IntegratorKind::Path);
        let sky = sky.map(environment_of).transpose()?;
        let settings = file.settings(kind, scene, camera.as_ref(), sky);
        let mut settings = settings.map_err(|error| text.fault(&error))?;
        let mut encoding = file.encoding;
        encoding.background = settings.visible_background();
        settings.is_transparent = encoding.transparent;
        let mut notes = settings.notes(scene);
        let middle = scene.bounds_to_frame();
        let middle = 0.5 * (middle.min() + middle.max());
        let view = View::new(camera.as_ref(), film);
        let made = file.annotations.annotations(key, arrows, &view, middle);
        let (annotations, more) = made.map_err(|error| match error {
            AnnotationError::NoKey => Fault::Input(format!("{error}, with color_by or cmap, or draw arrows")),
            error => Fault::input(error),
        })?;
        notes.extend(more);
        Ok(Self { film, camera, eyes, settings, encoding, annotations, notes })
    }

    /// The view of the camera, or of the middle between two eyes.
    pub(crate) fn view(&self) -> View<'_> {
        View::new(self.camera.as_ref(), self.film)
    }

    /// The views to render: one, or those of two eyes.
    pub(crate) fn views(&self) -> Vec<View<'_>> {
        match &self.eyes {
            None => vec![self.view()],
            Some(eyes) => eyes.iter().map(|eye| View::new(eye.as_ref(), self.film)).collect(),
        }
    }

    /// Returns these layers and those that encoding needs.
    pub(crate) fn layers(&self, asked: LayerSet) -> LayerSet {
        asked.iter().chain(self.encoding.layers().iter()).collect()
    }
}

/// Reads the image of the sky.
fn environment_of(path: &str) -> Outcome<Environment> {
    let mut bytes = Vec::new();
    let read = open_regular(path.as_ref()).and_then(|mut file| file.read_to_end(&mut bytes));
    read.map_err(|error| Fault::File(format!("sky: {path}: cannot be read: {error}")))?;
    environment::read(&bytes).map_err(|error| Fault::Input(format!("sky: {path}: {error}")))
}

/// The camera of a text with its position, as JSON. It frames the box between two corners, or else the scene.
pub(crate) fn placed(text: &SceneText, framed: &Scene) -> Outcome<String> {
    let file = text.parse()?;
    let placed = file.camera_parameters().placed(file.film.aspect(), &framed.subject());
    let placed = placed.map_err(|error| text.fault(&file.at_camera(&error)))?;
    serde_json::to_string(&placed).map_err(|error| Fault::Internal(error.to_string()))
}
