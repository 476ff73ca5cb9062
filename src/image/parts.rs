//! Pictures in parts: copying a part into the whole, and the bytes by which parts travel between machines.

use super::{Image, Layer, LayerSet};

/// A part does not fit into a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a part of {}x{} pixels at column {} and row {} does not fit into a picture of {}x{} pixels",
    part[0], part[1], origin[0], origin[1], whole[0], whole[1]
)]
pub struct DoesNotFit {
    /// Width and height of the part in pixels.
    pub part: [u32; 2],
    /// Column and row of its first pixel.
    pub origin: [u32; 2],
    /// Width and height of the picture in pixels.
    pub whole: [u32; 2],
}

impl Image {
    /// Copies a part into this picture, with its first pixel at `origin` (column and row), in the layers that both have.
    /// The part is a picture on [`Film::part`](crate::camera::film::Film::part).
    ///
    /// # Errors
    /// Returns an error if the part reaches beyond this picture, which is then not changed.
    pub fn put(&mut self, part: &Self, origin: [u32; 2]) -> Result<(), DoesNotFit> {
        let ([width, height], whole) = ([part.width, part.height], [self.width, self.height]);
        let fits = |axis: usize, side: u32| {
            origin[axis].checked_add(side).is_some_and(|end| end <= whole[axis])
        };
        if !(fits(0, width) && fits(1, height)) {
            return Err(DoesNotFit { part: [width, height], origin, whole });
        }
        let place = Place {
            first: origin[1] as usize * self.width as usize + origin[0] as usize,
            stride: self.width as usize,
            width: width as usize,
        };
        place.copy(Some(&mut self.color), Some(&part.color));
        place.copy(self.alpha.as_mut(), part.alpha.as_ref());
        place.copy(self.depth.as_mut(), part.depth.as_ref());
        place.copy(self.normal.as_mut(), part.normal.as_ref());
        place.copy(self.position.as_mut(), part.position.as_ref());
        place.copy(self.albedo.as_mut(), part.albedo.as_ref());
        place.copy(self.id.as_mut(), part.id.as_ref());
        place.copy(self.samples.as_mut(), part.samples.as_ref());
        place.copy(self.variance.as_mut(), part.variance.as_ref());
        Ok(())
    }

    /// Copies the pixels with these indices from a picture of the same size and layers.
    pub(crate) fn copy_pixels(&mut self, from: &Self, pixels: &[usize]) {
        fn copy<T: Copy>(to: Option<&mut Vec<T>>, from: Option<&Vec<T>>, pixels: &[usize]) {
            if let (Some(to), Some(from)) = (to, from) {
                pixels.iter().for_each(|at| to[*at] = from[*at]);
            }
        }
        copy(Some(&mut self.color), Some(&from.color), pixels);
        copy(self.alpha.as_mut(), from.alpha.as_ref(), pixels);
        copy(self.depth.as_mut(), from.depth.as_ref(), pixels);
        copy(self.normal.as_mut(), from.normal.as_ref(), pixels);
        copy(self.position.as_mut(), from.position.as_ref(), pixels);
        copy(self.albedo.as_mut(), from.albedo.as_ref(), pixels);
        copy(self.id.as_mut(), from.id.as_ref(), pixels);
        copy(self.samples.as_mut(), from.samples.as_ref(), pixels);
        copy(self.variance.as_mut(), from.variance.as_ref(), pixels);
    }

    /// Sets the layer of ids, if there is one of this length.
    pub(crate) fn set_id(&mut self, ids: &[u32]) {
        if let Some(layer) = self.id.as_mut().filter(|layer| layer.len() == ids.len()) {
            layer.copy_from_slice(ids);
        }
    }

    /// All layers, one after the other in the order of [`LayerSet::iter`], each row by row from the top, as little-endian
    /// numbers of 4 bytes: [`LayerSet::bytes_per_pixel`] bytes for each pixel. [`Image::from_le_bytes`] reads them back.
    #[must_use]
    pub fn to_le_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut floats = |values: &[f32]| {
            bytes.extend(values.iter().flat_map(|value| value.to_bits().to_le_bytes()));
        };
        floats(self.color.as_flattened());
        for layer in self.layers().iter() {
            match layer {
                // It is the first layer of every set.
                Layer::Color => {}
                Layer::Alpha => self.alpha.iter().for_each(|values| floats(values)),
                Layer::Depth => self.depth.iter().for_each(|values| floats(values)),
                Layer::Normal => {
                    self.normal.iter().for_each(|values| floats(values.as_flattened()));
                }
                Layer::Position => {
                    self.position.iter().for_each(|values| floats(values.as_flattened()));
                }
                Layer::Albedo => {
                    self.albedo.iter().for_each(|values| floats(values.as_flattened()));
                }
                Layer::Variance => self.variance.iter().for_each(|values| floats(values)),
                Layer::Id => self.id.iter().for_each(|values| floats(&bits(values))),
                Layer::Samples => self.samples.iter().for_each(|values| floats(&bits(values))),
            }
        }
        bytes
    }

    /// A picture from the bytes that [`Image::to_le_bytes`] returned for these layers. `None` if their number is another,
    /// or the memory cannot be reserved.
    #[must_use]
    pub fn from_le_bytes(
        [width, height]: [u32; 2],
        layers: LayerSet,
        bytes: &[u8],
    ) -> Option<Self> {
        let pixels = u64::from(width) * u64::from(height);
        if pixels.checked_mul(layers.bytes_per_pixel())? != bytes.len() as u64 {
            return None;
        }
        let mut image = Self::new(width, height, layers).ok()?;
        let mut words = bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word));
        let mut floats = |values: &mut [f32]| {
            values
                .iter_mut()
                .zip(&mut words)
                .for_each(|(value, word)| *value = f32::from_bits(word));
        };
        floats(image.color.as_flattened_mut());
        for layer in layers.iter() {
            match layer {
                Layer::Color => {}
                Layer::Alpha => image.alpha.iter_mut().for_each(|values| floats(values)),
                Layer::Depth => image.depth.iter_mut().for_each(|values| floats(values)),
                Layer::Normal => {
                    image.normal.iter_mut().for_each(|values| floats(values.as_flattened_mut()));
                }
                Layer::Position => {
                    image.position.iter_mut().for_each(|values| floats(values.as_flattened_mut()));
                }
                Layer::Albedo => {
                    image.albedo.iter_mut().for_each(|values| floats(values.as_flattened_mut()));
                }
                Layer::Variance => image.variance.iter_mut().for_each(|values| floats(values)),
                Layer::Id => image.id.iter_mut().for_each(|values| of_bits(values, &mut floats)),
                Layer::Samples => {
                    image.samples.iter_mut().for_each(|values| of_bits(values, &mut floats));
                }
            }
        }
        Some(image)
    }
}

