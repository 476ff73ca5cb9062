//! Data: what a file of spheres is, and which flags concern it.

use std::path::Path;

use anyhow::{Context, Error, Result};
use clap::ValueEnum;

use super::failure::Failure;
use super::input::extension;
use super::memory;
use pinhole::color::LinearRgb;
use pinhole::io::npy::SpheresError;
use pinhole::io::npz::NpzError;
use pinhole::io::{npy, npz, raw, xyz};
use pinhole::points::Points;
use pinhole::scene::{Scene, SceneError};
use pinhole::scene_file;
use pinhole::sphere::Sphere;

/// The formats of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum DataFormat {
    /// Atoms in text
    Xyz,
    /// Atoms in text, with named columns
    Extxyz,
    /// A NumPy array of shape (n, 4) or, with a radius, (n, 3)
    Npy,
    /// An archive with such an array
    Npz,
    /// Nothing but numbers: x, y, z, radius in little-endian f32
    #[value(name = "raw-f32x4")]
    RawF32x4,
}

/// What flags and a scene file say of the data.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DataOptions {
    /// Which frame of a trajectory.
    pub(super) frame: Option<usize>,
    /// The radius of all.
    pub(super) radius: Option<f64>,
    /// The colour of all.
    pub(super) color: Option<LinearRgb>,
}

/// Spheres that were read.
pub(super) enum Data {
    /// With their colours.
    Spheres(Vec<Sphere>),
    /// Atoms, with their colours.
    Atoms(xyz::Frame),
    /// Without.
    Points(Points),
}

impl DataFormat {
    /// The format that an extension stands for.
    pub(super) fn of(path: &Path) -> Option<Self> {
        match extension(path)?.as_str() {
            "xyz" => Some(Self::Xyz),
            "extxyz" => Some(Self::Extxyz),
            "npy" => Some(Self::Npy),
            "npz" => Some(Self::Npz),
            _ => None,
        }
    }

    fn is_xyz(self) -> bool {
        matches!(self, Self::Xyz | Self::Extxyz)
    }
}

impl DataOptions {
    /// Refuses what does not concern the format. The keys of a scene file and the flags have the same
    /// names, but for `prefix`.
    pub(super) fn check(&self, format: DataFormat, prefix: &str) -> Result<(), String> {
        let is_array = matches!(format, DataFormat::Npy | DataFormat::Npz);
        if self.frame.is_some() && !format.is_xyz() {
            return Err(format!("{prefix}frame concerns trajectories (.xyz, .extxyz); drop it"));
        }
        if self.radius.is_some() && !is_array {
            return Err(format!(
                "{prefix}radius concerns arrays of shape (n, 3) (.npy, .npz); drop it"
            ));
        }
        if self.color.is_some() && format.is_xyz() {
            return Err(format!(
                "{prefix}color concerns data without colors; atoms have those of their elements"
            ));
        }
        Ok(())
    }

    /// The flags where they are given, else what the scene file says.
    pub(super) fn or(self, file: Self) -> Self {
        Self {
            frame: self.frame.or(file.frame),
            radius: self.radius.or(file.radius),
            color: self.color.or(file.color),
        }
    }
}

impl Data {
    /// Reads the contents of the file `path`; also notes for the user.
    pub(super) fn read(
        bytes: &[u8],
        path: &Path,
        format: DataFormat,
        options: &DataOptions,
    ) -> Result<(Self, Vec<String>)> {
        let place = || path.display().to_string();
        match format {
            DataFormat::Xyz | DataFormat::Extxyz => {
                let atoms =
                    xyz::read(bytes, options.frame.unwrap_or_default()).with_context(place)?;
                let notes = unknown_species(&atoms.unknown_species, path).into_iter().collect();
                return Ok((Self::Atoms(atoms), notes));
            }
            DataFormat::Npy => npy::read_spheres(bytes, options.radius).with_context(place),
            DataFormat::Npz => {
                let size = npz::array_bytes(bytes).with_context(place)?;
                let what = format!("{}: to read an array of {size} bytes takes", path.display());
                memory::check_reading(&what, size).map_err(Error::msg)?;
                npz::read_spheres(bytes, options.radius).with_context(place)
            }
            DataFormat::RawF32x4 => raw::read_spheres(bytes).with_context(place),
        }
        .map(|points| (Self::Points(points), Vec::new()))
    }

    pub(super) fn scale_radii(&mut self, factor: f64) {
        match self {
            Self::Spheres(spheres) | Self::Atoms(xyz::Frame { spheres, .. }) => {
                spheres.iter_mut().for_each(|s| s.radius *= factor);
            }
            Self::Points(points) => points.scale_radii(factor),
        }
    }

    /// Gives spheres the look that a scene file says they have; also notes for the user.
    pub(super) fn dress(&mut self, says: &scene_file::Data) -> Result<Vec<String>, String> {
        match self {
            Self::Atoms(atoms) => {
                let absent = says.dress(&mut atoms.spheres, &atoms.species, &atoms.species_indices);
                let note =
                    |name| format!("`[elements.{name}]`: there is no such atom in {}", says.file);
                Ok(absent.into_iter().map(note).collect())
            }
            _ if !says.elements.is_empty() => {
                Err("`elements` concerns atoms (.xyz, .extxyz); drop it".to_owned())
            }
            Self::Spheres(spheres) => {
                says.dress(spheres, &[], &[]);
                Ok(Vec::new())
            }
            // The scene gives it to all.
            Self::Points(_) => Ok(Vec::new()),
        }
    }

    /// The scene of this data alone.
    pub(super) fn scene(self, color: LinearRgb) -> Result<Scene, SceneError> {
        match self {
            Self::Spheres(spheres) | Self::Atoms(xyz::Frame { spheres, .. }) => {
                Scene::new(&spheres)
            }
            Self::Points(points) => points.scene(color),
        }
    }
}

/// An array with a radius too many or too few is mended with a flag, so it is wrong usage.
pub(super) fn as_usage(error: anyhow::Error) -> Failure {
    let of_array = error.downcast_ref::<SpheresError>().or_else(|| {
        error.downcast_ref::<NpzError>().and_then(|error| match error {
            NpzError::Spheres { error, .. } => Some(error),
            _ => None,
        })
    });
    match of_array {
        Some(SpheresError::NoRadius { .. }) => {
            Failure::usage(format!("{error:#} (add --radius R)"))
        }
        Some(SpheresError::TwoRadii { .. }) => Failure::usage(format!("{error:#}; drop it")),
        _ => Failure::Job(error),
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
