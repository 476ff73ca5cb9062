//! Which frames are rendered: ranges like those of Python.

use std::str::FromStr;

/// Frames of a file: one of them, or those of a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FrameRange {
    /// One frame; a negative number counts from the end.
    One(i64),
    /// `START:END:STEP`, with the end excluded.
    Slice { start: Option<i64>, end: Option<i64>, step: i64 },
}

const WANTED: &str = "write START:END or START:END:STEP, such as 0:100:2, : for all, or one number; negative numbers \
                      count from the end, and END is excluded";

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<i64>().map_err(|_| WANTED.to_owned());
        let optional = |text: &str| match text.trim() {
            "" => Ok(None),
            text => number(text).map(Some),
        };
        let parts: Vec<&str> = text.split(':').collect();
        let (start, end, step) = match parts[..] {
            [one] => return number(one).map(Self::One),
            [start, end] => (start, end, ""),
            [start, end, step] => (start, end, step),
            _ => return Err(WANTED.to_owned()),
        };
        let step = optional(step)?.unwrap_or(1);
        if step == 0 {
            return Err("the step must not be 0".to_owned());
        }
        Ok(Self::Slice { start: optional(start)?, end: optional(end)?, step })
    }
}

impl FrameRange {
    /// All frames.
    pub(crate) const ALL: Self = Self::Slice { start: None, end: None, step: 1 };

    /// Returns the numbers of the frames of a file that has `count` frames.
    pub(crate) fn of(self, count: usize) -> Result<Vec<usize>, String> {
        // A count is far below the limit of i64, because each frame has some bytes in the file.
        let count = count as i64;
        let from_end = |number: i64| if number < 0 { number.saturating_add(count) } else { number };
        let plural = if count == 1 { "" } else { "s" };
        let (start, end, step) = match self {
            Self::One(number) => {
                let index = from_end(number);
                if !(0..count).contains(&index) {
                    return Err(format!(
                        "there is no frame {number}; the file has {count} frame{plural}, 0 to {}",
                        count - 1
                    ));
                }
                return Ok(vec![index as usize]);
            }
            Self::Slice { start, end, step } => (start, end, step),
        };
        // As Python clips them.
        let (low, high) = if step > 0 { (0, count) } else { (-1, count - 1) };
        let clip = |number: i64| from_end(number).clamp(low, high);
        let (first, last) = if step > 0 { (low, high) } else { (high, low) };
        let (start, end) = (start.map_or(first, clip), end.map_or(last, clip));
        let mut frames = Vec::new();
        let mut next = start;
        while if step > 0 { next < end } else { next > end } {
            frames.push(next as usize);
            next = next.saturating_add(step);
        }
        if frames.is_empty() {
            return Err(format!(
                "no frame lies in this range; the file has {count} frame{plural}, 0 to {}",
                count - 1
            ));
        }
        Ok(frames)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str, count: usize) -> Result<Vec<usize>, String> {
        text.parse::<FrameRange>()?.of(count)
    }

    /// What Python gives for `list(range(5))[text]`.
    #[test]
    fn ranges_are_those_of_python() {
        for (text, expected) in [
            (":", &[0, 1, 2, 3, 4][..]),
            ("::", &[0, 1, 2, 3, 4]),
            ("1:", &[1, 2, 3, 4]),
            (":2", &[0, 1]),
            ("0:100:2", &[0, 2, 4]),
            ("-2:", &[3, 4]),
            (":-2", &[0, 1, 2]),
            ("-99:2", &[0, 1]),
            ("::-1", &[4, 3, 2, 1, 0]),
            ("3:0:-2", &[3, 1]),
            ("9::-4", &[4, 0]),
            (":-3:-1", &[4, 3]),
            ("::9223372036854775807", &[0]),
            ("::-9223372036854775808", &[4]),
        ] {
            assert_eq!(frames(text, 5).as_deref(), Ok(expected), "{text}");
        }
        assert_eq!(frames("-1", 5), Ok(vec![4]));
        assert_eq!(frames(" 3 ", 5), Ok(vec![3]));
    }

    #[test]
    fn what_has_no_frame_is_refused() {
        for text in ["5", "-6", "3:3", "4:2", "7:", "2:4:-1"] {
            let error = frames(text, 5).unwrap_err();
            assert!(error.ends_with("the file has 5 frames, 0 to 4"), "{text}: {error}");
        }
        for text in ["", "a", "1:2:3:4", "1.5", "1:b", "0::x"] {
            assert_eq!(frames(text, 5).unwrap_err(), WANTED, "{text}");
        }
        assert_eq!(frames("::0", 5).unwrap_err(), "the step must not be 0");
    }
}
