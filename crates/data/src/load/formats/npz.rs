//! Reads spheres from an `.npz` file: a zip archive of NumPy arrays, as `savez` and `savez_compressed` write it.
//!
//! One array has the positions, or `x`, `y` and `z` do. Other arrays with a row for each sphere are columns. Their
//! names have the same meaning as in all tables: `radius`, `colors`, `opacity` and so on.

use std::borrow::Cow;
use std::fmt::Display;
use std::io::Read;

use flate2::bufread::DeflateDecoder;
use npyz::npz::array_name_from_file_name;
use rawzip::{CompressionMethod, ZipArchive, ZipSliceArchive, ZipVerification};

use super::npy::{Array, Spheres};
use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, Place, first_names};
use crate::load::format::Options;
use crate::load::table::{Columns, Table, TableColumn};
use pinhole::internals::text::{one_line, shortened};

/// Names that mark the array of positions among several. The first name in this list that occurs counts.
const NAMES: [&str; 9] =
    ["spheres", "positions", "position", "pos", "points", "coordinates", "coords", "centers", "xyz"];

/// The most arrays that are read.
const MAX_ARRAYS: usize = 1024;

/// The most bytes that one byte of deflate can expand to (zlib's technical details: 258 bytes from two bits).
const MAX_RATIO: u64 = 1032;

/// Reads spheres from the array called `spheres` or `positions`, or from the only one, as [`super::npy::read`] does; or
/// from `x`, `y` and `z`. Other arrays with a row for each sphere are radii, colours, opacities or columns, by their
/// names. A note lists unused arrays.
///
/// # Errors
/// Returns an error if no array has positions, an array is damaged, or the arrays do not make spheres.
pub fn read(bytes: &[u8], radius: Option<f64>) -> Result<Dataset, LoadError> {
    let archive = ZipArchive::from_slice(bytes).map_err(|error| broken(&error))?;
    let entries = entries(&archive, bytes.len() as u64)?;
    let main = main_array(&entries)?;
    let options = radius.map_or_else(Options::default, |r| Options::default().with_radius(r));
    let first = &entries[main.index];
    let data = first.contents(&archive)?;
    let array = Array::open(&data).map_err(of_array(&first.name))?;
    let count = array.rows();
    let (mut spheres, mut columns, mut notes) = (None, Vec::new(), Vec::new());
    if main.is_alone {
        match array.spheres(radius).map_err(of_array(&first.name))? {
            Spheres::Ready { spheres: ready, have_radii } => spheres = Some((ready, have_radii)),
            Spheres::Columns { columns: found, notes: said } => (columns, notes) = (found, said),
        }
    }
    drop(data);
    let is_other = |index: usize| !(main.is_alone && index == main.index);
    let others = entries.iter().enumerate().filter(|(index, _)| is_other(*index)).map(|(_, entry)| entry);
    let (found, unused) = columns_of(&archive, others, count, "spheres")?;
    columns.extend(found);
    let table = Table { columns };
    let loaded = match spheres {
        Some((spheres, have_radii)) => table.dress(spheres, have_radii, &options),
        None => table.into_loaded(&options),
    };
    let mut loaded = loaded.map_err(of_array(&first.name))?;
    loaded.notes.append(&mut notes);
    loaded.notes.extend(unused);
    Ok(loaded)
}

/// Reads the arrays of an archive of cylinders or cones, which have as many rows as the array `start`. A note lists others.
///
/// # Errors
/// Returns an error if there is no such array, or an array is damaged.
pub(super) fn columns(bytes: &[u8]) -> Result<Columns, LoadError> {
    let archive = ZipArchive::from_slice(bytes).map_err(|error| broken(&error))?;
    let entries = entries(&archive, bytes.len() as u64)?;
    let of_starts = |entry: &&Entry| ["start", "start_x", "start.x"].contains(&entry.name.to_lowercase().as_str());
    let Some(first) = entries.iter().find(of_starts) else {
        return Err(LoadError::new(format!(
            "the archive has no array `start`, but {}; name the arrays of both ends `start` and `end`",
            listed(&entries)
        )));
    };
    let count = Array::open(&first.contents(&archive)?).map_err(of_array(&first.name))?.rows();
    let (columns, unused) = columns_of(&archive, entries.iter(), count, "rows of `start`")?;
    Ok((columns, unused.into_iter().collect()))
}

