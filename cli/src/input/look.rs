//! The camera and the settings for rendering.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Error, Result};

use super::Input;
use super::read;
use crate::flags::camera::CameraTable;
use crate::input::contents::{Contents, Details};
use crate::input::kinds::KIND;
use crate::input::read_file::Format;
use crate::input::source::{Source, default_color};
use crate::output::picture::PictureFormat;
use crate::output::report::Report;
use crate::terminal::failure::Failure;
use crate::terminal::progress;
use pinhole::camera::{Camera, CameraError, CameraKind, CameraParameters, Viewpoint};
use pinhole::geometry::bounds::Bounds;
use pinhole::glam::DVec3;
use pinhole::light::environment::Environment;
use pinhole::render::RenderSettings;
use pinhole::scene::Scene;
use pinhole_figure::color_by::ColorKey;
use pinhole_figure::read::environment;
use pinhole_figure::scene_file::SceneFile;
use pinhole_figure::settings::flags::Group;

/// A camera with its eyes, and settings, which were chosen for some spheres.
pub(crate) struct Look {
    pub(crate) camera: Box<dyn Camera>,
    pub(crate) eyes: Option<[Box<dyn Camera>; 2]>,
    pub(crate) settings: RenderSettings,
    /// The camera, with its position.
    pub(crate) parameters: CameraParameters,
    /// The flags for the view, if there are such.
    pub(crate) view: Option<String>,
}

/// What a camera frames, and what is drawn beside it.
#[derive(Clone, Copy)]
pub(crate) struct FramedScene<'a> {
    scene: &'a Scene,
    /// What the legend shows.
    key: Option<&'a ColorKey>,
}

impl<'a> FramedScene<'a> {
    pub(crate) fn new(scene: &'a Scene, key: Option<&'a ColorKey>) -> Self {
        Self { scene, key }
    }
}

/// Returns the flags that show how a camera is turned, to be used again; `None` if there is nothing to say.
fn view_in_flags(asked: &CameraParameters, automatic: Option<Viewpoint>) -> Option<String> {
    let camera = CameraTable::new(asked)?;
    let number = |key: &str| camera.table.get(key).and_then(toml::Value::as_float);
    let turn = match number("turn").unwrap_or(0.0) {
        0.0 => String::new(),
        turn => format!(" --turn {turn}"),
    };
    if let Some(view) = camera.table.get("view").and_then(toml::Value::as_str) {
        return Some(format!("--view {view}{turn}"));
    }
    if camera.vector("eye").is_some() {
        return None;
    }
    match camera.vector("direction") {
        Some(DVec3 { x, y, z }) => Some(format!("--direction {x},{y},{z}{turn}")),
        None => automatic
            .filter(|_| CameraKind::ALL.iter().any(|k| k.name() == camera.kind && k.is_linear()))
            .map(|view| format!("--view {view}{turn}")),
    }
}

/// Changes a camera that has its position.
pub(crate) type Turn<'a> = &'a dyn Fn(&CameraParameters) -> Result<CameraParameters>;

impl Source {
    /// Makes the camera and the settings for spheres, which need not be those that are rendered.
    pub(crate) fn look(
        &self,
        file: &SceneFile,
        FramedScene { scene, key }: FramedScene<'_>,
        sky: Option<Environment>,
        turn: Option<Turn<'_>>,
    ) -> Result<Look, Failure> {
        let file_name = || self.path.display().to_string();
        let free_sides = match self.output {
            PictureFormat::Exr => [0.0; 4],
            PictureFormat::Png => file.annotations.free_sides(key, file.film),
        };
        let subject = scene.subject().with_free_sides(free_sides);
        let aspect = file.film.aspect();
        // A scene file says where its camera stands.
        let facing = self.is_data().then(|| {
            subject.flat_axis().map_or(Viewpoint::OBLIQUE, |axis| Viewpoint::Axis { axis, is_negative: false })
        });
        let asked = file.camera_parameters();
        let made = |parameters: CameraParameters| {
            let camera = parameters.camera(aspect, &subject)?;
            Ok((camera, parameters.stereo_pair(aspect, &subject)?))
        };
        let standing = asked.standing(facing, self.default_up());
        let mut placed = standing.and_then(|standing| standing.placed(aspect, &subject));
        if let (Ok(placed), Some(turn)) = (&mut placed, turn) {
            *placed = turn(placed).with_context(file_name)?;
        }
        let cameras = placed.and_then(|placed| Ok((placed, made(placed)?)));
        let (parameters, (camera, eyes)) = cameras.map_err(|error| {
            if self.has_camera_of_flags(file) {
                Error::new(error).context(file_name()).into()
            } else {
                self.failure(file.at_camera(&error))
            }
        })?;
        let settings = file.settings(file.kind(), scene, camera.as_ref(), sky);
        let settings = settings.map_err(|error| self.failure(error))?;
        // A view that follows from the kind of the data need not be said.
        let of_kind = CameraTable::new(&asked).and_then(|table| file.flag_of(&format!("camera.{}.up", table.kind)));
        let has_view = self.has_camera_of_flags(file) && of_kind != Some(KIND);
        let view = if has_view { view_in_flags(&asked, facing) } else { None };
        Ok(Look { camera, eyes, settings, parameters, view })
    }

