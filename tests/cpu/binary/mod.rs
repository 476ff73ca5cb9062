//! Binary readers: what their tests share.

mod dcd;
mod gromacs;
mod gsd;

use fastrand::Rng;
use pinhole::SphereArray;
use pinhole::load::{Format, LoadError, Loaded, Options};
use tempfile::TempDir;

use crate::binary_files::topology as topology_file;

/// Reads a file in memory.
fn read(format: &str, bytes: &[u8], options: &Options) -> Result<Loaded, LoadError> {
    Format::of_name(format).unwrap().read(bytes, options)
}

/// The spheres in f64.
fn spheres(loaded: &Loaded) -> Vec<[f64; 4]> {
    match &loaded.spheres {
        SphereArray::F32(all) => all.iter().map(|sphere| sphere.map(f64::from)).collect(),
        SphereArray::F64(all) => all.clone(),
        _ => Vec::new(),
    }
}

/// A topology of so many oxygen atoms, and options that name it.
fn topology(atoms: usize) -> (TempDir, Options) {
    let folder = TempDir::new().unwrap();
    let options = Options::default().with_topology(topology_file(folder.path(), atoms));
    (folder, options)
}

/// The message of an error, which has one line.
fn refused(loaded: Result<Loaded, LoadError>) -> String {
    let message = loaded.unwrap_err().to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

/// Calls `read` with the file after random changes.
fn mutations(random: &mut Rng, file: &[u8], count: usize, mut read: impl FnMut(&[u8], &mut Rng)) {
    for _ in 0..count {
        let mut bytes = file.to_vec();
        for _ in 0..random.usize(1..5) {
            let at = random.usize(..bytes.len());
            match random.u8(..6) {
                0 => bytes[at] = random.u8(..),
                1 => bytes[at] = *random.choice(&[0, 1, 0x7f, 0x80, 0xff]).unwrap(),
                2 => bytes[at] = bytes[at].wrapping_add(1),
                3 if bytes.len() > 1 => drop(bytes.remove(at)),
                4 => bytes.insert(at, random.u8(..)),
                _ => bytes.truncate(at.max(1)),
            }
        }
        read(&bytes, random);
    }
}
