//! Reads pictures from NumPy arrays: ids, numbers and vectors of pixels from `.npy` files, and rays from `.npz`
//! archives. Row 0 is the top.

use super::Array;
use super::dtype::Dtype;
use crate::load::error::LoadError;
use crate::load::formats::npz::{array_of, of_array};
use pinhole::camera::film::Film;
use pinhole::geometry::ray::Ray;
use pinhole::image::NO_ID;
use pinhole::internals::text::shortened;

/// One value for each pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels<T> {
    /// Width and height.
    pub size: [u32; 2],
    /// The values.
    pub values: Vec<T>,
}

const NUMBERS: &str = "must be (height, width), with at most 8388608 pixels a side";
const VECTORS: &str = "must be (height, width, 3), with at most 8388608 pixels a side";

impl Array<'_> {
    /// Width and height of a picture with `components` values for each pixel; `None` for another shape.
    fn sides(&self, components: u64) -> Option<[u32; 2]> {
        let (height, width) = match *self.header.shape {
            [height, width] if components == 1 => (height, width),
            [height, width, count] if components > 1 && count == components => (height, width),
            _ => return None,
        };
        let side = |side: u64| u32::try_from(side).ok().filter(|s| (1..=Film::MAX_SIDE).contains(s));
        Some([side(width)?, side(height)?])
    }

    fn picture(&self, components: u64) -> Result<[u32; 2], LoadError> {
        let wanted = if components == 1 { NUMBERS } else { VECTORS };
        self.sides(components).ok_or_else(|| self.wrong_shape(wanted))
    }

    fn wrong_shape(&self, wanted: &str) -> LoadError {
        LoadError::new(format!("the array has the shape {}, but {wanted}", self.shape()))
    }

    /// Returns the type of the elements, which must be one of `names` in either byte order.
    fn is_of(&self, names: &[&str], wanted: &'static str) -> Result<&Dtype, LoadError> {
        let is_one = |dtype: &&Dtype| {
            let (order, rest) = dtype.name.split_at_checked(1).unwrap_or_default();
            matches!(order, "<" | ">") && names.contains(&rest)
        };
        self.dtype.as_ref().filter(is_one).ok_or_else(|| {
            let found = shortened(&self.header.elements.name());
            LoadError::new(format!("the array has the type {found}, but {wanted}"))
        })
    }

    /// Decodes values in C order from either order of the file.
    fn values<T>(&self, size: [u32; 2], components: usize, dtype: &Dtype, decode: impl Fn(&[u8]) -> T) -> Vec<T> {
        let width = dtype.size;
        let at = |place: usize| decode(&self.data[place * width..(place + 1) * width]);
        let count = self.data.len() / width.max(1);
        if !self.header.fortran_order {
            return (0..count).map(at).collect();
        }
        let [columns, rows] = size.map(|side| side as usize);
        let place = |i: usize| {
            let (pixel, component) = (i / components, i % components);
            pixel / columns + rows * (pixel % columns + columns * component)
        };
        (0..count).map(|i| at(place(i))).collect()
    }

    fn floats(&self, components: u64, what: &'static str) -> Result<Pixels<f64>, LoadError> {
        let dtype = self.is_of(&["f4", "f8"], what)?;
        let size = self.picture(components)?;
        let decode = |bytes: &[u8]| dtype.number(bytes);
        Ok(Pixels { size, values: self.values(size, components as usize, dtype, decode) })
    }
}

/// Reads ids: integers of type uint32, int32, int64 or uint64 and shape (height, width), in either byte order. A miss
/// is -1 or the largest number of the type, and becomes [`NO_ID`].
///
/// # Errors
/// Returns an error if the file is not such an array, or a number is neither an id nor a miss.
pub fn ids(bytes: &[u8]) -> Result<Pixels<u32>, LoadError> {
    let array = Array::open(bytes)?;
    let wanted = "ids must be of the type uint32, int32, uint64 or int64 with a byte order; save them as \
                  ids.astype('int64')";
    let dtype = array.is_of(&["u4", "i4", "u8", "i8"], wanted)?;
    let size = array.picture(1)?;
    let signed = matches!(dtype.name.as_bytes().get(1), Some(b'i'));
    let largest = (1_i128 << (8 * dtype.size - usize::from(signed))) - 1;
    let integers = array.values(size, 1, dtype, |bytes| dtype.integer(bytes));
    let id = |(index, found): (usize, i128)| match u32::try_from(found) {
        _ if found == largest || (signed && found == -1) => Ok(NO_ID),
        Ok(id) if id != NO_ID => Ok(id),
        _ => {
            let width = size[0] as usize;
            Err(LoadError::new(format!(
                "the id at pixel ({}, {}) is {found}; an id is an index from 0, and a miss is -1 or the largest number of the \
                 type",
                index % width,
                index / width
            )))
        }
    };
    let values = integers.into_iter().enumerate().map(id).collect::<Result<_, _>>()?;
    Ok(Pixels { size, values })
}

/// Reads one number for each pixel: float32 or float64 of shape (height, width), in either byte order.
///
/// # Errors
/// Returns an error if the file is not such an array.
pub fn numbers(bytes: &[u8]) -> Result<Pixels<f64>, LoadError> {
    let wanted = "depths must be of the type float32 or float64";
    Array::open(bytes)?.floats(1, wanted)
}

/// Reads a vector for each pixel: float32 or float64 of shape (height, width, 3), in either byte order.
///
/// # Errors
/// Returns an error if the file is not such an array.
pub fn vectors(bytes: &[u8]) -> Result<Pixels<[f64; 3]>, LoadError> {
    let wanted = "vectors must be of the type float32 or float64";
    let Pixels { size, values } = Array::open(bytes)?.floats(3, wanted)?;
    Ok(Pixels { size, values: values.as_chunks().0.to_vec() })
}

/// Reads rays in world space from an `.npz` archive: the array `directions`, of shape (height, width, 3), and the array
/// `origins`, of the same shape, or of shape (3,) if all rays start at one point; float32 or float64.
///
/// # Errors
/// Returns an error if the archive has no such arrays.
pub fn rays(archive: &[u8]) -> Result<Pixels<Ray>, LoadError> {
    let data = array_of(archive, "directions")?;
    let Pixels { size, values: directions } = vectors(&data).map_err(of_array("directions"))?;
    let data = array_of(archive, "origins")?;
    let origins = origins(&data, size).map_err(of_array("origins"))?;
    let ray = |(i, direction): (usize, [f64; 3])| {
        let origin = origins[if origins.len() == 1 { 0 } else { i }];
        Ray { origin: origin.into(), direction: direction.into() }
    };
    Ok(Pixels { size, values: directions.into_iter().enumerate().map(ray).collect() })
}

/// The points at which rays start: one, or one for each pixel.
fn origins(bytes: &[u8], size: [u32; 2]) -> Result<Vec<[f64; 3]>, LoadError> {
    let array = Array::open(bytes)?;
    if *array.header.shape == [3] {
        let dtype = array.is_of(&["f4", "f8"], "origins must be of the type float32 or float64")?;
        let values = array.values([1, 1], 3, dtype, |bytes| dtype.number(bytes));
        return Ok(values.as_chunks().0.to_vec());
    }
    let found = vectors(bytes)?;
    if found.size != size {
        let wanted = "must be that of the array `directions`, or (3,) for one point";
        return Err(array.wrong_shape(wanted));
    }
    Ok(found.values)
}
