//! Cutting a film into tiles.

use crate::film::Film;

/// The most pixels of a tile. With it no buffer of a tile exceeds 64 MiB, half of WebGPU's smallest
/// limit, whatever the device.
const MAX_PIXELS: u64 = 1 << 22;

/// The fewest pixels that a tile is cut down to for the sake of time.
const MIN_PIXELS: u64 = 1 << 14;

/// About how many spheres are tried in one submission, so that it ends within seconds even on a
/// software device.
const TESTS_PER_SUBMISSION: u64 = 1 << 32;

/// A rectangle of the film, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tile {
    pub(super) origin: [u32; 2],
    pub(super) size: [u32; 2],
}

/// The size of tiles for a device whose textures have sides of at most `side_limit` pixels.
pub(super) fn tile_size(film: &Film, side_limit: u32, sphere_count: usize) -> [u32; 2] {
    let pixels = (TESTS_PER_SUBMISSION / sphere_count.max(1) as u64).clamp(MIN_PIXELS, MAX_PIXELS);
    let width = film.width().min(side_limit);
    // At most MAX_PIXELS, so it fits; at least one row, however wide.
    let rows = (pixels / u64::from(width)).max(1) as u32;
    [width, rows.min(film.height()).min(side_limit)]
}

/// The tiles that cover the film; those at the right and lower edge may be smaller.
pub(super) fn tiles(film: &Film, tile_size: [u32; 2]) -> impl Iterator<Item = Tile> {
    let (width, height) = (film.width(), film.height());
    (0..height).step_by(tile_size[1] as usize).flat_map(move |y| {
        (0..width).step_by(tile_size[0] as usize).map(move |x| Tile {
            origin: [x, y],
            size: [tile_size[0].min(width - x), tile_size[1].min(height - y)],
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        for (width, height, spheres) in
            [(1, 1, 0), (1, 5000, 3), (9000, 3, 1), (4096, 4096, 10), (801, 599, 1_000_000)]
        {
            let film = Film::new(width, height).unwrap();
            let size = tile_size(&film, 8192, spheres);
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
    fn more_spheres_make_smaller_tiles() {
        let film = Film::new(4096, 4096).unwrap();
        let pixels = |spheres| tile_size(&film, 8192, spheres).iter().product::<u32>();
        assert_eq!(pixels(3), 1 << 22);
        assert!(pixels(100_000) < pixels(3));
    }
}