/// Returns the columns of arrays with this many rows, and a note that lists other arrays.
fn columns_of<'a>(
    archive: &ZipSliceArchive<&[u8]>,
    entries: impl Iterator<Item = &'a Entry>,
    count: usize,
    of: &str,
) -> Result<(Vec<TableColumn>, Option<String>), LoadError> {
    let (mut columns, mut unused) = (Vec::new(), Vec::new());
    for entry in entries {
        let data = entry.contents(archive)?;
        let array = Array::open(&data).map_err(of_array(&entry.name))?;
        let name = shortened(&entry.name);
        if array.rows() != count || !array.has_rows() {
            unused.push(format!("`{name}` has the shape {}", array.shape()));
            continue;
        }
        match array.columns(&name) {
            Ok(found) => columns.extend(found),
            Err(reason) => unused.push(format!("`{name}` {reason}")),
        }
    }
    let note = (!unused.is_empty()).then(|| {
        let unused = first_names(unused.into_iter());
        format!(
            "these arrays are not used, because they do not have a row for each of the {count} {of}, or are not \
             numbers: {unused}"
        )
    });
    Ok((columns, note))
}

/// Returns the uncompressed size in bytes of the arrays, as the archive declares it.
pub(crate) fn array_bytes(bytes: &[u8]) -> Result<u64, LoadError> {
    let archive = ZipArchive::from_slice(bytes).map_err(|error| broken(&error))?;
    let entries = entries(&archive, bytes.len() as u64)?;
    let sizes = entries.iter().map(|entry| entry.wayfinder.uncompressed_size_hint());
    Ok(sizes.fold(0, u64::saturating_add))
}

/// Returns the `.npy` file of the array with this name.
pub(super) fn array_of(bytes: &[u8], wanted: &'static str) -> Result<Vec<u8>, LoadError> {
    let archive = ZipArchive::from_slice(bytes).map_err(|error| broken(&error))?;
    let entries = entries(&archive, bytes.len() as u64)?;
    match entries.iter().find(|entry| entry.name == wanted) {
        Some(entry) => Ok(entry.contents(&archive)?.into_owned()),
        None => Err(LoadError::new(format!(
            "the archive has no array `{wanted}`, but {}; save it with numpy.savez",
            listed(&entries)
        ))),
    }
}

/// An array in its archive: its place and compression.
struct Entry {
    name: String,
    wayfinder: rawzip::ZipArchiveEntryWayfinder,
    method: CompressionMethod,
}

