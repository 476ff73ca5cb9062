//! Reads the input: from a path to a scene with its camera and settings.

use std::path::{Path, PathBuf};

use anyhow::{Context, Error, Result, anyhow};

#[cfg(feature = "gpu")]
use super::args::BenchArgs;
use super::args::{InputArgs, ViewArgs};
use super::camera::CameraFlags;
use super::color_flags::ColorFlags;
use super::data::{self, DataOptions, as_usage};
use super::failure::Failure;
use super::found::{Found, FoundData, default_color};
pub(super) use super::input_format::extension;
pub(super) use super::input_format::parse_size;
use super::input_format::{Format, data_format};
use super::kind_color;
use super::light::LightFlags;
use super::progress;
pub(super) use super::read_file::read;
use super::report::Report;
use pinhole::annotate::AnnotationPlan;
use pinhole::camera::film::Film;
use pinhole::camera::{Camera, CameraParameters, View, Viewpoint};
use pinhole::color_by::{ColorBy, ColorKey, Mapping};
use pinhole::image::color::LinearRgb;
use pinhole::image::encoding::Encoding;
use pinhole::light::environment::Environment;
use pinhole::load::{self, environment};
use pinhole::render::RenderSettings;
use pinhole::scene::Scene;
use pinhole::scene::sphere::Sphere;
use pinhole::scene_file::{Data, DataSpheres, IntegratorKind, SceneFile};
use pinhole::style::Style;

/// Everything that a render needs from its input.
pub(super) struct Input {
    pub(super) scene: Scene,
    /// The camera; for a stereo camera, the view from the middle between the eyes.
    pub(super) camera: Box<dyn Camera>,
    /// The left and the right eye of a stereo camera.
    pub(super) eyes: Option<[Box<dyn Camera>; 2]>,
    pub(super) film: Film,
    /// The settings for rendering.
    pub(super) settings: RenderSettings,
    pub(super) encoding: Encoding,
    /// What colors mean, if a column of the data gives them.
    pub(super) color_key: Option<ColorKey>,
    /// What the scene file draws over the picture.
    pub(super) annotations: AnnotationPlan,
    /// Where the size of the picture comes from, for messages: a flag or a file.
    pub(super) size_from: String,
    /// Notes for the user that are not errors.
    pub(super) notes: Vec<String>,
    /// Paths of the files that were read.
    pub(super) files: Vec<PathBuf>,
    /// What the program says about the picture.
    pub(super) report: Report,
    /// The camera, with its position.
    pub(super) parameters: CameraParameters,
    /// The data with its keys and the flags about it; its path is as the program found it.
    pub(super) data: Option<Data>,
    /// The spheres of a scene file itself.
    pub(super) own_spheres: Vec<Sphere>,
    /// Path of the image of the sky.
    pub(super) sky_image: Option<PathBuf>,
}

impl Input {
    /// Returns the view of the camera, or of the middle between two eyes.
    pub(super) fn view(&self) -> View<'_> {
        View::new(self.camera.as_ref(), self.film)
    }
}

/// Checks that flags apply to a file of this format.
pub(super) fn check_flags(format: Format, options: &DataOptions) -> Result<(), Failure> {
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
    }
}

/// An input file with its flags, checked as far as is possible before the file is read.
pub(super) struct Source {
    path: PathBuf,
    format: Format,
    size: Option<(u32, u32)>,
    options: DataOptions,
    camera: CameraFlags,
    light: LightFlags,
    /// The style of data files.
    style: Style,
    color: ColorFlags,
}

impl Source {
    pub(super) fn new(InputArgs { path, view }: &InputArgs) -> Result<Self, Failure> {
        Self::of_view(path, view)
    }