/// Numbers as f32 of the same bits, which are only copied.
fn bits(values: &[u32]) -> Vec<f32> {
    values.iter().map(|value| f32::from_bits(*value)).collect()
}

fn of_bits(values: &mut [u32], read: &mut impl FnMut(&mut [f32])) {
    let mut floats = vec![0.0; values.len()];
    read(&mut floats);
    values.iter_mut().zip(&floats).for_each(|(value, float)| *value = float.to_bits());
}

/// Where a part lies in the list of all pixels.
struct Place {
    first: usize,
    /// From one row to the next.
    stride: usize,
    /// Pixels of the part in a row.
    width: usize,
}

impl Place {
    fn copy<T: Copy>(&self, whole: Option<&mut Vec<T>>, part: Option<&Vec<T>>) {
        let (Some(whole), Some(part)) = (whole, part) else { return };
        let rows = whole[self.first..].chunks_mut(self.stride).zip(part.chunks(self.width));
        rows.for_each(|(whole, part)| whole[..self.width].copy_from_slice(part));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture in which every number is another, also bits that are no numbers.
    fn numbered(width: u32, height: u32, layers: LayerSet) -> Image {
        let words = u64::from(width * height) * layers.bytes_per_pixel() / 4;
        let bytes: Vec<u8> =
            (0..words as u32).flat_map(|word| (0x7f80_0000 + 3 * word).to_le_bytes()).collect();
        let image = Image::from_le_bytes([width, height], layers, &bytes).unwrap();
        assert_eq!(image.to_le_bytes(), bytes);
        image
    }

    #[test]
    fn bytes_are_read_back() {
        for layers in [LayerSet::COLOR, LayerSet::DATA, LayerSet::ALL] {
            let image = numbered(3, 5, layers);
            assert_eq!(image.layers(), layers);
            let bytes = image.to_le_bytes();
            for other in [&bytes[1..], &[], &[bytes.clone(), vec![0]].concat()] {
                assert_eq!(Image::from_le_bytes([3, 5], layers, other), None);
            }
            assert!(Image::from_le_bytes([u32::MAX; 2], layers, &bytes).is_none());
        }
    }

    #[test]
    fn parts_make_the_whole() {
        let whole = numbered(7, 5, LayerSet::ALL);
        let mut joined = Image::new(7, 5, LayerSet::ALL).unwrap();
        for (x, width) in [(0, 3), (3, 4)] {
            for (y, height) in [(0, 1), (1, 2), (3, 2)] {
                let mut part = Image::new(width, height, LayerSet::ALL).unwrap();
                let first = (y * 7 + x) as usize;
                let place = Place { first: 0, stride: width as usize, width: width as usize };
                let cut = |of: &[u32]| -> Vec<u32> {
                    let rows = of[first..].chunks(7).take(height as usize);
                    rows.flat_map(|row| row[..width as usize].to_vec()).collect()
                };
                place.copy(part.id.as_mut(), Some(&cut(whole.id.as_ref().unwrap())));
                place.copy(part.samples.as_mut(), Some(&cut(whole.samples.as_ref().unwrap())));
                joined.put(&part, [x, y]).unwrap();
            }
        }
        assert_eq!((joined.id, joined.samples), (whole.id.clone(), whole.samples.clone()));
        let (mut small, part) = (whole.clone(), numbered(4, 2, LayerSet::COLOR));
        for origin in [[4, 0], [0, 4], [u32::MAX, 0], [0, u32::MAX]] {
            small.put(&part, origin).unwrap_err();
        }
        assert_eq!(small.to_le_bytes(), whole.to_le_bytes());
        small.put(&part, [3, 3]).unwrap();
        assert_eq!(small.color[3 * 7 + 3].map(f32::to_bits), part.color[0].map(f32::to_bits));
    }
}
