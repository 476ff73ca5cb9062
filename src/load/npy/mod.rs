//! Reads spheres from NumPy arrays (`.npy`) of shape (n, 4) or (n, 3).

mod header;

use super::numbers::{Layout, rows};
use crate::scene::sphere_array::SphereArray;
use crate::text::{one_line, shortened};

/// Why an array is no list of spheres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpheresError {
    /// Not NumPy's format.
    #[error("this is no .npy file; it does not start with \\x93NUMPY")]
    NoNpy,
    /// The header cannot be read.
    #[error("the header {message}; write the file with numpy.save")]
    Header {
        /// What is wrong with it.
        message: String,
    },
    /// Other numbers than f32 and f64.
    #[error(
        "the array has the type {}; wanted is float32 or float64, so save a.astype('float32')",
        shortened(&one_line(found))
    )]
    Type {
        /// NumPy's name of the type.
        found: String,
    },
    /// Neither (n, 4) nor (n, 3).
    #[error(
        "the array has the shape {}; wanted is (n, 4): x, y, z, radius, or (n, 3): x, y, z",
        tuple(shape)
    )]
    Shape {
        /// The array's sides.
        shape: Vec<u64>,
    },
    /// No radii in the array, and none given.
    #[error("the array has the shape ({rows}, 3), without radii; give one radius for all")]
    NoRadius {
        /// How many spheres there are.
        rows: u64,
    },
    /// Radii in the array, and one given.
    #[error("the array has the shape ({rows}, 4), with radii; a radius for all has no use")]
    TwoRadii {
        /// How many spheres there are.
        rows: u64,
    },
    /// Fewer or more bytes than the header says.
    #[error(
        "{} of type {dtype} takes {wanted} bytes, but {found} follow the header; {}",
        tuple(shape),
        if u128::from(*found) < *wanted { "the file is cut off" } else { "something stands behind the array" }
    )]
    Size {
        /// The array's sides.
        shape: Vec<u64>,
        /// NumPy's name of the type.
        dtype: String,
        /// By the header, in bytes.
        wanted: u128,
        /// In bytes.
        found: u64,
    },
    /// There is no memory for so many.
    #[error("there is no memory for {rows} spheres")]
    Memory {
        /// How many there are.
        rows: u64,
    },
}

/// Reads an `.npy` file of shape (n, 4): x, y, z, radius; or (n, 3), and then `radius` is that of all.
/// Float32 or float64 in either byte order, in C or Fortran order. An array without rows is no sphere.
///
/// # Errors
/// If the file is no such array, or has fewer or more bytes than its header says.
pub fn read_spheres(bytes: &[u8], radius: Option<f64>) -> Result<SphereArray, SpheresError> {
    let (header, data) = header::split(bytes)?;
    let shape = header.shape;
    let (count, columns) = match *shape {
        [rows, 4] if radius.is_some() => return Err(SpheresError::TwoRadii { rows }),
        [rows, 3] if radius.is_none() => return Err(SpheresError::NoRadius { rows }),
        [rows, columns @ (3 | 4)] => (rows, columns),
        _ => return Err(SpheresError::Shape { shape }),
    };
    let width = match header.dtype.as_str() {
        "<f4" | ">f4" => 4,
        "<f8" | ">f8" => 8,
        _ => return Err(SpheresError::Type { found: header.dtype }),
    };
    let wanted = u128::from(count) * u128::from(columns) * width;
    if wanted != data.len() as u128 {
        let (dtype, found) = (header.dtype, data.len() as u64);
        return Err(SpheresError::Size { shape, dtype, wanted, found });
    }
    let layout = Layout {
        // No more than there are bytes.
        rows: count as usize,
        columns: columns as usize,
        by_column: header.fortran_order,
    };
    let r = radius.unwrap_or_default();
    match header.dtype.as_str() {
        "<f4" => rows(data, layout, f32::from_le_bytes, r as f32).map(SphereArray::F32),
        ">f4" => rows(data, layout, f32::from_be_bytes, r as f32).map(SphereArray::F32),
        "<f8" => rows(data, layout, f64::from_le_bytes, r).map(SphereArray::F64),
        _ => rows(data, layout, f64::from_be_bytes, r).map(SphereArray::F64),
    }
    .map_err(|_| SpheresError::Memory { rows: count })
}

/// A shape as Python writes it.
fn tuple(shape: &[u64]) -> String {
    match shape {
        [side] => format!("({side},)"),
        sides => {
            let sides: Vec<_> = sides.iter().map(u64::to_string).collect();
            format!("({})", shortened(&sides.join(", ")))
        }
    }
}
