//! An input file with its flags, before it is read.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Error, Result};

#[cfg(feature = "gpu")]
use crate::bench::args::BenchArgs;
use crate::bricks::BrickFile;
use crate::flags::settings::Given;
use crate::frames::args::FrameRange;
use crate::input::data::{self, DataOptions};
use crate::input::kinds::Chosen;
use crate::input::read_file::{Format, check_regular, data_format};
use crate::output::picture::PictureFormat;
use crate::terminal::failure::Failure;
use pinhole::image::color::LinearRgb;
use pinhole_data::load::{self, Dataset, Trajectory};
use pinhole_figure::color_by::{ColorBy, JoinedKeys};
use pinhole_figure::scene_file::{DEFAULT_COLOR, Data, SceneFile, SceneFileError};
use pinhole_figure::settings::{Layer, Sources, quoted};
use pinhole_figure::style::Style;

/// An input file with its flags, checked as far as is possible before the file is read.
#[derive(Clone)]
pub(crate) struct Source {
    pub(crate) path: PathBuf,
    pub(crate) format: Format,
    pub(crate) given: Given,
    /// The settings of the flags.
    pub(crate) layers: Vec<Layer>,
    /// The style of data files.
    pub(crate) style: Style,
    /// The kind of the file that will be written.
    pub(crate) output: PictureFormat,
    /// The frame of a movie, which takes the place of the one in the settings.
    pub(crate) frame: Option<usize>,
    /// The colour keys shared by all frames of a movie.
    pub(crate) joined: JoinedKeys,
    /// The choices for all frames of a movie.
    pub(crate) chosen: Option<Chosen>,
    /// The open file, if several of its frames are read.
    pub(crate) frames: Option<Arc<OpenFrames>>,
    /// Whether the columns of the data are kept, for the viewer.
    pub(crate) keeps_columns: bool,
    /// The file of bricks, if the input is one.
    pub(crate) bricks: Option<Arc<BrickFile>>,
}

impl Source {
    /// Makes a source from a path and its flags. Data files have one ray for each pixel, unless a flag asks for another
    /// style. A frame that counts from the end is found.
    pub(crate) fn new(path: &Path, given: &Given) -> Result<Self, Failure> {
        let from_end = given.get("frame").and_then(|frame| frame.parse::<FrameRange>().ok());
        if let Some(last @ FrameRange::One(..0)) = from_end {
            let wrong = |error: String| Failure::usage(format!("--frame: {error}; choose another, or remove it"));
            let given = given.without("frame");
            let found = Self::new(path, &given)?.open_frames()?.map_err(wrong)?;
            let frame = last.of(found.count).map_err(wrong)?.first().map(ToString::to_string);
            return Self::new(path, &given.with("frame", frame));
        }
        check_regular(path)?;
        let named = given.get("format").and_then(load::Format::of_name);
        let format = match named {
            Some(format) => Format::Data(format),
            None => Format::of(path)?,
        };
        let bricks = (format == Format::Bricks).then(|| BrickFile::open(path)).transpose()?;
        let layers = given.layers()?;
        let source = Self { format, given: given.clone(), layers, bricks, ..Self::of_scene(path) };
        source.check()?;
        Ok(source)
    }

    /// Makes a source for a picture with light. `open_end` is the flag that leaves the number of samples open, if there
    /// is one.
    pub(crate) fn lit(path: &Path, given: &Given, open_end: Option<&'static str>) -> Result<Self, Failure> {
        let source = Self::new(path, given)?;
        let style = match given.get("integrator") {
            Some("primary") => Style::Fast,
            Some("path") => Style::Path,
            Some(_) => Style::Default,
            // Bricks have one ray for each pixel, unless a flag asks for light, which is refused with a reason.
            None if source.bricks.is_some() => Style::Fast,
            None => Style::Default,
        };
        // Any number of samples, unless a flag limits it.
        let open_end = open_end.map(|flag| Layer { flag, text: format!("sampling.samples = {}", 1 << 24) });
        let layers = open_end.into_iter().chain(source.layers.iter().cloned()).collect();
        Ok(Self { layers, style, ..source })
    }

