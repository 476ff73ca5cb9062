//! The files of jobs: all access to the file system, except for files that appear whole or not at all, which
//! `cli/src/output/files.rs` writes; and the digests that identify files.

use std::fs;
pub(super) use std::fs::{File, create_dir, remove_dir_all, remove_file};
use std::io::{self, Read, Seek, SeekFrom};
#[cfg(unix)]
use std::os::unix::fs::OpenOptionsExt;
#[cfg(windows)]
use std::os::windows::fs::OpenOptionsExt;
use std::path::Path;
use std::time::SystemTime;

use anyhow::{Result, ensure};
use data_encoding::HEXLOWER;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::input::read_file::read_open;
use pinhole_data::load::open_regular;

/// Returns the names in a folder. Listing them makes network file systems look for new files.
pub(super) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().into_string().ok()).collect()
}

/// Opens a file in the folder of a job. Links are not followed, because the folder may be that of a stranger.
pub(super) fn open(path: &Path) -> io::Result<File> {
    let mut options = File::options();
    options.read(true);
    // A link or a pipe may take the place of the file at any time, so that opening it must do no harm either.
    #[cfg(unix)]
    OpenOptionsExt::custom_flags(&mut options, libc::O_NOFOLLOW | libc::O_NONBLOCK);
    #[cfg(windows)]
    OpenOptionsExt::custom_flags(&mut options, FILE_FLAG_OPEN_REPARSE_POINT);
    let is_regular = |found: fs::Metadata| found.is_file().then_some(()).ok_or_else(|| io::Error::other(LINK));
    is_regular(path.symlink_metadata()?)?;
    let file = options.open(path)?;
    is_regular(file.metadata()?)?;
    Ok(file)
}

/// Reads a file in the folder of a job, without following links.
pub(super) fn read(path: &Path) -> Result<Vec<u8>> {
    read_open(path, open(path)?)
}

/// Refuses the folder of parts if it is a link, or has links or anything else than files.
pub(super) fn check_no_links(parts: &Path) -> Result<()> {
    let is_folder = parts.symlink_metadata().map_or(true, |found| found.is_dir());
    ensure!(is_folder, "{}: {LINK}; remove it", parts.display());
    for entry in fs::read_dir(parts).into_iter().flatten().flatten() {
        // A file that another process has renamed meanwhile has no type.
        let is_file = entry.file_type().map_or(true, |kind| kind.is_file());
        ensure!(is_file, "{}: {LINK}; remove it", entry.path().display());
    }
    Ok(())
}

const LINK: &str = "this is a link or a special file, which the folder of a job must not have";

#[cfg(windows)]
const FILE_FLAG_OPEN_REPARSE_POINT: u32 = 0x0020_0000;

/// The time at which a file was written, by the clock of the file system.
pub(super) fn modified(path: &Path) -> Option<SystemTime> {
    fs::symlink_metadata(path).and_then(|file| file.modified()).ok()
}

/// The digest of files of at most this many bytes includes all bytes.
const SMALL: u64 = 256 << 20;

/// Number of pieces of a larger file that its digest includes, and their length.
const PIECES: u64 = 64;
const PIECE: u64 = 1 << 20;

/// The identity of a file that a job reads.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InputFile {
    /// The path, relative to the folder in which the job was split.
    pub(super) path: String,
    pub(super) bytes: u64,
    /// Digest of all bytes, or of some pieces of a large file, so that a part need not read all of it.
    pub(super) sha256: String,
}

pub(super) fn hex(bytes: &[u8]) -> String {
    HEXLOWER.encode(&Sha256::digest(bytes))
}

pub(super) fn digest(path: &Path) -> io::Result<(u64, String)> {
    let mut file = open_regular(path)?;
    let length = file.metadata()?.len();
    let mut digest = Sha256::new();
    let mut piece = vec![0; PIECE as usize];
    if length <= SMALL {
        loop {
            match file.read(&mut piece)? {
                0 => break,
                read => digest.update(&piece[..read]),
            }
        }
    } else {
        for number in 0..PIECES {
            // Files are never so long that this overflows. The last piece ends with the file.
            let start = (length - PIECE) * number / (PIECES - 1);
            file.seek(SeekFrom::Start(start))?;
            file.read_exact(&mut piece)?;
            digest.update(&piece);
        }
    }
    Ok((length, HEXLOWER.encode(&digest.finalize())))
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    /// A link that appears after the folder was checked does no harm either.
    #[test]
    #[cfg(unix)]
    fn links_are_neither_read_nor_written_through() {
        let folder = tempfile::tempdir().unwrap();
        let [mine, link] = ["mine", "link"].map(|name| folder.path().join(name));
        fs::write(&mine, "mine").unwrap();
        std::os::unix::fs::symlink(&mine, &link).unwrap();
        assert!(read(&link).is_err() && open(folder.path()).is_err());
        crate::output::files::replace(&link, |file| file.write_all(b"part")).unwrap();
        assert_eq!((read(&link).unwrap(), read(&mine).unwrap()), (b"part".to_vec(), b"mine".to_vec()));
    }

    #[test]
    fn digests_are_those_of_sha256() {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(b"abc").unwrap();
        // The digest is from FIPS 180-2.
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(digest(file.path()).unwrap(), (3, abc.to_owned()));
        assert_eq!(hex(b"abc"), abc);
    }

    #[test]
    fn the_digest_of_a_large_file_has_both_ends_of_it() {
        let file = tempfile::NamedTempFile::new().unwrap();
        // The file has no contents, so it takes no space.
        file.as_file().set_len(SMALL + 5).unwrap();
        let digest = || digest(file.path()).unwrap();
        let empty = digest();
        for place in [0, SMALL + 4] {
            let mut changed = file.as_file();
            changed.seek(SeekFrom::Start(place)).unwrap();
            changed.write_all(b"x").unwrap();
            assert_ne!(digest(), empty, "{place}");
            changed.seek(SeekFrom::Start(place)).unwrap();
            changed.write_all(&[0]).unwrap();
            assert_eq!(digest(), empty);
        }
    }
}
