//! Reads what an input file holds: a scene file with its data, or a data file.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, anyhow};

use crate::bricks::BrickFile;
use crate::input::data::{self, DataOptions, as_usage};
use crate::input::read_file::{Format, data_format};
use crate::input::source::{Source, default_color};
use crate::input::{extension, read};
use crate::terminal::failure::Failure;
use crate::terminal::{profile, progress};
use pinhole::camera::film::Film;
use pinhole::image::color::LinearRgb;
use pinhole::scene::Scene;
use pinhole_data::added::Additions;
use pinhole_data::load::{self, Column, Dataset};
use pinhole_data::select::{KeptSpheres, Selection};
use pinhole_figure::color_by::{ColorBy, ColorKey, Mapping};
use pinhole_figure::scene_file::{AppliedData, Data, IntegratorKind, SceneFile};
use pinhole_figure::settings::{Layer, Sources};

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
        let path = &self.path;
        progress::stage(format!("reading {}", path.display()));
        if let Some(bricks) = &self.bricks {
            return self.contents_of_bricks(bricks);
        }
        let Format::Data(format) = self.format else {
            return self.contents_of_text(&self.text()?);
        };
        let mut loaded = self.read_data(path, format, &self.options).map_err(as_usage)?;
        let has_atoms = loaded.labels("species").is_some();
        let file_name = || path.display().to_string();
        let selected = self.structure.select.as_ref().map(|select| select.apply(&mut loaded));
        let kept = selected.transpose().context("--select").with_context(file_name)?;
        let columns = self.columns_of(&loaded, None);
        let mut mapping = self.color.apply_to(&Mapping::default())?;
        loaded.correct_notes(mapping.color.is_some(), mapping.radius.is_some(), |_| false);
        let mut notes = std::mem::take(&mut loaded.notes);
        notes.extend(kept.iter().flat_map(|kept| kept.notes.clone()));
        let kinds = self.kinds.clone().or_else(|| by_kind(&loaded, &self.options));
        let kinds = kinds.filter(|_| mapping.color.is_none());
        if let Some(by) = &kinds {
            notes.push(format!("{}: {}", path.display(), note(by)));
            let mut by = by.clone();
            self.color.join(&mut by);
            mapping.color = Some(by);
        }
        let color = self.color_of_all();
        let keeps_radii = self.options.radius.is_some();
        let additions = self.structure.additions(&Additions::default(), keeps_radii);
        let made = mapping.scene_with(loaded, color, &additions);
        let (scene, mapped, added) = made.with_context(file_name)?;
        notes.extend_from_slice(mapped.notes());
        notes.extend_from_slice(added.notes());
        let bonds = additions.bonds.as_ref().map(|_| added.bonds());
        let color_key = mapped.key().cloned();
        if scene.is_empty() {
            notes.push(format!(
                "{}: the file has no spheres, so the picture shows only the background",
                path.display()
            ));
        }
        let file = self.scene_of_data()?;
        let files = [path.clone()].into_iter().chain(self.options.topology.clone()).collect();
        let details = Details {
            notes,
            files,
            has_atoms,
            color_key,
            kinds,
            kept,
            bonds,
            columns,
            ..Details::default()
        };
        self.prepared(file, scene, details)
    }

    /// The spheres that stand for all of a file of bricks.
    fn contents_of_bricks(&self, bricks: &BrickFile) -> Result<Contents, Failure> {
        if let Some(flag) = self.structure.given().or(self.color.given()) {
            return Err(Failure::usage(format!(
                "{}: {flag} needs columns of the data or all spheres in memory, and bricks have neither; render the data \
                 that was sorted",
                self.path.display()
            )));
        }
        if self.options.color.is_some() && bricks.has_colors() {
            return Err(Failure::usage(format!(
                "{}: --color applies only to data without colors; remove it",
                self.path.display()
            )));
        }
        let scene = bricks.stand_in(self.color_of_all())?;
        let (files, has_atoms) = (vec![self.path.clone()], bricks.has_atoms());
        let details = Details { files, has_atoms, ..Details::default() };
        self.prepared(self.scene_of_data()?, scene, details)
    }

    /// The color of spheres without one.
    pub(crate) fn color_of_all(&self) -> LinearRgb {
        self.options.color.unwrap_or_else(default_color)
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
        let (scene, details) = self.scene_of(&file)?;
        let kind = self.light.integrator(file.integrator().or(self.color.integrator()));
        let sky_file = file.sky_image().filter(|_| kind == IntegratorKind::Path);
        let sky_image = sky_file.map(|file| self.resolve(file));
        let data_file = file.data().map(|data| self.resolve(&data.file));
        let topology = file.data().and_then(|data| data.topology.as_ref());
        let topology =
            self.options.topology.clone().or_else(|| topology.map(|file| self.resolve(file)));
        let files = [Some(self.path.clone()), data_file, topology, sky_image.clone()];
        let files = files.into_iter().flatten().collect();
        self.prepared(file, scene, Details { files, sky_image, ..details })
    }

    /// The scene file that stands for a data file: its style.
    pub(crate) fn scene_of_data(&self) -> Result<SceneFile> {
        let file = SceneFile::read(&Sources { style: Some(self.style), ..Sources::default() });
        file.with_context(|| self.path.display().to_string())
    }

    pub(crate) fn parsed(&self, text: &str) -> Result<SceneFile> {
        let style = self
            .light
            .style()
            .map(|style| Layer { flag: "--style", text: format!("style = \"{}\"", style.name()) });
        let file = SceneFile::read(&Sources { file: text, flags: style.as_slice(), style: None });
        file.with_context(|| self.path.display().to_string())
    }

    /// Applies the flags for the film and the background.
    fn prepared(
        &self,
        file: SceneFile,
        scene: Scene,
        details: Details,
    ) -> Result<Contents, Failure> {
        let (file, size_from) = self.with_film(file)?;
        Ok(Contents { file: Arc::new(file), scene, details: Details { size_from, ..details } })
    }

    /// Gives a scene file the film and the background of the flags. Also returns where the film's size comes from.
    pub(crate) fn with_film(&self, mut file: SceneFile) -> Result<(SceneFile, String), Failure> {
        let (film, size_from) = self.film(file.film)?;
        file.film = film;
        file.background = self.light.background().unwrap_or(file.background);
        Ok((file, size_from))
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

    /// Reads a data file, or one of its frames.
    fn read_data(
        &self,
        path: &Path,
        format: &'static load::Format,
        options: &DataOptions,
    ) -> Result<Dataset> {
        match &self.frames {
            Some(frames) => frames.read(options),
            None => data::read(path, format, options),
        }
    }

    /// Makes the scene of a scene file, and of its data if it has any.
    fn scene_of(&self, file: &SceneFile) -> Result<(Scene, Details), Failure> {
        let file_name = || self.path.display().to_string();
        let Some(DataPlace { data, path, format, options }) = self.data_place(file)? else {
            let flags = &self.options;
            let given = [
                ("--frame", flags.frame.is_some()),
                ("--radius", flags.radius.is_some()),
                ("--color", flags.color.is_some()),
                ("--topology", flags.topology.is_some()),
                ("--columns", !flags.columns.is_empty()),
            ];
            let given = given.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag);
            return match given.or(self.color.given()).or(self.structure.given()) {
                Some(flag) => Err(Failure::usage(format!(
                    "{}: {flag} applies to the `data` of a scene, but this scene has no `data`; remove {flag}",
                    self.path.display()
                ))),
                None => Ok((file.scene(&[]).with_context(file_name)?, Details::default())),
            };
        };
        let in_scene = || self.in_scene();
        let loaded =
            self.read_data(&path, format, &options).with_context(in_scene).map_err(as_usage)?;
        let has_atoms = loaded.labels("species").is_some();
        let data = self.with_flags(data)?;
        let columns = self.columns_of(&loaded, data.select.as_ref());
        let AppliedData { spheres, color_key, notes, kept, added, .. } =
            data.apply(loaded).with_context(in_scene)?;
        let scene = file.scene_of(spheres, data.color.unwrap_or_else(default_color));
        let scene = scene.with_context(file_name)?.with_added(added.len());
        let bonds = data.additions.bonds.is_some().then_some(added.bonds());
        let details =
            Details { notes, has_atoms, color_key, kept, bonds, columns, ..Details::default() };
        Ok((scene, details))
    }

    /// Finds the data of a scene file; `None` if it has none.
    pub(crate) fn data_place(&self, file: &SceneFile) -> Result<Option<DataPlace>, Failure> {
        let flags = self.options.clone();
        let Some(data) = file.data() else { return Ok(None) };
        let path = self.resolve(&data.file);
        let in_scene = || self.in_scene();
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
        Ok(Some(DataPlace { data: data.clone(), path, format, options }))
    }

    /// The place of the data in a scene file, for messages.
    fn in_scene(&self) -> String {
        format!("{}: `data`", self.path.display())
    }
}

/// The column that colors the spheres of a data file where neither the file nor a flag does; see [`ColorBy::of_kinds`].
pub(crate) fn by_kind(loaded: &Dataset, options: &DataOptions) -> Option<ColorBy> {
    ColorBy::of_kinds(loaded).filter(|_| options.color.is_none())
}

/// The note about such colors.
pub(crate) fn note(by: &ColorBy) -> String {
    let column = &by.column;
    format!(
        "there are no colors; the spheres are colored by {column}; --color CSS gives all one color"
    )
}
