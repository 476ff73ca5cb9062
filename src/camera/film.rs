//! The picture's size, and which relative location belongs to a pixel.

use glam::DVec2;

/// Which row of the picture has y = +1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "scene-file", derive(serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum YAxis {
    /// y = +1 is the top row, so `up = (0, 1, 0)` gives a picture the right way up.
    #[default]
    Up,
    /// y = −1 is the top row, so `up = (0, −1, 0)` gives a picture the right way up.
    Down,
}

impl YAxis {
    /// The name of this direction in scene files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }
}

/// The size of a picture: width and height in pixels, and the direction of y. Row 0 is the top row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Film {
    width: u32,
    height: u32,
    y_axis: YAxis,
}

/// Why a width and height do not make a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// Width or height is zero.
    #[error("the size {width}x{height} has no pixel; width and height must be at least 1")]
    Empty {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// Width or height is more than [`Film::MAX_SIDE`].
    #[error("the size {width}x{height} is too large; no side may exceed {}", Film::MAX_SIDE)]
    TooLarge {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
}

impl Default for Film {
    /// A film of 800 by 600 pixels with y up.
    fn default() -> Self {
        Self { width: 800, height: 600, y_axis: YAxis::Up }
    }
}

impl Film {
    /// The largest width or height: below 2²³, a pixel centre is exact in f32.
    pub const MAX_SIDE: u32 = 1 << 23;

    /// A film with y up.
    ///
    /// # Errors
    /// Returns an error if a side is zero or more than [`Film::MAX_SIDE`].
    pub fn new(width: u32, height: u32) -> Result<Self, FilmError> {
        if width == 0 || height == 0 {
            return Err(FilmError::Empty { width, height });
        }
        if width.max(height) > Self::MAX_SIDE {
            return Err(FilmError::TooLarge { width, height });
        }
        Ok(Self { width, height, y_axis: YAxis::Up })
    }

    /// The same film with `y_axis` as its direction of y.
    #[must_use]
    pub fn with_y_axis(self, y_axis: YAxis) -> Self {
        Self { y_axis, ..self }
    }

    /// Width in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The direction of y.
    #[must_use]
    pub fn y_axis(&self) -> YAxis {
        self.y_axis
    }

    /// The number of pixels: width times height.
    #[must_use]
    pub fn pixel_count(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The aspect ratio: width over height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        f64::from(self.width) / f64::from(self.height)
    }

    /// The relative location, in [−1, 1]², of a point of the picture that is `column` pixels from the
    /// left edge and `row` pixels from the top edge. The centre of pixel (i, j) is (i + ½, j + ½).
    #[must_use]
    pub fn relative_location(&self, column: f64, row: f64) -> DVec2 {
        let x = column / f64::from(self.width) * 2.0 - 1.0;
        let y_down = row / f64::from(self.height) * 2.0 - 1.0;
        match self.y_axis {
            YAxis::Up => DVec2::new(x, -y_down),
            YAxis::Down => DVec2::new(x, y_down),
        }
    }
}
