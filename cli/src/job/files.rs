//! The files of jobs: everything that jobs ask of the file system, except for what appears whole or not at all, which
//! `output.rs` writes.

use std::fs;
pub(super) use std::fs::File;
use std::io;
use std::path::Path;
use std::time::SystemTime;

pub(super) fn open(path: &Path) -> io::Result<File> {
    File::open(path)
}

pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    fs::read(path)
}

pub(super) fn read_text(path: &Path) -> io::Result<String> {
    fs::read_to_string(path)
}

pub(super) fn create_folder(path: &Path) -> io::Result<()> {
    fs::create_dir(path)
}

/// Removes a folder that this program has created, with all that is in it.
pub(super) fn remove_folder(path: &Path) {
    let _ = fs::remove_dir_all(path);
}

/// The names of what is in a folder. Asking for them makes network file systems look for new files.
pub(super) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().into_string().ok()).collect()
}

/// Removes a file, if it is there.
pub(super) fn remove(path: &Path) {
    let _ = fs::remove_file(path);
}

/// When a file was written, by the clock of the file system.
pub(super) fn modified(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).and_then(|file| file.modified()).ok()
}
