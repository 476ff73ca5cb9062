//! Pictures of parts of a scene by primary rays, and their merging, after which each pixel shows the nearest hit.

use crate::camera::View;
use crate::geometry::bounds::Bounds;
#[cfg(feature = "gpu")]
use crate::image::{DoesNotFit, ImageTooLarge};
use crate::image::{Image, LayerSet, NO_ID};
use crate::parallel::map;

/// A picture of some spheres of a scene by primary rays, with the distance at which each ray hits.
/// [`NearestPicture::keep_nearer`] merges such pictures of all parts of a scene into that of the whole, to the bit, in
/// any order and grouping. A ray shows the nearest hit, and at equal distances the smallest id, as in all structures.
#[derive(Clone, Debug, PartialEq)]
pub struct NearestPicture {
    image: Image,
    /// The distance along each ray from the renderer's start of the ray. Infinite for a miss.
    t: Vec<f64>,
    id: Vec<u32>,
    /// The distance from the camera. Infinite for a miss. Empty if it is not known.
    distance: Vec<f32>,
}

/// An error for pictures that cannot be merged, because they differ in size or layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("these pictures differ in size or layers, so they are not of parts of one scene")]
pub struct NotOfOneScene;

/// A hidden box is farther than a hit by at least this fraction of its distance: more than f32's rounding.
const FARTHER: f64 = 1.0 / (1 << 18) as f64;

/// Extra width of a box around spheres, as a fraction of the scene's diagonal. It exceeds the margin of boxes.
const WIDER: f64 = 1.0 / (1 << 14) as f64;

impl NearestPicture {
    /// The number of bytes per pixel in [`NearestPicture::to_le_bytes`], in addition to the layers.
    pub const BYTES_PER_PIXEL: u64 = 12;

    /// A picture with the distances along the rays and the ids of all pixels, row by row. `None` unless both lists have
    /// one entry per pixel. Only [`NearestPicture::hides`] needs the distances from the camera, which may be empty.
    pub(crate) fn new(image: Image, t: Vec<f64>, id: Vec<u32>, distance: Vec<f32>) -> Option<Self> {
        let pixels = image.color().len();
        let fits = t.len() == pixels && id.len() == pixels;
        let mut nearest = Self { image, t, id, distance };
        nearest.image.set_id(&nearest.id);
        fits.then_some(nearest)
    }

    /// The picture.
    #[must_use]
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Returns the picture without the distances.
    #[must_use]
    pub fn into_image(self) -> Image {
        self.image
    }

    /// The picture with other ids. `ids` has one for each sphere of the rendered scene. They must ascend, because
    /// at equal distances the sphere with the smallest index was found.
    #[must_use]
    pub fn with_ids(mut self, ids: &[u32]) -> Self {
        let of = |id: u32| ids.get(id as usize).copied().unwrap_or(NO_ID);
        self.id.iter_mut().for_each(|id| *id = of(*id));
        self.image.set_id(&self.id);
        self
    }

    /// Takes the pixels of another part that are nearer, or equally near with a smaller id.
    ///
    /// # Errors
    /// Returns an error if the pictures differ in size or layers. Then nothing changes.
    pub fn keep_nearer(&mut self, other: &Self) -> Result<(), NotOfOneScene> {
        let shape = |image: &Image| (image.width(), image.height(), image.layers());
        if shape(&self.image) != shape(&other.image) {
            return Err(NotOfOneScene);
        }
        let key = |of: &Self, at: usize| (of.t[at], of.id[at]);
        let nearer: Vec<usize> = (0..self.t.len()).filter(|at| key(other, *at) < key(self, *at)).collect();
        for at in &nearer {
            (self.t[*at], self.id[*at]) = (other.t[*at], other.id[*at]);
            if let (Some(distance), Some(new)) = (self.distance.get_mut(*at), other.distance.get(*at)) {
                *distance = *new;
            }
        }
        self.image.copy_pixels(&other.image, &nearer);
        Ok(())
    }

