//! The spheres, the camera and the settings that follow from flags.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Context;
use pinhole::camera::{Camera, CameraParameters};
use pinhole::image::encoding::Encoding;
use pinhole::light::environment::Environment;
use pinhole::render::RenderSettings;
use pinhole::scene::Scene;
use pinhole_data::load::Column;
use pinhole_figure::annotate::Annotations;

use super::RenderFlags;
use super::ViewError;
use crate::input::read_file::Format;
use crate::input::{FramedScene, Input, OpenFrames, Source};
use crate::render::ghosts;
use crate::terminal::failure::Failure;

/// The meaning of [`RenderFlags`]: the spheres of a file, a camera with a film, and the settings of the picture.
pub struct OpenView {
    flags: RenderFlags,
    pub(super) input: Input,
    /// The text of a scene file; `None` for a data file.
    text: Option<String>,
    sky: Option<(PathBuf, Environment)>,
    pub(super) encoding: Encoding,
    pub(super) annotations: Annotations,
    columns: Arc<Vec<Column>>,
    frames: FileFrames,
    notes: Vec<String>,
}

/// The data that a window shows beside the picture.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Facts {
    /// The current flags.
    pub flags: RenderFlags,
    /// The spheres.
    pub scene: Arc<Scene>,
    /// The columns of the data, with a value for each sphere of the data. These are the last spheres of the scene
    /// apart from [`Scene::added`]. Empty if the data has no columns.
    pub columns: Arc<Vec<Column>>,
    /// The parameters of the camera, with its position.
    pub camera: CameraParameters,
    /// The settings.
    pub settings: RenderSettings,
    /// The name of the style, if there is one.
    pub style: Option<&'static str>,
    /// The column that colours the spheres without a flag.
    pub own_color_by: Option<String>,
    /// The frames; `None` for a file with one picture.
    pub time_line: Option<TimeLine>,
    /// Notes for the user about the file.
    pub notes: Vec<String>,
}

/// The frames of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimeLine {
    /// The number of frames, at least one.
    pub count: usize,
    /// The current frame, counted from 0.
    pub frame: usize,
}

#[derive(Clone, Default)]
struct FileFrames {
    file: Option<Arc<OpenFrames>>,
    count: Option<usize>,
    note: Option<String>,
}

impl OpenView {
    /// Reads the file. Frames that `before` found in the same file are not searched again.
    pub fn open(flags: &RenderFlags, before: Option<&Self>) -> Result<Self, ViewError> {
        let job = flags.job()?;
        let before = before.filter(|before| flags.has_file_of(&before.flags));
        let mut source = Source { keeps_columns: true, ..job.source };
        let frames = match before {
            Some(before) => before.frames.clone(),
            None => found_frames(&mut source)?,
        };
        source.frames = frames.file.clone();
        let text = (source.format == Format::Scene).then(|| source.text()).transpose()?;
        let mut contents = match &text {
            Some(text) => source.contents_of_text(text)?,
            None => source.contents()?,
        };
        let columns = Arc::new(std::mem::take(&mut contents.details.columns));
        let sky = source.sky(&contents).map_err(Failure::from)?;
        let framed = FramedScene::new(&contents.scene, contents.color_key());
        let look = source.look(&contents.file, framed, sky.clone(), None)?;
        let mut input = source.input_with(contents, look)?;
        let mut notes = std::mem::take(&mut input.notes);
        notes.extend(frames.note.clone());
        notes.extend(ghosts::note(&input, "not drawn in a window"));
        let sky = input.sky_image.clone().zip(sky);
        let (encoding, annotations) = (Encoding::default(), Annotations::default());
        let flags = flags.clone();
        let mut shown = Self { flags, input, text, sky, encoding, annotations, columns, frames, notes };
        let flags = shown.flags.clone();
        shown.see(&flags)?;
        Ok(shown)
    }

    /// Changes camera, light and film to those of flags with the same data; see [`RenderFlags::has_data_of`].
    pub fn see(&mut self, flags: &RenderFlags) -> Result<(), ViewError> {
        let job = flags.job()?;
        let source = &job.source;
        let file = match &self.text {
            Some(text) => source.parsed(text)?,
            None => source.scene_of_data()?,
        };
        source.check_camera(&file)?;
        let size_from = source.size_from(&file);
        let sky = self.sky.as_ref().map(|(_, sky)| sky.clone());
        let framed = FramedScene::new(&self.input.scene, self.input.color_key.as_ref());
        let look = source.look(&file, framed, sky, None)?;
        let input = &mut self.input;
        (input.camera, input.eyes, input.settings) = (look.camera, look.eyes, look.settings);
        input.parameters = look.parameters;
        (input.film, input.encoding, input.size_from) = (file.film, file.encoding, size_from);
        input.annotations = file.annotations.clone();
        (self.encoding, self.annotations) = job.finish(input, |_| {})?;
        let checked = input.settings.check(&input.scene).with_context(|| flags.path().to_owned());
        checked.map_err(Failure::from)?;
        self.flags = flags.clone();
        Ok(())
    }

    /// Returns the data that a window shows beside the picture.
    pub fn facts(&self) -> Facts {
        let Self { flags, input, columns, notes, .. } = self;
        Facts {
            flags: flags.clone(),
            scene: Arc::clone(&input.scene),
            columns: Arc::clone(columns),
            camera: input.parameters,
            settings: input.settings.clone(),
            style: input.report.style.map(|style| style.name()),
            own_color_by: input.report.color_by.clone(),
            time_line: self.time_line(),
            notes: notes.clone(),
        }
    }

    /// The current flags.
    pub fn flags(&self) -> &RenderFlags {
        &self.flags
    }

    /// The spheres.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.input.scene
    }

    /// The camera; for two eyes, the one in the middle between them.
    pub fn camera(&self) -> &dyn Camera {
        self.input.camera.as_ref()
    }

    /// The settings.
    pub fn settings(&self) -> &RenderSettings {
        &self.input.settings
    }

    fn time_line(&self) -> Option<TimeLine> {
        let count = self.frames.count.filter(|count| *count > 1)?;
        let frame = self.flags.get("frame").and_then(|frame| frame.parse().ok());
        let of_scene = || self.input.data.as_ref().and_then(|data| data.frame);
        Some(TimeLine { count, frame: frame.or_else(of_scene).unwrap_or(0) })
    }
}

/// Finds the frames of the file, if its format has frames.
fn found_frames(source: &mut Source) -> Result<FileFrames, Failure> {
    Ok(match source.open_frames()? {
        Ok(found) => {
            let (count, note) = (Some(found.count), found.note);
            FileFrames { file: source.frames.clone(), count, note }
        }
        // The file has no frames.
        Err(_) => FileFrames::default(),
    })
}
