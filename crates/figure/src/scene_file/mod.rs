//! Reads scene files: TOML text that describes the film, the camera, the render settings and the shapes. This module
//! does not access the file system.
//!
//! The commented files `examples/*.toml` show every table and key.

mod camera_path;
mod cones;
mod data;
mod data_error;
mod data_scene;
mod document;
mod lighting;
mod mapping;
mod materials;
mod settled;
mod shapes;
mod show;
pub(crate) mod span;
mod tubes;

pub use camera_path::parse_camera_path;
pub use cones::{ConeFile, OwnCones};
pub(crate) use cones::{ConeTable, CylinderTable};
pub(crate) use data::{ArrowsTable, BondsTable, BoxTable};
pub use data::{Data, Element};
pub use data_error::DataError;
pub use data_scene::DataScene;
pub(crate) use document::Document;
pub use document::KEYS_OF_DATA;
pub(crate) use lighting::DepthCuePlan;
pub use lighting::IntegratorKind;
pub use settled::Settled;
pub use shapes::OwnShapes;
pub(crate) use shapes::SphereTable;
pub use show::{Show, ShowColor};
pub(crate) use show::{ShowTable, unknown_style};
pub use span::{DEFAULT_COLOR, SceneFileError};
pub(crate) use tubes::TubeTable;

use crate::annotate::AnnotationPlan;
use crate::settings::flags::{FLAGS, Group};
use crate::settings::layers::{Joined, Sources};
use crate::style::{Style, fit};
use cones::ConesTable;
use lighting::{IntegratorChoice, SceneLighting};
use pinhole::camera::film::Film;
use pinhole::camera::{Camera, CameraError, CameraParameters, CameraPath, View};
use pinhole::image::color::LinearRgb;
use pinhole::image::encoding::Encoding;
use pinhole::internals::exact::Table;
use pinhole::light::environment::Environment;
use pinhole::light::{Sky, SkyLight};
use pinhole::render::{Integrator, RenderSettings, Sampling, SettingsError};
use pinhole::scene::material::Material;
use pinhole::scene::sphere::Sphere;
use pinhole::scene::{Scene, SceneError};
use pinhole_data::load::ConeSet;
use span::{Span, WithSpan, scaled};

/// The contents of a scene file.
#[derive(Debug)]
pub struct SceneFile {
    /// Size of the picture, and the direction of its y axis.
    pub film: Film,
    /// How the picture is encoded: exposure, tone curve, transparency and bits.
    pub encoding: Encoding,
    /// What is drawn over the picture.
    pub annotations: AnnotationPlan,
    /// What is seen where there is nothing.
    pub background: LinearRgb,
    /// All keys and tables.
    document: Document,
    style: Option<Style>,
    lighting: SceneLighting,
    data: Option<WithSpan<Data>>,
    camera: WithSpan<CameraParameters>,
    camera_path: Option<CameraPath>,
    shapes: OwnShapes,
    /// The positions of the spheres.
    spheres: Vec<Span>,
    /// The tables of the cylinders and cones.
    cones: Vec<ConesTable>,
    asked: IntegratorChoice,
    /// The positions of the ground and of the image of the sky.
    spans: [Span; 2],
    flags: Vec<(String, &'static str)>,
    kept: Vec<String>,
}

impl SceneFile {
    /// Parses the text of a scene file.
    ///
    /// # Errors
    /// Returns the first error in the text, with its line and column.
    pub fn parse(text: &str) -> Result<Self, SceneFileError> {
        Self::read(&Sources { file: text, ..Sources::default() })
    }

