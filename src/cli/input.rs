//! From a path to a scene and a view of it.

use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};

use super::failure::Failure;
use crate::camera::{Camera, PinholeCamera};
use crate::film::Film;
use crate::io::xyz;
use crate::scene::Scene;
use crate::scene_file::SceneFile;
use crate::settings::Settings;
use crate::sphere::Sphere;

/// Everything that a render needs.
pub(super) struct Input {
    pub(super) scene: Scene,
    pub(super) camera: Box<dyn Camera>,
    pub(super) film: Film,
    pub(super) settings: Settings,
    /// What says how large the picture is: a flag or a file.
    pub(super) size_from: String,
    /// What the user should know although it is no error.
    pub(super) notes: Vec<String>,
}

/// What a file is, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Scene,
    Data(DataFormat),
}

/// The formats of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DataFormat {
    Xyz,
}

impl Format {
    /// The format that an extension stands for.
    pub(super) fn of(path: &Path) -> Result<Self> {
        match extension(path).as_deref() {
            Some("toml") => Ok(Self::Scene),
            Some("xyz" | "extxyz") => Ok(Self::Data(DataFormat::Xyz)),
            _ => bail!(
                "{}: the extension names no format that can be read; \
                 there are .toml (scene) and .xyz, .extxyz (data)",
                path.display()
            ),
        }
    }
}

/// What stands behind the last dot of a file's name, in small letters.
pub(super) fn extension(path: &Path) -> Option<String> {
    path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase)
}

/// Reads a scene or data file. `size` and `frame` take the place of what the file says.
pub(super) fn load(
    path: &Path,
    format: Format,
    size: Option<(u32, u32)>,
    frame: Option<usize>,
) -> Result<Input, Failure> {
    let Format::Data(format) = format else {
        let text = String::from_utf8(read(path)?).map_err(|_| {
            anyhow!("{}: this is no UTF-8 text; a scene file is TOML", path.display())
        })?;
        return scene_from_text(&text, path, size, frame);
    };
    let (spheres, notes) = load_data(path, format, frame.unwrap_or(0), 1.0)?;
    let place = || path.display().to_string();
    let (film, size_from) = film(Film::default(), size, path)?;
    let scene = Scene::new(&spheres).with_context(place)?;
    let camera = PinholeCamera::framing_from_the_front(&scene.bounds_to_frame(), film.aspect())
        .with_context(place)?;
    let (camera, settings) = (Box::new(camera), Settings::default());
    Ok(Input { scene, camera, film, settings, size_from, notes })
}

/// Reads the text of a scene file that stands, or will stand, at `path`, and its data.
pub(super) fn scene_from_text(
    text: &str,
    path: &Path,
    size: Option<(u32, u32)>,
    frame: Option<usize>,
) -> Result<Input, Failure> {
    let place = || path.display().to_string();
    let file = SceneFile::parse(text).with_context(place)?;
    let (spheres, notes) = match file.data() {
        Some(data) => {
            let data_path = path.parent().unwrap_or(Path::new("")).join(&data.file);
            let in_scene = || format!("{}: `data`", path.display());
            let Format::Data(format) = Format::of(&data_path).with_context(in_scene)? else {
                return Err(anyhow!("it names another scene file").context(in_scene()).into());
            };
            load_data(&data_path, format, frame.unwrap_or(data.frame), data.radius_scale)
                .with_context(in_scene)?
        }
        None if frame.is_some() => {
            return Err(Failure::usage(format!(
                "{}: --frame needs a scene with `data`, and this scene has none",
                path.display()
            )));
        }
        None => (Vec::new(), Vec::new()),
    };
    let (film, size_from) = film(file.film, size, path)?;
    let scene = file.scene(&spheres).with_context(place)?;
    let camera = file.camera(&film, &scene).with_context(place)?;
    Ok(Input { scene, camera, film, settings: file.settings, size_from, notes })
}

/// The film, and what its size comes from.
fn film(from_file: Film, size: Option<(u32, u32)>, path: &Path) -> Result<(Film, String), Failure> {
    let Some((width, height)) = size else { return Ok((from_file, path.display().to_string())) };
    let film = Film::new(width, height)
        .map_err(|error| Failure::usage(format!("--size: {error}")))?
        .with_y_axis(from_file.y_axis());
    Ok((film, "--size".to_owned()))
}

fn load_data(
    path: &Path,
    format: DataFormat,
    frame: usize,
    radius_scale: f64,
) -> Result<(Vec<Sphere>, Vec<String>)> {
    let bytes = read(path)?;
    match format {
        DataFormat::Xyz => {
            let mut atoms = xyz::read(&bytes, frame).with_context(|| path.display().to_string())?;
            for sphere in &mut atoms.spheres {
                sphere.radius *= radius_scale;
            }
            let notes = unknown_species(&atoms.unknown_species, path).into_iter().collect();
            Ok((atoms.spheres, notes))
        }
    }
}

/// A note that fits on a line, however many species there are.
fn unknown_species(names: &[String], path: &Path) -> Option<String> {
    const NAMED: usize = 5;
    let more = match names.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let named = names.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
    (!names.is_empty()).then(|| {
        format!(
            "{}: no chemical elements: {named}{more}; drawn in pink, with radius 2 if the file \
             gives none",
            path.display()
        )
    })
}

fn read(path: &Path) -> Result<Vec<u8>> {
    if path.is_dir() {
        bail!("{}: this is a folder; name a file", path.display());
    }
    std::fs::read(path).with_context(|| format!("{}: cannot be read", path.display()))
}
