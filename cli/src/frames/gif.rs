//! Movies as GIF, with a palette of 256 colours for each picture.

use std::io::{self, BufWriter, Write};

use gif::{Encoder, EncodingError, Frame, Repeat};

use super::sink::{Samples, Sink};

/// How much of a picture the choice of its palette looks at, from 1 (all, slow) to 30.
const SPEED: i32 = 10;

/// Writes pictures that repeat without end.
pub(super) fn write(sink: &Sink<'_>, samples: &Samples<'_>, file: impl Write) -> io::Result<()> {
    let failed = |error: EncodingError| match error {
        EncodingError::Io(error) => error,
        error => io::Error::other(error),
    };
    // The size was checked before.
    let [width, height] = sink.size.map(|side| u16::try_from(side).unwrap_or(u16::MAX));
    let mut out = BufWriter::new(file);
    let mut encoder = Encoder::new(&mut out, width, height, &[]).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    let mut index = 0;
    while let Some(picture) = samples.next()? {
        let mut frame = Frame::from_rgb_speed(width, height, &picture, SPEED);
        frame.delay = delay(index, sink.frames_per_second);
        encoder.write_frame(&frame).map_err(failed)?;
        index += 1;
    }
    drop(encoder);
    out.flush()
}

/// How long a picture is shown, in hundredths of a second. Each is rounded such that all together have the right length.
fn delay(index: u64, per_second: u32) -> u16 {
    let ends_at = |index: u64| (index * 100 + u64::from(per_second) / 2) / u64::from(per_second);
    u16::try_from(ends_at(index + 1) - ends_at(index)).unwrap_or(u16::MAX)
}

#[cfg(test)]
mod tests {
    use super::delay;

    #[test]
    fn a_second_takes_a_second() {
        for per_second in [1, 7, 24, 25, 30, 60, 240] {
            let sum: u32 =
                (0..u64::from(per_second)).map(|i| u32::from(delay(i, per_second))).sum();
            assert_eq!(sum, 100, "{per_second}");
        }
        assert_eq!(delay(5, 25), 4);
    }
}
