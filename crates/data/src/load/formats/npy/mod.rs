//! Reads spheres from NumPy arrays (`.npy`): plain ones of 3 to 7 columns, and structured ones, whose fields have names.

mod dtype;
mod header;
pub mod pixels;

use std::collections::TryReserveError;

use super::raw::{Layout, rows};
use crate::load::cone_kind::ConeKind;
use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, LoadErrorKind};
use crate::load::format::{Numbers, Options, Rows};
use crate::load::numbers::component_names;
use crate::load::table::{Columns, Table, TableColumn};
use dtype::{Dtype, Place};
use header::{Elements, Header};
use pinhole::internals::text::shortened;
use pinhole::scene::sphere_array::SphereArray;

/// Names of the columns of plain arrays with 3 to 7 columns.
const COLUMNS: [&[&str]; 5] = [
    &["x", "y", "z"],
    &["x", "y", "z", "radius"],
    &["x", "y", "z", "radius", "value"],
    &["x", "y", "z", "red", "green", "blue"],
    &["x", "y", "z", "radius", "red", "green", "blue"],
];

/// Vectors with more components than this do not become columns.
const MOST_COMPONENTS: u64 = 64;

/// Reads an `.npy` file of any type of floating-point numbers or integers, in either byte order, in C or Fortran order.
///
/// The columns are x, y, z; x, y, z, radius, perhaps a value; or x, y, z, perhaps radius, red, green, blue. Other
/// fields of structures are kept. Spheres without radii get `radius`, or else one from their spacing, with a note.
///
/// # Errors
/// Returns an error if the file is not such an array, or has fewer or more bytes than its header says.
pub fn read(bytes: &[u8], radius: Option<f64>) -> Result<Dataset, LoadError> {
    let array = Array::open(bytes)?;
    let options = radius.map_or_else(Options::default, |r| Options::default().with_radius(r));
    Ok(match array.spheres(radius)? {
        Spheres::Ready { spheres, have_radii } => Table::default().dress(spheres, have_radii, &options)?,
        Spheres::Columns { columns, notes } => {
            let mut loaded = Table { columns }.into_loaded(&options)?;
            loaded.notes.extend(notes);
            loaded
        }
    })
}

/// Reads the columns of an array of cylinders or cones: start, end, and perhaps radii.
pub(super) fn columns(bytes: &[u8], kind: ConeKind) -> Result<Columns, LoadError> {
    Array::open(bytes)?.columns_of(kind)
}

/// Returns the bytes of memory that reading takes in addition to the file, because columns are f64.
pub(super) fn extra_bytes(bytes: &[u8]) -> u64 {
    Array::open(bytes).map_or(0, |array| match &array.header.elements {
        Elements::Plain(_) => 0,
        Elements::Structures { fields, .. } => 8 * (array.rows() * fields.len()) as u64,
    })
}

/// The rows of a file of `size` bytes, if it is a plain array of spheres that any machine reads alike.
pub(super) fn rows_of(head: &[u8], size: u64, options: &Options) -> Option<Rows> {
    let (Header { elements: Elements::Plain(name), fortran_order: false, shape }, rest) = header::split(head).ok()?
    else {
        return None;
    };
    let [count, columns @ 3..=4] = *shape else { return None };
    let numbers = match name.as_str() {
        "<f4" => Numbers::F32,
        "<f8" => Numbers::F64,
        _ => return None,
    };
    let rows = Rows {
        first: (head.len() - rest.len()) as u64,
        count: usize::try_from(count).ok()?,
        columns: columns as usize,
        numbers,
    };
    let is_whole = rows.bytes().and_then(|bytes| bytes.checked_add(rows.first)) == Some(size);
    (is_whole && !(columns == 4 && options.radius.is_some())).then_some(rows)
}

/// An array whose data are as long as its header says.
pub(super) struct Array<'a> {
    header: Header,
    data: &'a [u8],
    /// The type of the elements, unless they are structures.
    dtype: Option<Dtype>,
}

/// The spheres of an array, or a table from which to make them.
pub(super) enum Spheres {
    /// Spheres, with radii or without.
    Ready { spheres: SphereArray, have_radii: bool },
    /// Columns of a table.
    Columns { columns: Vec<TableColumn>, notes: Vec<String> },
}

