//! Reads what an input file holds: a scene file with its data, or a data file.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Context, Result, anyhow};

use crate::bricks::BrickFile;
use crate::input::data::{self, DataOptions, as_usage};
use crate::input::read_file::{Format, data_format};
use crate::input::source::{Source, default_color};
use crate::input::{extension, read};
use crate::terminal::failure::Failure;
use crate::terminal::{profile, progress};
use pinhole::image::color::LinearRgb;
use pinhole::scene::Scene;
use pinhole_data::added::Additions;
use pinhole_data::load::{self, Column, Dataset};
use pinhole_data::select::{KeptSpheres, Selection};
use pinhole_figure::color_by::{ColorBy, ColorKey, Mapping};
use pinhole_figure::scene_file::{AppliedData, Data, IntegratorKind, SceneFile};
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
    /// The colors by kind that no flag asked for.
    pub(crate) kinds: Option<ColorBy>,
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
        let file = self.scene_of_data()?;
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

    /// Copies the columns of the spheres that `select` keeps, if they are asked for.
    fn columns_of(&self, loaded: &Dataset, select: Option<&Selection>) -> Vec<Column> {
        match (self.keeps_columns, select) {
            (false, _) => Vec::new(),
            (true, None) => loaded.columns.clone(),
            (true, Some(select)) => {
                let mut kept = loaded.clone();
                // Where this fails, so does what is drawn.
                let _ = select.apply(&mut kept);
                kept.columns
            }
        }
    }

    /// Returns the text of the scene file.
    pub(crate) fn text(&self) -> Result<String, Failure> {
        let not_text = |_| {
            anyhow!("{}: this is not UTF-8 text; a scene file is TOML text", self.path.display())
        };
        Ok(String::from_utf8(read(&self.path)?).map_err(not_text)?)
    }

    /// Reads a scene from the text of a scene file, and its data.
    pub(crate) fn contents_of_text(&self, text: &str) -> Result<Contents, Failure> {
        let file = self.parsed(text)?;
        self.check_camera(&file)?;
        self.contents_of(file)
    }

    fn contents_of(&self, file: SceneFile) -> Result<Contents, Failure> {
        let (scene, mut details) = self.scene_of(&file)?;
        if scene.is_empty() && matches!(self.format, Format::Data(_)) {
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
        let topology = data.as_ref().and_then(|data| self.options(&file, data).topology);
        let scene_file = (self.format == Format::Scene).then(|| self.path.clone());
        let files = [scene_file, data_file, topology, sky_image.clone()];
        let files = files.into_iter().flatten().collect();
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

    /// Makes the scene of a scene file, and of its data if it has any.
    fn scene_of(&self, file: &SceneFile) -> Result<(Scene, Details), Failure> {
        let file_name = || self.path.display().to_string();
        let Some(place) = self.data_place(file)? else {
            return Ok((file.scene(&[]).with_context(file_name)?, Details::default()));
        };
        let in_scene = || self.in_scene();
        let read = self.read_data(&place);
        let is_data = matches!(self.format, Format::Data(_));
        let mut loaded =
            if is_data { read } else { read.with_context(in_scene) }.map_err(as_usage)?;
        let mut data = place.data;
        let color = data.color.unwrap_or_else(default_color);
        let has_atoms = loaded.labels("species").is_some();
        let columns = self.columns_of(&loaded, data.select.as_ref());
        let kinds = self.kinds.clone().or_else(|| ColorBy::of_kinds(&loaded));
        let colors_itself = data.mapping.color.is_some() || data.color.is_some();
        let kinds = kinds.filter(|_| is_data && !colors_itself);
        let mut notes = Vec::new();
        if let Some(by) = &kinds {
            notes.push(format!("{}: {}", self.path.display(), note(by)));
            let mut by = by.clone();
            self.joined.apply_to(&mut by);
            data.mapping.color = Some(by);
        }
        let details =
            Details { has_atoms, columns, kinds, color: data.color, ..Details::default() };
        if is_data && data.is_plain() {
            let selected = data.select.as_ref().map(|select| select.apply(&mut loaded));
            let kept = selected.transpose().context("--select").with_context(file_name)?;
            let Mapping { color: by, radius, .. } = &data.mapping;
            let has_colors = by.is_some() && details.kinds.is_none();
            loaded.correct_notes(has_colors, radius.is_some(), |_| false);
            let mut all = std::mem::take(&mut loaded.notes);
            all.extend(kept.iter().flat_map(|kept| kept.notes.clone()));
            all.append(&mut notes);
            let additions = Additions { keeps_radii: data.radius.is_some(), ..data.additions };
            let made = data.mapping.scene_with(loaded, color, &additions);
            let (scene, mapped, added) = made.with_context(file_name)?;
            all.extend_from_slice(mapped.notes());
            all.extend_from_slice(added.notes());
            let bonds = additions.bonds.as_ref().map(|_| added.bonds());
            let color_key = mapped.key().cloned();
            return Ok((scene, Details { notes: all, color_key, kept, bonds, ..details }));
        }
        let AppliedData { spheres, color_key, notes: all, kept, added, .. } =
            data.apply(loaded).with_context(in_scene)?;
        notes.splice(0..0, all);
        let scene = file.scene_of(spheres, color);
        let scene = scene.with_context(file_name)?.with_added(added.len());
        let bonds = data.additions.bonds.is_some().then_some(added.bonds());
        Ok((scene, Details { notes, color_key, kept, bonds, ..details }))
    }

    /// Finds the data of a scene file; `None` if it has none.
    pub(crate) fn data_place(&self, file: &SceneFile) -> Result<Option<DataPlace>, Failure> {
        let Some(data) = self.keys_of_data(file) else { return Ok(None) };
        let path = self.data_path(&data);
        let in_scene = || self.in_scene();
        let named = data.format.as_deref().and_then(load::Format::of_name);
        let Some(format) = self.data_format().or(named).or_else(|| data_format(&path)) else {
            let problem = if extension(&path).as_deref() == Some("toml") {
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
        let options = self.options(file, &data);
        options.check(format, file).map_err(|(message, is_flag)| match is_flag {
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

/// The note about the colors by kind of a data file where neither the file nor a flag gives colors.
pub(crate) fn note(by: &ColorBy) -> String {
    let column = &by.column;
    format!(
        "there are no colors; the spheres are colored by {column}; --color CSS gives all one color"
    )
}
