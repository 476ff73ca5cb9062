//! Scenes for `pinhole bench`: standard scenes and files.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::Context;

use super::args::BenchArgs;
use super::failure::Failure;
use super::input::{Input, Source};
use super::memory;
use super::progress;
use super::speak::tell;
use pinhole::camera::Camera;
use pinhole::camera::film::Film;
use pinhole::generate::{BYTES_PER_SPHERE, Standard};
use pinhole::image::color::LinearRgb;
use pinhole::internals::text::one_line;
use pinhole::scene::Scene;
use pinhole::scene_file::DEFAULT_COLOR;

/// The scenes to measure by default; any machine has enough memory for them.
pub(super) const DEFAULT: [Standard; 3] = [Standard::R1M, Standard::L1M, Standard::C200k];

/// A scene as it was named on the command line.
pub(super) enum BenchSource {
    Standard(Standard),
    File(PathBuf, Box<Source>),
}

/// A scene that was generated or read.
pub(super) struct BenchScene {
    pub(super) name: String,
    pub(super) scene: Scene,
    pub(super) camera: Box<dyn Camera>,
    pub(super) film: Film,
    pub(super) load: Duration,
}

impl BenchSource {
    /// Finds the standard scene of this name, or takes the name as that of a file.
    pub(super) fn new(
        named: &Path,
        args: &BenchArgs,
        size: Option<(u32, u32)>,
    ) -> Result<Self, Failure> {
        let standard = Standard::ALL.iter().find(|standard| named == Path::new(standard.name()));
        match standard {
            Some(standard) => Ok(Self::Standard(*standard)),
            None if named.extension().is_none() => {
                let names: Vec<_> = Standard::ALL.iter().map(|standard| standard.name()).collect();
                Err(Failure::usage(format!(
                    "{}: this is neither a standard scene nor a file with an extension; name one of {} or a file",
                    named.display(),
                    names.join(", ")
                )))
            }
            None => {
                Ok(Self::File(named.to_path_buf(), Box::new(Source::of_bench(named, args, size)?)))
            }
        }
    }

    /// Generates or reads the scene. Prints how much memory a generated scene needs, and refuses it if that is not
    /// free.
    pub(super) fn load(&self, size: Option<(u32, u32)>) -> Result<BenchScene, Failure> {
        match self {
            Self::Standard(standard) => made(*standard, size),
            Self::File(path, source) => {
                let started = Instant::now();
                let input = source.load()?;
                let load = started.elapsed();
                for note in &input.notes {
                    tell(format_args!("note: {note}"));
                }
                let name = one_line(&path.display().to_string());
                let Input { scene, camera, film, .. } = input;
                let scene = Arc::unwrap_or_clone(scene);
                Ok(BenchScene { name, scene, camera, film, load })
            }
        }
    }
}

fn made(standard: Standard, size: Option<(u32, u32)>) -> Result<BenchScene, Failure> {
    let (name, count) = (standard.name(), standard.count());
    let film = match size {
        Some((width, height)) => film(width, height)?,
        None => standard.film().context(name)?,
    };
    let bytes = count * BYTES_PER_SPHERE;
    memory::check_bytes(&format!("{name}: {count} spheres need"), bytes, "a smaller scene")
        .map_err(anyhow::Error::msg)?;
    tell(format_args!("{name}: {count} spheres, {} of memory", memory::readable(bytes)));
    progress::stage(format!("generating {name}"));
    let started = Instant::now();
    let spheres = standard.spheres().context(name)?;
    let scene = Scene::from_f32(spheres, LinearRgb::from_srgb8(DEFAULT_COLOR)).context(name)?;
    let load = started.elapsed();
    let camera = Box::new(standard.camera().context(name)?);
    Ok(BenchScene { name: name.to_owned(), scene, camera, film, load })
}

fn film(width: u32, height: u32) -> Result<Film, Failure> {
    Film::new(width, height).map_err(|error| Failure::usage(format!("--size: {error}")))
}
