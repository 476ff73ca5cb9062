//! Scene files: TOML text in; film, camera, settings and spheres out. No file system.
//!
//! `examples/*.toml` show every part with comments.

mod data;
mod data_spheres;
mod document;
mod lighting;
mod materials;
mod output;
mod span;
mod value;
mod words;

pub use data::{Data, Element};
pub use data_spheres::{DataError, DataSpheres};
pub use lighting::IntegratorKind;
pub use span::SceneFileError;
pub use value::DEFAULT_COLOR;

use data::DataKeys;
use document::{Document, FilmTable, SphereTable};
use lighting::{LightingTables, SceneLighting};
use materials::Materials;
use span::{Lines, Span, WithSpan};
use toml::Spanned;
use words::explain;

use crate::camera::film::Film;
use crate::camera::{Camera, CameraParameters};
use crate::image::color::LinearRgb;
use crate::image::encoding::Encoding;
use crate::render::Shading;
use crate::scene::sphere::Sphere;
use crate::scene::sphere_array::SphereArray;
use crate::scene::{Scene, SceneError};

/// What a scene file says.
#[derive(Debug)]
pub struct SceneFile {
    /// The picture's size.
    pub film: Film,
    /// How the picture is written.
    pub encoding: Encoding,
    background: LinearRgb,
    /// Of primary rays.
    shading: Shading,
    lighting: SceneLighting,
    data: Option<WithSpan<Data>>,
    camera: WithSpan<CameraParameters>,
    spheres: Vec<WithSpan<Sphere>>,
}

impl SceneFile {
    /// Reads a scene file.
    ///
    /// # Errors
    /// The first thing in the text that is not as it should be.
    pub fn parse(text: &str) -> Result<Self, SceneFileError> {
        let lines = Lines::of(text);
        let document: Document = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            lines.span(start).error(explain(error.message()))
        })?;
        let materials = Materials::new(document.materials, &lines)?;
        let has_lighting = document.material.is_some() || document.opacity.is_some();
        let data = DataKeys {
            file: document.data,
            frame: document.frame,
            radius: document.radius,
            radius_scale: document.radius_scale,
            color: document.color,
            material: document.material,
            opacity: document.opacity,
            elements: document.elements,
            elements_by: document.elements_by,
            leave_out: document.leave_out,
        }
        .read(&materials, &lines)?;
        let spheres = document.spheres.into_iter();
        let spheres: Vec<_> = spheres
            .map(|sphere| SphereTable::sphere(sphere, &materials, &lines))
            .collect::<Result<_, _>>()?;
        let lighting = LightingTables {
            shading: document.shading.as_ref().map(|shading| shading.span().start),
            integrator: document.integrator,
            studio: document.studio,
            path: document.path,
            sampling: document.sampling,
            lights: document.lights,
            sky: document.sky,
            sun: document.sun,
            ground: document.ground,
            has_materials: has_lighting || has_surface(&spheres, data.as_ref()),
        }
        .read(&lines)?;
        Ok(Self {
            film: FilmTable::film(document.film, &lines)?,
            background: document.background.map_or(LinearRgb::WHITE, |color| color.0),
            shading: document.shading.map(Spanned::into_inner).unwrap_or_default(),
            encoding: document.output.0.encoding(&lines)?,
            lighting,
            data,
            camera: lines.spanned(document.camera),
            spheres,
        })
    }

    /// The scene: the file's own spheres, then those of its data.
    ///
    /// # Errors
    /// The first sphere that is out of range, with its place if it stands in this file.
    pub fn scene(&self, data: &[Sphere]) -> Result<Scene, SceneFileError> {
        let own = self.spheres.iter().map(|sphere| sphere.value);
        let spheres: Vec<Sphere> = own.chain(data.iter().copied()).collect();
        Scene::new(&spheres).map_err(|error| self.spanned(&error))
    }

    /// As [`SceneFile::scene`], with data that has no colours; where the file has no spheres of its own,
    /// without a copy. They get the surface properties that the file states.
    ///
    /// # Errors
    /// As [`SceneFile::scene`].
    pub fn scene_with_array(
        &self,
        data: SphereArray,
        color: LinearRgb,
    ) -> Result<Scene, SceneFileError> {
        let surface = self.data().map(|data| data.surface).unwrap_or_default();
        if self.spheres.is_empty() {
            let scene = data.scene(color).map_err(|error| self.spanned(&error))?;
            return Ok(scene.with_surface(surface));
        }
        let colored = data.with_color(color).map(|sphere| Sphere { surface, ..sphere });
        self.scene(&colored.collect::<Vec<_>>())
    }

    fn spanned(&self, error: &SceneError) -> SceneFileError {
        let &SceneError::Sphere { index, error: fault } = error else {
            return Span::START.error(error);
        };
        match (self.spheres.get(index), &self.data) {
            (Some(sphere), _) => sphere.span.error(error),
            (None, Some(data)) => {
                let in_data = index - self.spheres.len();
                data.span.error(format!("sphere {in_data} of {}: {fault}", data.value.file))
            }
            (None, None) => Span::START.error(error),
        }
    }

    /// The file with more spheres, if there is one.
    #[must_use]
    pub fn data(&self) -> Option<&Data> {
        self.data.as_ref().map(|data| &data.value)
    }

    /// The camera, or of two eyes that in the middle, for a film of this shape; without a fixed place it frames
    /// the scene.
    ///
    /// # Errors
    /// If a parameter is out of range, or parameters exclude each other.
    pub fn camera(&self, film: &Film, scene: &Scene) -> Result<Box<dyn Camera>, SceneFileError> {
        self.camera
            .value
            .camera(film.aspect(), &scene.bounds_to_frame())
            .map_err(|error| self.camera.span.error(error))
    }

    /// The cameras of the left and of the right eye, if the camera has two.
    ///
    /// # Errors
    /// As [`SceneFile::camera`].
    pub fn stereo_pair(
        &self,
        film: &Film,
        scene: &Scene,
    ) -> Result<Option<[Box<dyn Camera>; 2]>, SceneFileError> {
        self.camera
            .value
            .stereo_pair(film.aspect(), &scene.bounds_to_frame())
            .map_err(|error| self.camera.span.error(error))
    }
}

/// Whether any sphere is to be more than matt and opaque.
fn has_surface(spheres: &[WithSpan<Sphere>], data: Option<&WithSpan<Data>>) -> bool {
    let matt = crate::scene::material::SurfaceProperties::default();
    let of_data = data.iter().flat_map(|data| {
        let elements = data.value.elements.iter().map(|element| element.surface);
        elements.chain([data.value.surface])
    });
    spheres.iter().map(|sphere| sphere.value.surface).chain(of_data).any(|surface| surface != matt)
}
