//! An input file with its flags, before it is read.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::Result;

#[cfg(feature = "gpu")]
use crate::bench::args::BenchArgs;
use crate::bricks::BrickFile;
use crate::flags::annotation::AnnotationFlags;
use crate::flags::camera::CameraFlags;
use crate::flags::common::{InputArgs, ViewArgs};
use crate::flags::data::{ColorFlags, StructureFlags};
use crate::flags::light::LightFlags;
use crate::input::data::{self, DataOptions};
use crate::input::read_file::{Format, data_format, parse_size};
use crate::terminal::failure::Failure;
use pinhole::image::color::LinearRgb;
use pinhole_data::css;
use pinhole_data::load::{self, Dataset, Trajectory};
use pinhole_figure::color_by::ColorBy;
use pinhole_figure::scene_file::{DEFAULT_COLOR, Data, SceneFile};
use pinhole_figure::style::Style;

/// Checks that flags apply to a file of this format.
pub(crate) fn check_flags(format: Format, options: &DataOptions) -> Result<(), Failure> {
    if let Some(radius) = options.radius
        && !(radius.is_finite() && radius > 0.0)
    {
        return Err(Failure::usage(format!(
            "--radius {radius}: a radius must be finite and greater than 0"
        )));
    }
    match format {
        Format::Data(format) => options.check(format, "--").map_err(Failure::usage),
        Format::Scene => Ok(()),
        Format::Bricks => match options.given() {
            Some(flag) => Err(Failure::usage(format!(
                "{flag} applies when data is sorted into bricks; give it to `pinhole sort`"
            ))),
            None => Ok(()),
        },
    }
}

/// An input file with its flags, checked as far as is possible before the file is read.
pub(crate) struct Source {
    pub(crate) path: PathBuf,
    pub(crate) format: Format,
    pub(crate) size: Option<(u32, u32)>,
    pub(crate) options: DataOptions,
    pub(crate) camera: CameraFlags,
    pub(crate) light: LightFlags,
    /// The style of data files.
    pub(crate) style: Style,
    pub(crate) color: ColorFlags,
    pub(crate) structure: StructureFlags,
    pub(crate) annotation: AnnotationFlags,
    /// The colors by kind that all frames of a movie have, although no flag asks for them.
    pub(crate) kinds: Option<ColorBy>,
    /// The open file, if several of its frames are read.
    pub(crate) frames: Option<Arc<OpenFrames>>,
    /// Whether the columns of the data are kept, for the viewer.
    pub(crate) keeps_columns: bool,
    /// The file of bricks, if the input is one.
    pub(crate) bricks: Option<Arc<BrickFile>>,
}

impl Source {
    pub(crate) fn new(InputArgs { path, view }: &InputArgs) -> Result<Self, Failure> {
        Self::of_view(path, view)
    }

    /// Makes a source from a path and its flags.
    pub(crate) fn of_view(path: &Path, args: &ViewArgs) -> Result<Self, Failure> {
        let format = match args.format {
            Some(format) => Format::Data(format),
            None => Format::of(path).map_err(Failure::Usage)?,
        };
        let color = args.color.as_deref().map(css::color).transpose();
        let color = color.map_err(|error| Failure::usage(format!("--color: {error}")))?;
        let (topology, columns) = (args.topology.clone(), args.columns.clone());
        let options =
            DataOptions { frame: args.frame, radius: args.radius, color, topology, columns };
        check_flags(format, &options)?;
        let bricks = (format == Format::Bricks).then(|| BrickFile::open(path)).transpose()?;
        Ok(Self {
            bricks,
            path: path.to_path_buf(),
            format,
            size: args.size.as_deref().map(parse_size).transpose()?,
            options,
            camera: args.camera.flags()?,
            ..Self::of_scene(path)
        })
    }

    /// Returns this source with light flags. Without them, data files have one ray for each pixel.
    pub(crate) fn with_light(self, light: LightFlags) -> Self {
        let style = match &self.bricks {
            // Bricks have one ray for each pixel, unless a flag asks for light, which is refused with a reason.
            Some(_) => light.style_of_bricks(),
            None => light.style_of_data(),
        };
        Self { light, style, ..self }
    }

