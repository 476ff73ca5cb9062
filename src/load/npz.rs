//! Spheres in an `.npz` file: a zip archive of NumPy arrays, as `savez` and `savez_compressed` write it.

use std::io::Read;

use flate2::bufread::DeflateDecoder;
use npyz::npz::array_name_from_file_name;
use rawzip::{CompressionMethod, ZipArchive, ZipSliceArchive, ZipVerification};

use super::npy::{self, SpheresError};
use crate::scene::sphere_array::SphereArray;
use crate::text::{one_line, shortened};

/// What an array with spheres may be called beside others; the first that is there is taken.
const NAMES: [&str; 2] = ["spheres", "positions"];

/// Deflate makes at most this many bytes of one (zlib's technical details: 258 bytes from two bits).
const MAX_RATIO: u64 = 1032;

/// Why an archive has no list of spheres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NpzError {
    /// Not a zip archive, or a damaged one.
    #[error("this is no whole .npz file: {message}")]
    Archive {
        /// What is wrong with it.
        message: String,
    },
    /// No array at all.
    #[error("there is no array in it")]
    Empty,
    /// Several arrays, and none has one of the names.
    #[error(
        "it has the arrays {}; call the one to read `spheres` or `positions`, or save it alone",
        listed(names)
    )]
    Ambiguous {
        /// Their names.
        names: Vec<String>,
    },
    /// The array cannot be taken out.
    #[error("array `{name}`: {message}")]
    Entry {
        /// Its name.
        name: String,
        /// Why.
        message: String,
    },
    /// The array is no list of spheres.
    #[error("array `{name}`: {error}")]
    Spheres {
        /// Its name.
        name: String,
        /// Why.
        error: SpheresError,
    },
}

/// Reads the only array of an archive, or the one called `spheres` or `positions`, as
/// [`npy::read_spheres`] does.
///
/// # Errors
/// If there is no such array, it is not whole, or it is no list of spheres.
pub fn read_spheres(bytes: &[u8], radius: Option<f64>) -> Result<SphereArray, NpzError> {
    let archive = ZipArchive::from_slice(bytes).map_err(|error| broken(&error))?;
    let (name, entry) = entry_with_spheres(&archive)?;
    let contents = contents(&archive, entry.wayfinder, entry.method);
    let array = contents
        .map_err(|message| NpzError::Entry { name: name.clone(), message: one_line(&message) })?;
    npy::read_spheres(&array, radius).map_err(|error| NpzError::Spheres { name, error })
}

/// How many bytes the array that [`read_spheres`] reads is said to have once it is taken out of the archive.
///
/// # Errors
/// If there is no such array.
pub fn array_bytes(bytes: &[u8]) -> Result<u64, NpzError> {
    let archive = ZipArchive::from_slice(bytes).map_err(|error| broken(&error))?;
    let (_, entry) = entry_with_spheres(&archive)?;
    Ok(entry.wayfinder.uncompressed_size_hint())
}

/// Where an array is in its archive.
struct Entry {
    wayfinder: rawzip::ZipArchiveEntryWayfinder,
    method: CompressionMethod,
}

/// The array to read, and its name.
fn entry_with_spheres(archive: &ZipSliceArchive<&[u8]>) -> Result<(String, Entry), NpzError> {
    let mut entries = Vec::new();
    for entry in archive.entries() {
        let entry = entry.map_err(|error| broken(&error))?;
        let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
        if let Some(name) = array_name_from_file_name(&name) {
            entries.push((name.to_owned(), entry));
        }
    }
    // Of two of one name the later one holds, as for NumPy.
    let named = |wanted: &&str| entries.iter().rposition(|(name, _)| name == wanted);
    let index = match (entries.len(), NAMES.iter().find_map(named)) {
        (0, _) => return Err(NpzError::Empty),
        (_, Some(index)) => index,
        (1, None) => 0,
        _ => {
            let names = entries.into_iter().map(|(name, _)| name).collect();
            return Err(NpzError::Ambiguous { names });
        }
    };
    let (name, entry) = entries.swap_remove(index);
    let entry = Entry { wayfinder: entry.wayfinder(), method: entry.compression_method() };
    Ok((shortened(&one_line(&name)), entry))
}

/// The bytes of an entry: those of the archive if they are stored, else new ones.
fn contents<'a>(
    archive: &'a ZipSliceArchive<&[u8]>,
    wayfinder: rawzip::ZipArchiveEntryWayfinder,
    method: CompressionMethod,
) -> Result<std::borrow::Cow<'a, [u8]>, String> {
    let entry = archive.get_entry(wayfinder).map_err(|error| error.to_string())?;
    let data = entry.data();
    match method {
        CompressionMethod::STORE => {
            let found =
                ZipVerification { crc: rawzip::crc32(data), uncompressed_size: data.len() as u64 };
            entry.claim_verifier().valid(found).map_err(|error| error.to_string())?;
            Ok(data.into())
        }
        CompressionMethod::DEFLATE => {
            let size = wayfinder.uncompressed_size_hint();
            if size > (data.len() as u64).saturating_mul(MAX_RATIO) {
                return Err(format!("{} bytes cannot hold {size} by deflate", data.len()));
            }
            let mut inflated = Vec::new();
            usize::try_from(size)
                .ok()
                .and_then(|size| inflated.try_reserve_exact(size).ok())
                .ok_or_else(|| format!("there is no memory for its {size} bytes"))?;
            let reader = entry.verifying_reader(DeflateDecoder::new(data));
            // One more, so that the reader comes to the end and verifies.
            reader
                .take(size.saturating_add(1))
                .read_to_end(&mut inflated)
                .map_err(|error| error.to_string())?;
            if inflated.len() as u64 == size {
                Ok(inflated.into())
            } else {
                Err(format!("it is longer than the {size} bytes that the archive says"))
            }
        }
        method => {
            let method = format!("{method:?}");
            let method = method.rsplit("::").next().unwrap_or_default();
            Err(format!("it is compressed by {method}; stored and deflated arrays can be read"))
        }
    }
}

fn broken(error: &rawzip::Error) -> NpzError {
    NpzError::Archive { message: one_line(&error.to_string()) }
}

/// Names that fit on a line, however many there are.
fn listed(names: &[String]) -> String {
    const NAMED: usize = 5;
    let named = names.iter().take(NAMED).map(|name| format!("`{}`", shortened(&one_line(name))));
    let more = match names.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    named.collect::<Vec<_>>().join(", ") + &more
}
