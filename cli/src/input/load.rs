//! Facts about an input before it is read, such as its frames, its camera path and its name, and the input of one
//! picture.

use std::sync::{Arc, Mutex};

use super::Input;
use super::contents::Contents;
use super::look::FramedScene;
use super::source::{FoundFrames, OpenFrames, Source};
use crate::input::data::{self, DataOptions, as_usage};
use crate::input::kinds::Chosen;
use crate::input::read_file::{Format, is_standard_input};
use crate::terminal::failure::Failure;
use pinhole::camera::CameraPath;
use pinhole::glam::DVec3;
use pinhole_data::load;
use pinhole_figure::settings::flags::Group;
use pinhole_figure::settings::list_of;

impl Source {
    /// Reads the file, and the data files that it names.
    pub(crate) fn load(&self) -> Result<Input, Failure> {
        self.input(self.contents()?)
    }

    /// Reads a scene from the text of a scene file, and its data. The file need not exist; its path is the base of
    /// other paths.
    pub(crate) fn scene_from_text(&self, text: &str) -> Result<Input, Failure> {
        self.input(self.contents_of_text(text)?)
    }

    fn input(&self, mut contents: Contents) -> Result<Input, Failure> {
        if contents.file.camera_path().is_some() {
            contents.details.notes.push(format!(
                "{}: `camera_path` is not used, because this is one picture; for all, write a movie such as -o movie.apng, \
                 or --frames : with -o f%04d.png",
                self.path.display()
            ));
        }
        let sky = self.sky(&contents)?;
        let framed = FramedScene::new(&contents.scene, contents.color_key());
        let look = self.look(&contents.file, framed, sky, None)?;
        self.input_with(contents, look)
    }

    /// Finds the frames of the file, or of the data of a scene. `Ok(None)` means that there are none, because of the
    /// format or the place of the data.
    pub(crate) fn open_frames(&mut self) -> Result<Result<FoundFrames, String>, Failure> {
        let (path, format, options) = match self.format {
            Format::Bricks => return Ok(Err("files of bricks have one frame".to_owned())),
            Format::Data(format) => {
                let file = self.scene_of_data()?;
                let options = file.data().map(|data| self.options(&file, data));
                (self.path.clone(), format, options.unwrap_or_default())
            }
            Format::Scene => match self.data_place(&self.parsed(&self.text()?)?)? {
                Some(place) => (place.path, place.format, place.options),
                None => return Ok(Err("this scene has no `data`".to_owned())),
            },
        };
        if !data::has_frames(&path, format) {
            let with_frames = load::Format::extensions_of(load::Format::has_frames);
            return Ok(Err(format!("files of the format {} have no frames; those of {with_frames} have", format.name)));
        }
        if is_standard_input(&path) {
            return Ok(Err("frames are read one by one, which needs a file".to_owned()));
        }
        let options = DataOptions { frame: None, ..options };
        let file = data::trajectory(&path, format, &options).map_err(as_usage)?;
        let count = file.len();
        let note =
            file.problem().map(|problem| format!("{}: after the {count} complete frames: {problem}", path.display()));
        self.frames = Some(Arc::new(OpenFrames { path, format, file: Mutex::new(file) }));
        Ok(Ok(FoundFrames { count, note }))
    }

    /// Whether a flag chooses one frame of the data.
    pub(crate) fn has_frame(&self) -> bool {
        self.given.get("frame").is_some()
    }

    /// The path along which the camera of a scene file moves, and whether flags replace that camera.
    pub(crate) fn camera_path(&self) -> Result<Option<(CameraPath, bool)>, Failure> {
        if self.is_data() {
            return Ok(None);
        }
        let file = self.parsed(&self.text()?)?;
        Ok(file.camera_path().map(|path| (path.clone(), self.has_camera_of_flags(&file))))
    }

    /// The path, for messages.
    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The direction that is up for the flags, or else for what was chosen; `None` if the camera is that of a scene file.
    pub(crate) fn up(&self, chosen: Option<&Chosen>) -> Option<DVec3> {
        let is_of_flags = self.is_data() || self.given.first_in(Group::Camera as u32).is_some();
        let up = self.given.get("up").and_then(|text| list_of(text, 3).ok());
        let up = up.and_then(|up| <[f64; 3]>::try_from(up).ok()).map(DVec3::from);
        is_of_flags.then(|| up.or(chosen.and_then(|chosen| chosen.up)).unwrap_or_else(|| self.default_up()))
    }
}
