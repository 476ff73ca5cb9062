//! Cutting a film into tiles.

use crate::film::Film;

/// The most pixels of a tile: its largest buffer then takes about 64 MiB, half of WebGPU's smallest limit.
pub(super) const MAX_PIXELS: u64 = 1 << 22;

/// About how many spheres are tried in one submission: some seconds of a software device's time. Tiles
/// are not cut below one workgroup, so that with more than 2²⁴ spheres it becomes more.
const TESTS_PER_SUBMISSION: u64 = 1 << 30;

/// The side of a workgroup, as in `@workgroup_size(8, 8)`.
pub(super) const WORKGROUP_SIDE: u32 = 8;

/// A rectangle of the film, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tile {
    pub(super) origin: [u32; 2],
    pub(super) size: [u32; 2],
    /// Where it lies in the target textures.
    pub(super) in_target: [u32; 2],
}

/// The size of tiles for a device whose textures have sides of at most `side_limit` pixels.
pub(super) fn tile_size(film: &Film, side_limit: u32, sphere_count: usize) -> [u32; 2] {
    let pixels = (TESTS_PER_SUBMISSION / sphere_count.max(1) as u64).min(MAX_PIXELS) as u32;
    let (width, height) = (film.width().min(side_limit), film.height().min(side_limit));
    if pixels / width >= WORKGROUP_SIDE {
        return [width, height.min(pixels / width)];
    }
    // One row of workgroups, and as many of them as may be.
    let side = WORKGROUP_SIDE;
    let narrow = (pixels / (side * side)).max(1) * side;
    [width.min(narrow), height.min(side)]
}

/// Cuts a tile into bands of at most so many rows.
pub(super) fn bands(tile: Tile, rows: u32) -> impl Iterator<Item = Tile> {
    let height = tile.size[1];
    (0..height).step_by(rows as usize).map(move |y| Tile {
        origin: [tile.origin[0], tile.origin[1] + y],
        size: [tile.size[0], rows.min(height - y)],
        in_target: [tile.in_target[0], tile.in_target[1] + y],
    })
}

/// The tiles that cover the film; those at the right and lower edge may be smaller.
pub(super) fn tiles(film: &Film, tile_size: [u32; 2]) -> impl Iterator<Item = Tile> {
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
    fn more_spheres_make_smaller_tiles_of_whole_workgroups() {
        let film = Film::new(4096, 4096).unwrap();
        assert_eq!(tile_size(&film, 8192, 3), [4096, 1024]);
        assert_eq!(tile_size(&film, 8192, 10_000), [4096, 26]);
        assert_eq!(tile_size(&film, 8192, 1_000_000), [128, 8]);
        assert_eq!(tile_size(&film, 8192, 100_000_000), [8, 8]);
    }

    #[test]
    fn bands_follow_each_other_in_film_and_target() {
        let tile = Tile { origin: [5, 7], size: [11, 10], in_target: [0, 0] };
        let bands: Vec<Tile> = bands(tile, 4).collect();
        assert_eq!(bands.iter().map(|band| band.size[1]).collect::<Vec<_>>(), [4, 4, 2]);
        assert_eq!(bands[2], Tile { origin: [5, 15], size: [11, 2], in_target: [0, 8] });
    }
}
