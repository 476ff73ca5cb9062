//! Reads spheres repeatedly from the file that is sorted, and writes bricks.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use data_encoding::HEXLOWER;
use sha2::{Digest, Sha256};

use crate::bricks::file::{BEFORE, Brick, COLOR, Header, ID, PLACE, SPHERE, START, Section, bits};
use crate::input::read_file;
use pinhole::LinearRgb;
use pinhole::geometry::bounds::Bounds;
use pinhole::glam::{DVec3, Vec3};
use pinhole::scene::sphere::Sphere;
use pinhole::scene::{Scene, SceneError, SceneExtent};
use pinhole_data::load::Format;

/// Number of spheres that are read at a time.
const PIECE: usize = 1 << 16;

/// The spheres of a data file.
pub(crate) enum Stream {
    /// An array that is read again for each pass.
    Array(PathBuf, Array),
    /// A file of another format, which is in memory.
    Scene(Box<Scene>),
}

impl Stream {
    pub(crate) fn count(&self) -> u64 {
        match self {
            Self::Array(_, array) => array.count,
            Self::Scene(scene) => scene.len() as u64,
        }
    }

    /// Checks all spheres, and returns their box; `None` if there are no spheres.
    pub(crate) fn bounds(&self) -> Result<Option<Bounds>> {
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

    /// Calls `each` with every sphere and its id. Spheres are in the frame of the whole.
    pub(crate) fn for_each(
        &self,
        whole: &SceneExtent,
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
            Self::Scene(scene) => (0..).zip(scene.spheres()).try_for_each(|(id, sphere)| each(id, *sphere)),
        }
    }
}

/// Calls `each` with every row of an array until it returns false.
fn rows(path: &Path, array: &Array, each: &mut dyn FnMut([f64; 4]) -> Result<bool>) -> Result<()> {
    let cannot = || format!("{}: cannot be read", path.display());
    let mut file = read_file::open(path)?;
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

/// An array of spheres that is read in pieces: an `.npy` file of rows of three or four little-endian f32 or f64, or raw
/// f32. Other files, and all faulty ones, are left to the readers of the library, which describe the fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Array {
    count: u64,
    /// Offset of the first byte.
    offset: u64,
    /// The number of columns: 3 without radii, 4 with them.
    columns: usize,
    is_wide: bool,
    /// The radius of all spheres if the array has none.
    radius: f64,
}

/// The first bytes of an `.npy` file.
const MAGIC: &[u8] = b"\x93NUMPY";

impl Array {
    /// Returns the array in a file; `None` if it must be read in another way.
    pub(crate) fn of(path: &Path, format: &Format, radius: Option<f64>) -> Option<Self> {
        let mut file = read_file::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        let array = match format.name {
            "raw-f32x4" => Self { count: length / 16, offset: 0, columns: 4, is_wide: false, radius: 0.0 },
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
        (3..=4).contains(&columns).then_some(Self { count, offset: before + length, columns, is_wide, radius })
    }

    fn row(&self) -> usize {
        self.columns * if self.is_wide { 8 } else { 4 }
    }

    fn begin(&self, file: &mut File) -> std::io::Result<()> {
        file.seek(SeekFrom::Start(self.offset)).map(drop)
    }

    /// Returns the sphere of a row, as the readers of the library make it.
    fn sphere(&self, row: &[u8]) -> [f64; 4] {
        let mut sphere = [0.0, 0.0, 0.0, self.radius];
        if self.is_wide {
            let numbers = row.as_chunks::<8>().0.iter().map(|number| f64::from_le_bytes(*number));
            sphere.iter_mut().zip(numbers).for_each(|(to, number)| *to = number);
        } else {
            let numbers = row.as_chunks::<4>().0.iter().map(|number| f32::from_le_bytes(*number));
            sphere.iter_mut().zip(numbers).for_each(|(to, number)| *to = number.into());
            // The radius for an array of f32 is rounded to f32 as well.
            if self.columns == 3 {
                sphere[3] = f64::from(self.radius as f32);
            }
        }
        sphere
    }
}

/// Total number of bytes of all buffers.
const BUFFERS: usize = 64 << 20;

/// The parts of a brick: spheres, ids and colours.
const PARTS: usize = 3;

/// Bytes to be written at a place, and the digest of all bytes before them.
struct Buffer {
    place: u64,
    bytes: Vec<u8>,
    digest: Sha256,
}

/// A brick that is being written.
struct Open {
    count: u64,
    added: u64,
    offset: u64,
    min: Vec3,
    max: Vec3,
    parts: [Buffer; PARTS],
}

/// The bricks of a file that is being written.
pub(crate) struct Writer<'a, F: Write + Seek> {
    file: &'a mut F,
    bricks: Vec<Open>,
    /// Number of bytes at which a buffer is written.
    capacity: usize,
    has_colors: bool,
    end: u64,
}