    /// Reads the text of a scene file, the flags that take precedence over it, and its style.
    ///
    /// # Errors
    /// Returns the first error, with its line and column, or with its flag.
    pub fn read(sources: &Sources<'_>) -> Result<Self, SceneFileError> {
        let mut layers = Joined::read(sources)?;
        let depth_cue = layers.take("studio.depth_cue")?;
        let document: Document = layers.document()?;
        let places = &layers.places;
        materials::check(&document.materials, places)?;
        let data = document.data(&layers)?;
        let spheres = shapes::spheres(&document.spheres, &document.materials, places)?;
        let (spheres, own_spheres): (Vec<_>, _) = spheres.into_iter().map(|of| (of.span, of.value)).unzip();
        let cones = cones::cones((&document.cylinders, &document.cones), &document.materials, places)?;
        let tubes = tubes::tubes(&document.tubes, &document.materials, places)?;
        let (cones, own_cones) = cones.into_iter().chain(tubes).unzip();
        let shapes = OwnShapes { spheres: own_spheres, cones: own_cones };
        let has_materials = document.material.is_some()
            || document.opacity.is_some()
            || document.opacity_by.is_some()
            || document.emission_by.is_some()
            || has_surface(&shapes, data.as_ref());
        let path = document.camera_path.as_ref();
        let path = path.map(|Table(path)| path.path("camera_path.", places));
        Ok(Self {
            film: document.film.0.film(places)?,
            encoding: document.output.0.encoding(places)?,
            annotations: document.annotations(places)?,
            background: document.background.unwrap_or(LinearRgb::WHITE),
            style: layers.style,
            asked: IntegratorChoice::read(&layers, has_materials)?,
            lighting: SceneLighting::read(&document, depth_cue, &layers)?,
            data,
            camera: WithSpan { value: document.camera, span: places.span("camera") },
            camera_path: path.transpose()?,
            shapes,
            spheres,
            cones,
            spans: ["ground", "sky.image"].map(|key| places.span(key)),
            flags: layers.flags(),
            kept: layers.kept,
            document,
        })
    }

    /// Returns the files of cylinders and cones, in the order of their tables.
    pub fn cone_files(&self) -> impl Iterator<Item = &ConeFile> {
        self.cones.iter().filter_map(|table| table.file.as_ref())
    }

    /// Reads the files of cylinders and cones with a function, whose error is the message. Returns their notes.
    ///
    /// # Errors
    /// Returns the first error, with the position of the path in the scene file.
    pub fn read_cones(
        &mut self,
        mut read: impl FnMut(&ConeFile) -> Result<ConeSet, String>,
    ) -> Result<Vec<String>, SceneFileError> {
        let mut notes = Vec::new();
        for (table, own) in self.cones.iter_mut().zip(&mut self.shapes.cones) {
            let Some(file) = &table.file else { continue };
            let mut set = read(file).map_err(|error| table.span.error(error))?;
            notes.append(&mut set.notes);
            *own = table.fill(set)?;
        }
        Ok(notes)
    }

    /// Makes the scene of the file's own shapes. [`Data::scene`] makes that of its data.
    ///
    /// # Errors
    /// Names the first shape that is out of range, with its position; or a file that [`SceneFile::read_cones`] has not
    /// read.
    pub fn scene(&self) -> Result<Scene, SceneFileError> {
        if let Some(table) = self.cones.iter().find(|table| table.is_open) {
            return Err(table.span.error("this file has not been read; call `read_cones` before"));
        }
        self.shapes().scene().map_err(|error| self.at_shape(&error))
    }

    /// Adds the position of a shape, or of the key `data`, to an error of a scene: first the file's own shapes of a
    /// kind, then those of its data.
    #[must_use]
    pub fn at_shape(&self, error: &SceneError) -> SceneFileError {
        let own = &self.shapes.cones;
        let (mut index, what, fault) = match error {
            SceneError::Sphere { index, error: of_sphere } => {
                if let Some(span) = self.spheres.get(*index) {
                    return span.error(error);
                }
                (*index - self.spheres.len(), "sphere", of_sphere.to_string())
            }
            SceneError::Cone { index, error } => (*index, "bond or edge", error.to_string()),
            _ => return Span::START.error(error),
        };
        let is_sphere = what == "sphere";
        for (table, own) in self.cones.iter().zip(own) {
            let count = if is_sphere { own.ends.len() } else { own.cones.len() };
            if index < count {
                return match &table.file {
                    // Without round ends, shapes have the order of the file.
                    Some(of) if own.ends.is_empty() => table.span.error(format!("{}: row {index}: {fault}", of.file)),
                    Some(of) => table.span.error(format!("{}: {fault}", of.file)),
                    None => table.span.error(format!("{}: {fault}", table.name)),
                };
            }
            index -= count;
        }
        match &self.data {
            Some(data) => data.span.error(format!("{what} {index} of {}: {fault}", data.value.file)),
            None => Span::START.error(error),
        }
    }

