//! Pictures in parts: copying a part into the whole, and the bytes in which parts travel between machines.

use super::{Image, ImageTooLarge, Layer, LayerSet};

/// An error for a part that does not fit into a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a part of {}x{} pixels at column {} and row {} does not fit into a picture of {}x{} pixels",
    part[0], part[1], origin[0], origin[1], whole[0], whole[1]
)]
pub struct DoesNotFit {
    /// Width and height of the part in pixels.
    pub part: [u32; 2],
    /// Column and row of the part's first pixel.
    pub origin: [u32; 2],
    /// Width and height of the picture in pixels.
    pub whole: [u32; 2],
}

impl Image {
    /// Copies a part into this picture, with its first pixel at `origin` (column and row), in the layers that both have.
    /// The part is a picture on [`Film::part`](crate::camera::film::Film::part).
    ///
    /// # Errors
    /// Returns an error if the part reaches beyond this picture, which then does not change.
    pub fn put(&mut self, part: &Self, origin: [u32; 2]) -> Result<(), DoesNotFit> {
        let ([width, height], whole) = ([part.width, part.height], [self.width, self.height]);
        let fits = |axis: usize, side: u32| origin[axis].checked_add(side).is_some_and(|end| end <= whole[axis]);
        if !(fits(0, width) && fits(1, height)) {
            return Err(DoesNotFit { part: [width, height], origin, whole });
        }
        self.copy_rows(part, origin);
        Ok(())
    }

    /// Copies the rows of a part, which must not be too wide, from top to bottom, as far as they are in this picture.
    fn copy_rows(&mut self, part: &Self, [column, row]: [u32; 2]) {
        let rows = (part.height as usize).min((self.height - row) as usize);
        let [width, stride] = [part.width, self.width].map(|side| side as usize);
        let first = row as usize * stride + column as usize;
        self.copy(part, &(0..rows).map(|row| (first + row * stride, row * width)), width);
    }

    /// Copies runs of `count` pixels, in the layers that both pictures have. `starts` has the start of each in both.
    fn copy(&mut self, from: &Self, starts: &(impl Iterator<Item = (usize, usize)> + Clone), count: usize) {
        let planes = self.planes.iter_mut().zip(&from.planes);
        for (layer, (to, from)) in Layer::ALL.iter().zip(planes) {
            let (Some(to), Some(from)) = (to, from) else { continue };
            let words = layer.words();
            for (at, start) in starts.clone() {
                let run = &from[start * words..][..count * words];
                to[at * words..][..count * words].copy_from_slice(run);
            }
        }
    }

    /// Joins two images of the same height, side by side, in the layers that both have.
    ///
    /// # Errors
    /// Returns an error if the memory cannot be reserved.
    pub fn side_by_side([left, right]: [&Self; 2]) -> Result<Self, ImageTooLarge> {
        let in_both = left.layers().iter().filter(|layer| right.layers().contains(*layer));
        let (width, height) = (left.width + right.width, left.height.min(right.height));
        let mut both = Self::new(width, height, in_both.collect())?;
        both.copy_rows(left, [0, 0]);
        both.copy_rows(right, [left.width, 0]);
        Ok(both)
    }

    /// Every pixel in a rectangle of the picture, or only one of `step` in every row and column: `size` pixels in all (width
    /// and height), of which the first is at `origin`.
    pub(crate) fn cut(&self, origin: [u32; 2], size: [u32; 2], step: u32) -> Result<Self, ImageTooLarge> {
        let mut part = Self::new(size[0], size[1], self.layers())?;
        let [[left, top], [width, height]] = [origin, size].map(|pair| pair.map(|side| side as usize));
        let (step, stride) = (step as usize, self.width as usize);
        let start =
            |row: usize, column: usize| (row * width + column, (top + row * step) * stride + left + column * step);
        if step == 1 {
            part.copy(self, &(0..height).map(|row| start(row, 0)), width);
        } else {
            part.copy(self, &(0..height * width).map(|at| start(at / width, at % width)), 1);
        }
        Ok(part)
    }

    /// Copies the pixels with these indices from a picture of the same size and layers.
    pub(crate) fn copy_pixels(&mut self, from: &Self, pixels: &[usize]) {
        self.copy(from, &pixels.iter().map(|at| (*at, *at)), 1);
    }

    /// Sets the layer of ids, if there is one with as many pixels.
    pub(crate) fn set_id(&mut self, ids: &[u32]) {
        if let Some(layer) = self.plane_mut(Layer::Id).filter(|layer| layer.len() == ids.len()) {
            layer.copy_from_slice(ids);
        }
    }

    /// Returns all layers as little-endian 4-byte numbers, in the order of [`LayerSet::iter`], each row by row from the
    /// top: [`LayerSet::bytes_per_pixel`] bytes per pixel. [`Image::from_le_bytes`] reads them.
    #[must_use]
    pub fn to_le_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        for plane in self.planes.iter().flatten() {
            bytes.extend(plane.iter().flat_map(|word| word.to_le_bytes()));
        }
        bytes
    }

    /// Makes a picture from the bytes that [`Image::to_le_bytes`] returned for these layers. `None` if the number of
    /// bytes differs, or the memory cannot be reserved.
    #[must_use]
    pub fn from_le_bytes([width, height]: [u32; 2], layers: LayerSet, bytes: &[u8]) -> Option<Self> {
        let pixels = u64::from(width) * u64::from(height);
        if pixels.checked_mul(layers.bytes_per_pixel())? != bytes.len() as u64 {
            return None;
        }
        let mut image = Self::new(width, height, layers).ok()?;
        let words = bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word));
        let all = image.planes.iter_mut().flatten().flatten();
        all.zip(words).for_each(|(to, word)| *to = word);
        Some(image)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture in which all numbers differ, including bits that are not numbers.
    fn numbered(width: u32, height: u32, layers: LayerSet) -> Image {
        let words = u64::from(width * height) * layers.bytes_per_pixel() / 4;
        let bytes: Vec<u8> = (0..words as u32).flat_map(|word| (0x7f80_0000 + 3 * word).to_le_bytes()).collect();
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
                let start = |row: u32| ((row * width) as usize, ((y + row) * 7 + x) as usize);
                part.copy(&whole, &(0..height).map(start), width as usize);
                joined.put(&part, [x, y]).unwrap();
            }
        }
        assert_eq!(joined.to_le_bytes(), whole.to_le_bytes());
        let (mut small, part) = (whole.clone(), numbered(4, 2, LayerSet::COLOR));
        for origin in [[4, 0], [0, 4], [u32::MAX, 0], [0, u32::MAX]] {
            small.put(&part, origin).unwrap_err();
        }
        assert_eq!(small.to_le_bytes(), whole.to_le_bytes());
        small.put(&part, [3, 3]).unwrap();
        assert_eq!(small.color()[3 * 7 + 3].map(f32::to_bits), part.color()[0].map(f32::to_bits));
    }
}
