//! Reads spheres from NumPy arrays (`.npy`) of shape (n, 4) or (n, 3).

mod header;

use super::numbers::{Layout, rows};
use crate::scene::sphere_array::SphereArray;
use crate::text::{one_line, shortened};

/// An error of reading spheres from an `.npy` file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpheresError {
    /// The file does not start with the signature of the format.
    #[error(
        "this is not an .npy file: it does not start with \\x93NUMPY; write the file with numpy.save"
    )]
    NoNpy,
    /// The header cannot be read.
    #[error("the .npy header {message}; write the file with numpy.save")]
    Header {
        /// What is wrong with the header, as the end of a sentence.
        message: String,
    },
    /// The numbers are neither float32 nor float64.
    #[error(
        "the array has the type {}, but it must be float32 or float64; save it as a.astype('float32')",
        shortened(&one_line(found))
    )]
    Type {
        /// NumPy's name of the type of the array.
        found: String,
    },
    /// The shape is neither (n, 4) nor (n, 3).
    #[error(
        "the array has the shape {}, but it must be (n, 4) for x, y, z, radius or (n, 3) for x, y, z",
        tuple(shape)
    )]
    Shape {
        /// The shape of the array.
        shape: Vec<u64>,
    },
    /// The array has no radii, and no radius was given.
    #[error("the array has the shape ({rows}, 3) without radii; give one radius for all spheres")]
    NoRadius {
        /// Number of spheres.
        rows: u64,
    },
    /// The array has radii, and a radius was given as well.
    #[error(
        "the array has the shape ({rows}, 4) with radii; remove the radius that is given for all spheres"
    )]
    TwoRadii {
        /// Number of spheres.
        rows: u64,
    },
    /// The file has fewer or more bytes than its header says.
    #[error(
        "an array of shape {} and type {dtype} takes {wanted} bytes, but {found} bytes follow the header; {}",
        tuple(shape),
        if u128::from(*found) < *wanted { "the file is cut off" } else { "there are other data after the array" }
    )]
    Size {
        /// The shape of the array.
        shape: Vec<u64>,
        /// NumPy's name of the type of the array.
        dtype: String,
        /// Size of the array by its header, in bytes.
        wanted: u128,
        /// Size of the data after the header, in bytes.
        found: u64,
    },
    /// There is not enough memory for the spheres.
    #[error("there is not enough memory for {rows} spheres")]
    Memory {
        /// Number of spheres.
        rows: u64,
    },
}

/// Reads an `.npy` file of shape (n, 4): x, y, z, radius; or of shape (n, 3): x, y, z, where all spheres get `radius`.
/// The numbers are float32 or float64 in either byte order, in C or Fortran order. An array without rows gives no
/// spheres.
///
/// # Errors
/// If the file is not such an array, or has fewer or more bytes than its header says.
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
        // This fits into usize, because there are not fewer bytes than rows.
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
