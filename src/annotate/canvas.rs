//! The samples of a picture in sRGB, which annotations are blended into.

use crate::image::encoding::Bits;

/// A picture of RGB or RGBA samples in sRGB, row by row from the top. Alpha is not premultiplied.
#[derive(Debug)]
pub struct Canvas<'a> {
    size: [u32; 2],
    channels: usize,
    bits: Bits,
    samples: &'a mut [u8],
}

impl<'a> Canvas<'a> {
    /// A canvas of this width and height on samples: 3 (RGB) or 4 (RGBA) for each pixel, each of one byte or of two
    /// bytes with the high one first. `None` unless the number of bytes is right.
    #[must_use]
    pub fn new(size: [u32; 2], channels: usize, bits: Bits, samples: &'a mut [u8]) -> Option<Self> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let bytes = pixels * channels as u64 * bits.bytes() as u64;
        let is_right = matches!(channels, 3 | 4) && bytes == samples.len() as u64;
        is_right.then_some(Self { size, channels, bits, samples })
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// How bright a pixel looks over white, from 0 to 1: its luma, of encoded components.
    pub(super) fn luma(&self, x: u32, y: u32) -> f32 {
        let Some(start) = self.start(i64::from(x), i64::from(y)) else { return 1.0 };
        let of = |channel| self.sample(start, channel) / 255.0;
        let luma = 0.2126 * of(0) + 0.7152 * of(1) + 0.0722 * of(2);
        if self.channels == 4 { luma * of(3) + 1.0 - of(3) } else { luma }
    }

    /// Blends a colour over a pixel: `coverage` is from 0, no change, to 1, exactly this colour. Pixels outside are left
    /// out.
    pub(super) fn blend(&mut self, x: i64, y: i64, color: [u8; 3], coverage: f32) {
        let Some(start) = self.start(x, y) else { return };
        if coverage.is_nan() || coverage <= 0.0 {
            return;
        }
        let over = coverage.min(1.0);
        let below = if self.channels == 4 { self.sample(start, 3) / 255.0 } else { 1.0 };
        let alpha = over + below * (1.0 - over);
        for (channel, byte) in color.into_iter().enumerate() {
            let (new, old) = (f32::from(byte), self.sample(start, channel));
            let blended =
                if over >= 1.0 { new } else { (new * over + old * below * (1.0 - over)) / alpha };
            self.set(start, channel, blended);
        }
        if self.channels == 4 {
            self.set(start, 3, 255.0 * alpha);
        }
    }

    /// The index of the first byte of a pixel.
    fn start(&self, x: i64, y: i64) -> Option<usize> {
        let [width, height] = self.size.map(i64::from);
        let is_inside = (0..width).contains(&x) && (0..height).contains(&y);
        let pixel = usize::try_from(y * width + x).ok().filter(|_| is_inside)?;
        Some(pixel * self.channels * self.bits.bytes())
    }

    /// A sample on a scale from 0 to 255.
    fn sample(&self, start: usize, channel: usize) -> f32 {
        match self.bits {
            Bits::Eight => self.samples[start + channel].into(),
            Bits::Sixteen => {
                let at = start + 2 * channel;
                f32::from(u16::from_be_bytes([self.samples[at], self.samples[at + 1]])) / 257.0
            }
        }
    }

    fn set(&mut self, start: usize, channel: usize, value: f32) {
        match self.bits {
            Bits::Eight => self.samples[start + channel] = value.round() as u8,
            Bits::Sixteen => {
                let at = start + 2 * channel;
                let bytes = ((257.0 * value).round() as u16).to_be_bytes();
                self.samples[at..at + 2].copy_from_slice(&bytes);
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "what is compared is exact")]
mod tests {
    use super::*;

    #[test]
    fn full_coverage_gives_exactly_the_color() {
        let mut eight = vec![7; 3];
        let mut canvas = Canvas::new([1, 1], 3, Bits::Eight, &mut eight).unwrap();
        canvas.blend(0, 0, [1, 128, 255], 1.0);
        canvas.blend(1, 0, [9; 3], 1.0);
        canvas.blend(0, -1, [9; 3], 1.0);
        canvas.blend(0, 0, [9; 3], f32::NAN);
        assert_eq!(eight, [1, 128, 255]);
        let mut sixteen = vec![7; 8];
        let mut canvas = Canvas::new([1, 1], 4, Bits::Sixteen, &mut sixteen).unwrap();
        canvas.blend(0, 0, [1, 128, 255], 1.0);
        assert_eq!(sixteen, [1, 1, 128, 128, 255, 255, 255, 255]);
    }

    #[test]
    fn blending_over_a_clear_pixel_gives_the_color_with_its_coverage_as_alpha() {
        let mut rgba = vec![200, 10, 30, 0];
        let mut canvas = Canvas::new([1, 1], 4, Bits::Eight, &mut rgba).unwrap();
        assert_eq!(canvas.luma(0, 0), 1.0);
        canvas.blend(0, 0, [50, 100, 150], 0.4);
        assert_eq!(rgba, [50, 100, 150, 102]);
        let mut rgb = vec![0, 100, 200];
        let mut canvas = Canvas::new([1, 1], 3, Bits::Eight, &mut rgb).unwrap();
        canvas.blend(0, 0, [100, 100, 100], 0.25);
        assert_eq!(rgb, [25, 100, 175]);
    }

    #[test]
    fn the_number_of_samples_must_be_right() {
        assert!(Canvas::new([2, 2], 3, Bits::Eight, &mut [0; 11]).is_none());
        assert!(Canvas::new([2, 2], 2, Bits::Eight, &mut [0; 8]).is_none());
    }
}