    /// Adds the position of the camera's table to an error.
    #[must_use]
    pub fn at_camera(&self, error: &CameraError) -> SceneFileError {
        let mut error = self.camera.span.error(error);
        if self.has_camera_of_flags() {
            // Several flags say what the camera is, and the error names the one that is wrong.
            error.flag = Some("");
            for flag in FLAGS.iter().filter(|flag| flag.group == Group::Camera) {
                let key = flag.key.rsplit('.').next().unwrap_or_default();
                error.message = error.message.replace(&format!("`{key}`"), &format!("`{}`", flag.flag));
            }
        }
        error
    }

    /// Returns true if flags say what the camera is.
    #[must_use]
    pub fn has_camera_of_flags(&self) -> bool {
        self.flags.iter().any(|(key, _)| key == "camera" || key.starts_with("camera."))
    }

    /// Returns the style, if there is one.
    #[must_use]
    pub fn style(&self) -> Option<Style> {
        self.style
    }

    /// Returns the parameters of the camera.
    #[must_use]
    pub fn camera_parameters(&self) -> CameraParameters {
        self.camera.value
    }

    /// Returns the path along which the camera moves from picture to picture, if the file has one.
    #[must_use]
    pub fn camera_path(&self) -> Option<&CameraPath> {
        self.camera_path.as_ref()
    }

    /// Returns the spheres that are in the file itself.
    pub fn spheres(&self) -> impl Iterator<Item = Sphere> {
        self.shapes.spheres.iter().copied()
    }

    /// Returns the shapes that are in the file itself, or in files of cylinders and cones that were read.
    #[must_use]
    pub fn shapes(&self) -> &OwnShapes {
        &self.shapes
    }

    /// Returns the reference to a data file, if the scene file has one.
    #[must_use]
    pub fn data(&self) -> Option<&Data> {
        self.data.as_ref().map(|data| &data.value)
    }

    /// Makes the camera for a film of this aspect ratio. For a stereo camera this is the view from the middle between
    /// the eyes. A camera without an eye position frames the scene.
    ///
    /// # Errors
    /// If a parameter is out of range, or parameters exclude each other.
    pub fn camera(&self, film: &Film, scene: &Scene) -> Result<Box<dyn Camera>, SceneFileError> {
        self.camera.value.camera(film.aspect(), &scene.subject()).map_err(|error| self.at_camera(&error))
    }

    /// Makes the cameras of the left and the right eye, if the camera of the file is a stereo camera.
    ///
    /// # Errors
    /// If a parameter is out of range, or parameters exclude each other.
    pub fn stereo_pair(&self, film: &Film, scene: &Scene) -> Result<Option<[Box<dyn Camera>; 2]>, SceneFileError> {
        self.camera.value.stereo_pair(film.aspect(), &scene.subject()).map_err(|error| self.at_camera(&error))
    }
}

/// Whether the surface of any shape is not matt and opaque.
fn has_surface(shapes: &OwnShapes, data: Option<&WithSpan<Data>>) -> bool {
    let matt = pinhole::scene::material::SurfaceProperties::default();
    let of_data = data.iter().flat_map(|data| {
        let elements = data.value.elements.iter().map(|element| element.surface);
        elements.chain([data.value.surface])
    });
    let own = shapes.spheres.iter().map(|sphere| sphere.surface);
    own.chain(shapes.cones.iter().map(|own| own.surface)).chain(of_data).any(|surface| surface != matt)
}

impl SceneFile {
    /// Returns the integrator that the file asks for: with the key `integrator`, or with a table, material or opacity
    /// that needs a lit picture. `None` means that the file asks for nothing, so that primary rays are enough.
    #[must_use]
    pub fn integrator(&self) -> Option<IntegratorKind> {
        self.asked.by_scene
    }

    /// Returns the integrator of the picture: the one that a flag names, or that the scene asks for, or that flags need.
    #[must_use]
    pub fn kind(&self) -> IntegratorKind {
        self.asked.kind()
    }

    /// Returns the flag that gives a key, such as `film.width`.
    #[must_use]
    pub fn flag_of(&self, key: &str) -> Option<&'static str> {
        self.flags.iter().find(|(other, _)| other == key).map(|(_, flag)| *flag)
    }

    /// Returns the keys that a style which a flag names does not decide, because the file gives other values.
    #[must_use]
    pub fn kept_from_style(&self) -> &[String] {
        &self.kept
    }

    /// Returns the path of the sky image, relative to the scene file. Only the integrator `path` needs the image.
    #[must_use]
    pub fn sky_image(&self) -> Option<&str> {
        self.document.sky.as_ref()?.0.image()
    }

