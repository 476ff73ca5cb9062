//! Reads files of cylinders and cones: `.npz`, `.npy` and tables of text with the middles of both ends, radii, and perhaps
//! colours.

use std::path::Path;

use super::compressed::{Compression, decompressed};
use super::cone_kind::ConeKind;
use super::error::{LoadError, Place};
use super::format::Format;
use super::formats::CONE_FORMATS;
use super::source::start_of;
use super::table::{Table, numbers_of};
use pinhole::LinearRgb;
use pinhole::scene::cone::Cone;

/// The cylinders or cones of a file, in its order.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ConeSet {
    /// The shapes, which are in range and closed.
    pub cones: Vec<Cone>,
    /// The colour of each shape, if the file gives colours.
    pub colors: Option<Vec<LinearRgb>>,
    /// Notes for the user that are not errors, one line each and without the file's name.
    pub notes: Vec<String>,
}

const START: &[[&str; 3]] = &[["start.x", "start.y", "start.z"]];
const END: &[[&str; 3]] = &[["end.x", "end.y", "end.z"]];
/// Names of the columns of both radii. An array `radii` of shape (n, 2) has the second pair.
const TWO_RADII: [[&str; 2]; 2] = [["radius.start", "radius.end"], ["radii.x", "radii.y"]];

impl ConeSet {
    /// Reads a file of cylinders or cones that is in memory, which may be compressed. `name` is the name of the
    /// file, of which only the extension is used. `radii` are those of all shapes, for a file without radii.
    ///
    /// # Errors
    /// Returns an error if the file is of another format, is damaged, or lacks an end or a radius; if it has radii
    /// although `radii` are given; or for the first shape that is out of range.
    pub fn from_bytes(
        bytes: &[u8],
        name: impl AsRef<Path>,
        kind: ConeKind,
        radii: Option<[f64; 2]>,
    ) -> Result<Self, LoadError> {
        let plain = match Compression::of(bytes) {
            Some(compression) => &decompressed(bytes, compression)?,
            None => bytes,
        };
        let format = Format::of_file(name.as_ref(), &start_of(bytes)?).ok();
        let reads = |format: &Format| CONE_FORMATS.iter().find(|(name, _)| *name == format.name);
        let Some((_, read)) = format.and_then(reads) else {
            return Err(LoadError::new(format!(
                "{} are read from {}; save them as one of these",
                kind.plural(),
                Format::extensions_of(|format| reads(format).is_some())
            )));
        };
        let (columns, notes) = read(plain, kind)?;
        Self::of_columns(Table { columns }, notes, kind, radii)
    }

    fn of_columns(
        mut table: Table,
        mut notes: Vec<String>,
        kind: ConeKind,
        given: Option<[f64; 2]>,
    ) -> Result<Self, LoadError> {
        let mut ends = Vec::new();
        for (sets, name) in [(START, "start"), (END, "end")] {
            let Some(columns) = table.take_set(sets) else {
                let lacks = format!("columns `{name}_x`, `{name}_y` and `{name}_z`, or array `{name}` of shape (n, 3)");
                return Err(missing(&lacks, &table, &notes));
            };
            for column in columns {
                ends.push(numbers_of(column)?);
            }
        }
        let radii = radii_of(&mut table, kind, given, &notes)?;
        let colors = table.colors(&mut notes);
        if !table.columns.is_empty() {
            notes.push(format!(
                "these columns are not used, because {} have both ends, radii and colors: {}",
                kind.plural(),
                table.names()
            ));
        }
        let place = |first: usize, row: usize| [0, 1, 2].map(|axis| ends[first + axis][row]);
        let count = ends.first().map_or(0, Vec::len);
        let cone = |row| Cone::new(place(0, row), place(3, row), radii.at(row));
        let cones: Vec<Cone> = (0..count).map(cone).collect();
        let wrong = cones.iter().enumerate().find_map(|(row, cone)| Some((row, cone.check().err()?)));
        match wrong {
            Some((row, error)) => Err(LoadError::at(Place::Row(row), error.to_string())),
            None => Ok(Self { cones, colors, notes }),
        }
    }
}

/// The radii of all shapes, or columns of them.
enum Radii {
    All([f64; 2]),
    One(Vec<f64>),
    Two([Vec<f64>; 2]),
}

impl Radii {
    fn at(&self, row: usize) -> [f64; 2] {
        match self {
            Self::All(radii) => *radii,
            Self::One(radii) => [radii[row]; 2],
            Self::Two(radii) => radii.each_ref().map(|radii| radii[row]),
        }
    }
}

fn radii_of(table: &mut Table, kind: ConeKind, given: Option<[f64; 2]>, notes: &[String]) -> Result<Radii, LoadError> {
    let key = kind.radii();
    let two = TWO_RADII.iter().find(|pair| pair.iter().all(|name| table.position(&[*name]).is_some()));
    match (kind, two, table.radii()?) {
        (ConeKind::Cylinder, None, Some((name, _))) if given.is_some() => Err(both(&name, key)),
        (ConeKind::Cone, Some([first, _]), _) if given.is_some() => Err(both(first, key)),
        (ConeKind::Cylinder, Some([first, second]), _) => Err(LoadError::new(format!(
            "cylinders have one radius, and there are {first} and {second}; list the file in `[[cones]]`"
        ))),
        (ConeKind::Cone, _, Some((name, _))) => Err(LoadError::new(format!(
            "cones have two radii, and the column {name} has one; list the file in `[[cylinders]]`, or save {}",
            kind.columns()
        ))),
        (ConeKind::Cylinder, None, Some((_, radii))) => Ok(Radii::One(radii)),
        (ConeKind::Cone, Some(pair), None) => {
            let [Some(first), Some(second)] = pair.map(|name| table.take(&[name])) else {
                return Err(missing(kind.columns(), table, notes));
            };
            Ok(Radii::Two([numbers_of(first)?, numbers_of(second)?]))
        }
        (_, None, None) => match given {
            Some(radii) => Ok(Radii::All(radii)),
            None => Err(missing(&format!("{}; or give the key `{key}`", kind.columns()), table, notes)),
        },
    }
}

/// The error of radii that both the file and the table of the scene file give.
fn both(column: &str, key: &str) -> LoadError {
    LoadError::new(format!("the column {column} has radii; remove it, or the key `{key}`, which is for all shapes"))
}

/// The error of columns that a file lacks, with the reasons why others were not used.
fn missing(lacks: &str, table: &Table, notes: &[String]) -> LoadError {
    let others = match table.columns.is_empty() {
        true => "no other columns".to_owned(),
        false => format!("the columns {}", table.names()),
    };
    let reasons: String = notes.iter().map(|note| format!("; {note}")).collect();
    LoadError::new(format!("it lacks {lacks}; it has {others}{reasons}"))
}
