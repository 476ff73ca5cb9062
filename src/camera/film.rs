//! The picture's size, and the relative location of each pixel.

use glam::DVec2;

/// The row of the picture that has y = +1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
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
///
/// A film may be a part of another one, see [`Film::part`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Film {
    width: u32,
    height: u32,
    y_axis: YAxis,
    /// Column and row of the first pixel in the whole film.
    origin: [u32; 2],
    /// Width and height of the whole film.
    whole: [u32; 2],
}

/// The reason why numbers do not make a film, and what would be right.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct FilmError(String);

impl Default for Film {
    /// A film of 800 by 600 pixels with y up.
    fn default() -> Self {
        Self { width: 800, height: 600, y_axis: YAxis::Up, origin: [0; 2], whole: [800, 600] }
    }
}

impl Film {
    /// The largest width or height. Below 2²³, a pixel centre is exact in f32.
    pub const MAX_SIDE: u32 = 1 << 23;

    /// A film with y up.
    ///
    /// # Errors
    /// Returns an error if a side is zero or more than [`Film::MAX_SIDE`].
    pub fn new(width: u32, height: u32) -> Result<Self, FilmError> {
        has_pixels([width, height])?;
        if width.max(height) > Self::MAX_SIDE {
            return Err(FilmError(format!(
                "the size {width}x{height} is too large; no side may exceed {}",
                Self::MAX_SIDE
            )));
        }
        Ok(Self { width, height, y_axis: YAxis::Up, origin: [0; 2], whole: [width, height] })
    }

    /// A rectangle of this film, of `size` (width and height) pixels, whose first pixel is at `origin` (column and row).
    ///
    /// A picture on the part has the same pixels as a picture on the whole film, to the bit, on one kind of device. So
    /// several machines can render one picture. [`Image::put`](crate::image::Image::put) joins the parts. Steps that read
    /// neighbours of pixels need the whole picture, so render parts with
    /// [`RenderSettings::unfinished`](crate::render::RenderSettings::unfinished).
    ///
    /// # Errors
    /// Returns an error if the rectangle has no pixel or is not inside this film.
    pub fn part(&self, origin: [u32; 2], size: [u32; 2]) -> Result<Self, FilmError> {
        has_pixels(size)?;
        let ([width, height], film) = (size, [self.width, self.height]);
        let fits = |axis: usize| origin[axis].checked_add(size[axis]).is_some_and(|end| end <= film[axis]);
        if !(fits(0) && fits(1)) {
            return Err(FilmError(format!(
                "the rectangle of {width}x{height} pixels at column {} and row {} is not inside a film of {}x{} pixels",
                origin[0], origin[1], film[0], film[1]
            )));
        }
        let origin = self.in_whole(origin);
        Ok(Self { width, height, origin, ..*self })
    }

    /// The film with each pixel divided into `side` rows of `side` pixels; `None` if it is too large. If `side` is odd, the
    /// middle one of these has the centre of the pixel.
    pub(crate) fn divided(&self, side: u32) -> Option<Self> {
        let times = |count: u32| count.checked_mul(side).filter(|count| *count <= Self::MAX_SIDE);
        let both = |[x, y]: [u32; 2]| Some([times(x)?, times(y)?]);
        let [width, height] = both([self.width, self.height])?;
        Some(Self { width, height, origin: both(self.origin)?, whole: both(self.whole)?, ..*self })
    }

    /// The film that contains this part. A whole film returns itself.
    #[must_use]
    pub fn whole(&self) -> Self {
        let [width, height] = self.whole;
        Self { width, height, origin: [0; 2], ..*self }
    }

    /// Returns true if this is a whole film and not a part of a larger one.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.whole == [self.width, self.height]
    }

    /// Column and row in the whole film of this film's first pixel.
    #[must_use]
    pub fn origin(&self) -> [u32; 2] {
        self.origin
    }

    /// Column and row in the whole film of a pixel of this film.
    pub(crate) fn in_whole(&self, [column, row]: [u32; 2]) -> [u32; 2] {
        [self.origin[0] + column, self.origin[1] + row]
    }

    /// The film with another direction of y.
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

    /// The aspect ratio of the whole film: width over height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        let [width, height] = self.whole.map(f64::from);
        width / height
    }

    /// The relative location on the whole film, in [−1, 1]², of a point that is `column` pixels from the left edge of
    /// this film and `row` pixels from its top edge. The centre of pixel (i, j) is (i + ½, j + ½).
    #[must_use]
    pub fn relative_location(&self, column: f64, row: f64) -> DVec2 {
        let ([left, top], [width, height]) = (self.origin.map(f64::from), self.whole.map(f64::from));
        let x = (left + column) / width * 2.0 - 1.0;
        let y_down = (top + row) / height * 2.0 - 1.0;
        match self.y_axis {
            YAxis::Up => DVec2::new(x, -y_down),
            YAxis::Down => DVec2::new(x, y_down),
        }
    }
}

fn has_pixels([width, height]: [u32; 2]) -> Result<(), FilmError> {
    if width > 0 && height > 0 {
        return Ok(());
    }
    Err(FilmError(format!("the size {width}x{height} has no pixel; width and height must be at least 1")))
}
