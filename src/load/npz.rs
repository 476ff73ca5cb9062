//! Reads spheres from an `.npz` file: a zip archive of NumPy arrays, as `savez` and `savez_compressed` write it.

use std::io::Read;

use flate2::bufread::DeflateDecoder;
use npyz::npz::array_name_from_file_name;
use rawzip::{CompressionMethod, ZipArchive, ZipSliceArchive, ZipVerification};

use super::npy::{self, SpheresError};
use crate::scene::sphere_array::SphereArray;
use crate::text::{one_line, shortened};

/// Names that mark the array to read among several; the first name that occurs counts.
const NAMES: [&str; 2] = ["spheres", "positions"];

/// The most bytes that one byte of deflate can expand to (zlib's technical details: 258 bytes from two bits).
const MAX_RATIO: u64 = 1032;

/// An error of reading spheres from an `.npz` archive.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NpzError {
    /// The file is not a zip archive, or is damaged.
    #[error("this is not a complete .npz file: {message}")]
    Archive {
        /// What is wrong with the archive.
        message: String,
    },
    /// The archive has no array.
    #[error("the archive has no array; save the spheres with numpy.savez")]
    Empty,
    /// The archive has several arrays, and none is called `spheres` or `positions`.
    #[error(
        "the archive has the arrays {}; name the one to read `spheres` or `positions`, or save it alone",
        listed(names)
    )]
    Ambiguous {
        /// Names of the arrays.
        names: Vec<String>,
    },
    /// The array cannot be extracted.
    #[error("array `{name}`: {message}")]
    Entry {
        /// Name of the array.
        name: String,
        /// Why the array cannot be extracted.
        message: String,
    },
    /// The array is not a list of spheres.
    #[error("array `{name}`: {error}")]
    Spheres {
        /// Name of the array.
        name: String,
        /// What is wrong with the array.
        error: SpheresError,
    },
}

/// Reads spheres from the only array of an archive, or else from the one called `spheres` or `positions`, as
/// [`npy::read_spheres`] does.
///
/// # Errors
/// If there is no such array, it is damaged, or it is not a list of spheres.
pub fn read_spheres(bytes: &[u8], radius: Option<f64>) -> Result<SphereArray, NpzError> {
    let archive = ZipArchive::from_slice(bytes).map_err(|error| broken(&error))?;
    let (name, entry) = entry_with_spheres(&archive)?;
    let contents = contents(&archive, entry.wayfinder, entry.method);
    let array = contents
        .map_err(|message| NpzError::Entry { name: name.clone(), message: one_line(&message) })?;
    npy::read_spheres(&array, radius).map_err(|error| NpzError::Spheres { name, error })
}

/// Returns the uncompressed size in bytes of the array that [`read_spheres`] reads, as the archive declares it.
///
/// # Errors
/// If there is no such array.
pub fn array_bytes(bytes: &[u8]) -> Result<u64, NpzError> {
    let archive = ZipArchive::from_slice(bytes).map_err(|error| broken(&error))?;
    let (_, entry) = entry_with_spheres(&archive)?;
    Ok(entry.wayfinder.uncompressed_size_hint())
}

/// The position of an array in its archive, and how it is compressed.
struct Entry {
    wayfinder: rawzip::ZipArchiveEntryWayfinder,
    method: CompressionMethod,
}

/// Finds the array to read, and its name.
fn entry_with_spheres(archive: &ZipSliceArchive<&[u8]>) -> Result<(String, Entry), NpzError> {
    let mut entries = Vec::new();
    for entry in archive.entries() {
        let entry = entry.map_err(|error| broken(&error))?;
        let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
        if let Some(name) = array_name_from_file_name(&name) {
            entries.push((name.to_owned(), entry));
        }
    }
    // If two arrays have the same name, the later one counts, as in NumPy.
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

/// Returns the bytes of an entry, which are borrowed from the archive if they are not compressed.
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
                return Err(format!(
                    "{} compressed bytes cannot expand to {size} bytes",
                    data.len()
                ));
            }
            let mut inflated = Vec::new();
            usize::try_from(size)
                .ok()
                .and_then(|size| inflated.try_reserve_exact(size).ok())
                .ok_or_else(|| format!("there is not enough memory for its {size} bytes"))?;
            let reader = entry.verifying_reader(DeflateDecoder::new(data));
            // One byte more, so that the reader reaches the end of the data and verifies the checksum.
            reader
                .take(size.saturating_add(1))
                .read_to_end(&mut inflated)
                .map_err(|error| error.to_string())?;
            if inflated.len() as u64 == size {
                Ok(inflated.into())
            } else {
                Err(format!("it is longer than the {size} bytes that the archive declares"))
            }
        }
        method => {
            let method = format!("{method:?}");
            let method = method.rsplit("::").next().unwrap_or_default();
            Err(format!(
                "it is compressed with {method}, but only stored and deflated arrays can be read; use \
                 numpy.savez_compressed"
            ))
        }
    }
}

fn broken(error: &rawzip::Error) -> NpzError {
    NpzError::Archive { message: one_line(&error.to_string()) }
}

/// Lists names on one line, however many there are.
fn listed(names: &[String]) -> String {
    const NAMED: usize = 5;
    let named = names.iter().take(NAMED).map(|name| format!("`{}`", shortened(&one_line(name))));
    let more = match names.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    named.collect::<Vec<_>>().join(", ") + &more
}