    /// Checks the camera of flags as far as is possible without a scene.
    pub(crate) fn check_camera(&self, file: &SceneFile) -> Result<(), Failure> {
        if self.given.first_in(Group::Camera as u32).is_none() {
            return Ok(());
        }
        let asked = file.camera_parameters();
        // An error in the flags themselves shows with any scene, so these bounds are arbitrary.
        let subject = &Bounds::of_sphere(DVec3::ZERO, 1.0).into();
        let standing = asked.standing(Some(Viewpoint::OBLIQUE), self.default_up());
        let checked = standing.and_then(|camera| {
            camera.camera(1.0, subject)?;
            camera.stereo_pair(1.0, subject).map(drop)
        });
        // Without an eye, the distance at which a lens is sharp depends on the scene.
        let is_framed = self.given.get("eye").is_none();
        let is_open = |error: &CameraError| match error {
            CameraError::Range { parameter, .. } => *parameter == "`aperture_radius`",
            CameraError::Length { .. } => self.given.get("camera") == Some("thin-lens"),
            _ => false,
        };
        match checked {
            Err(error) if !(is_framed && is_open(&error)) => Err(self.failure(file.at_camera(&error))),
            _ => Ok(()),
        }
    }

    /// The direction that is up if no flag and no scene file says what is.
    pub(super) fn default_up(&self) -> DVec3 {
        match self.format {
            Format::Data(format) if format.z_is_up => DVec3::Z,
            Format::Bricks if self.bricks.as_ref().is_some_and(|file| file.z_is_up()) => DVec3::Z,
            _ => DVec3::Y,
        }
    }

    /// Whether the flags say what the camera is, and not the scene file.
    pub(super) fn has_camera_of_flags(&self, file: &SceneFile) -> bool {
        self.is_data() || file.has_camera_of_flags()
    }

    /// Makes the input from what was read and from the look of the picture.
    pub(crate) fn input_with(&self, contents: Contents, look: Look) -> Result<Input, Failure> {
        let Contents { file, scene, details } = contents;
        let Details {
            notes,
            files,
            sky_image,
            color_key,
            arrow_key,
            chosen,
            has_atoms,
            size_from,
            kept,
            bonds,
            color,
            ..
        } = details;
        let kind = chosen.as_ref().and_then(|chosen| chosen.name);
        let kinds = chosen.and_then(|chosen| chosen.colors);
        let spheres = match (&self.bricks, &kept) {
            (Some(bricks), _) => bricks.whole().count as usize,
            (None, Some(kept)) => kept.kept,
            (None, None) => scene.len() - scene.added(),
        };
        let report = Report {
            path: self.path.display().to_string(),
            spheres,
            cones: file.shapes().cone_count(),
            selected_from: kept.map(|kept| kept.of).filter(|of| *of != spheres),
            bonds,
            has_atoms,
            style: file.style(),
            kind,
            view: look.view,
            color_by: kinds.as_ref().map(|by| by.column.clone()),
        };
        let (film, encoding, annotations) = (file.film, file.encoding, file.annotations.clone());
        let data = self.data(&file, kinds);
        let cone_files = file.cone_files().map(|of| self.resolve(&of.file)).collect();
        let Look { camera, eyes, settings, parameters, .. } = look;
        Ok(Input {
            scene: Arc::new(scene),
            camera,
            eyes,
            film,
            settings,
            encoding,
            color_key,
            arrow_key,
            annotations,
            size_from,
            notes,
            files,
            report,
            parameters,
            data,
            file,
            sky_image,
            cone_files,
            bricks: self.bricks.clone(),
            color: color.unwrap_or_else(default_color),
        })
    }

    /// Reads the image of the sky, if there is one.
    pub(crate) fn sky(&self, contents: &Contents) -> Result<Option<Environment>> {
        let path = contents.details.sky_image.as_deref();
        path.map(|path| self.environment(path)).transpose()
    }

    fn environment(&self, path: &Path) -> Result<Environment> {
        let in_scene = || format!("{}: `[sky]`", self.path.display());
        progress::stage(format!("reading {}", path.display()));
        let bytes = read(path).with_context(in_scene)?;
        let read = environment::read(&bytes);
        read.with_context(|| path.display().to_string()).with_context(in_scene)
    }
}
