//! Reads what an input file holds: a scene file with its data, or a data file.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Context, Error, Result, anyhow};

use crate::bricks::BrickFile;
use crate::input::data::{self, DataOptions, as_usage};
use crate::input::kinds::Chosen;
use crate::input::read_file::{Format, data_format};
use crate::input::source::{Source, default_color};
use crate::input::{extension, read};
use crate::terminal::failure::Failure;
use crate::terminal::{profile, progress};
use pinhole::image::color::LinearRgb;
use pinhole::scene::Scene;
use pinhole_data::added::ArrowKey;
use pinhole_data::kind::Traits;
use pinhole_data::load::{self, Column, ConeSet, Dataset, FileSet};
use pinhole_data::select::KeptSpheres;
use pinhole_figure::color_by::ColorKey;
use pinhole_figure::scene_file::{ConeFile, Data, DataError, DataScene, IntegratorKind, SceneFile};
use pinhole_figure::settings::flags::Group;

/// What a file holds. The scene may be moved out of it.
pub(crate) struct Contents {
    pub(crate) file: Arc<SceneFile>,
    pub(crate) scene: Scene,
    pub(crate) details: Details,
}

/// Details of a file that was read, beside its spheres.
#[derive(Default)]
pub(crate) struct Details {
    pub(crate) notes: Vec<String>,
    pub(crate) files: Vec<PathBuf>,
    pub(crate) sky_image: Option<PathBuf>,
    pub(crate) has_atoms: bool,
    /// What colors mean, if a column gives them.
    pub(crate) color_key: Option<ColorKey>,
    /// The meaning of arrows, if there are any.
    pub(crate) arrow_key: Option<ArrowKey>,
    /// The choices for the data that no flag made.
    pub(crate) chosen: Option<Chosen>,
    /// The color of spheres without one, if a key or a flag gives it.
    pub(crate) color: Option<LinearRgb>,
    /// Where the size of the picture comes from.
    pub(crate) size_from: String,
    pub(crate) kept: Option<KeptSpheres>,
    pub(crate) bonds: Option<usize>,
    /// The columns of the data that is drawn, if they were asked for.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "for the viewer"))]
    pub(crate) columns: Vec<Column>,
}

/// Where the data of a scene file is, and the options for reading it.
pub(crate) struct DataPlace {
    pub(crate) data: Data,
    pub(crate) path: PathBuf,
    pub(crate) format: &'static load::Format,
    pub(crate) options: DataOptions,
}

impl DataPlace {
    /// Returns true if there are frames after the first one.
    fn has_more(&self, first: &Dataset) -> bool {
        match FileSet::of(&self.path) {
            Ok(Some(set)) => set.are_frames() && set.files().len() > 1,
            _ => self.format.has_frames() && first.frames != Some(1),
        }
    }
}

impl Contents {
    /// What colors mean, if a column gives them.
    pub(crate) fn color_key(&self) -> Option<&ColorKey> {
        self.details.color_key.as_ref()
    }
}

impl Source {
    /// Reads the spheres, but not the image of the sky.
    pub(crate) fn contents(&self) -> Result<Contents, Failure> {
        let _phase = profile::phase("read");
        progress::stage(format!("reading {}", self.path.display()));
        match (&self.bricks, self.format) {
            (Some(bricks), _) => self.contents_of_bricks(bricks),
            (None, Format::Scene) => self.contents_of_text(&self.text()?),
            (None, _) => self.contents_of(self.scene_of_data()?),
        }
    }

    /// The spheres that stand for all of a file of bricks.
    fn contents_of_bricks(&self, bricks: &BrickFile) -> Result<Contents, Failure> {
        let plain = Chosen::of_traits(&Traits::plain(!bricks.has_colors()), &self.given);
        let file = self.scene_of_kind(&plain)?;
        let of_columns = Group::Structure as u32 | Group::Color as u32;
        if let Some(flag) = self.given.first_in(of_columns) {
            return Err(Failure::usage(format!(
                "{}: {flag} needs columns of the data or all spheres in memory, and bricks have neither; render the data \
                 that was sorted",
                self.path.display()
            )));
        }
        let color = file.data().and_then(|data| data.color);
        if color.is_some() && bricks.has_colors() {
            return Err(Failure::usage(format!(
                "{}: --color applies only to data without colors; remove it",
                self.path.display()
            )));
        }
        let scene = bricks.stand_in(color.unwrap_or_else(default_color))?;
        let (files, has_atoms) = (vec![self.path.clone()], bricks.has_atoms());
        let details = Details { files, has_atoms, color, ..Details::default() };
        Ok(self.prepared(file, scene, details))
    }