impl<'a, F: Write + Seek> Writer<'a, F> {
    /// Creates bricks with these numbers of spheres, which must not be zero, with or without colours.
    pub(crate) fn new(file: &'a mut F, counts: &[u64], has_colors: bool) -> Self {
        let mut end = BEFORE;
        let color = if has_colors { COLOR } else { 0 };
        let open = |count: &u64| {
            let offset = end;
            let places = [offset, offset + SPHERE * count, offset + (SPHERE + ID) * count];
            end += (SPHERE + ID + color) * count;
            let parts = places.map(|place| Buffer { place, bytes: Vec::new(), digest: Sha256::new() });
            Open { count: *count, added: 0, offset, min: Vec3::MAX, max: Vec3::MIN, parts }
        };
        let bricks: Vec<Open> = counts.iter().map(open).collect();
        let capacity = (BUFFERS / (PARTS * bricks.len().max(1))).clamp(1 << 10, 1 << 18);
        Self { file, bricks, capacity, has_colors, end }
    }

    /// Adds a sphere to a brick. The ids of a brick must ascend.
    pub(crate) fn add(&mut self, brick: usize, id: u32, sphere: [f32; 4], color: Option<[u8; 4]>) -> io::Result<()> {
        let Self { file, bricks, capacity, .. } = self;
        let brick = &mut bricks[brick];
        brick.added += 1;
        if brick.added > brick.count {
            return Err(changed());
        }
        let [x, y, z, radius] = sphere;
        let center = Vec3::new(x, y, z);
        brick.min = brick.min.min(center - radius);
        brick.max = brick.max.max(center + radius);
        let [spheres, ids, colors] = &mut brick.parts;
        sphere.iter().for_each(|x| spheres.bytes.extend(x.to_le_bytes()));
        ids.bytes.extend(id.to_le_bytes());
        colors.bytes.extend(color.into_iter().flatten());
        [spheres, ids, colors].into_iter().try_for_each(|part| part.write(*file, *capacity))
    }

    /// Writes the remaining bytes, and returns the bricks and where they end.
    pub(crate) fn finish(mut self) -> io::Result<(Vec<Brick>, u64)> {
        if self.bricks.iter().any(|brick| brick.added < brick.count) {
            return Err(changed());
        }
        let file = &mut *self.file;
        for part in self.bricks.iter_mut().flat_map(|brick| &mut brick.parts) {
            part.write(file, 0)?;
        }
        let brick = |open: Open| {
            let Open { count, offset, min, max, parts, .. } = open;
            let parts = parts.map(|part| part.digest.finalize());
            let used = if self.has_colors { PARTS } else { PARTS - 1 };
            let digest = Sha256::digest(parts[..used].concat());
            let section = Section { count, offset, sha256: HEXLOWER.encode(&digest) };
            Brick { section, min: bits(min), max: bits(max) }
        };
        Ok((self.bricks.into_iter().map(brick).collect(), self.end))
    }
}

fn changed() -> io::Error {
    io::Error::other("the data changed while it was read; sort it again")
}

impl Buffer {
    /// Writes the bytes if there are at least `least`.
    fn write(&mut self, file: &mut (impl Write + Seek), least: usize) -> io::Result<()> {
        if self.bytes.len() >= least.max(1) {
            file.seek(SeekFrom::Start(self.place))?;
            file.write_all(&self.bytes)?;
            self.digest.update(&self.bytes);
            self.place += self.bytes.len() as u64;
            self.bytes.clear();
        }
        Ok(())
    }
}

/// Writes the outer spheres after the bricks.
pub(crate) fn outer(file: &mut (impl Write + Seek), place: u64, spheres: &[[f32; 4]]) -> io::Result<Section> {
    let bytes: Vec<u8> = spheres.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    file.seek(SeekFrom::Start(place))?;
    file.write_all(&bytes)?;
    Ok(Section {
        count: spheres.len() as u64,
        offset: place,
        sha256: HEXLOWER.encode(&Sha256::digest(Sha256::digest(&bytes))),
    })
}

/// Writes the header at the end, and then the start of the file, which has the header's place.
pub(crate) fn header(file: &mut (impl Write + Seek), place: u64, header: &Header) -> io::Result<()> {
    let text = serde_json::to_vec(header)?;
    let mut start = [0; BEFORE as usize];
    start[..START.len()].copy_from_slice(START);
    start[PLACE..PLACE + 8].copy_from_slice(&place.to_le_bytes());
    start[PLACE + 8..PLACE + 16].copy_from_slice(&(text.len() as u64).to_le_bytes());
    let digest = Sha256::new().chain_update(start).chain_update(&text).finalize();
    file.seek(SeekFrom::Start(place))?;
    file.write_all(&text)?;
    file.write_all(&digest)?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(&start)
}

/// A section of the file that has not been written yet.
pub(crate) fn none() -> Section {
    Section { count: 0, offset: 0, sha256: String::new() }
}
