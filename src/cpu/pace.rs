//! The pace of a render: how much is rendered between two calls of the caller, and errors of rendering.

use std::ops::Range;
use std::time::{Duration, Instant};

use crate::image::ImageTooLarge;
use crate::parallel;
use crate::render::SettingsError;

/// The reason why a picture cannot be rendered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The settings, or the materials of the scene, are not valid.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// There is not enough memory for the image.
    #[error(transparent)]
    Image(#[from] ImageTooLarge),
    /// The caller ended the work.
    #[error("rendering was stopped")]
    Stopped,
}

/// The intended time between two calls. It is short enough for a person, and so long that waiting for the slowest
/// thread does not matter.
const AIM: Duration = Duration::from_millis(60);

/// The largest number of strips that are rendered together. References to the layers of their rows may need more memory
/// than narrow rows.
const MOST: usize = 512;

/// Divides the strips of a picture into bands that take about the same time.
#[derive(Debug)]
pub(super) struct Pace {
    /// The number of strips of the next band.
    strips: usize,
    /// The smallest number of strips of a band, except the last. There is one for each thread, so that no thread waits.
    least: usize,
}

impl Pace {
    /// Starts with the shortest possible band, because nothing is known yet.
    pub(super) fn new() -> Self {
        let least = parallel::threads();
        Self { strips: least, least }
    }

    /// Calls `work` with bands of strips that together cover all `count` strips, until it returns an error.
    pub(super) fn run(
        &mut self,
        count: usize,
        mut work: impl FnMut(Range<usize>) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let mut start = 0;
        while start < count {
            let end = count.min(start + self.strips);
            let began = now();
            work(start..end)?;
            if let Some(began) = began {
                self.adapt(end - start, began.elapsed());
            }
            start = end;
        }
        Ok(())
    }

    fn adapt(&mut self, strips: usize, elapsed: Duration) {
        let fitting = strips as f64 * AIM.as_secs_f64() / elapsed.as_secs_f64().max(1e-6);
        // Conversions saturate. The next band may be harder than this one.
        self.strips = (fitting as usize).clamp(self.least, MOST.max(self.least)).min(4 * self.strips);
    }
}

/// The current time. `None` in a browser, where the standard library has no clock.
fn now() -> Option<Instant> {
    (!cfg!(target_arch = "wasm32")).then(Instant::now)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_grow_to_the_time_that_is_aimed_at() {
        let mut pace = Pace { strips: 1, least: 1 };
        for wanted in [4, 16, 64, 100, 100] {
            // A strip takes a hundredth of the time.
            pace.adapt(pace.strips, AIM * pace.strips as u32 / 100);
            assert_eq!(pace.strips, wanted);
        }
        pace.adapt(100, 1000 * AIM);
        assert_eq!(pace.strips, 1);
        let mut on_eight = Pace { strips: 8, least: 8 };
        on_eight.adapt(8, 1000 * AIM);
        assert_eq!(on_eight.strips, 8);
    }

    #[test]
    fn bands_are_the_whole() {
        let (mut pace, mut next) = (Pace::new(), 0);
        pace.run(1000, |band| {
            assert_eq!(band.start, next);
            next = band.end;
            Ok(())
        })
        .unwrap();
        assert_eq!(next, 1000);
        let stopped = Pace::new().run(3, |_| Err(RenderError::Stopped));
        assert_eq!(stopped, Err(RenderError::Stopped));
    }
}