    /// Returns the render settings for an integrator, which need not be the one that the file asks for; tables that it
    /// does not use are ignored. If the file names lights, a sun or a sky, there are no other lights; otherwise there
    /// are the default lights. Missing values follow from the scene and, for the depth cue, from the camera. `image` is
    /// the image at [`SceneFile::sky_image`]. The settings are not transparent; the caller can change that.
    ///
    /// # Errors
    /// For a lit picture: if a colour would create light, if the integrator does not support shadow catchers, or if the
    /// image of the sky is needed and not given.
    pub fn settings(
        &self,
        kind: IntegratorKind,
        scene: &Scene,
        camera: &dyn Camera,
        image: Option<Environment>,
    ) -> Result<RenderSettings, SceneFileError> {
        let (says, defaults) = (&self.lighting, RenderSettings::studio());
        let background = self.background;
        let has_smooth_edges = self.asked.check_flags(kind)?;
        let integrator = match kind {
            IntegratorKind::Primary => {
                let integrator = Integrator::Primary(self.document.shading.unwrap_or_default());
                let settings = RenderSettings { integrator, background, ..RenderSettings::default() };
                return Ok(if has_smooth_edges { self.smooth(&settings) } else { settings });
            }
            IntegratorKind::Studio => Integrator::Studio(says.studio.studio(scene, camera, background)?),
            IntegratorKind::Path => Integrator::Path(self.document.path.unwrap_or_default().0),
        };
        // Only path tracing is lit by a sky and needs its image.
        let sky = match &self.document.sky {
            _ if kind == IntegratorKind::Studio => defaults.sky,
            Some(Table(sky)) => sky.sky(image).map_err(|error| self.spans[1].error(error))?,
            None if says.lights.is_none() || !says.given.light => defaults.sky,
            None => Sky { light: SkyLight::Constant(LinearRgb::BLACK), is_visible: false },
        };
        let mut settings = RenderSettings {
            integrator,
            sampling: self.sampling(),
            lights: says.lights.clone().unwrap_or(defaults.lights),
            sky,
            ground: self.document.ground.as_ref().map(|Table(ground)| ground.ground(scene)),
            background,
            is_transparent: false,
        };
        self.check_colors()?;
        if let Some(style) = self.style {
            fit(&mut settings, style, says.given, scene, &View::new(camera, self.film));
        }
        settings.check(scene).map(|()| settings).map_err(|error| self.span_of(&error).error(error))
    }

    /// A picture without light, with the samples and the lines that flags ask for.
    fn smooth(&self, settings: &RenderSettings) -> RenderSettings {
        let mut smooth = settings.with_smooth_edges();
        smooth.sampling = self.sampling();
        if let Integrator::Studio(studio) = &mut smooth.integrator {
            studio.outline = self.lighting.studio.outline();
        }
        smooth
    }

    fn sampling(&self) -> Sampling {
        self.document.sampling.unwrap_or_default().0
    }

    /// Refuses shapes of this file that would reflect more light than they receive, or emit too much.
    fn check_colors(&self) -> Result<(), SceneFileError> {
        let spheres = self.spheres.iter().zip(&self.shapes.spheres).enumerate();
        let spheres = spheres.map(|(index, (span, s))| (format!("sphere {index}"), *span, s.color, s.surface));
        // Files have no colours that create light.
        let cones = self.cones.iter().map(|table| (table.name.clone(), table.span, table.color, table.surface));
        for (what, span, color, surface) in spheres.chain(cones) {
            let rgb = color.to_array();
            match surface.material {
                Material::Emissive { strength } => {
                    scaled(color, strength.into(), &what).map_err(|error| span.error(error))?;
                }
                _ if rgb.iter().any(|c| *c > 1.0) => {
                    return Err(span.error(SettingsError::Albedo { what, rgb }));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Returns the position in the file that an error is about. All tables and the spheres of this file have been
    /// checked before, so only a few errors are left.
    fn span_of(&self, error: &SettingsError) -> Span {
        let ground = || Some(self.spans[0]);
        let data = || self.data.as_ref().map(|data| data.span);
        match error {
            SettingsError::Ground | SettingsError::Catcher => ground(),
            SettingsError::Albedo { what, .. } if what == "the ground" => ground(),
            SettingsError::Albedo { .. } | SettingsError::TooBright { .. } => data(),
            _ => None,
        }
        .unwrap_or(Span::START)
    }
}
