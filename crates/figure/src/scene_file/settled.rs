//! Scene files with every value settled.

use super::SceneFile;
use super::data::Data;
use super::document::{Document, FilmTable, OutputTable};
use super::lighting::{GroundTable, IntegratorKind, LightTable, SkyTable};
use super::mapping::ByColumn;
use pinhole::camera::CameraParameters;
use pinhole::internals::exact::Table;
use pinhole::render::{Integrator, RenderSettings};

/// Values that a scene file need not say, because they follow from the spheres.
#[derive(Clone, Debug)]
pub struct Settled<'a> {
    /// The camera. Without a position, it would frame the scene again.
    pub camera: CameraParameters,
    /// All settings for rendering.
    pub settings: &'a RenderSettings,
    /// The path of the image of the sky, relative to the file that is written, if the sky is one.
    pub sky_image: Option<String>,
    /// The data and its keys; paths are relative to the file that is written.
    pub data: Option<Data>,
    /// The paths of [`SceneFile::cone_files`], relative to the file that is written; those of this file if it is empty.
    pub cone_files: Vec<String>,
}

impl SceneFile {
    /// Returns the text of a scene file that makes the same picture, whatever the defaults and styles are when it is read.
    #[must_use]
    pub fn settled(&self, settled: Settled<'_>) -> String {
        let Settled { camera, settings, sky_image, data, cone_files } = settled;
        let RenderSettings { integrator, sampling, lights, sky, ground, background, .. } = settings;
        let is_lit = !integrator.is_primary();
        let lights = || lights.iter().map(|light| Table(LightTable::of(light))).collect();
        let mut document = Document {
            style: None,
            kind: None,
            integrator: Some(IntegratorKind::of(integrator)),
            shading: settings.primary().map(|primary| primary.shading),
            background: Some(*background),
            film: Table(FilmTable::of(&self.film)),
            camera,
            output: Table(OutputTable::of(&self.encoding)),
            sampling: is_lit.then_some(Table(*sampling)),
            studio: settings.studio_parameters().cloned().map(Table),
            path: None,
            lights: is_lit.then(lights),
            sun: None,
            sky: None,
            ground: ground.as_ref().filter(|_| is_lit).map(|ground| Table(GroundTable::of(ground))),
            ..self.document.clone()
        };
        if let Integrator::Path(path) = integrator {
            document.path = Some(Table(*path));
            document.sky = Some(Table(SkyTable::of(sky, sky_image)));
        }
        if let Some(data) = data {
            document.data = Some(data.file);
            (document.format, document.frame) = (data.format, data.frame);
            document.topology = data.topology;
            document.color_by = data.mapping.color.map(ByColumn);
        }
        let cylinders = document.cylinders.iter_mut().map(|table| &mut table.as_mut().0.file);
        let cones = document.cones.iter_mut().map(|table| &mut table.as_mut().0.file);
        cylinders.chain(cones).flatten().zip(cone_files).for_each(|(file, written)| *file = written);
        // All values are numbers, texts, lists and tables, which can always be written.
        toml::to_string(&document).unwrap_or_default()
    }
}
