//! Dividing a film into tiles, bands and rectangles of workgroups.

use std::ops::Range;

use crate::camera::film::Film;

/// Maximum number of pixels of a band, whose hits share one buffer.
pub(crate) const MAX_BAND_PIXELS: u64 = 1 << 22;

/// The side of a workgroup, as in `@workgroup_size(8, 8)`.
pub(crate) const WORKGROUP_SIDE: u32 = 8;

/// A rectangle of the film, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    pub(crate) origin: [u32; 2],
    pub(crate) size: [u32; 2],
    /// Position of the first pixel in the target textures.
    pub(crate) in_target: [u32; 2],
}

/// A rectangle of workgroups.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Groups {
    pub(crate) first: [u32; 2],
    pub(crate) size: [u32; 2],
}

impl Groups {
    /// An empty rectangle.
    pub(crate) const NONE: Self = Self { first: [0, 0], size: [0, 0] };

    /// The workgroups that cover a rectangle of this size in pixels.
    pub(crate) fn of_size(pixels: [u32; 2]) -> Self {
        Self { first: [0, 0], size: pixels.map(|side| side.div_ceil(WORKGROUP_SIDE)) }
    }

    /// The columns and rows of the pixels of a picture of this size that the workgroups cover.
    pub(crate) fn pixels_in(self, size: [u32; 2]) -> [Range<usize>; 2] {
        [0, 1].map(|axis| {
            let (first, count) = (self.first[axis], self.size[axis]);
            let end = ((first + count) * WORKGROUP_SIDE).min(size[axis]);
            (first * WORKGROUP_SIDE).min(end) as usize..end as usize
        })
    }

    /// The indices of these pixels, row by row.
    pub(crate) fn indices(self, size: [u32; 2]) -> impl Iterator<Item = usize> {
        let ([columns, rows], width) = (self.pixels_in(size), size[0] as usize);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// Number of workgroups.
    pub(crate) fn count(self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Number of pixels of the workgroups, including any outside the picture.
    pub(crate) fn pixels(self) -> u64 {
        self.count() * u64::from(WORKGROUP_SIDE * WORKGROUP_SIDE)
    }

    /// Removes at most about `count` of the remaining workgroups: whole rows, or a part of one row.
    pub(crate) fn take(left: &mut Vec<Self>, count: u64) -> Option<Self> {
        let Self { first: [x, y], size: [width, height] } = left.pop()?;
        if width == 0 || height == 0 {
            return Self::take(left, count);
        }
        let mut leave = |first: [u32; 2], size: [u32; 2]| {
            if size[0] > 0 && size[1] > 0 {
                left.push(Self { first, size });
            }
        };
        let rows = (count / u64::from(width)).min(u64::from(height)) as u32;
        if rows > 0 {
            leave([x, y + rows], [width, height - rows]);
            return Some(Self { first: [x, y], size: [width, rows] });
        }
        // This is less than a row, so it fits into u32.
        let columns = (count as u32).max(1);
        leave([x, y + 1], [width, height - 1]);
        leave([x + columns, y], [width - columns, 1]);
        Some(Self { first: [x, y], size: [columns, 1] })
    }
}

/// Size of tiles of at most `max_pixels` pixels, for a device whose textures have sides of at most `side_limit` pixels.
pub(crate) fn tile_size(film: &Film, max_pixels: u64, side_limit: u32) -> [u32; 2] {
    let (width, height) = (film.width().min(side_limit), film.height().min(side_limit));
    // No device has sides of more than 2^15 pixels, so one row of workgroups always fits.
    let rows = (max_pixels / u64::from(width)) as u32;
    [width, height.min((rows / WORKGROUP_SIDE).max(1) * WORKGROUP_SIDE)]
}

/// Divides a tile into bands of at most `rows` rows.
pub(crate) fn bands(tile: Tile, rows: u32) -> impl Iterator<Item = Tile> {
    let height = tile.size[1];
    (0..height).step_by(rows as usize).map(move |y| Tile {
        origin: [tile.origin[0], tile.origin[1] + y],
        size: [tile.size[0], rows.min(height - y)],
        in_target: [tile.in_target[0], tile.in_target[1] + y],
    })
}

/// The tiles that cover a film. Tiles at its right and lower edges may be smaller.
pub(crate) fn tiles(film: &Film, tile_size: [u32; 2]) -> impl Iterator<Item = Tile> {
    let (width, height) = (film.width(), film.height());
    (0..height).step_by(tile_size[1] as usize).flat_map(move |y| {
        (0..width).step_by(tile_size[0] as usize).map(move |x| Tile {
            origin: [x, y],
            size: [tile_size[0].min(width - x), tile_size[1].min(height - y)],
            in_target: [0, 0],
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        for (width, height) in [(1, 1), (1, 5000), (9000, 3), (4096, 4096), (801, 599)] {
            let film = Film::new(width, height).unwrap();
            let size = tile_size(&film, 1 << 20, 8192);
            assert!(size[0] <= 8192 && size[1] <= 8192);
            let mut covered = vec![0_u8; film.pixel_count() as usize];
            for tile in tiles(&film, size) {
                for j in tile.origin[1]..tile.origin[1] + tile.size[1] {
                    for i in tile.origin[0]..tile.origin[0] + tile.size[0] {
                        covered[(j * width + i) as usize] += 1;
                    }
                }
            }
            assert!(covered.iter().all(|n| *n == 1), "{width}x{height}");
        }
    }

    #[test]
    fn slices_cover_every_workgroup_once() {
        for (size, count) in [([5, 7], 1), ([5, 7], 4), ([5, 7], 5), ([5, 7], 12), ([5, 7], 1000)] {
            let mut left = vec![Groups { first: [0, 0], size }];
            let mut covered = [[0; 5]; 7];
            while let Some(part) = Groups::take(&mut left, count) {
                assert!(part.count() <= count);
                for y in part.first[1]..part.first[1] + part.size[1] {
                    for x in part.first[0]..part.first[0] + part.size[0] {
                        covered[y as usize][x as usize] += 1;
                    }
                }
            }
            assert_eq!(covered, [[1; 5]; 7], "{count}");
        }
    }

    #[test]
    fn bands_follow_each_other_in_film_and_target() {
        let tile = Tile { origin: [5, 7], size: [11, 10], in_target: [0, 0] };
        let bands: Vec<Tile> = bands(tile, 4).collect();
        assert_eq!(bands.iter().map(|band| band.size[1]).collect::<Vec<_>>(), [4, 4, 2]);
        assert_eq!(bands[2], Tile { origin: [5, 15], size: [11, 2], in_target: [0, 8] });
    }
}