    /// Returns the text of the scene file.
    pub(crate) fn text(&self) -> Result<String, Failure> {
        let not_text = |_| anyhow!("{}: this is not UTF-8 text; a scene file is TOML text", self.path.display());
        Ok(String::from_utf8(read(&self.path)?).map_err(not_text)?)
    }

    /// Reads a scene from the text of a scene file, and its data.
    pub(crate) fn contents_of_text(&self, text: &str) -> Result<Contents, Failure> {
        let file = self.parsed(text)?;
        self.check_camera(&file)?;
        self.contents_of(file)
    }

    fn contents_of(&self, mut file: SceneFile) -> Result<Contents, Failure> {
        let of_cones = file.read_cones(|of| self.read_cones(of)).map_err(|error| self.failure(error))?;
        let (of_kind, scene, mut details) = self.scene_of(&file)?;
        file = of_kind.unwrap_or(file);
        details.notes.extend(of_cones);
        if scene.is_empty() && scene.ghosts().is_none() && matches!(self.format, Format::Data(_)) {
            details.notes.push(format!(
                "{}: the file has no spheres, so the picture shows only the background",
                self.path.display()
            ));
        }
        let kept = file.kept_from_style();
        if !kept.is_empty() {
            details.notes.push(format!(
                "{}: --style leaves the values as they are that the scene gives itself, {}; --set KEY=VALUE changes one",
                self.path.display(),
                kept.join(", ")
            ));
        }
        let sky_file = file.sky_image().filter(|_| file.kind() == IntegratorKind::Path);
        let sky_image = sky_file.map(|file| self.resolve(file));
        let data = self.keys_of_data(&file);
        let data_file = data.as_ref().map(|data| self.data_path(data));
        // A folder is not searched again for each frame of a movie.
        let data_files = data_file.map_or_else(Vec::new, |path| match (&self.frames, FileSet::is_one(&path)) {
            (Some(frames), _) => frames.files(),
            (None, true) => FileSet::of(&path).ok().flatten().map_or_else(Vec::new, |set| set.files().to_vec()),
            (None, false) => vec![path],
        });
        let topology = data.as_ref().and_then(|data| self.options(&file, data).topology);
        let scene_file = (self.format == Format::Scene).then(|| self.path.clone());
        let cone_files = file.cone_files().map(|of| self.resolve(&of.file));
        let others = [topology, sky_image.clone()].into_iter().flatten().chain(cone_files);
        let files = scene_file.into_iter().chain(data_files).chain(others).collect();
        Ok(self.prepared(file, scene, Details { files, sky_image, ..details }))
    }

    fn prepared(&self, file: SceneFile, scene: Scene, details: Details) -> Contents {
        let size_from = self.size_from(&file);
        Contents { file: Arc::new(file), scene, details: Details { size_from, ..details } }
    }

    /// Where the size of the picture comes from: a flag or the file.
    pub(crate) fn size_from(&self, file: &SceneFile) -> String {
        let flag = file.flag_of("film.width").or(file.flag_of("film.height"));
        flag.map_or_else(|| self.path.display().to_string(), str::to_owned)
    }

    /// Reads a data file, or one of its frames.
    fn read_data(&self, place: &DataPlace) -> Result<Dataset> {
        match &self.frames {
            Some(frames) => frames.read(&place.options),
            None => data::read(&place.path, place.format, &place.options),
        }
    }

    /// Reads a file of cylinders or cones. An error is a message, with the path in front as in notes.
    fn read_cones(&self, of: &ConeFile) -> Result<ConeSet, String> {
        let path = self.resolve(&of.file);
        progress::stage(format!("reading {}", path.display()));
        let mut set = data::read_cones(&path, of).map_err(|error| format!("{error:#}"))?;
        for note in &mut set.notes {
            *note = format!("{}: {note}", path.display());
        }
        Ok(set)
    }

