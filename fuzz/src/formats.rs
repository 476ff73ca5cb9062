//! Files of spheres, of each format of the table.

use std::fs;
use std::io::Write as _;
use std::path::Path;

use fastrand::Rng;
use flate2::{Compression, write::GzEncoder};
use pinhole_data::load::{self, ColumnValues, ConeKind, ConeSet, Dataset, Format, LoadError, Options, Trajectory};
use tempfile::TempDir;

use crate::{Target, check_message, checked, seeds};

/// The good files of a format, which are damaged, and all options that one of them needs.
pub(crate) fn target(format: &'static Format, folder: TempDir) -> Target {
    let seeds = seeds::of(format, folder.path());
    for (bytes, options) in &seeds {
        let read = load::from_bytes(bytes, "", &options.clone().with_format(format));
        assert!(read.is_ok_and(|loaded| !loaded.spheres.is_empty()), "a file of {} is not good", format.name);
    }
    let (seeds, options): (Vec<_>, Vec<_>) = seeds.into_iter().unzip();
    let mut distinct: Vec<Options> = Vec::new();
    for one in options {
        if !distinct.contains(&one) {
            distinct.push(one);
        }
    }
    let file = folder.path().join("file");
    let read = move |bytes: &[u8]| distinct.iter().try_for_each(|options| read_all(format, bytes, options, &file));
    Target::new(folder, seeds, read)
}

/// Reads a file in every way that a program can. Those that take long are chosen by the bytes, and rarely.
fn read_all(format: &'static Format, bytes: &[u8], options: &Options, file: &Path) -> Result<(), String> {
    let mut sum = flate2::Crc::new();
    sum.update(bytes);
    let mut random = Rng::with_seed(sum.sum().into());
    let named = options.clone().with_format(format);
    check(load::from_bytes(bytes, "", &named))?;
    // The content may now look like another format, which would get options that do not apply to it.
    if random.u8(0..8) == 0 {
        check(load::from_bytes(bytes, "", options))?;
        let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
        gzip.write_all(bytes)
            .and_then(|()| gzip.finish())
            .map_or(Ok(()), |packed| check(load::from_bytes(&packed, "", &named)))?;
    }
    if !format.has_frames() || random.u8(0..20) > 0 {
        return Ok(());
    }
    fs::write(file, bytes).map_err(|error| error.to_string())?;
    check(load::open(file, &named.clone().with_frame(random.usize(0..3))))?;
    let mut trajectory = match Trajectory::open(file, &named) {
        Err(error) => return check(Err(error)),
        Ok(trajectory) => trajectory,
    };
    check_message(trajectory.problem().map(LoadError::to_string))?;
    let last = trajectory.len().checked_sub(1).ok_or("a trajectory has no frames")?;
    [0, last, random.usize(0..=last), last + 1].into_iter().try_for_each(|index| check(trajectory.frame(index)))
}

/// Files of cylinders and cones.
pub(crate) fn cones(folder: TempDir) -> Target {
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/data/tests/files/cones");
    let mut paths: Vec<_> = fs::read_dir(files).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let read = |bytes: &[u8]| {
        let name = if bytes.starts_with(b"PK") || bytes.starts_with(b"\x93") { "" } else { "a.csv" };
        for (kind, radii) in [(ConeKind::Cylinder, None), (ConeKind::Cone, None), (ConeKind::Cone, Some([1.0, 0.5]))] {
            let Some(set) = checked(ConeSet::from_bytes(bytes, name, kind, radii))? else { continue };
            if set.colors.is_some_and(|colors| colors.len() != set.cones.len()) {
                return Err(format!("{} cones have other numbers of colors", set.cones.len()));
            }
            check_message(set.notes)?;
        }
        Ok(())
    };
    Target::new(folder, paths.iter().map(|path| fs::read(path).unwrap()).collect(), read)
}

/// Checks that the data are consistent, or that the error is one line.
fn check(read: Result<Dataset, LoadError>) -> Result<(), String> {
    let loaded = match read {
        Ok(loaded) => loaded,
        Err(error) => return check_message([error.to_string()]),
    };
    let count = loaded.spheres.len();
    let is = |what: &str, found: usize| match found == count {
        true => Ok(()),
        false => Err(format!("{count} spheres have {found} {what}")),
    };
    is("colors", loaded.colors.as_ref().map_or(count, Vec::len))?;
    is("opacities", loaded.opacities.as_ref().map_or(count, Vec::len))?;
    let is_bond = |[a, b]: &[u32; 2]| a < b && (*b as usize) < count;
    if !(loaded.bonds.iter().all(is_bond) && loaded.bonds.is_sorted_by(|one, next| one < next)) {
        return Err("bonds are not in order".to_owned());
    }
    for column in &loaded.columns {
        match &column.values {
            ColumnValues::Numbers(numbers) => is("numbers", numbers.len())?,
            ColumnValues::Labels(labels) => {
                is("labels", labels.indices.len())?;
                if labels.indices.iter().any(|index| *index as usize >= labels.names.len()) {
                    return Err(format!("a label of {} has no name", column.name));
                }
            }
        }
    }
    check_message(loaded.notes)
}