    /// Makes a source from a scene file without flags.
    pub(crate) fn of_scene(path: &Path) -> Self {
        let options = DataOptions::default();
        Self {
            path: path.to_path_buf(),
            format: Format::Scene,
            size: None,
            options,
            camera: CameraFlags::default(),
            light: LightFlags::default(),
            style: Style::Fast,
            color: ColorFlags::default(),
            structure: StructureFlags::default(),
            annotation: AnnotationFlags::default(),
            kinds: None,
            frames: None,
            keeps_columns: false,
            bricks: None,
        }
    }

    /// Returns this source with the size of a picture, such as `800x600`.
    pub(crate) fn with_size(self, size: Option<&str>) -> Result<Self, Failure> {
        Ok(Self { size: size.map(parse_size).transpose()?, ..self })
    }

    /// Returns this source with a size, if it is a data file, and no flag gives its size.
    pub(crate) fn with_size_of_data(self, [width, height]: [u32; 2]) -> Self {
        match (self.format, self.size) {
            (Format::Data(_) | Format::Bricks, None) => {
                Self { size: Some((width, height)), ..self }
            }
            _ => self,
        }
    }

    /// Makes a source from a file that `bench` measures.
    #[cfg(feature = "gpu")]
    pub(crate) fn of_bench(
        path: &Path,
        args: &BenchArgs,
        size: Option<(u32, u32)>,
    ) -> Result<Self, Failure> {
        let format = match args.format {
            Some(format) if Format::of(path).ok() != Some(Format::Scene) => Format::Data(format),
            _ => Format::of(path).map_err(Failure::Usage)?,
        };
        let options = DataOptions { radius: args.radius, ..DataOptions::default() };
        check_flags(format, &options)?;
        let bricks = (format == Format::Bricks).then(|| BrickFile::open(path)).transpose()?;
        let source = Self { format, size, options, bricks, ..Self::of_scene(path) };
        source.without_bricks("`bench`")
    }

    /// Returns the data with its keys, over which flags take precedence.
    pub(crate) fn data(
        &self,
        file: &SceneFile,
        kinds: Option<ColorBy>,
    ) -> Result<Option<Data>, Failure> {
        let data = match self.format {
            Format::Data(format) => Data {
                format: (data_format(&self.path) != Some(format)).then(|| format.name.to_owned()),
                ..Data::of_file(self.path.to_string_lossy())
            },
            Format::Bricks => return Ok(None),
            Format::Scene => {
                let Some(data) = file.data().cloned() else { return Ok(None) };
                let resolved = |file: &String| self.resolve(file).to_string_lossy().into_owned();
                Data {
                    file: resolved(&data.file),
                    topology: data.topology.as_ref().map(resolved),
                    ..data
                }
            }
        };
        let mut data = self.with_flags(data)?;
        data.mapping.color = data.mapping.color.or(kinds);
        Ok(Some(data))
    }

    /// Returns the keys of data with the flags in their place.
    pub(super) fn with_flags(&self, mut data: Data) -> Result<Data, Failure> {
        let flags = self.options.clone();
        data.frame = flags.frame.or(data.frame);
        data.radius = flags.radius.or(data.radius);
        data.color = flags.color.or(data.color);
        let topology = flags.topology.map(|file| file.to_string_lossy().into_owned());
        data.topology = topology.or(data.topology);
        if !flags.columns.is_empty() {
            data.columns = flags.columns;
        }
        data.mapping = self.color.apply_to(&data.mapping)?;
        data.select = self.structure.select.clone().or(data.select);
        data.additions = self.structure.additions(&data.additions, false);
        Ok(data)
    }

    pub(crate) fn data_format(&self) -> Option<&'static load::Format> {
        match self.format {
            Format::Data(format) => Some(format),
            Format::Scene | Format::Bricks => None,
        }
    }

    /// Refuses a file of bricks, for what needs all spheres at once.
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
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }
}

pub(crate) fn default_color() -> LinearRgb {
    LinearRgb::from_srgb8(DEFAULT_COLOR)
}

/// A file whose frames were found.
pub(crate) struct OpenFrames {
    pub(crate) path: PathBuf,
    pub(crate) file: Mutex<Trajectory>,
}

/// What was found about the frames of a file.
pub(crate) struct FoundFrames {
    pub(crate) count: usize,
    /// What is wrong after the last frame, for the user.
    pub(crate) note: Option<String>,
}

impl OpenFrames {
    /// Reads the frame that the options name, or else the first.
    pub(crate) fn read(&self, options: &DataOptions) -> Result<Dataset> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        data::read_frame_of(&self.path, &mut file, options)
    }
}