    /// Makes a source from a path and its flags.
    pub(super) fn of_view(path: &Path, args: &ViewArgs) -> Result<Self, Failure> {
        let format = match args.format {
            Some(format) => Format::Data(format),
            None => Format::of(path).map_err(Failure::Usage)?,
        };
        let color = args.color.as_deref().map(LinearRgb::from_css).transpose();
        let color = color.map_err(|error| Failure::usage(format!("--color: {error}")))?;
        let (topology, columns) = (args.topology.clone(), args.columns.clone());
        let options =
            DataOptions { frame: args.frame, radius: args.radius, color, topology, columns };
        check_flags(format, &options)?;
        Ok(Self {
            path: path.to_path_buf(),
            format,
            size: args.size.as_deref().map(parse_size).transpose()?,
            options,
            camera: args.camera.flags()?,
            ..Self::of_scene(path)
        })
    }

    /// Returns this source with light flags. Without them, data files have one ray for each pixel.
    pub(super) fn with_light(self, light: LightFlags) -> Self {
        Self { light, style: light.style_of_data(), ..self }
    }

    /// Returns this source with flags for colors from data.
    pub(super) fn with_color(self, color: ColorFlags) -> Self {
        Self { color, ..self }
    }

    /// Makes a source from a scene file without flags.
    pub(super) fn of_scene(path: &Path) -> Self {
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
        }
    }

    /// Returns this source with the size of a picture, such as `800x600`.
    pub(super) fn with_size(self, size: Option<&str>) -> Result<Self, Failure> {
        Ok(Self { size: size.map(parse_size).transpose()?, ..self })
    }

    /// Makes a source from a file that `bench` measures.
    #[cfg(feature = "gpu")]
    pub(super) fn of_bench(
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
        Ok(Self { format, size, options, ..Self::of_scene(path) })
    }

    /// Reads the file, and the data files that it names.
    pub(super) fn load(&self) -> Result<Input, Failure> {
        let path = &self.path;
        progress::stage(format!("reading {}", path.display()));
        let Format::Data(format) = self.format else {
            let text = String::from_utf8(read(path)?).map_err(|_| {
                anyhow!("{}: this is not UTF-8 text; a scene file is TOML text", path.display())
            })?;
            return self.scene_from_text(&text);
        };
        let mut loaded = data::read(path, format, &self.options).map_err(as_usage)?;
        let has_atoms = loaded.labels("species").is_some();
        let file_name = || path.display().to_string();
        let mut mapping = self.color.apply_to(&Mapping::default())?;
        loaded.correct_notes(mapping.color.is_some(), mapping.radius.is_some(), |_| false);
        let mut notes = std::mem::take(&mut loaded.notes);
        let kinds = kind_color::by_kind(&loaded, &self.options);
        let kinds = kinds.filter(|_| mapping.color.is_none());
        if let Some(by) = &kinds {
            notes.push(format!("{}: {}", path.display(), kind_color::note(by)));
            mapping.color = Some(by.clone());
        }
        let color = self.options.color.unwrap_or_else(default_color);
        let (scene, mapped) = mapping.scene(loaded, color).with_context(file_name)?;
        notes.extend_from_slice(mapped.notes());
        let color_key = mapped.key().cloned();
        if scene.is_empty() {
            notes.push(format!(
                "{}: the file has no spheres, so the picture shows only the background",
                path.display()
            ));
        }
        let file = SceneFile::parse_in_style("", Some(self.style)).with_context(file_name)?;
        let facing = scene.subject().flat_axis().map(Viewpoint::on_axis);
        let files = [path.clone()].into_iter().chain(self.options.topology.clone()).collect();
        let facing = Some(facing.unwrap_or(Viewpoint::OBLIQUE));
        self.input(
            file,
            scene,
            Found { notes, files, sky: None, sky_image: None, has_atoms, facing, color_key, kinds },
        )
    }

    /// Reads a scene from the text of a scene file, and its data. The file need not exist; its path is the base of
    /// other paths.
    pub(super) fn scene_from_text(&self, text: &str) -> Result<Input, Failure> {
        let file_name = || self.path.display().to_string();
        let file = SceneFile::parse_in_style(text, self.light.style()).with_context(file_name)?;
        let FoundData { spheres: data, color_key, color, notes, has_atoms } =
            self.data_of(&file)?;
        let kind = self.light.integrator(file.integrator().or(self.color.integrator()));
        let sky_file = file.sky_image().filter(|_| kind == IntegratorKind::Path);
        let sky_file = sky_file.map(|file| self.resolve(file));
        let sky = sky_file.as_deref().map(|path| self.environment(path)).transpose()?;
        let data_file = file.data().map(|data| self.resolve(&data.file));
        let topology = file.data().and_then(|data| data.topology.as_ref());
        let topology =
            self.options.topology.clone().or_else(|| topology.map(|file| self.resolve(file)));
        let files = [Some(self.path.clone()), data_file, topology, sky_file.clone()];
        let files = files.into_iter().flatten().collect();
        let scene = match data {
            DataSpheres::Spheres(spheres) => file.scene(&spheres),
            DataSpheres::Array(spheres) => file.scene_with_array(spheres, color),
            DataSpheres::Mapped(spheres, mapped) => file.scene_with_mapped(spheres, &mapped, color),
        };
        let scene = scene.with_context(file_name)?;
        self.input(
            file,
            scene,
            Found {
                notes,
                files,
                sky,
                sky_image: sky_file,
                has_atoms,
                facing: None,
                color_key,
                kinds: None,
            },
        )
    }

    /// Makes the film, the camera and the settings of a scene.
    fn input(&self, mut file: SceneFile, scene: Scene, found: Found) -> Result<Input, Failure> {
        let file_name = || self.path.display().to_string();
        let (film, size_from) = self.film(file.film)?;
        file.film = film;
        file.background = self.light.background().unwrap_or(file.background);
        let has_flags = self.camera.is_given || matches!(self.format, Format::Data(_));
        let parameters = if has_flags {
            self.camera.parameters(found.facing).map_err(Failure::usage)?
        } else {
            file.camera_parameters()
        };
        let (aspect, subject) = (film.aspect(), scene.subject());
        let placed = parameters.placed(aspect, &subject);
        let made = |parameters: CameraParameters| {
            let camera = parameters.camera(aspect, &subject)?;
            Ok((camera, parameters.stereo_pair(aspect, &subject)?))
        };
        let cameras = placed.and_then(|placed| Ok((placed, made(placed)?)));
        let (placed, (camera, eyes)) = match cameras {
            Ok(cameras) => cameras,
            // The scene file knows the place of the error.
            Err(error) if has_flags => return Err(Error::new(error).context(file_name()).into()),
            Err(error) => {
                return Err(Error::new(file.at_camera(&error)).context(file_name()).into());
            }
        };
        let kind = self.light.integrator(file.integrator());
        let settings = file.settings(kind, &scene, camera.as_ref(), found.sky);
        let settings = self.light.apply_to(settings.with_context(file_name)?, file.integrator())?;
        let report = Report {
            path: self.path.display().to_string(),
            spheres: scene.len(),
            has_atoms: found.has_atoms,
            style: file.style(),
            view: if has_flags { self.camera.view_in_flags(found.facing) } else { None },
            color_by: found.kinds.as_ref().map(|by| by.column.clone()),
        };
        let (encoding, annotations) = (file.encoding, file.annotations.clone());
        let data = self.data(&file, found.kinds)?;
        let own_spheres = file.spheres().collect();
        let parameters = placed;
        let Found { notes, files, sky_image, color_key, .. } = found;
        Ok(Input {
            scene,
            camera,
            eyes,
            film,
            settings,
            encoding,
            color_key,
            annotations,
            size_from,
            notes,
            files,
            report,
            parameters,
            data,
            own_spheres,
            sky_image,
        })
    }

    /// Returns the data with its keys, over which flags take precedence.
    fn data(&self, file: &SceneFile, kinds: Option<ColorBy>) -> Result<Option<Data>, Failure> {
        let flags = self.options.clone();
        let mut data = match self.format {
            Format::Data(format) => Data {
                format: (data_format(&self.path) != Some(format)).then(|| format.name.to_owned()),
                ..Data::of_file(self.path.to_string_lossy())
            },
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
        data.frame = flags.frame.or(data.frame);
        data.radius = flags.radius.or(data.radius);
        data.color = flags.color.or(data.color);
        let topology = flags.topology.map(|file| file.to_string_lossy().into_owned());
        data.topology = topology.or(data.topology);
        if !flags.columns.is_empty() {
            data.columns = flags.columns;
        }
        data.mapping = self.color.apply_to(&data.mapping)?;
        data.mapping.color = data.mapping.color.or(kinds);
        Ok(Some(data))
    }

    /// Reads the image of the sky.
    fn environment(&self, path: &Path) -> Result<Environment> {
        let in_scene = || format!("{}: `[sky]`", self.path.display());
        progress::stage(format!("reading {}", path.display()));
        let bytes = read(path).with_context(in_scene)?;
        let read = environment::read(&bytes);
        read.with_context(|| path.display().to_string()).with_context(in_scene)
    }

    /// Resolves a path that is relative to the folder of the scene file.
    fn resolve(&self, path: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }

    /// Reads the data of a scene file.
    fn data_of(&self, file: &SceneFile) -> Result<FoundData, Failure> {
        let flags = self.options.clone();
        let Some(data) = file.data() else {
            let given = [
                ("--frame", flags.frame.is_some()),
                ("--radius", flags.radius.is_some()),
                ("--color", flags.color.is_some()),
                ("--topology", flags.topology.is_some()),
                ("--columns", !flags.columns.is_empty()),
            ];
            let given = given.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag);
            return match given.or(self.color.given()) {
                Some(flag) => Err(Failure::usage(format!(
                    "{}: {flag} applies to the `data` of a scene, but this scene has no `data`; remove {flag}",
                    self.path.display()
                ))),
                None => Ok(FoundData {
                    spheres: DataSpheres::Spheres(Vec::new()),
                    color_key: None,
                    color: default_color(),
                    notes: Vec::new(),
                    has_atoms: false,
                }),
            };
        };
        let path = self.resolve(&data.file);
        let in_scene = || format!("{}: `data`", self.path.display());
        let extension = extension(&path);
        let named = data.format.as_deref().and_then(load::Format::of_name);
        let Some(format) = named.or_else(|| data_format(&path)) else {
            let problem = if extension.as_deref() == Some("toml") {
                anyhow!("it names another scene file; name a data file")
            } else {
                anyhow!(
                    "{}: this is not the extension of a data format; a scene can use {}",
                    path.display(),
                    load::Format::extensions_of(|_| true)
                )
            };
            return Err(problem.context(in_scene()).into());
        };
        let keys = DataOptions {
            frame: data.frame,
            radius: data.radius,
            color: data.color,
            topology: data.topology.as_ref().map(|file| self.resolve(file)),
            columns: data.columns.clone(),
        };
        flags.check(format, "--").map_err(Failure::usage)?;
        keys.check(format, "").map_err(|message| anyhow!(message).context(in_scene()))?;
        let options = flags.or(keys);
        let loaded =
            data::read(&path, format, &options).with_context(in_scene).map_err(as_usage)?;
        let has_atoms = loaded.labels("species").is_some();
        let mapping = self.color.apply_to(&data.mapping)?;
        let data = Data { mapping, color: options.color, ..data.clone() };
        let (spheres, color_key, notes) = data.apply(loaded).with_context(in_scene)?;
        let color = options.color.unwrap_or_else(default_color);
        Ok(FoundData { spheres, color_key, color, notes, has_atoms })
    }

    /// Returns the film, and where its size comes from.
    fn film(&self, from_file: Film) -> Result<(Film, String), Failure> {
        let Some((width, height)) = self.size else {
            return Ok((from_file, self.path.display().to_string()));
        };
        let film = Film::new(width, height)
            .map_err(|error| Failure::usage(format!("--size: {error}")))?
            .with_y_axis(from_file.y_axis());
        Ok((film, "--size".to_owned()))
    }
}