    /// Makes a source from a scene file without flags.
    pub(crate) fn of_scene(path: &Path) -> Self {
        Self {
            path: path.to_path_buf(),
            format: Format::Scene,
            given: Given::default(),
            layers: Vec::new(),
            style: Style::Fast,
            output: PictureFormat::Png,
            frame: None,
            joined: JoinedKeys::default(),
            chosen: None,
            frames: None,
            keeps_columns: false,
            bricks: None,
        }
    }

    /// Returns this source with a size, such as `800x600`.
    pub(crate) fn with_size(self, size: Option<&str>) -> Result<Self, Failure> {
        let given = self.given.with("size", size.map(str::to_owned));
        Ok(Self { layers: given.layers()?, given, ..self })
    }

    /// Returns this source with a size, if it is a data file, and no flag gives its size.
    pub(crate) fn with_size_of_data(self, [width, height]: [u32; 2]) -> Result<Self, Failure> {
        match (self.format, self.given.get("size")) {
            (Format::Data(_) | Format::Bricks, None) => self.with_size(Some(&format!("{width}x{height}"))),
            _ => Ok(self),
        }
    }

    /// Makes a source from a file that `bench` measures.
    #[cfg(feature = "gpu")]
    pub(crate) fn of_bench(path: &Path, args: &BenchArgs) -> Result<Self, Failure> {
        let is_data = Format::of(path).ok() != Some(Format::Scene);
        let format = args.format.filter(|_| is_data);
        let options = DataOptions { radius: args.radius, ..DataOptions::default() };
        let given = options.given(format).with("size", args.size.clone()).plain();
        Self::new(path, &given)?.without_bricks("`bench`")
    }

    /// Checks the flags for a file that is not a scene file.
    fn check(&self) -> Result<(), Failure> {
        if !matches!(self.format, Format::Data(_)) && self.given.get("kind").is_some_and(|kind| kind != "plain") {
            return Err(Failure::usage(format!("--kind applies to data files, and {} is none", self.path.display())));
        }
        if self.format == Format::Scene {
            return Ok(());
        }
        let file = self.scene_of_data()?;
        let names = ["frame", "radius", "topology", "columns"];
        if let (Format::Bricks, Some(flag)) = (self.format, self.given.first_of(&names)) {
            return Err(Failure::usage(format!(
                "{flag} applies when data is sorted into bricks; give it to `pinhole sort`"
            )));
        }
        if let (Format::Data(format), Some(data)) = (self.format, file.data()) {
            let options = self.options(&file, data);
            options.check(&self.path, format, &file).map_err(|(error, _)| Failure::usage(error))?;
        }
        self.check_camera(&file)
    }

    /// The scene file that stands for a data file.
    pub(crate) fn scene_of_data(&self) -> Result<SceneFile, Failure> {
        let text = format!("data = {}", quoted(&self.path.to_string_lossy()));
        let sources = Sources { file: &text, flags: &self.layers, style: Some(self.style) };
        SceneFile::read(&sources).map_err(|error| self.failure(error))
    }

    /// The scene that stands for a data file, with what was chosen for it.
    pub(super) fn scene_of_kind(&self, chosen: &Chosen) -> Result<SceneFile, Failure> {
        let style = chosen.style.filter(|_| self.style == Style::Default).unwrap_or(self.style);
        Self { layers: chosen.layers(&self.layers), style, ..self.clone() }.scene_of_data()
    }

    /// Reads the text of a scene file, with the flags.
    pub(crate) fn parsed(&self, text: &str) -> Result<SceneFile, Failure> {
        let sources = Sources { file: text, flags: &self.layers, style: None };
        SceneFile::read(&sources).map_err(|error| self.failure(error))
    }

