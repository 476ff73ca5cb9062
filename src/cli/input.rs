//! From a path to a scene and a view of it.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};

use super::failure::Failure;
use crate::camera::Camera;
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
    /// What the user should know although it is no error.
    pub(super) notes: Vec<String>,
}

/// What a file is, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Scene,
    Xyz,
}

impl Format {
    /// The format that an extension stands for.
    pub(super) fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            Some("toml") => Ok(Self::Scene),
            Some("xyz" | "extxyz") => Ok(Self::Xyz),
            _ => bail!(
                "{}: the extension names no format that can be read; \
                 there are .toml (scene) and .xyz, .extxyz (data)",
                path.display()
            ),
        }
    }
}

/// Reads a scene or data file. `size` and `frame` take the place of what the file says.
pub(super) fn load(
    path: &Path,
    format: Format,
    size: Option<(u32, u32)>,
    frame: Option<usize>,
) -> Result<Input, Failure> {
    match format {
        Format::Scene => load_scene(path, size, frame),
        Format::Xyz => {
            let (spheres, notes) = load_data(path, frame.unwrap_or(0), 1.0)?;
            assemble(&SceneFile::default(), &spheres, size, notes, path)
        }
    }
}

fn load_scene(
    path: &Path,
    size: Option<(u32, u32)>,
    frame: Option<usize>,
) -> Result<Input, Failure> {
    let text = String::from_utf8(read(path)?)
        .map_err(|_| anyhow!("{}: this is no UTF-8 text; a scene file is TOML", path.display()))?;
    let file = SceneFile::parse(&text).with_context(|| path.display().to_string())?;
    let Some(data) = file.data() else {
        if frame.is_some() {
            return Err(Failure::usage(format!(
                "{}: --frame needs a scene with `data`, and this scene has none",
                path.display()
            )));
        }
        return assemble(&file, &[], size, Vec::new(), path);
    };
    let data_path = path.parent().map_or_else(PathBuf::new, Path::to_path_buf).join(&data.file);
    let place = || format!("{}: `data`", path.display());
    if Format::of(&data_path).with_context(place)? == Format::Scene {
        return Err(anyhow!("it names another scene file").context(place()).into());
    }
    let (spheres, notes) = load_data(&data_path, frame.unwrap_or(data.frame), data.radius_scale)?;
    assemble(&file, &spheres, size, notes, path)
}

fn load_data(path: &Path, frame: usize, radius_scale: f64) -> Result<(Vec<Sphere>, Vec<String>)> {
    let bytes = read(path)?;
    let mut atoms = xyz::read(&bytes, frame).with_context(|| path.display().to_string())?;
    for sphere in &mut atoms.spheres {
        sphere.radius *= radius_scale;
    }
    let mut notes = Vec::new();
    if !atoms.unknown_species.is_empty() {
        notes.push(format!(
            "{}: no chemical elements: {}; drawn in pink with radius 2",
            path.display(),
            atoms.unknown_species.join(", ")
        ));
    }
    Ok((atoms.spheres, notes))
}

fn assemble(
    file: &SceneFile,
    data: &[Sphere],
    size: Option<(u32, u32)>,
    notes: Vec<String>,
    path: &Path,
) -> Result<Input, Failure> {
    let place = || path.display().to_string();
    let film = match size {
        Some((width, height)) => Film::new(width, height)
            .map_err(|error| Failure::usage(format!("--size: {error}")))?
            .with_y_axis(file.film.y_axis()),
        None => file.film,
    };
    let scene = file.scene(data).with_context(place)?;
    let camera = file.camera(&film, &scene).with_context(place)?;
    Ok(Input { scene, camera, film, settings: file.settings, notes })
}

fn read(path: &Path) -> Result<Vec<u8>> {
    if path.is_dir() {
        bail!("{}: this is a folder; name a file", path.display());
    }
    std::fs::read(path).with_context(|| format!("{}: cannot be read", path.display()))
}