    /// Returns true if the rays of all pixels miss the spheres in a box, or hit something before it. Then a part with
    /// only these spheres changes nothing. Always false for cameras whose rays start far from the scene, because
    /// kernels round such rays by more than the margin of boxes.
    #[must_use]
    pub fn hides(&self, view: &View<'_>, scene: &Bounds, spheres: &Bounds) -> bool {
        let pixels = self.t.len();
        if !view.camera.kind().is_linear() || self.distance.len() != pixels {
            return false;
        }
        let margin = WIDER * scene.size().length()
            + f64::from(f32::EPSILON) * scene.min().abs().max(scene.max().abs()).max_element();
        let wider = spheres.widened(margin);
        let width = self.image.width() as usize;
        let is_hidden = |at: usize| {
            let pixel = [(at % width) as u32, (at / width) as u32];
            let entry = view.ray_through_center(pixel).and_then(|ray| wider.entry(&ray));
            entry.is_none_or(|entry| f64::from(self.distance[at]) < entry * (1.0 - FARTHER))
        };
        let rows = self.image.height() as usize;
        map(rows, |row| (row * width..(row + 1) * width).all(is_hidden)).into_iter().all(|all| all)
    }

    /// Copies a part of the film into this picture, with its first pixel at `origin`.
    #[cfg(feature = "gpu")]
    pub(crate) fn put(&mut self, part: &Self, origin: [u32; 2]) -> Result<(), DoesNotFit> {
        self.image.put(&part.image, origin)?;
        let width = self.image.width() as usize;
        let [across, down] = [part.image.width() as usize, part.image.height() as usize];
        for row in 0..down {
            let from = row * across..(row + 1) * across;
            let first = (origin[1] as usize + row) * width + origin[0] as usize;
            let to = first..first + across;
            self.t[to.clone()].copy_from_slice(&part.t[from.clone()]);
            self.id[to.clone()].copy_from_slice(&part.id[from.clone()]);
            if let (Some(to), Some(from)) = (self.distance.get_mut(to), part.distance.get(from)) {
                to.copy_from_slice(from);
            }
        }
        Ok(())
    }

    /// A picture in which every ray misses.
    #[cfg(feature = "gpu")]
    pub(crate) fn misses([width, height]: [u32; 2], layers: LayerSet) -> Result<Self, ImageTooLarge> {
        let image = Image::new(width, height, layers)?;
        let pixels = image.color().len();
        let distance = vec![f32::INFINITY; pixels];
        Ok(Self { image, t: vec![f64::INFINITY; pixels], id: vec![NO_ID; pixels], distance })
    }

    /// Returns the bytes of [`Image::to_le_bytes`], then the distances along the rays as f64 and the ids as u32.
    #[must_use]
    pub fn to_le_bytes(&self) -> Vec<u8> {
        let mut bytes = self.image.to_le_bytes();
        bytes.extend(self.t.iter().flat_map(|t| t.to_bits().to_le_bytes()));
        bytes.extend(self.id.iter().flat_map(|id| id.to_le_bytes()));
        bytes
    }

    /// Makes a picture from the bytes that [`NearestPicture::to_le_bytes`] returned for these layers. `None` if the
    /// number of bytes differs, or the memory cannot be reserved.
    #[must_use]
    pub fn from_le_bytes(size: [u32; 2], layers: LayerSet, bytes: &[u8]) -> Option<Self> {
        let pixels = usize::try_from(u64::from(size[0]) * u64::from(size[1])).ok()?;
        let more = pixels.checked_mul(Self::BYTES_PER_PIXEL as usize)?;
        let (layered, more) = bytes.split_at_checked(bytes.len().checked_sub(more)?)?;
        let (t, id) = more.split_at_checked(8 * pixels)?;
        let t = t.as_chunks::<8>().0.iter().map(|t| f64::from_bits(u64::from_le_bytes(*t)));
        let id = id.as_chunks::<4>().0.iter().map(|id| u32::from_le_bytes(*id));
        let image = Image::from_le_bytes(size, layers, layered)?;
        Self::new(image, t.collect(), id.collect(), Vec::new())
    }
}