    /// The failure for an error in a scene file, or in a flag, which is wrong usage.
    pub(crate) fn failure(&self, error: SceneFileError) -> Failure {
        match error.flag {
            Some(_) => Failure::usage(error.to_string()),
            None => Error::new(error).context(self.path.display().to_string()).into(),
        }
    }

    /// The options for reading the data of a scene.
    pub(crate) fn options(&self, file: &SceneFile, data: &Data) -> DataOptions {
        let topology = data.topology.as_ref().map(|name| match file.flag_of("topology") {
            Some(_) => PathBuf::from(name),
            None => self.resolve(name),
        });
        DataOptions { frame: self.frame.or(data.frame), radius: data.radius, topology, columns: data.columns.clone() }
    }

    /// Returns the data with its keys and paths as the program finds them.
    pub(crate) fn data(&self, file: &SceneFile, kinds: Option<ColorBy>) -> Option<Data> {
        let mut data = self.keys_of_data(file)?;
        let options = self.options(file, &data);
        data.topology = options.topology.map(|path| path.to_string_lossy().into_owned());
        match self.format {
            Format::Bricks => return None,
            Format::Scene => data.file = self.data_path(&data).to_string_lossy().into_owned(),
            Format::Data(format) if data_format(&self.path) == Some(format) => data.format = None,
            Format::Data(_) => {}
        }
        data.mapping.color = data.mapping.color.or(kinds);
        Some(data)
    }

    /// Returns the keys of the data, for the frame of a movie if there is one.
    pub(super) fn keys_of_data(&self, file: &SceneFile) -> Option<Data> {
        let mut data = file.data()?.clone();
        data.frame = self.frame.or(data.frame);
        data.mapping.color.iter_mut().for_each(|color| self.joined.apply_to(color));
        self.joined.apply_to_arrows(&mut data.additions);
        Some(data)
    }

    pub(crate) fn data_format(&self) -> Option<&'static load::Format> {
        match self.format {
            Format::Data(format) => Some(format),
            Format::Scene | Format::Bricks => None,
        }
    }

    /// Whether the input is a file of data, which the program frames and gives a style.
    pub(crate) fn is_data(&self) -> bool {
        matches!(self.format, Format::Data(_) | Format::Bricks)
    }

    /// Refuses a file of bricks, for work that needs all spheres at once.
    pub(crate) fn without_bricks(self, what: &str) -> Result<Self, Failure> {
        match self.bricks {
            None => Ok(self),
            Some(_) => Err(Failure::usage(format!(
                "{}: {what} needs all spheres in memory, and bricks are read one by one; name the data that was sorted",
                self.path.display()
            ))),
        }
    }

    /// Resolves a path that is relative to the folder of the scene file.
    pub(crate) fn resolve(&self, path: &str) -> PathBuf {
        match self.format {
            Format::Scene => self.path.parent().unwrap_or(Path::new("")).join(path),
            Format::Data(_) | Format::Bricks => PathBuf::from(path),
        }
    }

    /// The path of the data. A data file on the command line need not have a name that is text.
    pub(super) fn data_path(&self, data: &Data) -> PathBuf {
        if self.is_data() { self.path.clone() } else { self.resolve(&data.file) }
    }
}

pub(crate) fn default_color() -> LinearRgb {
    LinearRgb::from_srgb8(DEFAULT_COLOR)
}

/// A file whose frames were found.
pub(crate) struct OpenFrames {
    pub(crate) path: PathBuf,
    pub(crate) format: &'static load::Format,
    pub(crate) file: Mutex<Trajectory>,
}

/// What was found about the frames of a file.
pub(crate) struct FoundFrames {
    pub(crate) count: usize,
    /// What is wrong after the last frame, for the user.
    pub(crate) note: Option<String>,
}

impl OpenFrames {
    /// The files of the frames.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner).files().map(Path::to_path_buf).collect()
    }

    /// Reads the frame that the options name, or else the first.
    pub(crate) fn read(&self, options: &DataOptions) -> Result<Dataset> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        data::read_frame_of(&self.path, &mut file, options)
    }
}
