//! Units of work: which tile of which picture an index means, and lists of indices as schedulers write them.

use crate::failure::Failure;

/// A rectangle of a picture: column and row of the first pixel, and width and height.
pub(super) type Rectangle = ([u32; 2], [u32; 2]);

/// The tile with a number, counted row by row, of a picture of `size` pixels that is divided into columns and rows.
pub(super) fn tile(size: [u32; 2], tiles: [u32; 2], number: usize) -> Rectangle {
    let columns = tiles[0] as usize;
    let place = [number % columns, number / columns];
    let edge = |axis: usize, at: usize| {
        // At most the side, which fits.
        (u64::from(size[axis]) * at as u64 / u64::from(tiles[axis])) as u32
    };
    let origin = [0, 1].map(|axis| edge(axis, place[axis]));
    let end = [0, 1].map(|axis| edge(axis, place[axis] + 1));
    (origin, [end[0] - origin[0], end[1] - origin[1]])
}

/// Reads columns and rows of tiles, such as `4x4`, for a picture of `size` pixels.
pub(super) fn parse_tiles(text: &str, size: [u32; 2]) -> Result<[u32; 2], Failure> {
    let sides = text.split_once('x').and_then(|(columns, rows)| {
        Some([columns.trim().parse::<u32>().ok()?, rows.trim().parse::<u32>().ok()?])
    });
    let Some(tiles) = sides.filter(|sides| !sides.contains(&0)) else {
        return Err(Failure::usage(format!(
            "--tiles {text}: write columns and rows that are at least 1, such as 4x4"
        )));
    };
    if tiles[0] > size[0] || tiles[1] > size[1] {
        return Err(Failure::usage(format!(
            "--tiles {text}: a picture of {}x{} pixels has no room for so many tiles; choose fewer",
            size[0], size[1]
        )));
    }
    Ok(tiles)
}

/// Reads indices and ranges of indices, such as `0-15,20`, of which a job has `count`.
pub(super) fn parse_list(text: &str, count: usize) -> Result<Vec<usize>, Failure> {
    let wrong = || {
        Failure::usage(format!(
            "INDEX {text}: write an index, or indices and ranges such as 0-15,20"
        ))
    };
    let mut all = Vec::new();
    for range in text.split(',') {
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| wrong());
        let (first, last) = match range.split_once('-') {
            Some((first, last)) => (number(first)?, number(last)?),
            None => (number(range)?, number(range)?),
        };
        if last < first {
            return Err(wrong());
        }
        if last >= count {
            return Err(Failure::usage(format!(
                "INDEX {last}: this job has {count} unit{}, 0 to {}",
                if count == 1 { "" } else { "s" },
                count.saturating_sub(1)
            )));
        }
        all.extend(first..=last);
    }
    all.sort_unstable();
    all.dedup();
    Ok(all)
}

/// Writes indices, which ascend, as `sbatch --array` and [`parse_list`] read them.
pub(super) fn ranges(indices: &[usize]) -> String {
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for &index in indices {
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == index => *last = index,
            _ => ranges.push((index, index)),
        }
    }
    let words = ranges.into_iter().map(|(first, last)| match last - first {
        0 => first.to_string(),
        _ => format!("{first}-{last}"),
    });
    words.collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        for (size, tiles) in
            [([7, 5], [3, 2]), ([1, 1], [1, 1]), ([100, 3], [100, 3]), ([64, 48], [4, 4])]
        {
            let mut covered = vec![0; (size[0] * size[1]) as usize];
            for number in 0..(tiles[0] * tiles[1]) as usize {
                let ([x, y], [width, height]) = tile(size, tiles, number);
                assert!(width > 0 && height > 0);
                for row in y..y + height {
                    (x..x + width)
                        .for_each(|column| covered[(row * size[0] + column) as usize] += 1);
                }
            }
            assert!(covered.iter().all(|times| *times == 1), "{size:?} {tiles:?}");
        }
        let largest = 1 << 23;
        assert_eq!(tile([largest; 2], [largest; 2], 0), ([0, 0], [1, 1]));
    }

    #[test]
    fn lists_are_read_as_they_are_written() {
        for list in [vec![], vec![0], vec![0, 1, 2, 5, 7, 8], (0..1000).collect::<Vec<_>>()] {
            let text = ranges(&list);
            if !list.is_empty() {
                assert_eq!(parse_list(&text, 1000).unwrap(), list, "{text}");
            }
        }
        assert_eq!(ranges(&[0, 1, 2, 5, 7, 8]), "0-2,5,7-8");
        assert_eq!(parse_list("3, 1-2 ,1", 4).unwrap(), [1, 2, 3]);
        for wrong in
            ["", "a", "-1", "2-1", "1,", "1-", "4", "0-4", "1:2", "99999999999999999999999"]
        {
            assert!(parse_list(wrong, 4).is_err(), "{wrong}");
        }
    }

    #[test]
    fn tiles_have_columns_and_rows() {
        assert_eq!(parse_tiles("4x3", [4, 3]).unwrap(), [4, 3]);
        for wrong in ["", "4", "4x", "0x1", "1x0", "-1x1", "5x1", "1x4", "4x3x2"] {
            assert!(parse_tiles(wrong, [4, 3]).is_err(), "{wrong}");
        }
    }
}