impl Entry {
    /// The bytes of the array, which are borrowed from the archive if they are not compressed.
    fn contents<'a>(&self, archive: &'a ZipSliceArchive<&[u8]>) -> Result<Cow<'a, [u8]>, LoadError> {
        let wrong = |error: &dyn Display| of_array(&self.name)(LoadError::new(one_line(&error.to_string())));
        let entry = archive.get_entry(self.wayfinder).map_err(|error| wrong(&error))?;
        let data = entry.data();
        match self.method {
            CompressionMethod::STORE => {
                let found = ZipVerification { crc: rawzip::crc32(data), uncompressed_size: data.len() as u64 };
                entry.claim_verifier().valid(found).map_err(|error| wrong(&error))?;
                Ok(data.into())
            }
            CompressionMethod::DEFLATE => {
                let size = self.wayfinder.uncompressed_size_hint();
                if size > (data.len() as u64).saturating_mul(MAX_RATIO) {
                    let count = data.len();
                    return Err(wrong(&format!("{count} compressed bytes cannot expand to {size} bytes")));
                }
                let mut inflated = Vec::new();
                usize::try_from(size)
                    .ok()
                    .and_then(|size| inflated.try_reserve_exact(size).ok())
                    .ok_or_else(|| wrong(&format!("there is not enough memory for its {size} bytes")))?;
                let reader = entry.verifying_reader(DeflateDecoder::new(data));
                // One more byte is asked for, so that the reader reaches the end of the data and verifies the checksum.
                reader.take(size.saturating_add(1)).read_to_end(&mut inflated).map_err(|error| wrong(&error))?;
                if inflated.len() as u64 == size {
                    Ok(inflated.into())
                } else {
                    Err(wrong(&format!("it is longer than the {size} bytes that the archive declares")))
                }
            }
            method => {
                let method = format!("{method:?}");
                let method = method.rsplit("::").next().unwrap_or_default();
                Err(wrong(&format!(
                    "it is compressed with {method}, but only stored and deflated arrays can be read; use \
                 numpy.savez_compressed"
                )))
            }
        }
    }
}

/// Lists the arrays of an archive. The later of two arrays with the same name counts, as in NumPy.
fn entries(archive: &ZipSliceArchive<&[u8]>, size: u64) -> Result<Vec<Entry>, LoadError> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut compressed = 0_u64;
    for entry in archive.entries() {
        let entry = entry.map_err(|error| broken(&error))?;
        let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
        let Some(name) = array_name_from_file_name(&name) else { continue };
        let (name, wayfinder) = (name.to_owned(), entry.wayfinder());
        compressed = compressed.saturating_add(wayfinder.compressed_size_hint());
        // Overlapping arrays could take much more memory than the file.
        if entries.len() == MAX_ARRAYS || compressed > size {
            let message = format!("it has more than {MAX_ARRAYS} arrays, or arrays that lie over each other");
            return Err(broken(&message));
        }
        entries.retain(|known| known.name != name);
        entries.push(Entry { name, wayfinder, method: entry.compression_method() });
    }
    Ok(entries)
}

/// The array that determines the number of spheres.
struct Main {
    index: usize,
    /// Whether the array has complete positions, as opposed to one coordinate.
    is_alone: bool,
}

fn main_array(entries: &[Entry]) -> Result<Main, LoadError> {
    let named = |wanted: &str| entries.iter().position(|entry| entry.name.eq_ignore_ascii_case(wanted));
    let is_alone = true;
    match (entries.len(), NAMES.into_iter().find_map(named)) {
        (0, _) => Err(LoadError::new("the archive has no array; save the spheres with numpy.savez")),
        (_, Some(index)) => Ok(Main { index, is_alone }),
        (1, None) => Ok(Main { index: 0, is_alone }),
        _ => match ["x", "y", "z"].map(named) {
            [Some(index), Some(_), Some(_)] => Ok(Main { index, is_alone: false }),
            _ => Err(LoadError::new(format!(
                "the archive has the arrays {}; name the one with the centers `positions`, or `spheres` if it has radii as \
                 well",
                listed(entries)
            ))),
        },
    }
}

/// The error of a file that is not a zip archive, or is damaged.
fn broken(error: &impl ToString) -> LoadError {
    LoadError::new(format!("this is not a complete .npz file: {}", one_line(&error.to_string())))
}

/// Puts the name of an array before an error.
pub(super) fn of_array(name: &str) -> impl Fn(LoadError) -> LoadError {
    let name = shortened(name);
    move |error| LoadError { place: Place::Array(name.clone()), message: error.to_string(), ..error }
}

/// Lists the names of arrays on one line, however many there are.
fn listed(entries: &[Entry]) -> String {
    first_names(entries.iter().map(|entry| format!("`{}`", shortened(&entry.name))))
}
