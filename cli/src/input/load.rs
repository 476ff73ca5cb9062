//! Reads the input of one picture.

use super::Input;
use super::contents::Contents;
use super::look::Framed;
use super::source::Source;
use crate::failure::Failure;

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
            contents.add_note(format!(
                "{}: `camera_path` is not used, because this is one picture; for all, write a movie such as -o movie.apng, \
                 or --frames : with -o f%04d.png",
                self.path.display()
            ));
        }
        let sky = self.sky(&contents)?;
        let framed = Framed::new(&contents.scene, contents.color_key());
        let look = self.look(&contents.file, framed, sky, None)?;
        self.input_with(contents, look)
    }
}
