//! Places in the pictures of a report: a pixel with those around it, and rectangles.

use serde::Serialize;

use super::verify_pictures::Window;

/// Width and height of an enlarged pixel in CSS pixels.
const ZOOM: u32 = 11;

/// Where a pixel is in its enlarged part and in the whole picture.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Spot {
    /// Width of the enlarged part in CSS pixels.
    width: u32,
    height: u32,
    zoom: u32,
    /// Offset of the pixel in the enlarged part, in CSS pixels.
    left: u32,
    top: u32,
    /// Position of the pixel in the whole picture, in percent.
    x: f64,
    y: f64,
}

impl Spot {
    /// The part of a film around a pixel, and the place of the pixel.
    pub(super) fn around(pixel: [u32; 2], film: [u32; 2]) -> (Window, Self) {
        let window = Window::around(pixel, film);
        let at = |axis: usize| pixel[axis].saturating_sub(window.first[axis]) * ZOOM;
        let percent =
            |axis: usize| 100.0 * (f64::from(pixel[axis]) + 0.5) / f64::from(film[axis].max(1));
        let spot = Self {
            width: window.size[0] * ZOOM,
            height: window.size[1] * ZOOM,
            zoom: ZOOM,
            left: at(0),
            top: at(1),
            x: percent(0),
            y: percent(1),
        };
        (window, spot)
    }
}

/// A rectangle of the film in percent of the whole picture.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Area {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Area {
    pub(super) fn new([x, y, width, height]: [u32; 4], film: [u32; 2]) -> Self {
        let part =
            |pixels: u32, axis: usize| 100.0 * f64::from(pixels) / f64::from(film[axis].max(1));
        Self { left: part(x, 0), top: part(y, 1), width: part(width, 0), height: part(height, 1) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_those_of_the_pixel() {
        let (window, spot) = Spot::around([50, 3], [100, 40]);
        assert_eq!((window.first, window.size), ([42, 0], [16, 16]));
        assert_eq!((spot.left, spot.top, spot.width), (88, 33, 176));
        assert_eq!((spot.x, spot.y), (50.5, 8.75));
        let area = Area::new([25, 10, 50, 20], [100, 40]);
        assert_eq!((area.left, area.top, area.width, area.height), (25.0, 25.0, 50.0, 50.0));
    }
}
