//! Movies on standard output as YUV4MPEG2, which is not compressed.

use std::io::{self, Write};

use super::sink::{Samples, Sink};

/// Writes pictures with full resolution of colour, in the limited range of ITU-R BT.601, which readers assume.
pub(super) fn write(sink: &Sink<'_>, samples: &Samples<'_>) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match write_to(sink, samples, &mut out).and_then(|()| out.flush()) {
        // The reader has closed the pipe because it needs no more.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

fn write_to(sink: &Sink<'_>, samples: &Samples<'_>, out: &mut impl Write) -> io::Result<()> {
    let ([width, height], per_second) = (sink.size, sink.frames_per_second);
    writeln!(out, "YUV4MPEG2 W{width} H{height} F{per_second}:1 Ip A1:1 C444 XCOLORRANGE=LIMITED")?;
    while let Some(rgb) = samples.next()? {
        out.write_all(b"FRAME\n")?;
        out.write_all(&planes(&rgb))?;
    }
    Ok(())
}

/// The planes Y, Cb and Cr of a picture of RGB bytes, one after the other.
fn planes(rgb: &[u8]) -> Vec<u8> {
    let pixels = rgb.len() / 3;
    let mut planes = vec![0; 3 * pixels];
    for (index, pixel) in rgb.chunks_exact(3).enumerate() {
        for (plane, value) in yuv([pixel[0], pixel[1], pixel[2]]).into_iter().enumerate() {
            planes[plane * pixels + index] = value;
        }
    }
    planes
}

fn yuv(rgb: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = rgb.map(|c| f32::from(c) / 255.0);
    let y = 0.299 * r + 0.587 * g + 0.114 * b;
    let (cb, cr) = ((b - y) / 1.772, (r - y) / 1.402);
    [16.0 + 219.0 * y, 128.0 + 224.0 * cb, 128.0 + 224.0 * cr].map(|v| v.round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values of the standard.
    #[test]
    fn colors_are_those_of_bt_601() {
        for (rgb, expected) in [
            ([0, 0, 0], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128]),
            ([255, 0, 0], [81, 90, 240]),
            ([0, 255, 0], [145, 54, 34]),
            ([0, 0, 255], [41, 240, 110]),
        ] {
            assert_eq!(yuv(rgb), expected, "{rgb:?}");
        }
        assert_eq!(planes(&[255, 255, 255, 0, 0, 0]), [235, 16, 128, 128, 128, 128]);
    }
}