    /// Makes the scene of a scene file, and of its data if it has any. For a data file, the file with what was chosen for
    /// its kind comes out as well.
    fn scene_of(&self, file: &SceneFile) -> Result<(Option<SceneFile>, Scene, Details), Failure> {
        let file_name = || self.path.display().to_string();
        let Some(place) = self.data_place(file)? else {
            return Ok((None, file.scene().with_context(file_name)?, Details::default()));
        };
        let in_scene = || self.in_scene();
        let read = self.read_data(&place);
        let is_data = matches!(self.format, Format::Data(_));
        let mut loaded = if is_data { read } else { read.with_context(in_scene) }.map_err(as_usage)?;
        let is_one = self.frames.is_none() && !self.keeps_columns && place.options.frame.is_none();
        let is_first = is_one && place.has_more(&loaded);
        let mut data = place.data;
        let has_atoms = loaded.labels("species").is_some();
        let (mut of_kind, mut chosen) = (None, None);
        if is_data {
            let mut choice = self
                .chosen
                .clone()
                .unwrap_or_else(|| Chosen::of(&loaded, data.select.as_ref(), &self.given, self.frames.is_some()));
            let with_kind = self.scene_of_kind(&choice)?;
            data = self.keys_of_data(&with_kind).unwrap_or(data);
            if place.options.radius.is_none() {
                loaded.give_radius(data.radius);
            }
            if is_first {
                let how = "--frame -1 draws the last one, and -o movie.mp4 or -o f%04d.png all of them";
                loaded.notes.push(format!("{}: this is the first of several frames; {how}", self.path.display()));
            }
            let colors = data.color_by_kinds(&loaded, choice.colors.take());
            data.mapping.color.iter_mut().for_each(|by| self.joined.apply_to(by));
            let of_colors = colors.as_ref().map(|by| by.note_of_kinds("--color CSS"));
            let notes = choice.notes.iter().cloned().chain(of_colors);
            loaded.notes.extend(notes.map(|note| format!("{}: {note}", self.path.display())));
            choice.colors = colors;
            (of_kind, chosen) = (Some(with_kind), Some(choice));
        }
        let file = of_kind.as_ref().unwrap_or(file);
        let made = data.scene(loaded, file.shapes()).map_err(|error| match error {
            DataError::Scene(error) if !is_data => Error::new(file.at_shape(&error)).context(file_name()),
            DataError::Select(error) if is_data => Error::new(error).context("--select").context(file_name()),
            error => Error::new(error).context(in_scene()),
        });
        let DataScene { scene, color_key, arrow_key, columns, notes, kept, bonds, .. } = made?;
        let columns = if self.keeps_columns { columns } else { Vec::new() };
        let color = data.color;
        let details = Details { has_atoms, columns, chosen, color, notes, ..Details::default() };
        Ok((of_kind, scene, Details { color_key, arrow_key, kept, bonds, ..details }))
    }

    /// Finds the data of a scene file; `None` if it has none.
    pub(crate) fn data_place(&self, file: &SceneFile) -> Result<Option<DataPlace>, Failure> {
        let Some(data) = self.keys_of_data(file) else { return Ok(None) };
        let path = self.data_path(&data);
        let in_scene = || self.in_scene();
        let named = data.format.as_deref().and_then(load::Format::of_name);
        let of_frames = self.frames.as_ref().map(|frames| frames.format);
        let Some(format) = self.data_format().or(named).or(of_frames).or_else(|| data_format(&path)) else {
            let problem = if let Err(error) = FileSet::of(&path) {
                data::named(&path, error)
            } else if extension(&path).as_deref() == Some("toml") {
                anyhow!("it names another scene file; name a data file")
            } else if let Some(refused) = load::Format::refused(&path) {
                anyhow!("{}: {refused}", path.display())
            } else {
                anyhow!(
                    "{}: this is not the extension of a data format; a scene can use {}",
                    path.display(),
                    load::Format::extensions_of(|_| true)
                )
            };
            return Err(problem.context(in_scene()).into());
        };
        let options = self.options(file, &data);
        options.check(&path, format, file).map_err(|(message, is_flag)| match is_flag {
            true => Failure::usage(message),
            false => anyhow!(message).context(in_scene()).into(),
        })?;
        Ok(Some(DataPlace { data, path, format, options }))
    }

    /// The place of the data in a scene file, for messages.
    fn in_scene(&self) -> String {
        match self.format {
            Format::Data(_) => self.path.display().to_string(),
            _ => format!("{}: `data`", self.path.display()),
        }
    }
}
