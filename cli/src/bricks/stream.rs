//! The spheres of a data file in input order, as often as they are needed.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use pinhole::LinearRgb;
use pinhole::geometry::bounds::Bounds;
use pinhole::glam::DVec3;
use pinhole::load::Format;
use pinhole::scene::sphere::Sphere;
use pinhole::scene::{Scene, SceneError, Whole};

/// Spheres of a piece.
const PIECE: usize = 1 << 16;

/// The spheres of a data file.
pub(super) enum Stream {
    /// An array that is read anew each time.
    Array(PathBuf, Array),
    /// A file of another format, which is in memory.
    Scene(Box<Scene>),
}

impl Stream {
    pub(super) fn count(&self) -> u64 {
        match self {
            Self::Array(_, array) => array.count,
            Self::Scene(scene) => scene.len() as u64,
        }
    }

    /// Checks all spheres, and returns their box; `None` without spheres.
    pub(super) fn bounds(&self) -> Result<Option<Bounds>> {
        let Self::Array(path, array) = self else {
            let Self::Scene(scene) = self else { return Ok(None) };
            return Ok(scene.bounds());
        };
        let mut bounds: Option<Bounds> = None;
        let (mut index, mut wrong) = (0, None);
        rows(path, array, &mut |sphere @ [x, y, z, radius]| {
            let checked = Sphere::new([x, y, z], radius, LinearRgb::WHITE).check();
            if let (Err(error), None) = (checked, &wrong) {
                wrong = Some(SceneError::Sphere { index, error });
            }
            let of_sphere = Bounds::of_sphere(DVec3::new(x, y, z), sphere[3]);
            bounds = Some(bounds.map_or(of_sphere, |bounds| bounds.union(of_sphere)));
            index += 1;
            Ok(wrong.is_none())
        })?;
        match wrong {
            Some(error) => Err(anyhow!("{}: {error}", path.display())),
            None => Ok(bounds),
        }
    }

    /// Calls `each` with the id of every sphere and the sphere in the frame of the whole.
    pub(super) fn for_each(
        &self,
        whole: &Whole,
        each: &mut dyn FnMut(u32, [f32; 4]) -> Result<()>,
    ) -> Result<()> {
        match self {
            Self::Array(path, array) => {
                let mut id = 0;
                rows(path, array, &mut |sphere| {
                    each(id, whole.in_frame(sphere))?;
                    id += 1;
                    Ok(true)
                })
            }
            Self::Scene(scene) => {
                (0..).zip(scene.spheres()).try_for_each(|(id, sphere)| each(id, *sphere))
            }
        }
    }
}

/// Calls `each` with every row of an array until it returns false.
fn rows(path: &Path, array: &Array, each: &mut dyn FnMut([f64; 4]) -> Result<bool>) -> Result<()> {
    let cannot = || format!("{}: cannot be read", path.display());
    let mut file = File::open(path).with_context(cannot)?;
    array.begin(&mut file).with_context(cannot)?;
    let mut piece = vec![0; PIECE * array.row()];
    let mut left = array.count;
    while left > 0 {
        let count = left.min(PIECE as u64);
        let bytes = &mut piece[..count as usize * array.row()];
        file.read_exact(bytes).with_context(cannot)?;
        for row in bytes.chunks_exact(array.row()) {
            if !each(array.sphere(row))? {
                return Ok(());
            }
        }
        left -= count;
    }
    Ok(())
}

/// An array of spheres that is read piece by piece: an `.npy` file of rows of three or four little-endian f32 or f64, or raw
/// f32. Other files, and all that are not as they should be, are left to the readers of the library, which say what is
/// wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Array {
    count: u64,
    /// The first byte.
    offset: u64,
    /// 3 without radii, and 4.
    columns: usize,
    is_wide: bool,
    /// The radius of all spheres, where the array has none.
    radius: f64,
}

/// The first bytes of an `.npy` file.
const MAGIC: &[u8] = b"\x93NUMPY";

impl Array {
    /// The array in a file; `None` if it must be read otherwise.
    pub(super) fn of(path: &Path, format: &Format, radius: Option<f64>) -> Option<Self> {
        if !path.is_file() {
            return None;
        }
        let mut file = File::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        let array = match format.name {
            "raw-f32x4" => {
                Self { count: length / 16, offset: 0, columns: 4, is_wide: false, radius: 0.0 }
            }
            "npy" => Self::of_npy(&mut file, radius)?,
            _ => return None,
        };
        let bytes = array.count.checked_mul(array.row() as u64)?.checked_add(array.offset)?;
        let has_radius = array.columns == 4;
        (bytes == length && array.count > 0 && has_radius == radius.is_none()).then_some(array)
    }

    fn of_npy(file: &mut File, radius: Option<f64>) -> Option<Self> {
        let mut start = [0; 12];
        file.read_exact(&mut start).ok()?;
        let (length, before) = match (start.starts_with(MAGIC), start[6]) {
            (true, 1) => (u64::from(u16::from_le_bytes([start[8], start[9]])), 10),
            (true, 2 | 3) => {
                let length = [start[8], start[9], start[10], start[11]];
                (u64::from(u32::from_le_bytes(length)), 12)
            }
            _ => return None,
        };
        file.seek(SeekFrom::Start(before)).ok()?;
        let mut text = String::new();
        (length < 4096).then(|| file.take(length).read_to_string(&mut text))?.ok()?;
        let text: String = text.split_whitespace().collect();
        let is_wide = match text.split_once("'descr':'")?.1.get(..3)? {
            "<f4" => false,
            "<f8" => true,
            _ => return None,
        };
        text.contains("'fortran_order':False").then_some(())?;
        let shape = text.split_once("'shape':(")?.1.split_once(')')?.0;
        let (count, columns) = shape.split_once(',')?;
        let (count, columns) = (count.parse().ok()?, columns.trim_end_matches(',').parse().ok()?);
        let radius = radius.unwrap_or(0.0);
        (3..=4).contains(&columns).then_some(Self {
            count,
            offset: before + length,
            columns,
            is_wide,
            radius,
        })
    }

    /// Bytes of a row.
    fn row(&self) -> usize {
        self.columns * if self.is_wide { 8 } else { 4 }
    }

    /// Puts the file to the first row.
    fn begin(&self, file: &mut File) -> std::io::Result<()> {
        file.seek(SeekFrom::Start(self.offset)).map(drop)
    }

    /// The sphere of a row, as the readers of the library make it.
    fn sphere(&self, row: &[u8]) -> [f64; 4] {
        let mut sphere = [0.0, 0.0, 0.0, self.radius];
        if self.is_wide {
            let numbers = row.as_chunks::<8>().0.iter().map(|number| f64::from_le_bytes(*number));
            sphere.iter_mut().zip(numbers).for_each(|(to, number)| *to = number);
        } else {
            let numbers = row.as_chunks::<4>().0.iter().map(|number| f32::from_le_bytes(*number));
            sphere.iter_mut().zip(numbers).for_each(|(to, number)| *to = number.into());
            // An array of f32 has its radius in f32 as well.
            if self.columns == 3 {
                sphere[3] = f64::from(self.radius as f32);
            }
        }
        sphere
    }
}