impl<'a> Array<'a> {
    /// Reads the header, and checks it against the length of the data.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, LoadError> {
        let (header, data) = header::split(bytes)?;
        let (dtype, size) = match &header.elements {
            Elements::Plain(name) => {
                let dtype = Dtype::parse(name).ok_or_else(|| no_numbers(name))?;
                let size = dtype.size;
                (Some(dtype), size)
            }
            Elements::Structures { size, .. } => (None, *size),
        };
        let shape = header.shape.iter();
        let count = shape.fold(1_u128, |all, side| all.saturating_mul(u128::from(*side)));
        let wanted = count.saturating_mul(size as u128);
        if wanted != data.len() as u128 {
            let (dtype, found) = (header.elements.name(), data.len() as u64);
            let (what, kind) = if u128::from(found) < wanted {
                ("the file is cut off", LoadErrorKind::CutOff)
            } else {
                ("there are other data after the array", LoadErrorKind::Other)
            };
            let shape = tuple(&header.shape);
            let message = format!(
                "an array of shape {shape} and type {dtype} takes {wanted} bytes, but {found} bytes follow the header; {what}"
            );
            return Err(LoadError::new(message).of_kind(kind));
        }
        Ok(Self { header, data, dtype })
    }

    /// The first dimension, or 0 if there is none or elements take no bytes.
    pub(super) fn rows(&self) -> usize {
        if self.data.is_empty() {
            return 0;
        }
        // This fits, because there are at least as many bytes as rows.
        self.header.shape.first().map_or(0, |rows| *rows as usize)
    }

    /// Whether the array has at least one dimension.
    pub(super) fn has_rows(&self) -> bool {
        !self.header.shape.is_empty()
    }

    pub(super) fn shape(&self) -> String {
        tuple(&self.header.shape)
    }

    /// Returns the array as spheres, or as a table.
    pub(super) fn spheres(&self, radius: Option<f64>) -> Result<Spheres, LoadError> {
        let Some(dtype) = &self.dtype else {
            let [_] = *self.header.shape else {
                return Err(LoadError::new(format!(
                    "the array of structures has the shape {}, but it must be (n,); save it as a.ravel()",
                    self.shape()
                )));
            };
            let (columns, unused) = self.fields("");
            return Ok(Spheres::Columns { columns, notes: note_of_unused(&unused).into_iter().collect() });
        };
        let names = match *self.header.shape {
            [_, columns @ 3..=7] => COLUMNS[columns as usize - 3],
            _ => {
                return Err(LoadError::new(format!(
                    "the array has the shape {}, but it must be (n, 3) for x, y, z; (n, 4) for x, y, z, radius; (n, 5) with \
                     a value after that; (n, 6) for x, y, z, red, green, blue; or (n, 7) for x, y, z, radius, red, green, \
                     blue",
                    self.shape()
                )));
            }
        };
        if !dtype.is_real() {
            return Err(no_numbers(&dtype.name));
        }
        let count = self.rows();
        if radius.is_some() && names.contains(&"radius") {
            let message = format!(
                "the array has the shape ({count}, {}) with radii; remove the radius that is given for all spheres",
                names.len()
            );
            return Err(LoadError::new(message).of_kind(LoadErrorKind::TwoRadii));
        }
        if names.len() <= 4
            && let Some(spheres) = self.plain(dtype, names.len())
        {
            let have_radii = names.len() == 4;
            let memory = |_| LoadError::new(format!("there is not enough memory for {count} spheres"));
            return spheres.map(|spheres| Spheres::Ready { spheres, have_radii }).map_err(memory);
        }
        let mut columns = self.matrix(dtype, names.iter().map(ToString::to_string));
        // Positions and colours share a type here, so that its largest value says nothing about colours.
        columns.iter_mut().for_each(|column| column.full = None);
        Ok(Spheres::Columns { columns, notes: Vec::new() })
    }

    /// Returns the columns of an array of cylinders or cones, with radii or without.
    fn columns_of(&self, kind: ConeKind) -> Result<Columns, LoadError> {
        let names = kind.names();
        match (&self.dtype, &*self.header.shape) {
            (None, [_]) => {
                let (columns, unused) = self.fields("");
                Ok((columns, note_of_unused(&unused).into_iter().collect()))
            }
            (Some(dtype), [_, columns]) if [6, names.len() as u64].contains(columns) => {
                if !dtype.is_real() {
                    return Err(no_numbers(&dtype.name));
                }
                Ok((self.matrix(dtype, names[..*columns as usize].iter().map(ToString::to_string)), Vec::new()))
            }
            _ => Err(LoadError::new(format!(
                "the array has the shape {}, but it must be (n, {}) for {}; or (n, 6) without radii, with the key `{}`",
                self.shape(),
                names.len(),
                names.join(", "),
                kind.radii()
            ))),
        }
    }

    /// Reads rows of three or four numbers in f32 or f64 directly; `None` for other types. Radii are 0 if there is no
    /// fourth number.
    fn plain(&self, dtype: &Dtype, columns: usize) -> Option<Result<SphereArray, TryReserveError>> {
        let layout = Layout { rows: self.rows(), columns, by_column: self.header.fortran_order };
        let data = self.data;
        Some(match dtype.name.as_str() {
            "<f4" => rows(data, layout, f32::from_le_bytes, 0.0).map(SphereArray::F32),
            ">f4" => rows(data, layout, f32::from_be_bytes, 0.0).map(SphereArray::F32),
            "<f8" => rows(data, layout, f64::from_le_bytes, 0.0).map(SphereArray::F64),
            ">f8" => rows(data, layout, f64::from_be_bytes, 0.0).map(SphereArray::F64),
            _ => return None,
        })
    }

    /// Returns the columns of an array with one row, or one value, for each sphere. An error is the end of a sentence.
    pub(super) fn columns(&self, name: &str) -> Result<Vec<TableColumn>, String> {
        let Some(dtype) = &self.dtype else {
            return match *self.header.shape {
                [_] => Ok(self.fields(&format!("{name}.")).0),
                _ => Err(format!("has the shape {}", self.shape())),
            };
        };
        if !dtype.is_column() {
            return Err(format!("has the type {}", shortened(&dtype.name)));
        }
        match *self.header.shape {
            [_] => Ok(self.matrix(dtype, [name.to_owned()].into_iter())),
            [_, count @ 1..=MOST_COMPONENTS] => {
                Ok(self.matrix(dtype, component_names(name, count as usize).into_iter()))
            }
            _ => Err(format!("has the shape {}", self.shape())),
        }
    }

    fn matrix(&self, dtype: &Dtype, names: impl ExactSizeIterator<Item = String>) -> Vec<TableColumn> {
        let (rows, columns, size) = (self.rows(), names.len(), dtype.size);
        let place = |column| match self.header.fortran_order {
            true => Place { first: column * rows * size, stride: size, rows },
            false => Place { first: column * size, stride: columns * size, rows },
        };
        let named = names.enumerate();
        named.map(|(column, name)| dtype.column(name, self.data, place(column))).collect()
    }

    /// Returns the fields of structures, and the names of fields that cannot be columns.
    fn fields(&self, prefix: &str) -> (Vec<TableColumn>, Vec<String>) {
        let Elements::Structures { fields, size } = &self.header.elements else {
            return Default::default();
        };
        let (used, unused): (Vec<_>, Vec<_>) = fields.iter().partition(|field| field.dtype.is_column());
        let column = |field: &header::Field| {
            let place = Place { first: field.offset, stride: *size, rows: self.rows() };
            field.dtype.column(format!("{prefix}{}", field.name), self.data, place)
        };
        let unused = unused.into_iter().map(|field| field.name.clone());
        (used.into_iter().map(column).collect(), unused.collect())
    }
}

fn note_of_unused(fields: &[String]) -> Option<String> {
    let note =
        || format!("these fields are not used, because they are neither numbers nor text: {}", fields.join(", "));
    (!fields.is_empty()).then(note)
}

/// The error of elements that are not real numbers.
fn no_numbers(dtype: &str) -> LoadError {
    LoadError::new(format!(
        "the array has the type {}, but it must be of floating-point numbers or integers; save it as a.astype('float32')",
        shortened(dtype)
    ))
}

/// Formats a shape as Python writes it.
fn tuple(shape: &[u64]) -> String {
    match shape {
        [dimension] => format!("({dimension},)"),
        dimensions => {
            let dimensions: Vec<_> = dimensions.iter().map(u64::to_string).collect();
            format!("({})", shortened(&dimensions.join(", ")))
        }
    }
}
